/* choice.c -- ABS, MIN, MAX: one of the operands where it is known which, else |d| on a line. Upward mode.
**
** Over [-p, q], p, q > 0, and for |s| <= 1 the convex |d| - s d is at least 0, its value at d = 0, and at most the
** larger of its values at the ends; s = (q - p)/(q + p) makes these equal. max(x, y) = (x + y)/2 + |x - y|/2, and min
** has -.
*/
#include "affine.h"

typedef struct bend { /* |d| - slope d in [0, top] */
  double slope, top;
} bend;

static bend bend_over(double p, double q) {
  double half = 0.5 * ((q - p) / (q + p)), s = 2 * smaller(larger(half, -0.5), 0.5); /* half of it is a double */
  return (bend) { s, larger((-s) * q + q, s * p + p) };
}

static uint32_t absolute(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  (void)y;
  r->nlo = -larger(0, larger(-x->nlo, -x->hi)), r->hi = larger(x->nlo, x->hi);
  if (x->nlo <= 0) return c->kernels->apply(c, r, x, 1, 0, 0, symbol);
  if (x->hi <= 0) return c->kernels->apply(c, r, x, -1, 0, 0, symbol);
  bend v = bend_over(x->nlo, x->hi);
  return c->kernels->apply(c, r, x, v.slope, 0, v.top, symbol);
}

/* sign 1: MAX, -1: MIN; r has its hull, and d = x - y has both signs */
static uint32_t between(const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y,
    const affine_element *d, double sign, int64_t symbol) {
  affine_element *mean = affine_unbounded(c->scratch[3]), *line = affine_unbounded(c->scratch[4]);
  bend v = bend_over(d->nlo, d->hi);
  double top = 0.5 * v.top;
  affine_combine(c, mean, 0.5, x, 0.5, y, AFFINE_NO_SYMBOL);
  c->kernels->apply(c, line, d, sign * (0.5 * v.slope), sign > 0 ? 0 : -top, sign > 0 ? top : 0, AFFINE_NO_SYMBOL);
  if (!affine_has_form(mean) || !affine_has_form(line)) return affine_constant(c, r, r->nlo, r->hi, symbol);
  return affine_combine(c, r, 1, mean, 1, line, symbol);
}

static uint32_t choose(const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y,
    double sign, int64_t symbol) {
  affine_element *d = c->scratch[2];
  c->kernels->add(c, d, x, y, 1, AFFINE_NO_SYMBOL);
  r->nlo = sign > 0 ? smaller(x->nlo, y->nlo) : larger(x->nlo, y->nlo);
  r->hi = sign > 0 ? larger(x->hi, y->hi) : smaller(x->hi, y->hi);
  if (d->nlo <= 0 && !affine_is_empty(d)) return c->kernels->apply(c, r, sign > 0 ? x : y, 1, 0, 0, symbol);
  if (d->hi <= 0 && !affine_is_empty(d)) return c->kernels->apply(c, r, sign > 0 ? y : x, 1, 0, 0, symbol);
  if (!affine_has_form(d)) return affine_constant(c, r, r->nlo, r->hi, symbol);
  return between(c, r, x, y, d, sign, symbol);
}

static uint32_t minimum(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  return choose(c, r, x, y, -1, symbol);
}

static uint32_t maximum(
    const affine_context *c, affine_element *r, const affine_element *x, const affine_element *y, int64_t symbol) {
  return choose(c, r, x, y, 1, symbol);
}

AFFINE_RUN(affine_run_ABS, ABS, absolute, a)
AFFINE_RUN(affine_run_MIN, MIN, minimum, b)
AFFINE_RUN(affine_run_MAX, MAX, maximum, b)
