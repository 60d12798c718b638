/* portable.c -- two doubles at a time: SSE2 on x86-64, the compiler's vectors elsewhere; no fused multiply-add. */
#define VARIANT kernels_portable
#include "variant.h"
