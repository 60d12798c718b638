/* model.c -- elements: constants, variables, and the bookkeeping that ends every operation. Upward mode. */
#include "model.h"

/* Beyond, only the hull is kept: sums of products may overflow, and a substitution, which grows coefficients by up to 2
** to the power of the order (substitute.c), would do so unnoticed where upward mode stops at the largest double. */
#define LARGEST 0x1p960

void model_clear(const context *c, model *x, double v) {
  double *coef = model_coef(c, x), *norm = model_norm(c, x);
  *x = (model) { .hull = { v, v } };
  memset(model_mask(c, x), 0, c->m.words * sizeof(uint64_t));
  memset(coef, 0, MONOMIALS_BLOCK * sizeof *coef);
  memset(norm, 0, (c->m.order + 1u) * sizeof *norm);
  coef[0] = v, norm[0] = fabs(v);
}

static void set_hull(const context *c, model *x, interval hull) {
  model_clear(c, x, 0);
  x->hull = hull, x->rad = INFINITY;
}

/* the middle of bounded [lo, hi], and how far the ends are from it at most */
static double middle(interval y, double *rad) {
  double mid = y.lo == y.hi ? y.lo : y.lo / 2 + y.hi / 2;
  double above = y.hi - mid, below = mid - y.lo;
  *rad = above > below ? above : below;
  return mid;
}

static int is_moderate(interval y) { return y.lo > -LARGEST && y.hi < LARGEST; }

void model_set_interval(const context *c, model *x, interval hull) {
  double rad, mid;
  if (interval_is_empty(hull) || !is_moderate(hull)) {
    set_hull(c, x, hull);
    return;
  }
  mid = middle(hull, &rad);
  model_clear(c, x, mid);
  x->hull = hull, x->rad = rad;
}

double *model_place(const context *c, model *x, uint32_t i) {
  uint32_t block = i / MONOMIALS_BLOCK;
  uint64_t *word = &model_mask(c, x)[block / 64], bit = (uint64_t)1 << (block % 64);
  double *coef = model_coef(c, x);
  if (block && !(*word & bit)) memset(coef + (size_t)block * MONOMIALS_BLOCK, 0, MONOMIALS_BLOCK * sizeof *coef);
  *word |= bit;
  return coef + i;
}

void model_set_variable(const context *c, model *x, interval hull, uint32_t var) {
  model_set_interval(c, x, hull);
  if (!model_is_polynomial(x) || x->rad == 0 || var >= c->m.nvar || c->m.order == 0) return;
  *model_place(c, x, 1 + var) = x->rad, model_norm(c, x)[1] = x->rad;
  x->down = x->up = x->size = x->rad, x->rad = 0;
}

void model_copy(const context *c, model *dst, const model *src) {
  const double *from = model_coef(c, src);
  const uint64_t *mask = model_mask(c, src);
  double *to = model_coef(c, dst);
  memcpy(dst, src, c->coef_at); /* head, norms, mask */
  memcpy(to, from, MONOMIALS_BLOCK * sizeof *to);
  for (uint32_t w = 0; w < c->m.words; w++)
    for (uint64_t rest = mask[w]; rest; rest &= rest - 1) {
      size_t i = ((size_t)w * 64 + (size_t)__builtin_ctzll(rest)) * MONOMIALS_BLOCK;
      memcpy(to + i, from + i, MONOMIALS_BLOCK * sizeof *to);
    }
}

AMBIT_WORKER void model_survey(const context *c, model *x) {
  double *norm = model_norm(c, x), size = 0;
  c->kernels->survey(&c->m, model_mask(c, x), model_coef(c, x), norm, &x->down, &x->up);
  for (uint32_t q = 1; q <= c->m.order; q++) size += norm[q];
  x->size = size;
}

interval model_range_naive(const context *c, const model *x) {
  double constant = model_coef(c, x)[0];
  return (interval) { -(x->down - constant), constant + x->up };
}

static uint32_t flags_of(interval hull) {
  if (interval_is_empty(hull)) return AMBIT_F_EMPTY;
  return hull.lo > -INFINITY && hull.hi < INFINITY ? 0 : AMBIT_F_UNBOUNDED;
}

AMBIT_WORKER uint32_t model_finish_interval(const context *c, model *x, interval hull) {
  model_set_interval(c, x, hull);
  return flags_of(hull);
}

AMBIT_WORKER uint32_t model_finish(const context *c, model *x, interval hull) {
  model_survey(c, x);
  /* also false for NaN, which an overflow may have left in a coefficient */
  if (!(x->size + model_norm(c, x)[0] + x->rad < LARGEST)) return model_finish_interval(c, x, hull);
  interval range = model_range_naive(c, x);
  double lo = -(x->rad - range.lo), hi = range.hi + x->rad;
  if (hull.lo < lo) hull.lo = lo;
  if (hull.hi > hi) hull.hi = hi;
  if (interval_is_empty(hull)) return model_finish_interval(c, x, (interval) { INFINITY, -INFINITY });
  if (2 * x->rad >= hull.hi - hull.lo) return model_finish_interval(c, x, hull);
  x->hull = hull;
  return 0;
}

void model_add_interval(const context *c, model *x, interval y) {
  if (!is_moderate(y)) {
    x->rad = INFINITY;
    return;
  }
  double *coef = model_coef(c, x), rad, mid = middle(y, &rad);
  double up = coef[0] + mid, down = -(-coef[0] - mid);
  x->rad += rad + (up - down); /* whichever of the two is taken, the true sum is between */
  coef[0] = up;
}

uint32_t model_hull(const context *c, uint32_t op, interval *r, interval a, interval b, int32_t exponent) {
  double x[2] = { a.lo, a.hi }, y[2] = { b.lo, b.hi }, z[2];
  uint32_t flags = c->num->map(op, 1, z, x, y, exponent);
  *r = (interval) { z[0], z[1] };
  return flags & AMBIT_F_PARTIAL;
}
