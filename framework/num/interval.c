/* interval.c -- set-based interval arithmetic (IEEE 1788-2015), element by element.
**
** Every public function sets upward rounding for its worker and restores what it found. A lower bound is computed as
** minus the upward-rounded negated value, so one mode serves both bounds. Bounds that are products or quotients with
** 0 and infinity follow the set meaning: 0 * x = 0 for every real x, and an infinite bound is no element.
*/
#include "num/interval.h"
#include "num/elementary.h"
#include "num/power.h"
#include "num/rounding.h"
#include <float.h>

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

/* In upward mode: a bound from above of a*b, for real a, b that may stand for open infinite ends. */
static double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

static ambit_interval add(ambit_interval a, ambit_interval b) {
  return (ambit_interval) { -(-a.lo + -b.lo), a.hi + b.hi };
}

static ambit_interval negate(ambit_interval a) { return (ambit_interval) { -a.hi, -a.lo }; }

static ambit_interval multiply(ambit_interval a, ambit_interval b) {
  double up = larger(larger(times(a.lo, b.lo), times(a.lo, b.hi)), larger(times(a.hi, b.lo), times(a.hi, b.hi)));
  double down = larger(larger(times(-a.lo, b.lo), times(-a.lo, b.hi)), larger(times(-a.hi, b.lo), times(-a.hi, b.hi)));
  return (ambit_interval) { -down, up };
}

/* b > 0 */
static ambit_interval divide_positive(ambit_interval a, ambit_interval b) {
  double up = a.hi >= 0 ? a.hi / b.lo : a.hi / b.hi;
  double down = a.lo >= 0 ? -a.lo / b.hi : -a.lo / b.lo;
  return (ambit_interval) { -down, up };
}

/* b = [0, b.hi], b.hi > 0: the quotients by the positive part of b */
static ambit_interval divide_from_zero(ambit_interval a, ambit_interval b) {
  if (a.lo == 0 && a.hi == 0) return a;
  double up = a.hi > 0 ? INFINITY : a.hi / b.hi;
  double down = a.lo < 0 ? INFINITY : -a.lo / b.hi;
  return (ambit_interval) { -down, up };
}

static ambit_interval divide(ambit_interval a, ambit_interval b) {
  if (b.lo > 0) return divide_positive(a, b);
  if (b.hi < 0) return divide_positive(negate(a), negate(b));
  if (b.lo == 0 && b.hi == 0) return AMBIT_EMPTY;
  if (b.lo == 0) return divide_from_zero(a, b);
  if (b.hi == 0) return divide_from_zero(negate(a), negate(b));
  return a.lo == 0 && a.hi == 0 ? a : AMBIT_ENTIRE;
}

static double magnitude(ambit_interval a) { return larger(fabs(a.lo), fabs(a.hi)); }
static double mignitude(ambit_interval a) { return a.lo > 0 ? a.lo : a.hi < 0 ? -a.hi : 0; }

static ambit_interval square(ambit_interval a) {
  double small = mignitude(a), large = magnitude(a);
  return (ambit_interval) { -(-small * small), large * large };
}

/* In upward mode r = sqrt(x) >= the root, so r*r - x >= 0; it is 0 exactly if r is the root: a positive residual
** rounds up to at least the smallest subnormal. */
static double root_down(double x) {
  double r = sqrt(x);
  if (r == 0 || r == INFINITY) return r;
  return fma(r, r, -x) == 0 ? r : nextafter(r, 0);
}

static ambit_interval root(ambit_interval a) {
  if (a.hi < 0) return AMBIT_EMPTY;
  double lo = a.lo > 0 ? root_down(a.lo) : 0;
  return (ambit_interval) { lo, sqrt(a.hi) };
}

static ambit_interval absolute(ambit_interval a) { return (ambit_interval) { mignitude(a), magnitude(a) }; }

static ambit_interval minimum(ambit_interval a, ambit_interval b) {
  return (ambit_interval) { smaller(a.lo, b.lo), smaller(a.hi, b.hi) };
}

static ambit_interval maximum(ambit_interval a, ambit_interval b) {
  return (ambit_interval) { larger(a.lo, b.lo), larger(a.hi, b.hi) };
}

static bool is_binary(uint32_t op) {
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_MUL:
  case AMBIT_OP_DIV:
  case AMBIT_OP_ATAN2:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return true;
  default: return false;
  }
}

static bool is_elementary(uint32_t op) { return (op >= AMBIT_OP_EXP && op <= AMBIT_OP_TANH); }

