/* kernels.h -- the loops over coefficients, once per instruction set. They round as the caller has set the mode. */
#ifndef KERNELS_H
#define KERNELS_H
#include "monomials.h"

typedef struct kernels {
  uint32_t lanes; /* how many products `lanes_product` does at once */
  /* norm[q] := sum |c| over degree q; down, up: sums over all but c[0] of what each term can reach below and above 0.
  ** Upward mode. */
  void (*survey)(const monomials *m, const uint64_t *mask, const double *c, double *norm, double *down, double *up);
  /* c := a + b or a - b over the blocks that either has; *mc: their union. Returns the sum of all rounding errors to a
  ** relative 2^-40. Nearest mode. */
  double (*sum)(const monomials *m, double *c, uint64_t *mc, const double *a, const uint64_t *ma, const double *b,
      const uint64_t *mb, int subtract);
  /* The products below cut after degree `limit`; each leaves c defined where it set *mc (dense ones: everywhere) and
  ** rounds each of the products that make up a coefficient at most as often as there are products, plus 3. */
  /* a, b packed in rows with zeros around (monomials.h) */
  void (*rows_product)(const monomials *m, uint32_t limit, double *c, const double *a, const double *b);
  void (*dense_product)(const monomials *m, uint32_t limit, double *c, const double *a, const double *b);
  /* operands as lists in graded order: a[k] is the coefficient of monomial ia[k] */
  void (*sparse_product)(const monomials *m, uint32_t limit, double *c, uint64_t *mc, const double *a,
      const uint32_t *ia, uint32_t na, const double *b, const uint32_t *ib, uint32_t nb);
  /* the same for `lanes` products: coefficient k of lane l at a[k lanes + l]; c by monomial, likewise, everywhere */
  void (*lanes_product)(const monomials *m, uint32_t limit, double *c, const double *a, const uint32_t *ia, uint32_t na,
      const double *b, const uint32_t *ib, uint32_t nb);
} kernels;

extern const kernels kernels_portable;
#if defined(__x86_64__)
extern const kernels kernels_avx2, kernels_avx512;
#endif

#endif
