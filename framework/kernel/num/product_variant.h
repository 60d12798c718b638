/* product_variant.h -- the compiled variants of product_kernel.h. Upward mode on entry.
**
** portable: any machine (SSE2 on x86-64). avx2 (with FMA, chosen at run time) rounds less often, so the bits differ.
** Vectors of 512 bits brought nothing where it was measured (Zen 4): their loads cross a border of the cache each time.
*/
#ifndef AMBIT_PRODUCT_VARIANT_H
#define AMBIT_PRODUCT_VARIANT_H
#include <stddef.h>
#include <stdint.h>

/* Returned in place of flags: an operand is empty, not bounded, or beyond what midpoint and radius can say. Results may
** have been written, but mean nothing. */
#define AMBIT_PRODUCT_DECLINED UINT32_MAX

/* Arrays as in ambit/num.h. */
typedef struct ambit_product_variant {
  uint32_t (*convolve)(
      size_t n, double *rlo, double *rhi, const double *alo, const double *ahi, const double *blo, const double *bhi);
  uint32_t (*matmul)(size_t rows, size_t inner, size_t cols, double *rlo, double *rhi, const double *alo,
      const double *ahi, const double *blo, const double *bhi);
} ambit_product_variant;

extern const ambit_product_variant ambit_product_portable;
#if defined(__x86_64__)
extern const ambit_product_variant ambit_product_avx2;
#endif
#endif
