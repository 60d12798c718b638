/* atanh.c -- the inverse hyperbolic tangent, |x| < 1. */
#include "functions/function.h"

/* ln(1 + 2u/(1 - u)) / 2, 1 - u without error */
static pair positive(double u) {
  pair twice = { 2 * u, 0 }, y = value_log1p(pair_divide(twice, two_sum(1, -u)));
  return (pair) { 0.5 * y.h, 0.5 * y.l };
}

/* 0 < atanh x - x < x^3/2 for tiny x > 0: less than the distance to the next double */
static ambit_interval at(double x) {
  double u = fabs(x);
  if (x == 0) return value_point(0);
  ambit_interval r = u == 1 ? VALUE_INFINITY : u < 0x1p-27 ? value_above(u) : value_within(positive(u), VALUE_ERROR);
  return x < 0 ? value_negate(r) : r;
}

/* of (ln(1 + x) - ln(1 - x)) / 2 */
static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  const ambit_interval one = value_point(1);
  ambit_interval above = ambit_interval_add(one, x), below = ambit_interval_sub(one, x);
  for (uint32_t k = 1; k <= n; k++) {
    ambit_interval other = function_over(function_power(below, -(int32_t)k), k);
    c[k] = function_over(ambit_interval_add(function_log_coefficient(above, k), other), 2);
  }
}

static double touch(double s) { return sqrt(1 - 1 / s); }

static ambit_interval inverse(ambit_interval r) { return function_op(AMBIT_OP_TANH, r); }

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  ambit_expr q = function_fold(g, AMBIT_OP_SUB, AMBIT_ONE, function_fold_one(g, AMBIT_OP_SQR, a));
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, q);
}

/* ln((1 + a) / (1 - a)) / 2: numerator and denominator of a set end together, so nothing is lost */
static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  ambit_expr above = function_make(g, AMBIT_OP_ADD, AMBIT_ONE, a), below = function_make(g, AMBIT_OP_SUB, AMBIT_ONE, a);
  ambit_expr log = function_make_one(g, AMBIT_OP_LOG, function_make(g, AMBIT_OP_DIV, above, below));
  return function_make(g, AMBIT_OP_MUL, function_number(g, 0.5), log);
}

const ambit_described ambit_function_atanh = { .facts = FACTS(AMBIT_CONVEX_RIGHT, -1, 1, 1, 1, touch),
  .latex = { .head = "\\operatorname{artanh}\\left(", .tail = "\\right)" },
  .modelica = { .head = "(0.5*log(2/(1 - ", .tail = ") - 1))" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
