/* interval.c -- set-based interval arithmetic (IEEE 1788-2015), element by element.
**
** Every public function sets upward rounding for its worker and restores what it found. A lower bound is computed as
** minus the upward-rounded negated value, so one mode serves both bounds. Bounds that are products or quotients with
** 0 and infinity follow the set meaning: 0 * x = 0 for every real x, and an infinite bound is no element.
*/
#include "num/interval.h"
#include "num/elementary.h"
#include "num/function.h"
#include "num/power.h"
#include "num/rounding.h"
#include <float.h>
#include <string.h>

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

static bool is_binary(uint32_t op) { return ambit_op_arity(op) == 2; }

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

static void map_basic(uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b) {
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
  double lo[CHUNK], hi[CHUNK];
  uint32_t flags = 0;
  for (size_t done = 0; done < n; done += CHUNK) {
    size_t m = n - done < CHUNK ? n - done : CHUNK;
    for (size_t i = 0; i < m; i++) {
      lo[i] = a[done + i].lo, hi[i] = a[done + i].hi;
      if (exponent < 0 && lo[i] <= 0 && hi[i] >= 0) flags |= AMBIT_F_PARTIAL;
    }
    ambit_power(exponent, m, lo, hi, lo, hi);
    for (size_t i = 0; i < m; i++) {
      r[done + i] = (ambit_interval) { lo[i], hi[i] };
      flags |= shape_flags(r[done + i]);
    }
  }
  return flags;
}

static uint32_t map_chunk(uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b) {
  ambit_interval result[CHUNK];
  if (is_elementary(op))
    map_elementary(op, n, result, a, b);
  else
    map_basic(op, n, result, a, b);
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

/* upward mode, which elementary functions and powers leave and restore */
static AMBIT_WORKER uint32_t map(
    uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b, int32_t exponent) {
  if (op == AMBIT_OP_POWN) return map_pown(n, r, a, exponent);
  if (ambit_op_is_function(op)) return ambit_function_map(op, n, r, a, b);
  uint32_t flags = 0;
  for (size_t done = 0; done < n; done += CHUNK) {
    size_t m = n - done < CHUNK ? n - done : CHUNK;
    flags |= map_chunk(op, m, r + done, a + done, is_binary(op) ? b + done : a + done);
  }
  return flags;
}

uint32_t ambit_interval_map(
    uint32_t op, size_t n, ambit_interval *r, const ambit_interval *a, const ambit_interval *b, int32_t exponent) {
  ambit_rounding old = ambit_round_up();
  uint32_t flags = map(op, n, r, a, b, exponent);
  ambit_rounding_restore(old);
  return flags;
}

uint32_t ambit_interval_op(uint32_t op, ambit_interval *r, ambit_interval a, ambit_interval b) {
  return ambit_interval_map(op, 1, r, &a, &b, 0);
}

static AMBIT_WORKER ambit_interval combine_up(uint32_t op, ambit_interval a, ambit_interval b) {
  ambit_interval r;
  map_basic(op, 1, &r, &a, &b);
  return r;
}

static ambit_interval combine(uint32_t op, ambit_interval a, ambit_interval b) {
  ambit_rounding old = ambit_round_up();
  ambit_interval r = combine_up(op, a, b);
  ambit_rounding_restore(old);
  return r;
}

ambit_interval ambit_interval_add(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_ADD, a, b); }
ambit_interval ambit_interval_sub(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_SUB, a, b); }
ambit_interval ambit_interval_mul(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_MUL, a, b); }
ambit_interval ambit_interval_div(ambit_interval a, ambit_interval b) { return combine(AMBIT_OP_DIV, a, b); }

uint32_t ambit_interval_pown(ambit_interval *r, ambit_interval a, int32_t n) {
  return ambit_interval_map(AMBIT_OP_POWN, 1, r, &a, NULL, n);
}

/* The functions below set no mode. So that they are right for a caller who takes subnormal numbers for zero, they
** compare bits, not doubles: `rank` increases with the double, is the same for -0 and 0, and beyond those of the
** infinities for NaN. */
static int64_t rank(double x) {
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits < 0 ? -(bits & INT64_MAX) : bits;
}

static double upper(double a, double b) { return rank(a) > rank(b) ? a : b; }
static double lower(double a, double b) { return rank(a) < rank(b) ? a : b; }

ambit_interval ambit_interval_of(double lo, double hi) {
  int64_t first = rank(lo), last = rank(hi), infinity = rank(INFINITY);
  bool nonempty = first <= last && first >= -infinity && first < infinity && last > -infinity && last <= infinity;
  return nonempty ? (ambit_interval) { lo, hi } : AMBIT_EMPTY;
}

ambit_interval ambit_interval_hull(ambit_interval a, ambit_interval b) {
  if (ambit_interval_is_empty(a)) return b;
  if (ambit_interval_is_empty(b)) return a;
  return (ambit_interval) { lower(a.lo, b.lo), upper(a.hi, b.hi) };
}

ambit_interval ambit_interval_intersect(ambit_interval a, ambit_interval b) {
  return ambit_interval_of(upper(a.lo, b.lo), lower(a.hi, b.hi));
}

/* round to nearest */
static AMBIT_WORKER double middle(ambit_interval x) {
  if (ambit_interval_is_empty(x)) return NAN;
  if (x.lo == -INFINITY) return x.hi == INFINITY ? 0 : -DBL_MAX;
  if (x.hi == INFINITY) return DBL_MAX;
  double sum = x.lo + x.hi;
  double mid = fabs(sum) <= DBL_MAX ? 0.5 * sum : 0.5 * x.lo + 0.5 * x.hi;
  return smaller(larger(mid, x.lo), x.hi);
}

double ambit_interval_mid(ambit_interval x) {
  ambit_rounding old = ambit_round_nearest();
  double mid = middle(x);
  ambit_rounding_restore(old);
  return mid;
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

double ambit_interval_mag(ambit_interval x) { return ambit_interval_is_empty(x) ? 0 : upper(fabs(x.lo), fabs(x.hi)); }

double ambit_interval_mig(ambit_interval x) { return rank(x.lo) > 0 ? x.lo : rank(x.hi) < 0 ? -x.hi : 0; }

/* the neighbours of pi = 3.14159265358979323846264338... */
ambit_interval ambit_interval_pi(void) { return (ambit_interval) { 0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1 }; }
