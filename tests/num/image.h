/* image.h -- the tightest interval around the image of any operands under any opcode: what the kernel's functions are
** compared with.
**
** At a point, + - * / and sqrt are judged by their exact rounding errors (TwoSum; the residual of a fused
** multiply-add), everything else, and these near over- and underflow, by one correctly rounded evaluation of MPFR. Over
** intervals the set logic is written from the definitions (hulls of corners, domains cut off, extrema counted by exact
** periods), not from the code under test. Round-to-nearest. Each thread may call it.
*/
#ifndef NUM_IMAGE_H
#define NUM_IMAGE_H
#include <ambit/tape.h>
#include <ambit/interval.h>
#include <float.h>
#include <mpfr.h>
#include <stdint.h>

#define PI_DOWN 0x1.921fb54442d18p+1
#define PI_UP 0x1.921fb54442d19p+1

typedef int (*image_function)(mpfr_t, const mpfr_t, mpfr_rnd_t);

static inline int image_evaluate(mpfr_t v, uint32_t op, const mpfr_t x, const mpfr_t y, int32_t n) {
  static const image_function unary[AMBIT_OP_COUNT] = { [AMBIT_OP_SQR] = mpfr_sqr,
    [AMBIT_OP_SQRT] = mpfr_sqrt,
    [AMBIT_OP_EXP] = mpfr_exp,
    [AMBIT_OP_LOG] = mpfr_log,
    [AMBIT_OP_SIN] = mpfr_sin,
    [AMBIT_OP_COS] = mpfr_cos,
    [AMBIT_OP_TAN] = mpfr_tan,
    [AMBIT_OP_ASIN] = mpfr_asin,
    [AMBIT_OP_ACOS] = mpfr_acos,
    [AMBIT_OP_ATAN] = mpfr_atan,
    [AMBIT_OP_SINH] = mpfr_sinh,
    [AMBIT_OP_COSH] = mpfr_cosh,
    [AMBIT_OP_TANH] = mpfr_tanh };
  switch (op) {
  case AMBIT_OP_ADD: return mpfr_add(v, x, y, MPFR_RNDD);
  case AMBIT_OP_MUL: return mpfr_mul(v, x, y, MPFR_RNDD);
  case AMBIT_OP_DIV: return mpfr_div(v, x, y, MPFR_RNDD);
  case AMBIT_OP_ATAN2: return mpfr_atan2(v, x, y, MPFR_RNDD);
  case AMBIT_OP_POWN: return mpfr_pow_si(v, x, n, MPFR_RNDD);
  default: return unary[op](v, x, MPFR_RNDD);
  }
}

/* The value rounded down to 53 bits and its successor have no double between them. */
static inline ambit_interval image_mpfr(uint32_t op, double x, double y, int32_t n) {
  MPFR_DECL_INIT(a, 53);
  MPFR_DECL_INIT(b, 53);
  MPFR_DECL_INIT(v, 53);
  mpfr_set_d(a, x, MPFR_RNDN);
  mpfr_set_d(b, y, MPFR_RNDN);
  int inexact = image_evaluate(v, op, a, b, n);
  ambit_interval r = { mpfr_get_d(v, MPFR_RNDD), 0 };
  if (inexact) mpfr_nextabove(v);
  r.hi = mpfr_get_d(v, MPFR_RNDU);
  return r;
}

/* value is the rounded result and rest has the sign of the exact one minus it */
static inline ambit_interval image_beside(double value, double rest) {
  return (
      ambit_interval) { rest < 0 ? nextafter(value, -INFINITY) : value, rest > 0 ? nextafter(value, INFINITY) : value };
}
static inline bool image_ordinary(double x) { return fabs(x) > 0x1p-900 && fabs(x) < 0x1p900; }

/* Tightest doubles around op at the point (x, y) of its domain, or at a limit where one is infinite and the limit
** exists; 0 times infinity is 0. */
static inline ambit_interval image_point(uint32_t op, double x, double y, int32_t n) {
  double v;
  switch (op) {
  case AMBIT_OP_ADD:
    v = x + y;
    if (fabs(x) > 0x1p1000 || fabs(y) > 0x1p1000) break;
    return image_beside(v, (x - (v - (v - x))) + (y - (v - x))); /* exact, subnormal or not */
  case AMBIT_OP_SQR:
  case AMBIT_OP_MUL:
    if (op == AMBIT_OP_SQR) y = x;
    if (x == 0 || y == 0) return (ambit_interval) { 0, 0 };
    v = x * y;
    if (!image_ordinary(v)) return image_mpfr(AMBIT_OP_MUL, x, y, 0);
    return image_beside(v, fma(x, y, -v));
  case AMBIT_OP_DIV:
    v = x / y;
    if (!image_ordinary(v) || !image_ordinary(x) || !image_ordinary(y)) break;
    return image_beside(v, y > 0 ? fma(-v, y, x) : -fma(-v, y, x));
  case AMBIT_OP_SQRT:
    v = sqrt(x);
    if (!image_ordinary(x)) break;
    return image_beside(v, fma(-v, v, x));
  case AMBIT_OP_ATAN2:
    if (x == 0) x = 0; /* -0 would be below the cut */
    break;
  default: break;
  }
  return image_mpfr(op, x, y, n);
}

