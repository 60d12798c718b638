/* values.c -- the functions that are linearised: values and derivatives, enclosed. Upward mode.
**
** A lower bound is minus the upward-rounded negated value.
*/
#include "linearise.h"
#include <string.h>

static range square(range x) {
  double small = x.lo > 0 ? x.lo : x.hi < 0 ? -x.hi : 0, large = -x.lo > x.hi ? -x.lo : x.hi;
  return (range) { -((-small) * small), large * large };
}

static range negate(range x) { return (range) { -x.hi, -x.lo }; }
static range plus(range x, double y) { return (range) { -(-x.lo - y), x.hi + y }; }

/* x > 0, or both ends may be 0 or infinite */
static range reciprocal(range x) { return (range) { -(-1 / x.hi), 1 / x.lo }; }

static range times(range x, double y) {
  if (y < 0) return negate(times(x, -y));
  return (range) { -(-x.lo * y), x.hi * y };
}

/* x >= 0: s = sqrt x rounded up, and x / s rounded down is at most sqrt x because s is at least that */
static range root(range x) {
  double s = sqrt(x.lo);
  return (range) { s > 0 && s < INFINITY ? -(-x.lo / s) : 0, sqrt(x.hi) };
}

static range clip(range x, double least) {
  return (range) { x.lo < least ? least : x.lo, x.hi < least ? least : x.hi };
}

static int is_served(uint32_t op) { return op >= AMBIT_OP_EXP && op <= AMBIT_OP_TANH; }

/* of a function that the kernel describes: coefficient k of its series at each [a, b] */
static void described(const affine_context *c, uint32_t op, uint32_t k, size_t n, const double *a, const double *b,
    double *lo, double *hi) {
  double series[4];
  for (size_t i = 0; i < n; i++) {
    c->num->taylor(op, k, series, a[i], b[i]);
    lo[i] = series[2 * k], hi[i] = series[2 * k + 1];
  }
}

void linearise_values(
    const affine_context *c, uint32_t op, int32_t power, size_t n, const double *x, double *lo, double *hi) {
  if (ambit_op_is_function(op)) {
    described(c, op, 0, n, x, x, lo, hi);
    return;
  }
  if (is_served(op)) {
    c->num->elementary(op, n, x, x, x, x, lo, hi);
    return;
  }
  for (size_t i = 0; i < n; i++) {
    range r = { x[i], x[i] };
    if (op == AMBIT_OP_SQRT)
      r = root(r);
    else if (op == AMBIT_OP_POWN)
      c->num->pown(&r.lo, &r.hi, x[i], x[i], power);
    else
      r = (range) { -(-1 / x[i]), 1 / x[i] };
    lo[i] = r.lo, hi[i] = r.hi;
  }
}

/* f' = sign * the function `op` of the same argument, for the functions where f does not give it */
static uint32_t companion(uint32_t op) {
  switch (op) {
  case AMBIT_OP_SIN: return AMBIT_OP_COS;
  case AMBIT_OP_COS: return AMBIT_OP_SIN;
  case AMBIT_OP_COSH: return AMBIT_OP_SINH;
  default: return AMBIT_OP_COUNT;
  }
}

/* e: the companion's enclosure, of POWN: x^(power - 1) */
static range slope_of(uint32_t op, int32_t power, range x, range f, range e) {
  switch (op) {
  case AMBIT_OP_EXP: return f;
  case AMBIT_OP_LOG: return reciprocal(x);
  case AMBIT_OP_SQRT: return reciprocal(times(f, 2));
  case LINEARISE_RECIPROCAL: return negate(square(f));
  case AMBIT_OP_TAN: return plus(square(f), 1);
  case AMBIT_OP_TANH: return clip(plus(negate(square(f)), 1), 0);
  case AMBIT_OP_ATAN: return reciprocal(plus(square(x), 1));
  case AMBIT_OP_ASIN: return reciprocal(root(clip(plus(negate(square(x)), 1), 0)));
  case AMBIT_OP_ACOS: return negate(reciprocal(root(clip(plus(negate(square(x)), 1), 0))));
  case AMBIT_OP_SINH: return root(plus(square(f), 1));
  case AMBIT_OP_COS: return negate(e);
  case AMBIT_OP_POWN: return times(e, power);
  default: return e; /* SIN, COSH */
  }
}

