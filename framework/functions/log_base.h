/* log_base.h -- the logarithm to base BASE: what log2.c and log10.c share; they define BASE, `factor`, an enclosure of
** 1 / ln BASE, and `touching`, about the same number. */
static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  for (uint32_t k = 1; k <= n; k++) c[k] = ambit_interval_mul(factor, function_log_coefficient(x, k));
}

static double touch(double s) { return touching / s; }

static ambit_interval inverse(ambit_interval r) {
  return function_op(AMBIT_OP_EXP, ambit_interval_mul(r, function_op(AMBIT_OP_LOG, value_point(BASE))));
}

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  ambit_expr log_base = function_fold_one(g, AMBIT_OP_LOG, function_number(g, BASE));
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, function_fold(g, AMBIT_OP_MUL, a, log_base));
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  ambit_expr log_base = function_make_one(g, AMBIT_OP_LOG, function_number(g, BASE));
  return function_make(g, AMBIT_OP_DIV, function_make_one(g, AMBIT_OP_LOG, a), log_base);
}