static inline ambit_interval image_hull(uint32_t op, double x, double y, int32_t n) {
  return ambit_interval_hull(image_point(op, x, 0, n), image_point(op, y, 0, n));
}

/* floor((x - shift pi)/pi) as an exact integer, modulo 2^30: a double of size 2^e is further than 2^(-120 - e) from
** every multiple of pi/2 */
static inline long image_half_period(double x, double shift) {
  mpfr_prec_t precision = fabs(x) < 0x1p60 ? 256 : 2400;
  mpfr_t a, pi;
  mpfr_init2(a, precision), mpfr_init2(pi, precision);
  mpfr_const_pi(pi, MPFR_RNDN);
  mpfr_set_d(a, x, MPFR_RNDN);
  mpfr_div(a, a, pi, MPFR_RNDN);
  mpfr_sub_d(a, a, shift, MPFR_RNDN);
  mpfr_floor(a, a);
  mpfr_fmod_ui(a, a, 1u << 30, MPFR_RNDN);
  long r = mpfr_get_si(a, MPFR_RNDN) & 0x3fffffff;
  mpfr_clear(a), mpfr_clear(pi);
  return r;
}
static inline long image_periods_between(ambit_interval x, double shift) {
  return (image_half_period(x.hi, shift) - image_half_period(x.lo, shift)) & 0x3fffffff;
}

static inline ambit_interval image_wave(uint32_t op, ambit_interval x) {
  if (!(x.hi - x.lo <= 7)) return (ambit_interval) { -1, 1 };
  double shift = op == AMBIT_OP_SIN ? 0.5 : 0;
  ambit_interval r = image_hull(op, x.lo, x.hi, 0);
  if (x.lo == x.hi) return r;
  long last = image_half_period(x.hi, shift), count = image_periods_between(x, shift);
  if (count >= 2) return (ambit_interval) { -1, 1 };
  if (count == 1) *(last % 2 == 0 ? &r.hi : &r.lo) = last % 2 == 0 ? 1 : -1;
  if (op == AMBIT_OP_COS && x.lo <= 0 && x.hi >= 0) r.hi = 1;
  return r;
}

static inline ambit_interval image_tan(ambit_interval x) {
  if (!(x.hi - x.lo <= 4) || (x.lo != x.hi && image_periods_between(x, 0.5))) return AMBIT_ENTIRE;
  return image_hull(AMBIT_OP_TAN, x.lo, x.hi, 0);
}

/* Angles are monotone along the edges of a box, so that its corners decide, unless it meets the cut. The corner where
** both are infinite has no limit, and its neighbours bound it. */
static inline ambit_interval image_atan2(ambit_interval y, ambit_interval x) {
  if (y.lo < 0 && y.hi >= 0 && x.lo < 0) return (ambit_interval) { -PI_UP, PI_UP };
  ambit_interval r = AMBIT_EMPTY;
  for (int i = 0; i < 4; i++) {
    double v = i & 1 ? y.hi : y.lo, u = i & 2 ? x.hi : x.lo;
    if ((v == 0 && u == 0) || (isinf(v) && isinf(u))) continue;
    r = ambit_interval_hull(r, image_point(AMBIT_OP_ATAN2, v, u, 0));
  }
  return r;
}

/* the hull of op at the four corners */
static inline ambit_interval image_corners(uint32_t op, ambit_interval a, ambit_interval b) {
  ambit_interval r = image_point(op, a.lo, b.lo, 0);
  r = ambit_interval_hull(r, image_point(op, a.lo, b.hi, 0));
  r = ambit_interval_hull(r, image_point(op, a.hi, b.lo, 0));
  return ambit_interval_hull(r, image_point(op, a.hi, b.hi, 0));
}

