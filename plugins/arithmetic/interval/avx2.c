/* avx2.c -- the plugin with AVX2 and FMA; its flags are in plugin.cmake. */
#if defined(__x86_64__)
#define VARIANT interval_avx2
#define VARIANT_NAME "AVX2"
#define JETS interval_avx2_jets
#include "variant.h"
#endif
