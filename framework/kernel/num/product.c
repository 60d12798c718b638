/* product.c -- products of series and matrices: the choice of the variant, and the slow way for data that are not
** bounded. */
#include "num/product.h"
#include "num/interval.h"
#include "num/product_variant.h"
#include "num/rounding.h"

static const ambit_product_variant *choose(void) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return &ambit_product_avx2;
#endif
  return &ambit_product_portable;
}

typedef struct factor { /* every stride-th interval from lo, hi on */
  const double *lo, *hi;
  ptrdiff_t stride;
} factor;

static ambit_interval pick(factor f, size_t i) {
  ptrdiff_t at = f.stride * (ptrdiff_t)i;
  return ambit_interval_of(f.lo[at], f.hi[at]);
}

/* sum of n products, by interval operations: any operands */
static uint32_t sum_slowly(size_t n, factor a, factor b, double *lo, double *hi) {
  ambit_interval total = { 0, 0 };
  for (size_t i = 0; i < n; i++) total = ambit_interval_add(total, ambit_interval_mul(pick(a, i), pick(b, i)));
  *lo = total.lo, *hi = total.hi;
  if (ambit_interval_is_empty(total)) return AMBIT_F_EMPTY;
  return ambit_interval_is_bounded(total) ? 0 : AMBIT_F_UNBOUNDED;
}

uint32_t ambit_product_convolve(
    size_t n, double *rlo, double *rhi, const double *alo, const double *ahi, const double *blo, const double *bhi) {
  const ambit_product_variant *variant = choose();
  ambit_rounding old = ambit_round_up();
  uint32_t flags = variant->convolve(n, rlo, rhi, alo, ahi, blo, bhi);
  ambit_rounding_restore(old);
  if (flags != AMBIT_PRODUCT_DECLINED) return flags;
  flags = 0;
  for (size_t k = 0; k < n; k++)
    flags |= sum_slowly(k + 1, (factor) { alo, ahi, 1 }, (factor) { blo + k, bhi + k, -1 }, rlo + k, rhi + k);
  return flags;
}

uint32_t ambit_product_matmul(size_t rows, size_t inner, size_t cols, double *rlo, double *rhi, const double *alo,
    const double *ahi, const double *blo, const double *bhi) {
  const ambit_product_variant *variant = choose();
  ambit_rounding old = ambit_round_up();
  uint32_t flags = variant->matmul(rows, inner, cols, rlo, rhi, alo, ahi, blo, bhi);
  ambit_rounding_restore(old);
  if (flags != AMBIT_PRODUCT_DECLINED) return flags;
  flags = 0;
  for (size_t i = 0; i < rows; i++)
    for (size_t j = 0; j < cols; j++) {
      factor a = { alo + i * inner, ahi + i * inner, 1 }, b = { blo + j, bhi + j, (ptrdiff_t)cols };
      flags |= sum_slowly(inner, a, b, rlo + i * cols + j, rhi + i * cols + j);
    }
  return flags;
}
