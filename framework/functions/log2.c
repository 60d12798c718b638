/* log2.c -- the logarithm to base 2, x > 0; exact at powers of two. */
#include "functions/function.h"

static const pair per_ln2 = { 0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56 };

static ambit_interval at(double x) {
  int exponent;
  if (x == 0) return VALUE_MINUS_INFINITY;
  if (x == INFINITY) return VALUE_INFINITY;
  if (frexp(x, &exponent) == 0.5) return value_point(exponent - 1);
  return value_within(value_product(log_kernel(x), per_ln2), VALUE_ERROR);
}

static const ambit_interval factor = { 0x1.71547652b82fep+0, 0x1.71547652b82ffp+0 };

static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  for (uint32_t k = 1; k <= n; k++) c[k] = ambit_interval_mul(factor, function_log_coefficient(x, k));
}

static double touch(double s) { return 1.4426950408889634 / s; }

static ambit_interval inverse(ambit_interval r) {
  return function_op(AMBIT_OP_EXP, ambit_interval_mul(r, function_op(AMBIT_OP_LOG, value_point(2))));
}

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  ambit_expr ln2 = function_fold_one(g, AMBIT_OP_LOG, function_number(g, 2));
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, function_fold(g, AMBIT_OP_MUL, a, ln2));
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  ambit_expr ln2 = function_make_one(g, AMBIT_OP_LOG, function_number(g, 2));
  return function_make(g, AMBIT_OP_DIV, function_make_one(g, AMBIT_OP_LOG, a), ln2);
}

const ambit_described ambit_function_log2 = { .facts = FACTS(AMBIT_CONCAVE, 0, INFINITY, 1, 0, touch),
  .latex = { .head = "\\log_{2}\\left(", .tail = "\\right)" },
  .modelica = { .head = "(log(", .tail = ")/log(2))" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
