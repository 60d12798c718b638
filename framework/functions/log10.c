/* log10.c -- the decimal logarithm, x > 0; exact at the powers of ten that are doubles. */
#include "functions/function.h"

static const pair per_ln10 = { 0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57 };

/* x = 10^k, or -1 */
static int power_of_ten(double x) {
  double ten = 1;
  for (int k = 0; k <= 22; k++, ten *= 10) /* exact */
    if (x == ten) return k;
  return -1;
}

static ambit_interval at(double x) {
  if (x == 0) return VALUE_MINUS_INFINITY;
  if (x == INFINITY) return VALUE_INFINITY;
  int k = power_of_ten(x);
  if (k >= 0) return value_point(k);
  return value_within(value_product(log_kernel(x), per_ln10), VALUE_ERROR);
}

static const ambit_interval factor = { 0x1.bcb7b1526e50ep-2, 0x1.bcb7b1526e50fp-2 };

static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  for (uint32_t k = 1; k <= n; k++) c[k] = ambit_interval_mul(factor, function_log_coefficient(x, k));
}

static double touch(double s) { return 0.43429448190325182 / s; }

static ambit_interval inverse(ambit_interval r) {
  return function_op(AMBIT_OP_EXP, ambit_interval_mul(r, function_op(AMBIT_OP_LOG, value_point(10))));
}

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  ambit_expr ln10 = function_fold_one(g, AMBIT_OP_LOG, function_number(g, 10));
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, function_fold(g, AMBIT_OP_MUL, a, ln10));
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  ambit_expr ln10 = function_make_one(g, AMBIT_OP_LOG, function_number(g, 10));
  return function_make(g, AMBIT_OP_DIV, function_make_one(g, AMBIT_OP_LOG, a), ln10);
}

const ambit_described ambit_function_log10 = { .facts = FACTS(AMBIT_CONCAVE, 0, INFINITY, 1, 0, touch),
  .latex = { .head = "\\log_{10}\\left(", .tail = "\\right)" },
  .modelica = { .head = "log10(", .tail = ")" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
