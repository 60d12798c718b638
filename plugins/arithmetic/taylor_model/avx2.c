/* avx2.c -- four doubles at a time, fused multiply-add; compiled with -mavx2 -mfma (plugin.cmake). */
#include "kernels.h"
#if defined(__x86_64__)
#define VARIANT kernels_avx2
#include "variant.h"
#endif
