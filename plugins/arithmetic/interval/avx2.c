/* avx2.c -- four doubles at a time, fused multiply-add; compiled with -mavx2 -mfma (plugin.cmake). */
#include "interval.h"
#if defined(__x86_64__)
#define VARIANT interval_avx2
#include "variant.h"
#endif
