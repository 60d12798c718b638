/* waves.c -- sin x - s x over [a, b], all extrema. Upward mode.
**
** The derivative cos x - s vanishes at x = 2 k pi + c and x = 2 k pi - c, c = acos s in [0, pi], and nowhere else. At
** the former sin x = +sqrt(1 - s^2), at the latter sin x = -sqrt(1 - s^2). cos x is sin(x + pi/2).
**
** Where b - a < 6, of each kind only the one next to the middle m can lie in [a, b]: it has |k - (m -+ c)/(2 pi)| <
** 3.01/(2 pi) < 0.48, so rounding the quotient finds k if its error is below 0.02; for |m| < 2^40 it is below 2^-9.
** A candidate proved to lie outside [a, b] is left out; a needless one does no harm.
*/
#include "linearise.h"

#define HALF_PI_LO 0x1.921fb54442d18p+0
#define HALF_PI_HI 0x1.921fb54442d19p+0
#define TURNS 0x1.45f306dc9c883p-3 /* about 1/(2 pi) */

static double product_down(double x, double y) { return -((-x) * y); }

/* k pi/2 for an integer k, exact as a double */
static range quarter_turns(double k) {
  if (k < 0) return (range) { product_down(k, HALF_PI_HI), k * HALF_PI_LO };
  return (range) { product_down(k, HALF_PI_LO), k * HALF_PI_HI };
}

static range sum(range x, range y) { return (range) { -(-x.lo - y.lo), x.hi + y.hi }; }

/* x rounded to an integer, whatever the rounding mode; |x| < 2^60 */
static double integer_near(double x) { return (double)(int64_t)(x + (x < 0 ? -0.5 : 0.5)); }

/* the place 2 k pi + offset - shift next to the middle */
static range nearest(double middle, range offset, double shift) {
  double turns = integer_near((middle - offset.lo + shift * HALF_PI_LO) * TURNS);
  return sum(quarter_turns(4 * turns - shift), offset);
}

/* f(x) - s x where f(x) is in [flo, fhi] and x in [at.lo, at.hi] */
static void include(linearise_chunk *k, size_t i, range at, double flo, double fhi) {
  if (at.hi < k->a[i] || at.lo > k->b[i]) return;
  double s = k->slope[i], high = (s > 0 ? (-s) * at.lo : (-s) * at.hi) + fhi,
         low = (s > 0 ? s * at.hi : s * at.lo) - flo;
  if (high > k->ghi[i]) k->ghi[i] = high;
  if (-low < k->glo[i]) k->glo[i] = -low;
}

void linearise_waves(const affine_context *c, linearise_chunk *k) {
  double lo[LINEARISE_CHUNK], hi[LINEARISE_CHUNK], shift = k->op == AMBIT_OP_COS ? 1 : 0;
  c->num->elementary(AMBIT_OP_ACOS, k->n, k->slope, k->slope, k->slope, k->slope, lo, hi);
  for (size_t i = 0; i < k->n; i++) {
    double s = k->slope[i], middle = 0.5 * k->a[i] + 0.5 * k->b[i];
    double up = sqrt((1 - s) * (1 + s)), square_down = -((s - 1) * -(-1 - s)); /* (1-s)(1+s) from below */
    double down = up > 0 ? -(-square_down / up) : 0;
    if (k->b[i] - k->a[i] < 6 && fabs(middle) < FAR_OUT) {
      include(k, i, nearest(middle, (range) { lo[i], hi[i] }, shift), down, up);
      include(k, i, nearest(middle, (range) { -hi[i], -lo[i] }, shift), -up, -down);
    } else
      k->slope[i] = NAN; /* too wide for a line to be of use, or too far out */
  }
}
