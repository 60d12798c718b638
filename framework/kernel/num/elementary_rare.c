/* elementary_rare.c -- one interval that the kernels decline: empty, infinite, leaving the domain, over- and
** underflow, huge angles.
**
** Each function is reduced to enclosures at points. Angles beyond 2^39, or too near a multiple of pi/128 for the
** proved reduction, take theirs from the slow path, and then monotony on [a, b] is read off the signs of the
** derivative at a and b: they are known (sine and cosine of a double other than 0 are not 0), and an interval
** shorter than pi has at most one extremum, one shorter than 2 pi at most two.
*/
#define AMBIT_LANES 1
#include "num/elementary_point.h"
#include "num/elementary_variant.h"
#include "num/interval.h"
#include <float.h>

#define PI_DOWN 0x1.921fb54442d18p+1
#define PI_UP 0x1.921fb54442d19p+1
#define HALF_PI_DOWN 0x1.921fb54442d18p+0
#define HALF_PI_UP 0x1.921fb54442d19p+0
#define TWO_PI_DOWN 0x1.921fb54442d18p+2
#define TINIEST 0x1p-1074

static double clamp(double x, double lo, double hi) { return x < lo ? lo : x > hi ? hi : x; }

static ambit_interval of(enclosure e) { return (ambit_interval) { e.lo, e.hi }; }

static ambit_interval exp_point(double x) {
  if (x == -INFINITY) return (ambit_interval) { 0, 0 };
  if (x < -746) return (ambit_interval) { 0, TINIEST };
  if (x > 710) return (ambit_interval) { DBL_MAX, INFINITY };
  enclosure e = exp_at(x);
  if (!e.declined) return of(e);
  bits k;
  pair y = exp_kernel(x, &k);
  enclosure mantissa = widen(y, y.h * AMBIT_ERROR_EXP);
  return of(scale(mantissa.lo, mantissa.hi, (int64_t)k));
}

/* sinh or cosh at x > 700, where both are e^x / 2 up to a factor 1 +- 2^-2000 */
static ambit_interval half_exp(double x) {
  if (x > 711) return (ambit_interval) { DBL_MAX, INFINITY };
  bits k;
  pair y = exp_kernel(x, &k);
  enclosure mantissa = widen(y, y.h * (2 * AMBIT_ERROR_EXP));
  return of(scale(mantissa.lo, mantissa.hi, (int64_t)k - 1));
}
static ambit_interval sinh_point(double x) {
  enclosure e = sinh_at(x);
  if (!e.declined) return of(e);
  ambit_interval r = half_exp(fabs(x));
  return x < 0 ? (ambit_interval) { -r.hi, -r.lo } : r;
}
static ambit_interval cosh_point(double x) {
  enclosure e = cosh_at(x);
  return e.declined ? half_exp(fabs(x)) : of(e);
}
static ambit_interval log_point(double x) {
  if (x == 0) return (ambit_interval) { -INFINITY, -DBL_MAX };
  return x == INFINITY ? (ambit_interval) { DBL_MAX, INFINITY } : of(log_at(x));
}

/* SIN, COS or TAN at a finite x */
static ambit_interval angle_point(uint32_t op, double x) {
  angle a = angle_reduce(x);
  enclosure e = op == AMBIT_OP_SIN ? sin_of(x, a) : op == AMBIT_OP_COS ? cos_of(x, a) : tan_of(x, a);
  if (!e.declined) return of(e);
  ambit_interval r;
  ambit_elementary_slow(op, x, 0, &r.lo, &r.hi);
  return r;
}
/* 1, -1, or 0 if it is not known */
static int sign(ambit_interval x) { return (x.lo > 0) - (x.hi < 0); }

/* b - a is exact for neighbouring huge numbers; otherwise the comparisons allow for its rounding */
static ambit_interval sin_cos_rare(uint32_t op, ambit_interval x) {
  if (x.lo == x.hi) return angle_point(op, x.lo);
  ambit_interval full = { -1, 1 };
  double width = x.hi - x.lo;
  if (!(width < TWO_PI_DOWN) || width == PI_DOWN) return full;
  /* the derivative is cos for sin, and -sin for cos */
  int flip = op == AMBIT_OP_SIN ? 1 : -1;
  uint32_t other = op == AMBIT_OP_SIN ? AMBIT_OP_COS : AMBIT_OP_SIN;
  int start = flip * sign(angle_point(other, x.lo)), end = flip * sign(angle_point(other, x.hi));
  if (start == 0 || end == 0 || (start == end && width > PI_DOWN)) return full;
  ambit_interval r = ambit_interval_hull(angle_point(op, x.lo), angle_point(op, x.hi));
  if (start > end) r.hi = 1;
  if (start < end) r.lo = -1;
  return r;
}
static ambit_interval tan_rare(ambit_interval x) {
  double width = x.hi - x.lo;
  if (!(width < PI_DOWN)) return AMBIT_ENTIRE;
  int start = sign(angle_point(AMBIT_OP_COS, x.lo)), end = sign(angle_point(AMBIT_OP_COS, x.hi));
  if (start == 0 || start != end) return AMBIT_ENTIRE;
  return (ambit_interval) { angle_point(AMBIT_OP_TAN, x.lo).lo, angle_point(AMBIT_OP_TAN, x.hi).hi };
}

