/* power.c -- integer powers over arrays: the floating-point environment and the choice of the variant. */
#include "num/power.h"
#include <ambit/interval.h>
#include "num/power_variant.h"
#include "num/rounding.h"

/* The widest variant that this machine has and this many intervals fill. */
static ambit_power_map *choose_map(size_t n) {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("fma") || !__builtin_cpu_supports("avx2")) return ambit_power_portable;
  if (n < 4) return ambit_power_fma;
  if (n >= 8 && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) return ambit_power_avx512;
  return ambit_power_avx2;
#else
  (void)n;
  return ambit_power_portable;
#endif
}

static void ones(size_t n, const double *alo, const double *ahi, double *rlo, double *rhi) {
  for (size_t i = 0; i < n; i++) {
    bool empty = ambit_interval_is_empty(ambit_interval_of(alo[i], ahi[i]));
    rlo[i] = empty ? INFINITY : 1, rhi[i] = empty ? -INFINITY : 1;
  }
}

void ambit_power(int32_t exponent, size_t n, const double *alo, const double *ahi, double *rlo, double *rhi) {
  ambit_rounding old = ambit_round_nearest();
  if (exponent == 0)
    ones(n, alo, ahi, rlo, rhi);
  else
    choose_map(n)(exponent, n, alo, ahi, rlo, rhi);
  ambit_rounding_restore(old);
}
