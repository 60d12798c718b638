/* portable.c -- sums of rows for every machine. */
#define VARIANT sum_portable
#include "sum.h"
