/* elementary_avx2.c -- elementary functions and powers: four lanes (AVX2 and FMA). Its flags are in
** cmake/elementary.cmake. */
#if defined(__x86_64__)
#define AMBIT_LANES 4
#define AMBIT_VARIANT ambit_elementary_avx2
#define AMBIT_REMAINDER ambit_elementary_fma
#define AMBIT_POWER ambit_power_avx2
#define AMBIT_POWER_REMAINDER ambit_power_fma
#include "num/elementary_map.h"
#include "num/power_map.h"
#endif
