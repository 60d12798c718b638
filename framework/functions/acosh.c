/* acosh.c -- the inverse hyperbolic cosine, x >= 1. */
#include "functions/function.h"

/* ln(1 + t + sqrt(t (t + 2))), t = x - 1; from 2^32 on ln(2 x), which is more by at most 1/(3 x^2) */
static ambit_interval at(double x) {
  if (x <= 1) return value_point(0);
  if (x == INFINITY) return VALUE_INFINITY;
  if (x > 0x1p32) return value_within(value_sum(log_kernel(x), value_ln2), VALUE_ERROR);
  pair t = two_sum(x, -1), two = { 2, 0 };
  pair root = value_root(value_product(t, value_sum(t, two)));
  return value_within(value_log1p(value_sum(root, t)), VALUE_ERROR);
}

/* at a number x > 1: f' = g with (x^2 - 1) (k + 1) g_(k+1) = -(2k + 1) x g_k - k g_(k-1) */
static void taylor_at(uint32_t n, double at, ambit_interval *g) {
  ambit_interval x = value_point(at), one = value_point(1);
  ambit_interval q = ambit_interval_mul(ambit_interval_sub(x, one), ambit_interval_add(x, one));
  g[0] = ambit_interval_div(one, function_op(AMBIT_OP_SQRT, q));
  for (uint32_t k = 0; k + 1 < n; k++) {
    ambit_interval sum = ambit_interval_mul(ambit_interval_mul(value_point(2.0 * k + 1), x), g[k]);
    if (k) sum = ambit_interval_add(sum, ambit_interval_mul(value_point(k), g[k - 1]));
    g[k + 1] = value_negate(function_over(ambit_interval_div(sum, q), k + 1.0));
  }
}

/* (x - 1)^(-1/2) (x + 1)^(-1/2) is completely monotone: so is every derivative up to its sign, and the ends decide.
** c holds the coefficients at the lower end, then the hull with those at the upper one, blockwise. */
static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  enum { MOST = 128 };
  ambit_interval upper[MOST];
  taylor_at(n, x.lo, c + 1);
  taylor_at(n < MOST ? n : MOST, x.hi, upper);
  for (uint32_t k = 1; k <= n; k++) {
    ambit_interval other = k <= MOST ? upper[k - 1] : value_point(0); /* 0 is beyond: the limit at infinity */
    c[k] = function_over(ambit_interval_hull(c[k], other), k);
  }
}

static double touch(double s) { return sqrt(1 / s * (1 / s) + 1); }

static ambit_interval inverse(ambit_interval r) { return function_op(AMBIT_OP_COSH, r); }

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  ambit_expr above = function_fold(g, AMBIT_OP_ADD, a, AMBIT_ONE), below = function_fold(g, AMBIT_OP_SUB, a, AMBIT_ONE);
  ambit_expr root = function_fold_one(g, AMBIT_OP_SQRT, function_fold(g, AMBIT_OP_MUL, above, below));
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, root);
}

/* sqrt(a - 1) sqrt(a + 1) = sqrt(a^2 - 1) for a >= 1, and the first is not defined for a <= -1 */
static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  ambit_expr above = function_make_one(g, AMBIT_OP_SQRT, function_make(g, AMBIT_OP_ADD, a, AMBIT_ONE));
  ambit_expr below = function_make_one(g, AMBIT_OP_SQRT, function_make(g, AMBIT_OP_SUB, a, AMBIT_ONE));
  ambit_expr sum = function_make(g, AMBIT_OP_ADD, a, function_make(g, AMBIT_OP_MUL, above, below));
  return function_make_one(g, AMBIT_OP_LOG, sum);
}

const ambit_described ambit_function_acosh = { .facts = FACTS(AMBIT_CONCAVE, 1, INFINITY, 0, 0, touch),
  .latex = { .head = "\\operatorname{arcosh}\\left(", .tail = "\\right)" },
  .modelica = { .head = "Modelica.Math.acosh(", .tail = ")" },
  .image = { 0, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
