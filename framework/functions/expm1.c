/* expm1.c -- e^x - 1: relative accuracy at tiny x, where e^x has lost it. */
#include "functions/function.h"

/* e^x - 1 = 2 s (s + c), s and c the hyperbolic sine and cosine of x/2 */
static pair near_zero(double x) {
  pair s, c;
  sinh_cosh_near(0.5 * x, &s, &c);
  pair p = value_product(s, value_sum(c, s));
  return (pair) { 2 * p.h, 2 * p.l };
}

/* e^x - 1, |x| >= 1/2: at most 2.6 times the relative error of e^x */
static pair far_out(double x) {
  bits k;
  pair e = exp_kernel(x, &k);
  double unit = power_of_two(k);
  pair s = two_sum(e.h * unit, -1);
  return fast_two_sum(s.h, s.l + e.l * unit);
}

/* 0 < e^x - 1 - x < x^2 for tiny x != 0: less than the distance to the next double */
static ambit_interval at(double x) {
  if (x == 0) return value_point(0);
  if (fabs(x) < 0x1p-54) return value_above(x);
  if (x < -38) return x == -INFINITY ? value_point(-1) : value_above(-1);
  if (x > 710) return VALUE_INFINITY;
  if (x > 80) return value_exp((pair) { x, 0 }, VALUE_ERROR, 0); /* the 1 is less than 2^-115 of it */
  return value_within(fabs(x) < 0.5 ? near_zero(x) : far_out(x), VALUE_ERROR);
}

static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  ambit_interval r = function_op(AMBIT_OP_EXP, x);
  for (uint32_t k = 1; k <= n; k++) c[k] = r = function_over(r, k);
}

static double touch(double s) { return log(s); }

static ambit_interval inverse(ambit_interval r) { return function_op(AMBIT_OP_LOG1P, r); }

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  return function_fold_one(g, AMBIT_OP_EXP, a);
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  return function_make(g, AMBIT_OP_SUB, function_make_one(g, AMBIT_OP_EXP, a), AMBIT_ONE);
}

const ambit_described ambit_function_expm1 = { .facts = FACTS(AMBIT_CONVEX, -INFINITY, INFINITY, 0, 0, touch),
  .latex = { .head = "\\operatorname{expm1}\\left(", .tail = "\\right)" },
  .modelica = { .head = "(exp(", .tail = ") - 1)" },
  .image = { -1, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
