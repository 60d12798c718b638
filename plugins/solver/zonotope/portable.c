/* portable.c -- sums of rows for every machine. */
#define VARIANT sum_portable
#include "sum.h"
#define MULTIPLY quartic_portable
#define MULTIPLY_FAR far_portable
#define ADD add_portable
#define MEASURE measure_portable
#include "multiply.h"
