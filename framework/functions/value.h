/* value.h -- values at a point as double-doubles with a proved error, and the bounds that follow.
**
** Every step has a relative error under 2^-98 (no cancellation: terms of one sign, or differences that are exact), so
** the errors are those of the kernels, multiplied by the condition of the steps: less than VALUE_ERROR in all uses
** (docs/numerics/functions.md). Round to nearest.
*/
#ifndef AMBIT_FUNCTION_VALUE_H
#define AMBIT_FUNCTION_VALUE_H
#define AMBIT_LANES 1
#include "num/elementary_point.h"
#include "num/interval.h"
#include <float.h>

#define VALUE_ERROR 0x1p-62
#define VALUE_TINIEST 0x1p-1074
#define VALUE_MINUS_INFINITY ((ambit_interval) { -INFINITY, -DBL_MAX }) /* a limit that is not reached */
#define VALUE_INFINITY ((ambit_interval) { DBL_MAX, INFINITY })

static const pair value_one = { 1, 0 }, value_ln2 = { 0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56 };

INLINE ambit_interval value_point(double x) { return (ambit_interval) { x, x }; }
INLINE ambit_interval value_of(enclosure e) { return (ambit_interval) { e.lo, e.hi }; }
/* within a relative error of the pair */
INLINE ambit_interval value_within(pair y, double error) { return value_of(widen(y, magnitude(y.h) * error)); }
INLINE ambit_interval value_negate(ambit_interval x) { return (ambit_interval) { -x.hi, -x.lo }; }
/* x != 0 is no value, but its neighbours on one side are further off */
INLINE ambit_interval value_above(double x) { return (ambit_interval) { x, next_above(x) }; }
INLINE ambit_interval value_below(double x) { return (ambit_interval) { next_below(x), x }; }

INLINE pair value_sum(pair a, pair b) { /* of one sign, or |a| > 2 |b| */
  pair s = two_sum(a.h, b.h);
  return fast_two_sum(s.h, s.l + (a.l + b.l));
}
INLINE pair value_product(pair a, pair b) {
  pair p = two_product(a.h, b.h);
  return fast_two_sum(p.h, p.l + (a.h * b.l + a.l * b.h));
}
INLINE pair value_root(pair a) { /* a > 0 */
  double s = square_root(a.h);
  pair v = two_product(s, s);
  return fast_two_sum(s, (((a.h - v.h) - v.l) + a.l) * (0.5 / s));
}

/* ln(1 + z), z = z.h + z.l > -1 + 2^-54, 2^-60 <= |z| <= 2^102. 1 + z = h + t, t a pair under half an ulp of h; then
** ln h + t/h - (t/h)^2/2, and what is left out is under 2^-160. Where h != 1, |ln h| is at least twice |t/h|. */
INLINE pair value_log1p(pair z) {
  pair s = two_sum(1, z.h), low = two_sum(s.l, z.l), t = fast_two_sum(s.h, low.h);
  double q = t.l / t.h;
  pair v = two_product(q, t.h), log = log_kernel(t.h);
  double rest = (((t.l - v.h) - v.l) + low.l) / t.h;
  pair r = two_sum(log.h, q);
  return fast_two_sum(r.h, r.l + (log.l + (rest - 0.5 * q * q)));
}

/* e^p 2^n for |p.h| <= 1400, |p.l| <= 2^-40: |e^(p.l) - 1 - p.l - p.l^2/2| is under 2^-122; `error` relative */
INLINE ambit_interval value_exp(pair p, double error, int64_t n) {
  bits k;
  pair e = exp_kernel(p.h, &k);
  e = fast_two_sum(e.h, e.l + e.h * (p.l + 0.5 * p.l * p.l));
  enclosure mantissa = widen(e, e.h * error);
  return value_of(scale(mantissa.lo, mantissa.hi, (int64_t)k + n));
}
#endif
