/* power.h -- integer powers of arrays of intervals, in any rounding mode: the tightest doubles.
**
** pown of IEEE 1788-2015, set-based: x^0 = 1 for every x, 0 is outside the domain of x^n, n < 0. Vector kernels with
** a proved error decide nearly every bound (power_map.h), 256-bit integers the rest (power_rare.c). */
#ifndef AMBIT_POWER_H
#define AMBIT_POWER_H
#include <stddef.h>
#include <stdint.h>

/* r[i] encloses a[i]^exponent, i < n; structure of arrays; r may be a. Empty in, empty out; no flags. */
void ambit_power(int32_t exponent, size_t n, const double *alo, const double *ahi, double *rlo, double *rhi);
#endif
