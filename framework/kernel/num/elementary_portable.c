/* elementary_portable.c -- elementary functions and powers: two lanes, any machine. */
#define AMBIT_LANES 2
#define AMBIT_VARIANT ambit_elementary_portable
#define AMBIT_POWER ambit_power_portable
#include "num/elementary_map.h"
#include "num/power_map.h"
