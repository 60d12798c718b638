/* tanh.c -- a line in the place of tanh, and by how much it differs.
**
** g(x) = tanh x - slope x - offset is concave for x >= 0, convex for x <= 0, so over an interval it is greatest and
** least at the ends, at 0, or where tanh' = 1 - tanh^2 is the slope. There a tangent of g at any place nearby bounds it
** from above (below). Proof: docs/numerics/zonotope.md, section 5a.
*/
#include "kink.h"
#include "proof.h"
#include "value.h"

#define DEEP 22 /* |x| from which tanh is 1 or -1 but for less than rounding */

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }
static double value(const zono *z, double x) { return value_of(z, AMBIT_OP_TANH, x, 0); }
static double slope_at(double y) { return (1 - y) * (1 + y); }

/* where tanh' is the slope; only as good as the library */
static double place_of(double slope) { return atanh(sqrt(1 - slope)); }

double tanh_half_width(const zono *z, double lo, double hi) { return 0.5 * (value(z, hi) - value(z, lo)); }

void tanh_line(const zono *z, kink *k, double lo, double hi) {
  k->slope = 0, k->offset = lo > 0 ? 1 : -1;
  if (lo > DEEP || hi < -DEEP) return;
  double first = value(z, lo), last = value(z, hi), middle = value(z, 0.5 * (lo + hi));
  k->slope = hi - lo > 0x1p-10 ? (last - first) / (hi - lo) : slope_at(middle);
  k->slope = larger(0, smaller(1, k->slope));
  double x = place_of(k->slope), least = first - k->slope * lo, most = least, end = last - k->slope * hi;
  least = smaller(least, end), most = larger(most, end);
  if (x > lo && x < hi) most = larger(most, value(z, x) - k->slope * x);
  if (-x > lo && -x < hi) least = smaller(least, k->slope * x - value(z, x));
  k->offset = 0.5 * (least + most);
}

/* tanh x - slope x - offset over [from, to], from >= 0, at most, if it is more than at the ends */
static double hump(const zono *z, double slope, double offset, double from, double to) {
  double first = slope_at(value(z, from)), last = slope_at(value(z, to));
  if (slope == 0 || slope >= first + 16 * UNIT || slope <= last - 16 * UNIT) return 0;
  double x = fmax(from, fmin(to, place_of(slope))), y = value(z, x);
  double rest = fabs(slope_at(y) - slope) + 16 * UNIT;
  return larger(0, y - slope * x - offset + rest * larger(to - x, x - from));
}

double tanh_miss(const zono *z, const kink *k, double lo, double hi) {
  double l = k->slope, c = k->offset, far = larger(-lo, hi);
  if (!(far < INFINITY)) return INFINITY;
  double most = larger(fabs(value(z, lo) - l * lo - c), fabs(value(z, hi) - l * hi - c));
  if (lo < 0 && hi > 0) most = larger(most, fabs(c));
  if (hi > 0) most = larger(most, hump(z, l, c, larger(lo, 0), hi));
  if (lo < 0) most = larger(most, hump(z, l, -c, larger(-hi, 0), -lo));
  return most * (1 + 8 * UNIT) + 16 * UNIT * (1 + l * fabs(far) + fabs(c));
}
