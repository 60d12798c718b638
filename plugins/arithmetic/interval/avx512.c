/* avx512.c -- the plugin with AVX-512 (F, DQ, VL) and FMA; its flags are in plugin.cmake. */
#if defined(__x86_64__)
#define VARIANT interval_avx512
#define VARIANT_NAME "AVX-512"
#include "variant.h"
#endif
