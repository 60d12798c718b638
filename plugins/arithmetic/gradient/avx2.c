/* avx2.c -- four directions at a time; compiled with -mavx2 (plugin.cmake). */
#include "gradient.h"
#if defined(__x86_64__)
#define VARIANT gradient_avx2
#include "loops.h"
#endif