/* nonempty operands, upward mode */
static ambit_interval basic(uint32_t op, ambit_interval a, ambit_interval b) {
  switch (op) {
  case AMBIT_OP_ADD: return add(a, b);
  case AMBIT_OP_SUB: return add(a, negate(b));
  case AMBIT_OP_NEG: return negate(a);
  case AMBIT_OP_MUL: return multiply(a, b);
  case AMBIT_OP_SQR: return square(a);
  case AMBIT_OP_DIV: return divide(a, b);
  case AMBIT_OP_SQRT: return root(a);
  case AMBIT_OP_ABS: return absolute(a);
  case AMBIT_OP_MIN: return minimum(a, b);
  case AMBIT_OP_MAX: return maximum(a, b);
  default: return AMBIT_ENTIRE;
  }
}

static AMBIT_WORKER void map_basic(
    uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b) {
  bool binary = is_binary(op);
  for (size_t i = 0; i < n; i++) {
    bool empty = ambit_interval_is_empty(a[i]) || (binary && ambit_interval_is_empty(b[i]));
    r[i] = empty ? AMBIT_EMPTY : basic(op, a[i], binary ? b[i] : a[i]);
  }
}

#define CHUNK 64

static void map_elementary(uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b) {
  double alo[CHUNK], ahi[CHUNK], blo[CHUNK], bhi[CHUNK], rlo[CHUNK], rhi[CHUNK];
  for (size_t done = 0; done < n; done += CHUNK) {
    size_t m = n - done < CHUNK ? n - done : CHUNK;
    for (size_t i = 0; i < m; i++) {
      ambit_interval y = op == AMBIT_OP_ATAN2 ? b[done + i] : a[done + i];
      alo[i] = a[done + i].lo, ahi[i] = a[done + i].hi, blo[i] = y.lo, bhi[i] = y.hi;
    }
    ambit_elementary(op, m, alo, ahi, blo, bhi, rlo, rhi);
    for (size_t i = 0; i < m; i++) r[done + i] = (ambit_interval) { rlo[i], rhi[i] };
  }
}

/* Did a nonempty operand reach outside the domain? r is the result. */
static bool leaves_domain(uint32_t op, ambit_interval a, ambit_interval b, ambit_interval r) {
  switch (op) {
  case AMBIT_OP_DIV: return b.lo <= 0 && b.hi >= 0;
  case AMBIT_OP_SQRT: return a.lo < 0;
  case AMBIT_OP_LOG: return a.lo <= 0;
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: return a.lo < -1 || a.hi > 1;
  case AMBIT_OP_TAN: return r.lo == -INFINITY && r.hi == INFINITY;
  case AMBIT_OP_ATAN2: return a.lo <= 0 && a.hi >= 0 && b.lo <= 0 && b.hi >= 0;
  default: return false;
  }
}

static uint32_t shape_flags(ambit_interval r) {
  if (ambit_interval_is_empty(r)) return AMBIT_F_EMPTY;
  return ambit_interval_is_bounded(r) ? 0 : AMBIT_F_UNBOUNDED;
}

static uint32_t map_pown(size_t n, ambit_interval *r, const ambit_interval *a, int32_t exponent) {
  uint32_t flags = 0;
  for (size_t i = 0; i < n; i++) flags |= ambit_interval_pown(&r[i], a[i], exponent);
  return flags;
}

static uint32_t map_chunk(uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b) {
  ambit_interval result[CHUNK];
  if (is_elementary(op)) {
    map_elementary(op, n, result, a, b);
  } else {
    ambit_rounding old = ambit_round_up();
    map_basic(op, n, result, a, b);
    ambit_rounding_restore(old);
  }
  uint32_t flags = 0;
  bool binary = is_binary(op);
  for (size_t i = 0; i < n; i++) {
    bool empty = ambit_interval_is_empty(a[i]) || (binary && ambit_interval_is_empty(b[i]));
    if (!empty && leaves_domain(op, a[i], binary ? b[i] : a[i], result[i])) flags |= AMBIT_F_PARTIAL;
    flags |= shape_flags(result[i]);
    r[i] = result[i];
  }
  return flags;
}

uint32_t ambit_interval_map(
    uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b, int32_t exponent) {
  if (op == AMBIT_OP_POWN) return map_pown(n, r, a, exponent);
  uint32_t flags = 0;
  for (size_t done = 0; done < n; done += CHUNK) {
    size_t m = n - done < CHUNK ? n - done : CHUNK;
    flags |= map_chunk(op, m, r + done, a + done, is_binary(op) ? b + done : a + done);
  }
  return flags;
}

uint32_t ambit_interval_op(uint32_t op, ambit_interval *r, ambit_interval a, ambit_interval b) {
  return map_chunk(op, 1, r, &a, &b);
}

static ambit_interval combine(uint32_t op, ambit_interval a, ambit_interval b) {
  ambit_interval r;
  ambit_rounding old = ambit_round_up();
  map_basic(op, 1, &r, &a, &b);
  ambit_rounding_restore(old);
  return r;
}