/* x / 0+ as a limit, x / inf = 0 */
static inline ambit_interval image_quotient(double x, double y) {
  if (x == 0 || isinf(y)) return (ambit_interval) { 0, 0 };
  if (y == 0) return x > 0 ? (ambit_interval) { DBL_MAX, INFINITY } : (ambit_interval) { -INFINITY, -DBL_MAX };
  return image_point(AMBIT_OP_DIV, x, y, 0);
}
/* the part of b that is positive, b.hi > 0; infinite ends of a stay infinite */
static inline ambit_interval image_divide_positive(ambit_interval a, ambit_interval b) {
  double c = b.lo > 0 ? b.lo : 0, lo_by = a.lo >= 0 ? b.hi : c, hi_by = a.hi <= 0 ? b.hi : c;
  ambit_interval low = image_quotient(a.lo, lo_by), high = image_quotient(a.hi, hi_by);
  return (ambit_interval) { isinf(a.lo) ? -INFINITY : low.lo, isinf(a.hi) ? INFINITY : high.hi };
}
static inline ambit_interval image_negative(ambit_interval a) {
  return ambit_interval_is_empty(a) ? a : (ambit_interval) { -a.hi, -a.lo };
}
static inline ambit_interval image_divide(ambit_interval a, ambit_interval b) {
  ambit_interval r = AMBIT_EMPTY;
  if (b.hi > 0) r = image_divide_positive(a, b);
  if (b.lo < 0) r = ambit_interval_hull(r, image_negative(image_divide_positive(a, image_negative(b))));
  return r;
}

/* over an interval on one side of 0, where the power is monotone; the ends may be 0 or infinite, as limits */
static inline ambit_interval image_power_side(ambit_interval a, int32_t n) {
  ambit_interval r = AMBIT_EMPTY;
  for (int i = 0; i < 2; i++) {
    double x = i ? a.hi : a.lo;
    ambit_interval v;
    if (x == 0 || isinf(x)) {
      double limit = (x == 0) == (n > 0) ? 0 : INFINITY;
      if (n % 2 && (x == 0 ? a.lo < 0 : x < 0)) limit = -limit;
      v = (ambit_interval) { limit, limit };
    } else {
      v = image_point(AMBIT_OP_POWN, x, 0, n);
    }
    r = ambit_interval_is_empty(r) ? v : (ambit_interval) { fmin(r.lo, v.lo), fmax(r.hi, v.hi) };
  }
  return r;
}
static inline ambit_interval image_power(ambit_interval a, int32_t n) {
  if (n == 0) return (ambit_interval) { 1, 1 };
  if (a.lo == 0 && a.hi == 0) return n > 0 ? a : AMBIT_EMPTY;
  ambit_interval r = AMBIT_EMPTY;
  if (a.hi > 0) r = image_power_side((ambit_interval) { fmax(a.lo, 0), a.hi }, n);
  if (a.lo < 0) r = ambit_interval_hull(r, image_power_side((ambit_interval) { a.lo, fmin(a.hi, 0) }, n));
  return r;
}

/* f over the part of a in [lo, hi]; decreasing or increasing */
static inline ambit_interval image_within(uint32_t op, ambit_interval a, double lo, double hi) {
  ambit_interval x = ambit_interval_intersect(a, (ambit_interval) { lo, hi });
  if (ambit_interval_is_empty(x)) return x;
  return image_hull(op, x.lo, x.hi, 0);
}

/* The tightest enclosure of op over nonempty operands. Empty: nothing of them is in the domain. */
static inline ambit_interval image(uint32_t op, ambit_interval a, ambit_interval b, int32_t n) {
  switch (op) {
  case AMBIT_OP_ADD: return (ambit_interval) { image_point(op, a.lo, b.lo, 0).lo, image_point(op, a.hi, b.hi, 0).hi };
  case AMBIT_OP_SUB: return image(AMBIT_OP_ADD, a, image_negative(b), 0);
  case AMBIT_OP_NEG: return image_negative(a);
  case AMBIT_OP_MUL: return image_corners(op, a, b);
  case AMBIT_OP_SQR:
  case AMBIT_OP_COSH: {
    ambit_interval r = image_hull(op, a.lo, a.hi, 0);
    if (a.lo <= 0 && a.hi >= 0) r.lo = op == AMBIT_OP_SQR ? 0 : 1;
    return r;
  }
  case AMBIT_OP_POWN: return image_power(a, n);
  case AMBIT_OP_DIV: return image_divide(a, b);
  case AMBIT_OP_SQRT: return image_within(op, a, 0, INFINITY);
  case AMBIT_OP_LOG: return a.hi <= 0 ? AMBIT_EMPTY : image_within(op, a, 0, INFINITY);
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: return image_wave(op, a);
  case AMBIT_OP_TAN: return image_tan(a);
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: return image_within(op, a, -1, 1);
  case AMBIT_OP_ATAN2: return image_atan2(a, b);
  case AMBIT_OP_ABS: return (ambit_interval) { ambit_interval_mig(a), ambit_interval_mag(a) };
  case AMBIT_OP_MIN: return (ambit_interval) { fmin(a.lo, b.lo), fmin(a.hi, b.hi) };
  case AMBIT_OP_MAX: return (ambit_interval) { fmax(a.lo, b.lo), fmax(a.hi, b.hi) };
  default: return image_hull(op, a.lo, a.hi, 0);
  }
}
#endif
