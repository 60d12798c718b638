/* avx512.c -- eight doubles at a time, fused multiply-add; compiled with -mavx512f and friends (plugin.cmake). */
#include "kernels.h"
#if defined(__x86_64__)
#define VARIANT kernels_avx512
#include "variant.h"
#endif
