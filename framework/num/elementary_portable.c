/* elementary_portable.c -- elementary functions: one lane, any machine. */
#define AMBIT_LANES 1
#define AMBIT_VARIANT ambit_elementary_portable
#include "num/elementary_map.h"
