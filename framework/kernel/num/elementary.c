/* elementary.c -- elementary functions over arrays: the floating-point environment, the choice of the variant, the
** slow path. */
#include "num/elementary.h"
#include "num/elementary_variant.h"
#include "num/rounding.h"
#include <stdatomic.h>

#define PI_UP 0x1.921fb54442d19p+1
#define HALF_PI_UP 0x1.921fb54442d19p+0

/* The functions have no context to keep it in; every value that it can take is a sound slow path. */
static _Atomic(ambit_elementary_point) slow_path = ambit_elementary_coarse;

void ambit_elementary_set_slow(ambit_elementary_point point) {
  atomic_store_explicit(&slow_path, point ? point : ambit_elementary_coarse, memory_order_release);
}

void ambit_elementary_slow(uint32_t op, double x, double y, double *lo, double *hi) {
  atomic_load_explicit(&slow_path, memory_order_acquire)(op, x, y, lo, hi);
}

void ambit_elementary_coarse(uint32_t op, double x, double y, double *lo, double *hi) {
  static const double range[AMBIT_ELEMENTARY_COUNT][2] = { { 0, INFINITY }, { -INFINITY, INFINITY }, { -1, 1 },
    { -1, 1 }, { -INFINITY, INFINITY }, { -HALF_PI_UP, HALF_PI_UP }, { 0, PI_UP }, { -HALF_PI_UP, HALF_PI_UP },
    { -PI_UP, PI_UP }, { -INFINITY, INFINITY }, { 1, INFINITY }, { -1, 1 } };
  (void)x, (void)y;
  *lo = range[op - AMBIT_OP_EXP][0], *hi = range[op - AMBIT_OP_EXP][1];
}

/* The widest variant that this machine has and this many intervals fill. */
static ambit_elementary_map choose_map(uint32_t op, size_t n) {
  uint32_t i = op - AMBIT_OP_EXP;
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("fma") || !__builtin_cpu_supports("avx2")) return ambit_elementary_portable[i];
  if (n < 4) return ambit_elementary_fma[i];
  if (n >= 8 && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return ambit_elementary_avx512[i];
  return ambit_elementary_avx2[i];
#else
  (void)n;
  return ambit_elementary_portable[i];
#endif
}

void ambit_elementary(uint32_t op, size_t n, const double *alo, const double *ahi, const double *blo, const double *bhi,
    double *rlo, double *rhi) {
  ambit_elementary_map map = choose_map(op, n);
  if (op != AMBIT_OP_ATAN2) blo = alo, bhi = ahi;
  ambit_rounding old = ambit_round_nearest();
  map(n, alo, ahi, blo, bhi, rlo, rhi);
  ambit_rounding_restore(old);
}