/* y/x < 2^-690, y > 0 finite, x > 0: the angle is below the quotient by less than 2^-1380 of it. With my/mx in (1/2, 2)
** and q' the double next to it on the grid of the result, my - q' mx is a multiple of 2^-106, so that no double but the
** quotient itself can lie between; fma gives its sign. */
static ambit_interval slender(double y, double x) {
  int ey, ex;
  double my = frexp(y, &ey), mx = frexp(x, &ex), q = ldexp(my / mx, ey - ex);
  if (q == 0) return (ambit_interval) { 0, TINIEST };
  double rest = fma(-ldexp(q, ex - ey), mx, my); /* of the quotient less q */
  return rest > 0 ? (ambit_interval) { q, next_above(q) } : (ambit_interval) { next_below(q), q };
}
/* The angle of the point (x, y), y >= 0, as a limit if one of them is infinite; not (0, 0). */
static ambit_interval upper_angle(double y, double x) {
  double u = fabs(x);
  int ey, ex;
  if (u == INFINITY || (y == 0 && x != 0)) return x > 0 ? (ambit_interval) { 0, 0 } : ambit_interval_pi();
  if (x == 0 || y == INFINITY) return (ambit_interval) { HALF_PI_DOWN, HALF_PI_UP };
  double my = frexp(y, &ey), mx = frexp(x, &ex);
  if (ey - ex > 700) return (ambit_interval) { HALF_PI_DOWN, HALF_PI_UP };
  if (ey - ex < -700) return x > 0 ? slender(y, x) : ambit_interval_pi();
  int half = (ey - ex) / 2;
  return of(atan2_at(ldexp(my, half), ldexp(mx, half - (ey - ex))));
}
/* y >= 0 */
static ambit_interval upper_atan2(ambit_interval y, ambit_interval x) {
  ambit_interval r;
  if (x.hi == 0 && y.hi == 0)
    r.lo = PI_DOWN; /* only (x < 0, 0) is in the domain */
  else
    r.lo = upper_angle(x.hi > 0 ? y.lo : y.hi, x.hi).lo;
  if (x.lo == 0 && y.hi == 0)
    r.hi = 0;
  else
    r.hi = upper_angle(x.lo < 0 ? y.lo : y.hi, x.lo).hi;
  return r;
}
static ambit_interval atan2_rare(ambit_interval y, ambit_interval x) {
  if (y.lo == 0 && y.hi == 0 && x.lo == 0 && x.hi == 0) return AMBIT_EMPTY;
  if (y.lo >= 0) return upper_atan2(y, x);
  if (x.lo < 0 && y.hi >= 0) return (ambit_interval) { -PI_UP, PI_UP };
  ambit_interval below = upper_atan2((ambit_interval) { y.hi < 0 ? -y.hi : 0, -y.lo }, x);
  if (y.hi <= 0) return (ambit_interval) { -below.hi, -below.lo };
  return (ambit_interval) { -below.hi, upper_atan2((ambit_interval) { 0, y.hi }, x).hi };
}

static ambit_interval cosh_rare(ambit_interval x) {
  double least = ambit_interval_mig(x), most = ambit_interval_mag(x);
  return (ambit_interval) { cosh_point(least).lo, cosh_point(most).hi };
}
static ambit_interval log_rare(ambit_interval x) {
  if (x.hi <= 0) return AMBIT_EMPTY;
  return (ambit_interval) { log_point(x.lo > 0 ? x.lo : 0).lo, log_point(x.hi).hi };
}
static ambit_interval asin_acos_rare(uint32_t op, ambit_interval x) {
  if (x.hi < -1 || x.lo > 1) return AMBIT_EMPTY;
  double lo = clamp(x.lo, -1, 1), hi = clamp(x.hi, -1, 1);
  if (op == AMBIT_OP_ASIN) return (ambit_interval) { asin_at(lo).lo, asin_at(hi).hi };
  return (ambit_interval) { acos_at(hi).lo, acos_at(lo).hi };
}

static ambit_interval rare(uint32_t op, ambit_interval x, ambit_interval y) {
  switch (op) {
  case AMBIT_OP_EXP: return (ambit_interval) { exp_point(x.lo).lo, exp_point(x.hi).hi };
  case AMBIT_OP_LOG: return log_rare(x);
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: return sin_cos_rare(op, x);
  case AMBIT_OP_TAN: return tan_rare(x);
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: return asin_acos_rare(op, x);
  case AMBIT_OP_ATAN2: return atan2_rare(x, y);
  case AMBIT_OP_SINH: return (ambit_interval) { sinh_point(x.lo).lo, sinh_point(x.hi).hi };
  case AMBIT_OP_COSH: return cosh_rare(x);
  case AMBIT_OP_ATAN: return (ambit_interval) { atan_at(x.lo).lo, atan_at(x.hi).hi };
  default: return (ambit_interval) { tanh_at(x.lo).lo, tanh_at(x.hi).hi };
  }
}

void ambit_elementary_rare(uint32_t op, double alo, double ahi, double blo, double bhi, double *lo, double *hi) {
  ambit_interval a = ambit_interval_of(alo, ahi), b = ambit_interval_of(blo, bhi);
  ambit_interval r = ambit_interval_is_empty(a) || ambit_interval_is_empty(b) ? AMBIT_EMPTY : rare(op, a, b);
  *lo = r.lo, *hi = r.hi;
}
