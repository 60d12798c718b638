/* avx2.c -- sums of rows in vectors of four; compiled with -mavx2 (plugin.cmake). */
#if defined(__x86_64__)
#define VARIANT sum_avx2
#include "sum.h"
#define MULTIPLY quartic_avx2
#define MULTIPLY_FAR far_avx2
#define ADD add_avx2
#define MEASURE measure_avx2
#include "multiply.h"
#else
typedef int nothing_here;
#endif
