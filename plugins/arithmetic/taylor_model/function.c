/* function.c -- smooth functions of a Taylor model [Makino & Berz 1996, 2003]. Upward mode.
**
** With a = c + h(x) + e, h a polynomial without constant, |e| <= rad, there is a t between a(x) and c + h(x) with
**   f(a) = f(c + h) + f'(t) e,
** and Taylor's theorem with Lagrange's rest gives, for some s between c and c + h,
**   f(c + h) = sum over k <= n of f^(k)(c) / k! h^k + f^(n+1)(s) / (n+1)! h^(n+1).
** The sum is evaluated by Horner's rule. In its step j, n - j more multiplications by h follow, each raising the least
** degree by one; so the polynomial is needed to degree j only, and what is cut is of degree above n at the end. The
** error of step j is multiplied by max |h| in each later step. With sums cut like that all n products together cost
** less than twice the last one.
*/
#include "series.h"

/* powers of h in [-down, up] */
static interval power_of(double down, double up, uint32_t n) {
  double below = 1, above = 1;
  for (uint32_t i = 0; i < n; i++) below *= down, above *= up;
  if (n % 2) return (interval) { -below, above };
  return (interval) { 0, below > above ? below : above };
}

/* dst := sum of s->mid[k] h^k; returns the error. dst is not surveyed. */
static double horner(const context *c, model *dst, const model *h, double reach, const series *s) {
  uint32_t n = s->terms;
  model *other = model_scratch(c, 1), *now = n % 2 ? other : dst;
  double error = s->rad[n];
  model_clear(c, now, s->mid[n]);
  for (uint32_t j = 1; j <= n; j++) {
    model *next = now == dst ? other : dst;
    error = error * reach + model_product(c, next, now, h, j) + s->rad[n - j];
    model_coef(c, next)[0] = s->mid[n - j]; /* it was 0: h has no constant */
    if (j < n) model_survey(c, next);
    now = next;
  }
  return error;
}

static uint32_t compose(
    const context *c, model *dst, const model *a, interval hull, double down, double up, const series *s) {
  model *h = model_scratch(c, 0);
  model_copy(c, h, a);
  model_coef(c, h)[0] = 0, model_norm(c, h)[0] = 0;
  double error = horner(c, dst, h, down > up ? down : up, s);
  dst->rad = error + s->slope * a->rad;
  model_add_interval(c, dst, interval_times(s->rest, power_of(down, up, s->terms + 1)));
  return model_finish(c, dst, hull);
}

AMBIT_WORKER uint32_t model_function(const context *c, uint32_t op, model *dst, const model *a, int32_t exponent) {
  interval hull, one = { 1, 1 };
  uint32_t flags = op == SERIES_RECIPROCAL ? model_hull(c, op, &hull, one, a->hull, 0)
                                           : model_hull(c, op, &hull, a->hull, a->hull, exponent);
  if (flags || !model_is_polynomial(a) || a->size == 0) return flags | model_finish_interval(c, dst, hull);
  double down, up, centre = model_coef(c, a)[0];
  series s = { .terms = c->m.order };
  model_range_quadratic(c, a, &down, &up);
  interval range = { -(down - centre), centre + up }, wide = { -(a->rad - range.lo), range.hi + a->rad };
  if (!series_expand(c->num, op, exponent, centre, range, wide, &s)) return model_finish_interval(c, dst, hull);
  return compose(c, dst, a, hull, down, up, &s);
}

/* dst := what was computed, and inside `hull` too */
static uint32_t inside(const context *c, model *dst, interval hull) {
  if (hull.lo < dst->hull.lo) hull.lo = dst->hull.lo;
  if (hull.hi > dst->hull.hi) hull.hi = dst->hull.hi;
  return model_is_polynomial(dst) ? model_finish(c, dst, hull) : model_finish_interval(c, dst, hull);
}

AMBIT_WORKER uint32_t model_divide(const context *c, model *dst, const model *a, const model *b) {
  interval hull;
  model *inverse = model_scratch(c, 2);
  uint32_t flags = model_hull(c, AMBIT_OP_DIV, &hull, a->hull, b->hull, 0);
  if (flags || !model_is_polynomial(a) || !model_is_polynomial(b)) return flags | model_finish_interval(c, dst, hull);
  if (a == b) hull = (interval) { 1, 1 };
  model_function(c, SERIES_RECIPROCAL, inverse, b, 0);
  model_multiply(c, dst, a, inverse);
  return inside(c, dst, hull);
}

/* -- the angle of (x, y): by the quotient that is smaller, where the axes tell which branch it is */

enum { NONE, RIGHT, ABOVE, BELOW };

static int side_of(interval x, interval y) {
  int right = x.lo > 0, above = y.lo > 0, below = y.hi < 0;
  int flat = fmax(fabs(y.lo), fabs(y.hi)) < fmax(fabs(x.lo), fabs(x.hi));
  if (right && (flat || (!above && !below))) return RIGHT;
  return above ? ABOVE : below ? BELOW : NONE;
}

AMBIT_WORKER uint32_t model_angle(const context *c, model *dst, const model *y, const model *x) {
  static const interval quarter[] = { [RIGHT] = { 0, 0 },
    [ABOVE] = { 0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0 },
    [BELOW] = { -0x1.921fb54442d19p+0, -0x1.921fb54442d18p+0 } };
  interval hull;
  model *quotient = model_scratch(c, 3), *angle = model_scratch(c, 4);
  uint32_t flags = model_hull(c, AMBIT_OP_ATAN2, &hull, y->hull, x->hull, 0);
  int side = side_of(x->hull, y->hull), right = side == RIGHT;
  if (flags || side == NONE || !model_is_polynomial(y) || !model_is_polynomial(x))
    return flags | model_finish_interval(c, dst, hull);
  model_divide(c, quotient, right ? y : x, right ? x : y);
  model_function(c, AMBIT_OP_ATAN, angle, quotient, 0);
  if (!model_is_polynomial(angle)) return model_finish_interval(c, dst, hull);
  if (right)
    model_copy(c, dst, angle);
  else
    model_negate(c, dst, angle), model_add_interval(c, dst, quarter[side]);
  return model_finish(c, dst, hull);
}

/* -- integer powers: few products for small ones, the binomial series for the others */

enum { SMALL_POWER = 16 };

static void by_products(const context *c, model *dst, const model *a, uint32_t n) {
  model *now = model_scratch(c, 2), *next = model_scratch(c, 3), *free;
  uint32_t bit = SMALL_POWER;
  while (!(n & bit)) bit >>= 1;
  model_copy(c, now, a);
  for (bit >>= 1; bit; bit >>= 1) {
    model_multiply(c, next, now, now);
    free = now, now = next, next = free;
    if (!(n & bit)) continue;
    model_multiply(c, next, now, a);
    free = now, now = next, next = free;
  }
  model_copy(c, dst, now);
}

AMBIT_WORKER uint32_t model_power(const context *c, model *dst, const model *a, int32_t n) {
  interval hull;
  if (n == 2) return model_multiply(c, dst, a, a);
  if (n < 1 || n > SMALL_POWER || !model_is_polynomial(a)) return model_function(c, AMBIT_OP_POWN, dst, a, n);
  uint32_t flags = model_hull(c, AMBIT_OP_POWN, &hull, a->hull, a->hull, n);
  by_products(c, dst, a, (uint32_t)n);
  return flags | inside(c, dst, hull);
}