void linearise_slopes(const affine_context *c, uint32_t op, int32_t power, size_t n, const double *a, const double *b,
    const double *flo, const double *fhi, double *lo, double *hi) {
  uint32_t other = companion(op);
  if (ambit_op_is_function(op)) {
    described(c, op, 1, n, a, b, lo, hi);
    return;
  }
  if (other != AMBIT_OP_COUNT) c->num->elementary(other, n, a, b, a, b, lo, hi);
  for (size_t i = 0; i < n; i++) {
    range e = { 0, 0 };
    if (other != AMBIT_OP_COUNT) e = (range) { lo[i], hi[i] };
    if (op == AMBIT_OP_POWN) c->num->pown(&e.lo, &e.hi, a[i], b[i], power - 1);
    range r = slope_of(op, power, (range) { a[i], b[i] }, (range) { flo[i], fhi[i] }, e);
    lo[i] = r.lo, hi[i] = r.hi;
  }
}

/* -- where the slope is reached: approximations, whose errors only cost tightness */

/* the argument of the function that the kernel's interval functions compute below */
static double prepare(uint32_t op, double s) {
  switch (op) {
  case AMBIT_OP_EXP: return s;
  case AMBIT_OP_SINH: return s + sqrt(s * s - 1);
  case AMBIT_OP_COSH: return fabs(s) + sqrt(s * s + 1);
  case AMBIT_OP_TANH: return (1 + sqrt(1 - s)) / (1 - sqrt(1 - s));
  default: return sqrt(s - 1); /* TAN */
  }
}

static double touch(uint32_t op, int32_t power, double s, double log_or_atan) {
  switch (op) {
  case AMBIT_OP_EXP:
  case AMBIT_OP_SINH:
  case AMBIT_OP_TAN: return log_or_atan;
  case AMBIT_OP_COSH: return copysign(log_or_atan, s);
  case AMBIT_OP_TANH: return 0.5 * log_or_atan;
  case AMBIT_OP_LOG: return 1 / s;
  case AMBIT_OP_SQRT: return 0.25 / (s * s);
  case LINEARISE_RECIPROCAL: return 1 / sqrt(-s);
  case AMBIT_OP_ATAN: return sqrt(1 / s - 1);
  case AMBIT_OP_POWN: return pow(fabs(s / power), 1.0 / (power - 1.0));
  default: return sqrt((1 - 1 / s) * (1 + 1 / s)); /* ASIN, ACOS */
  }
}

void linearise_touch(const affine_context *c, uint32_t op, int32_t power, size_t n, const double *slope, double *x) {
  double argument[LINEARISE_CHUNK], above[LINEARISE_CHUNK];
  int by_log = op == AMBIT_OP_EXP || op == AMBIT_OP_SINH || op == AMBIT_OP_COSH || op == AMBIT_OP_TANH;
  const ambit_function_facts *facts = c->num->facts(op);
  memset(x, 0, n * sizeof *x);
  for (size_t i = 0; i < n && facts; i++) x[i] = facts->touch(slope[i]);
  if (facts) return;
  if (by_log || op == AMBIT_OP_TAN) {
    for (size_t i = 0; i < n; i++) {
      double v = prepare(op, slope[i]);
      argument[i] = v >= 0 && v < INFINITY ? v : 1;
    }
    c->num->elementary(by_log ? AMBIT_OP_LOG : AMBIT_OP_ATAN, n, argument, argument, argument, argument, x, above);
  }
  for (size_t i = 0; i < n; i++) x[i] = touch(op, power, slope[i], x[i]);
}
