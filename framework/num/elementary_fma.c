/* elementary_fma.c -- elementary functions: one lane with fused multiply-add. Its flags are in
** cmake/elementary.cmake. */
#if defined(__x86_64__)
#define AMBIT_LANES 1
#define AMBIT_VARIANT ambit_elementary_fma
#include "num/elementary_map.h"
#endif
