/* elementary_avx512.c -- elementary functions and powers: eight lanes (AVX-512 F and DQ). Its flags are in
** cmake/elementary.cmake. */
#if defined(__x86_64__)
#define AMBIT_LANES 8
#define AMBIT_VARIANT ambit_elementary_avx512
#define AMBIT_REMAINDER ambit_elementary_avx2
#define AMBIT_POWER ambit_power_avx512
#define AMBIT_POWER_REMAINDER ambit_power_avx2
#include "num/elementary_map.h"
#include "num/power_map.h"
#endif
