/* power_variant.h -- the compiled variants of power_map.h; all give the same bits. Round-to-nearest on entry,
** exponent != 0, arrays as in ambit_power. */
#ifndef AMBIT_POWER_VARIANT_H
#define AMBIT_POWER_VARIANT_H
#include <stddef.h>
#include <stdint.h>

typedef void ambit_power_map(
    int32_t exponent, size_t n, const double *alo, const double *ahi, double *rlo, double *rhi);
extern ambit_power_map ambit_power_portable; /* two lanes, any machine */
#if defined(__x86_64__)
extern ambit_power_map ambit_power_fma, ambit_power_avx2, ambit_power_avx512; /* two, four and eight lanes */
#endif

/* One interval of any kind by integer arithmetic. */
void ambit_power_rare(int32_t exponent, double alo, double ahi, double *lo, double *hi);
#endif
