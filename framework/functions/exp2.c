/* exp2.c -- 2^x; exact at integers. */
#include "functions/function.h"

/* 2^(n + f) = e^(f ln2) 2^n, f exact, |f| <= 1/2 */
static ambit_interval at(double x) {
  if (x == -INFINITY) return value_point(0);
  if (x < -1074) return (ambit_interval) { 0, VALUE_TINIEST };
  if (x >= 1024) return VALUE_INFINITY;
  if (x != 0 && fabs(x) < 0x1p-60) return x < 0 ? value_below(1) : value_above(1);
  double n = nearbyint(x), f = x - n;
  if (f == 0) return value_point(ldexp(1, (int)n));
  pair p = two_product(f, value_ln2.h);
  p = fast_two_sum(p.h, p.l + f * value_ln2.l);
  return value_exp(p, VALUE_ERROR, (int64_t)n);
}

static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  ambit_interval r = function_op(AMBIT_OP_EXP2, x), ln2 = function_op(AMBIT_OP_LOG, value_point(2));
  for (uint32_t k = 1; k <= n; k++) c[k] = r = function_over(ambit_interval_mul(r, ln2), k);
}

static double touch(double s) { return log2(s / 0.69314718055994531); }

static ambit_interval inverse(ambit_interval r) { return function_op(AMBIT_OP_LOG2, r); }

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)a;
  return function_fold(g, AMBIT_OP_MUL, function_fold_one(g, AMBIT_OP_LOG, function_number(g, 2)), e);
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  ambit_expr ln2 = function_make_one(g, AMBIT_OP_LOG, function_number(g, 2));
  return function_make_one(g, AMBIT_OP_EXP, function_make(g, AMBIT_OP_MUL, ln2, a));
}

const ambit_described ambit_function_exp2 = { .facts = FACTS(AMBIT_CONVEX, -INFINITY, INFINITY, 0, 0, touch),
  .latex = { .head = "\\operatorname{exp2}\\left(", .tail = "\\right)" },
  .modelica = { .head = "(2^(", .tail = "))" },
  .positive = true,
  .image = { 0, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
