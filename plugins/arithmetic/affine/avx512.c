/* avx512.c -- eight doubles at a time, fused multiply-add; compiled with -mavx512f (plugin.cmake). */
#include "affine.h"
#if defined(__x86_64__)
#define VARIANT affine_avx512
#include "variant.h"
#endif
