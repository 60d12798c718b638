/* turn.c -- sine and cosine by Taylor's series about the nearest multiple of a right angle.
**
** c = k pi / 2 + r, |r| < 0.7855, with pi / 2 as three doubles: PI_1 + PI_2 + PI_3 is off by less than 2^-159, k PI_1
** and k PI_2 are exact as two doubles each, and |k| <= 2^20. With |r| < 1 no partial sum or power is above 1, so each
** of the 2 TERMS operations is off by at most 16 2^-106, and of c - k PI_1, where these differ, nothing is lost beyond
** that of what is left. Proof of the bound: docs/numerics/zonotope.md, section 3.
*/
#include "turn.h"

#define PI_1 0x1.921fb54442d18p+0
#define PI_2 0x1.1a62633145c07p-54
#define PI_3 -0x1.f1976b7ed8fbcp-110
#define TURNS 0x1p20
#define TERMS 30 /* powers of r: 0.7855^31 / 31! < 2^-123 */

static dd reduced(double c, double k) {
  dd first = two_product(k, PI_1), second = two_product(k, PI_2);
  dd rest = dd_sub(two_sum(c, -first.hi), dd_make(first.lo, 0)); /* the first sum is exact as two doubles */
  return dd_sub(dd_sub(rest, second), dd_make(k * PI_3, 0));
}

int turn_at(double c, dd *sine, dd *cosine) {
  double k = nearbyint(c * (2 / 3.14159265358979323846));
  if (!(fabs(k) <= TURNS)) return 0;
  dd r = reduced(c, k), power = { 1, 0 }, sum[2] = { { 1, 0 }, { 0, 0 } };
  for (int n = 1; n <= TERMS; n++) {
    power = dd_div(dd_mul(power, r), dd_make(n, 0));
    sum[n % 2] = n % 4 < 2 ? dd_add(sum[n % 2], power) : dd_sub(sum[n % 2], power);
  }
  int quarter = (int)fmod(fmod(k, 4) + 4, 4);
  dd s = sum[quarter % 2 == 0], t = sum[quarter % 2];
  *sine = quarter < 2 ? s : dd_neg(s);
  *cosine = quarter == 0 || quarter == 3 ? t : dd_neg(t);
  return 1;
}