ambit_interval ambit_interval_add(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_ADD, a, b); }
ambit_interval ambit_interval_sub(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_SUB, a, b); }
ambit_interval ambit_interval_mul(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_MUL, a, b); }
ambit_interval ambit_interval_div(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_DIV, a, b); }

/* a^n for positive n over the hull [least, most] of |a| */
static ambit_interval power_even(ambit_interval a, int32_t n) {
  return (ambit_interval) { ambit_power_down(mignitude(a), n), ambit_power_up(magnitude(a), n) };
}

static double signed_power_up(double x, int32_t n) { return x < 0 ? -ambit_power_down(-x, n) : ambit_power_up(x, n); }

static ambit_interval power_odd(ambit_interval a, int32_t n) {
  return (ambit_interval) { -signed_power_up(-a.lo, n), signed_power_up(a.hi, n) };
}

/* n < 0, the powers of the positive part of a, a.hi > 0 */
static ambit_interval inverse_positive(ambit_interval a, int32_t n) {
  double up = a.lo > 0 ? ambit_power_up(a.lo, n) : INFINITY;
  return (ambit_interval) { ambit_power_down(a.hi, n), up };
}

static ambit_interval inverse_power(ambit_interval a, int32_t n) {
  bool odd = n % 2 != 0;
  ambit_interval r = AMBIT_EMPTY;
  if (a.hi > 0) r = inverse_positive(a, n);
  if (a.lo < 0) {
    ambit_interval left = inverse_positive(negate(a), n);
    r = ambit_interval_hull(r, odd ? negate(left) : left);
  }
  return r;
}

uint32_t ambit_interval_pown(ambit_interval *r, ambit_interval a, int32_t n) {
  bool partial = false;
  if (ambit_interval_is_empty(a)) {
    *r = AMBIT_EMPTY;
  } else if (n == 0) {
    *r = (ambit_interval) { 1, 1 };
  } else if (n > 0) {
    *r = n % 2 ? power_odd(a, n) : power_even(a, n);
  } else {
    partial = a.lo <= 0 && a.hi >= 0;
    *r = inverse_power(a, n);
  }
  return shape_flags(*r) | (partial ? AMBIT_F_PARTIAL : 0);
}

ambit_interval ambit_interval_of(double lo, double hi) {
  return lo <= hi && lo < INFINITY && hi > -INFINITY ? (ambit_interval) { lo, hi } : AMBIT_EMPTY;
}

ambit_interval ambit_interval_hull(ambit_interval a, ambit_interval b) {
  if (ambit_interval_is_empty(a)) return b;
  if (ambit_interval_is_empty(b)) return a;
  return (ambit_interval) { smaller(a.lo, b.lo), larger(a.hi, b.hi) };
}

ambit_interval ambit_interval_intersect(ambit_interval a, ambit_interval b) {
  return ambit_interval_of(larger(a.lo, b.lo), smaller(a.hi, b.hi));
}

AMBIT_WORKER double ambit_interval_mid(ambit_interval x) {
  if (ambit_interval_is_empty(x)) return NAN;
  if (x.lo == -INFINITY) return x.hi == INFINITY ? 0 : -DBL_MAX;
  if (x.hi == INFINITY) return DBL_MAX;
  double sum = x.lo + x.hi;
  double mid = fabs(sum) <= DBL_MAX ? 0.5 * sum : 0.5 * x.lo + 0.5 * x.hi;
  return smaller(larger(mid, x.lo), x.hi);
}

static AMBIT_WORKER double radius_about(ambit_interval x, double mid) { return larger(x.hi - mid, mid - x.lo); }

static AMBIT_WORKER double distance(double lo, double hi) { return hi - lo; }

double ambit_interval_rad(ambit_interval x) {
  if (ambit_interval_is_empty(x)) return 0;
  double mid = ambit_interval_mid(x);
  ambit_rounding old = ambit_round_up();
  double rad = radius_about(x, mid);
  ambit_rounding_restore(old);
  return rad;
}

double ambit_interval_width(ambit_interval x) {
  if (ambit_interval_is_empty(x)) return 0;
  ambit_rounding old = ambit_round_up();
  double width = distance(x.lo, x.hi);
  ambit_rounding_restore(old);
  return width;
}

double ambit_interval_mag(ambit_interval x) { return ambit_interval_is_empty(x) ? 0 : magnitude(x); }
double ambit_interval_mig(ambit_interval x) { return ambit_interval_is_empty(x) ? 0 : mignitude(x); }

/* the neighbours of pi = 3.14159265358979323846264338... */
ambit_interval ambit_interval_pi(void) { return (ambit_interval) { 0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1 }; }
