/* kink.c -- absolute value, minimum, maximum. Upward mode.
**
** Where the sign is decided they are one of the operands. Otherwise the kink is enclosed by a line and a band, for any
** slope: on l <= x <= u, l < 0 < u,
**   |x| - s x       is in [0, max((1 - s) u, (1 + s) (-l))],  -1 <= s <= 1   (least for s = (u + l) / (u - l)),
**   max(x, 0) - s x is in [0, max((1 - s) u, s (-l))],         0 <= s <= 1   (least for s = u / (u - l)),
** both being convex and 0 at 0. That keeps the dependence on the data. max(a, b) = b + max(a - b, 0) and min(a, b) = a
** - max(a - b, 0), so the remainders of a and b count with weights s and 1 - s only.
*/
#include "model.h"

static double within(double s, double lo, double hi) { return s < lo ? lo : s > hi ? hi : s; }

/* polynomial of dst := s times that of a; returns what rounding lost */
static double stretch(const context *c, model *dst, const model *a, double s) {
  model *factor = model_scratch(c, 0);
  model_clear(c, factor, s);
  return model_product(c, dst, a, factor, c->m.order);
}

AMBIT_WORKER uint32_t model_absolute(const context *c, model *dst, const model *a) {
  interval hull, x = a->hull;
  model_hull(c, AMBIT_OP_ABS, &hull, x, x, 0);
  if (!model_is_polynomial(a) || (x.lo < 0 && x.hi > 0 && a->size == 0)) return model_finish_interval(c, dst, hull);
  if (x.hi <= 0) return model_negate(c, dst, a);
  if (x.lo >= 0) {
    model_copy(c, dst, a);
    return 0;
  }
  double s = within((x.hi + x.lo) / (x.hi - x.lo), -1, 1), above = (1 - s) * x.hi, below = (1 + s) * -x.lo;
  double lost = stretch(c, dst, a, s);
  dst->rad = lost + fabs(s) * a->rad;
  model_add_interval(c, dst, (interval) { 0, above > below ? above : below });
  return model_finish(c, dst, hull);
}

/* q + max(d, 0) or p - max(d, 0), where d = p - q; error: of the polynomial of d */
static uint32_t mix(const context *c, model *dst, const model *p, const model *q, const model *d, double error,
    interval hull, int maximum) {
  interval x = d->hull;
  double s = within(x.hi / (x.hi - x.lo), 0, 1), above = (1 - s) * x.hi, below = s * -x.lo;
  double band = above > below ? above : below;
  model *line = model_scratch(c, 2);
  double lost = stretch(c, line, d, s);
  lost += model_sum(c, dst, maximum ? q : p, line, maximum ? 1 : -1);
  dst->rad = lost + s * error + (maximum ? s * p->rad + (1 - s) * q->rad : (1 - s) * p->rad + s * q->rad);
  model_add_interval(c, dst, maximum ? (interval) { 0, band } : (interval) { -band, 0 });
  return model_finish(c, dst, hull);
}

AMBIT_WORKER uint32_t model_extremum(const context *c, model *dst, const model *a, const model *b, uint32_t op) {
  interval hull;
  int maximum = op == AMBIT_OP_MAX;
  model *d = model_scratch(c, 1);
  model_hull(c, op, &hull, a->hull, b->hull, 0);
  if (!model_is_polynomial(a) || !model_is_polynomial(b)) return model_finish_interval(c, dst, hull);
  model_add(c, d, a, b, -1);
  int decided = d->hull.lo >= 0 ? 1 : d->hull.hi <= 0 ? -1 : 0;
  if (decided) {
    model_copy(c, dst, (decided > 0) == maximum ? a : b);
    return 0;
  }
  double error = model_sum(c, d, a, b, -1); /* again, as model_add may have dropped the polynomial */
  model_survey(c, d);
  return mix(c, dst, a, b, d, error, hull, maximum);
}
