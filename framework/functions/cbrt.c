/* cbrt.c -- the cube root, of negative numbers too; exact where it is a double. */
#include "functions/function.h"

/* a cube of at most 53 bits has a root of at most 18, whose square is exact */
static bool is_root(double r, double u) {
  pair square = two_product(r, r), cube = two_product(square.h, r);
  return square.l == 0 && cube.l == 0 && cube.h == u;
}

/* one step of Newton's method from a root that is a few units of its last place off */
static pair root_of(double u) {
  double r = cbrt(u);
  pair square = two_product(r, r), cube = two_product(square.h, r), more = two_product(square.l, r);
  double rest = (((u - cube.h) - cube.l) - more.h) - more.l;
  return fast_two_sum(r, rest / (3 * square.h));
}

static ambit_interval at(double x) {
  int exponent, third;
  if (x == 0 || isinf(x)) return x == 0 ? value_point(0) : x > 0 ? VALUE_INFINITY : VALUE_MINUS_INFINITY;
  double u = frexp(fabs(x), &exponent); /* fabs(x) = u 2^exponent */
  third = (exponent + 1200) / 3 - 401;
  u = ldexp(u, exponent - 3 * third); /* in [4, 32) */
  pair y = root_of(u);
  ambit_interval r = is_root(y.h, u) ? value_point(y.h) : value_within(y, 0x1p-90);
  r = (ambit_interval) { ldexp(r.lo, third), ldexp(r.hi, third) };
  return x < 0 ? value_negate(r) : r;
}

/* binomial(1/3, k) x^(1/3 - k), the power as one of the root: x is there once */
static void taylor(uint32_t n, ambit_interval x, ambit_interval *c) {
  ambit_interval root = function_op(AMBIT_OP_CBRT, x), binomial = value_point(1);
  for (uint32_t k = 1; k <= n; k++) {
    binomial = function_over(ambit_interval_mul(binomial, value_point(4 - 3.0 * k)), 3.0 * k);
    c[k] = ambit_interval_mul(binomial, function_power(root, 1 - 3 * (int32_t)k));
  }
}

static bool is_smooth(ambit_interval x) { return x.lo > 0 || x.hi < 0; }

static double touch(double s) { return 1 / (3 * s * sqrt(3 * s)); }

static ambit_interval inverse(ambit_interval r) { return function_power(r, 3); }

static ambit_expr slope(ambit_graph *g, ambit_expr e, ambit_expr a) {
  (void)a;
  ambit_expr square = function_fold_one(g, AMBIT_OP_SQR, e);
  return function_fold(g, AMBIT_OP_DIV, AMBIT_ONE, function_fold(g, AMBIT_OP_MUL, function_number(g, 3), square));
}

/* for both signs of a: a (a^2)^(-1/3); where the sign is known, by the logarithm of a alone. Not at 0. */
static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  (void)b;
  const ambit_node *x = ambit_graph_node(g, a);
  bool positive = x->range.lo >= 0, negative = x->range.hi <= 0;
  ambit_expr three = function_number(g, 3), of = negative ? function_make_one(g, AMBIT_OP_NEG, a) : a;
  if (!positive && !negative) of = function_make_one(g, AMBIT_OP_SQR, a);
  ambit_expr third = function_make(g, AMBIT_OP_DIV, function_make_one(g, AMBIT_OP_LOG, of), three);
  ambit_expr root = function_make_one(g, AMBIT_OP_EXP, third);
  if (positive) return root;
  return negative ? function_make_one(g, AMBIT_OP_NEG, root) : function_make(g, AMBIT_OP_DIV, a, root);
}

const ambit_described ambit_function_cbrt = { .facts = FACTS(AMBIT_CONCAVE_RIGHT, -INFINITY, INFINITY, 0, 1, touch),
  .latex = { .head = "\\sqrt[3]{", .tail = "}" },
  .modelica = { .head = "(sign(", .middle = ")*abs(", .tail = ")^(1/3))" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .is_smooth = is_smooth,
  .unit = AMBIT_FUNCTION_ROOT_3,
  .inverse = inverse,
  .slope = slope,
  .written = written };
