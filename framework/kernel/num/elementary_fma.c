/* elementary_fma.c -- elementary functions and powers: two lanes with fused multiply-add. Its flags are in
** cmake/elementary.cmake. */
#if defined(__x86_64__)
#define AMBIT_LANES 2
#define AMBIT_VARIANT ambit_elementary_fma
#define AMBIT_POWER ambit_power_fma
#include "num/elementary_map.h"
#include "num/power_map.h"
#endif
