/* asinh.c -- the inverse hyperbolic sine: relative accuracy at tiny x, no overflow at huge ones. */
#include "functions/function.h"

/* ln(u + sqrt(1 + u^2)) = ln(1 + u + u^2 / (1 + sqrt(1 + u^2))); from 2^32 on ln(2 u), which is less by at most
** 1/(4 u^2) */
static pair positive(double u) {
  if (u > 0x1p32) return value_sum(log_kernel(u), value_ln2);
  pair square = two_product(u, u), root = value_root(value_sum(value_one, square));
  pair more = pair_divide(square, value_sum(value_one, root));
  return value_log1p(value_sum((pair) { u, 0 }, more));
}

/* 0 < x - asinh x < x^3/6 for tiny x > 0: less than the distance to the next double */
static ambit_interval at(double x) {
  double u = fabs(x);
  if (x == 0) return value_point(0);
  ambit_interval r = u == INFINITY ? VALUE_INFINITY
                     : u < 0x1p-27 ? value_below(u)
                                   : value_within(positive(u), VALUE_ERROR);
  return x < 0 ? value_negate(r) : r;
}

/* f' = g with (1 + x^2) g' = -x g, so that (1 + x^2) (k + 1) g_(k+1) = -(2k + 1) x g_k - k g_(k-1). Besides, g is
** the generating function of Legendre's polynomials, at most 1 in size: |g_k| <= (1 + x^2)^(-(k+1)/2). */
static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  const ambit_interval one = value_point(1);
  ambit_interval q = ambit_interval_add(one, function_op(AMBIT_OP_SQR, x)), before = value_point(0);
  ambit_interval inverse_root = ambit_interval_div(one, function_op(AMBIT_OP_SQRT, q)), g = inverse_root;
  for (uint32_t k = 0; k < n; k++) {
    double most = function_power(inverse_root, (int32_t)k + 1).hi;
    g = ambit_interval_intersect(g, (ambit_interval) { -most, most });
    c[k + 1] = function_over(g, k + 1.0);
    ambit_interval sum = ambit_interval_mul(ambit_interval_mul(value_point(2.0 * k + 1), x), g);
    sum = ambit_interval_add(sum, ambit_interval_mul(value_point(k), before));
    before = g;
    g = value_negate(function_over(ambit_interval_div(sum, q), k + 1.0));
  }
}

static double touch(double s) { return sqrt((1 / s - 1) * (1 / s + 1)); }

static ambit_interval inverse(ambit_interval r) { return function_op(AMBIT_OP_SINH, r); }

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)e;
  ambit_expr q = function_fold(g, AMBIT_OP_ADD, AMBIT_ONE, function_fold_one(g, AMBIT_OP_SQR, a));
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, function_fold_one(g, AMBIT_OP_SQRT, q));
}

/* 2 ln((1 + c + s) / (1 + c - s)), where s = a / (2 c) and c = sqrt((1 + sqrt(1 + a^2)) / 2) are the hyperbolic sine
** and cosine of half the result: as good for both signs, and for sets across 0 that are a few units wide. Its relative
** error is about sqrt |a| roundings, so that it proves nothing from |a| = 2^100 on. */
static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  ambit_expr q = function_make(g, AMBIT_OP_ADD, AMBIT_ONE, function_make_one(g, AMBIT_OP_SQR, a));
  q = function_make(g, AMBIT_OP_ADD, AMBIT_ONE, function_make_one(g, AMBIT_OP_SQRT, q));
  ambit_expr half = function_number(g, 0.5), two = function_number(g, 2);
  ambit_expr c = function_make_one(g, AMBIT_OP_SQRT, function_make(g, AMBIT_OP_MUL, half, q));
  ambit_expr s = function_make(g, AMBIT_OP_DIV, a, function_make(g, AMBIT_OP_MUL, two, c));
  c = function_make(g, AMBIT_OP_ADD, AMBIT_ONE, c);
  ambit_expr above = function_make(g, AMBIT_OP_ADD, c, s), below = function_make(g, AMBIT_OP_SUB, c, s);
  return function_make(
      g, AMBIT_OP_MUL, two, function_make_one(g, AMBIT_OP_LOG, function_make(g, AMBIT_OP_DIV, above, below)));
}

const ambit_described ambit_function_asinh = { .facts = FACTS(AMBIT_CONCAVE_RIGHT, -INFINITY, INFINITY, 0, 1, touch),
  .latex = { .head = "\\operatorname{arsinh}\\left(", .tail = "\\right)" },
  .modelica = { .head = "Modelica.Math.asinh(", .tail = ")" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
