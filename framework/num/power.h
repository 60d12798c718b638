/* power.h -- bounds of integer powers of a nonnegative double. */
#ifndef AMBIT_POWER_H
#define AMBIT_POWER_H
#include <stdint.h>

/* The double next to x^n from below and above, at most 1 ulp off; exact where x^n is a double. x in [0, +inf], n != 0, x > 0 if n < 0. */
double ambit_power_down(double x, int32_t n);
double ambit_power_up(double x, int32_t n);
#endif
