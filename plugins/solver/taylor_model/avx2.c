/* avx2.c -- the product in vectors of four; compiled with -mavx2 (plugin.cmake). */
#if defined(__x86_64__)
#define VARIANT sum_convolve_avx2
#include "multiply.h"
#else
typedef int nothing_here;
#endif
