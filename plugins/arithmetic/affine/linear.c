/* linear.c -- sums, and multiples plus a constant. Upward mode.
**
** The coefficients are rounded upward and what that loses goes to err (kernels.h), the centre likewise; err of the
** operands is nobody else's, so it is added in magnitude.
*/
#include "affine.h"

uint32_t affine_combine(const affine_context *c, affine_element *r, double p, const affine_element *x, double q,
    const affine_element *y, int64_t symbol) {
  affine_sums s;
  r->blocks = x->blocks > y->blocks ? x->blocks : y->blocks;
  c->kernels->combine(r->coef, p, x->coef, x->blocks, q, y->coef, y->blocks, &s);
  r->centre = p * x->centre + q * y->centre;
  double below = (-p) * x->centre + (-q) * y->centre;
  double own = fabs(p) * x->err + fabs(q) * y->err;
  return affine_finish(c, r, s.size, own + (s.gap + (r->centre + below)), symbol);
}

uint32_t affine_run_NEG(const ambit_arithmetic *self, void *ctx, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  (void)self, (void)b;
  const affine_context *c = ctx;
  uint32_t flags = 0;
  for (size_t i = 0; i < count; i++)
    for (size_t l = 0; l < lanes; l++) {
      affine_element *r = affine_at(c, base, dst[i] * pitch + l);
      const affine_element *x = affine_at(c, base, a[i] * pitch + l);
      affine_sums s;
      c->kernels->scale(r->coef, -1, x->coef, x->blocks, &s);
      r->nlo = x->hi, r->hi = x->nlo;
      r->centre = -x->centre, r->err = x->err, r->rad = x->rad, r->epoch = x->epoch, r->blocks = x->blocks;
      flags |= affine_flags(r);
    }
  return flags;
}
