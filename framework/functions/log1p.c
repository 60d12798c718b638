/* log1p.c -- ln(1 + x), x > -1: relative accuracy at tiny x, where 1 + x has lost it. */
#include "functions/function.h"

/* 0 < x - ln(1 + x) < x^2 for tiny x != 0: less than the distance to the next double */
static ambit_interval at(double x) {
  if (x == -1) return VALUE_MINUS_INFINITY;
  if (x == INFINITY) return VALUE_INFINITY;
  if (x == 0) return value_point(0);
  if (fabs(x) < 0x1p-54) return value_below(x);
  return value_within(x > 0x1p100 ? log_kernel(x) : value_log1p((pair) { x, 0 }), VALUE_ERROR);
}

static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  ambit_interval shifted = ambit_interval_add(value_point(1), x);
  for (uint32_t k = 1; k <= n; k++) c[k] = function_log_coefficient(shifted, k);
}

static double touch(double s) { return 1 / s - 1; }

static ambit_interval inverse(ambit_interval r) {
  return ambit_interval_sub(function_op(AMBIT_OP_EXP, r), value_point(1));
}

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, function_fold(g, AMBIT_OP_ADD, AMBIT_ONE, a));
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  return function_make_one(g, AMBIT_OP_LOG, function_make(g, AMBIT_OP_ADD, AMBIT_ONE, a));
}

const ambit_described ambit_function_log1p = { .facts = FACTS(AMBIT_CONCAVE, -1, INFINITY, 1, 0, touch),
  .latex = { .head = "\\operatorname{log1p}\\left(", .tail = "\\right)" },
  .modelica = { .head = "log(1 + ", .tail = ")" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
