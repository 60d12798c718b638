/* hypot.c -- sqrt(x^2 + y^2) without overflow or underflow in between; exact where few digits make it so. */
#include "functions/function.h"

/* r^2 = u^2 + v^2, where no square has more than 53 bits; false: not known */
static bool is_exact(double u, double v, double r) {
  pair a = two_product(u, u), b = two_product(v, v), c = two_product(r, r), s = two_sum(a.h, b.h);
  return a.l == 0 && b.l == 0 && c.l == 0 && s.l == 0 && s.h == c.h;
}

/* u >= v > 0. Where v is far less, the result is above u by less than v^2/(2 u) < 2^-56 u. */
static ambit_interval ordered(double u, double v) {
  int exponent;
  if (v < u * 0x1p-28) return value_above(u);
  u = frexp(u, &exponent), v = ldexp(v, -exponent);
  pair root = value_root(value_sum(two_product(u, u), two_product(v, v)));
  enclosure e = is_exact(u, v, root.h) ? (enclosure) { root.h, root.h, 0 } : widen(root, root.h * 0x1p-90);
  return value_of(scale(e.lo, e.hi, exponent));
}

static ambit_interval at_pair(double x, double y) {
  double u = fmax(fabs(x), fabs(y)), v = fmin(fabs(x), fabs(y));
  if (u == INFINITY) return VALUE_INFINITY;
  return v == 0 ? value_point(u) : ordered(u, v);
}

/* |a| = sqrt(r^2 - b^2) */
static bool contract_one(ambit_interval r, ambit_interval *a, ambit_interval b) {
  ambit_interval s = ambit_interval_sub(function_op(AMBIT_OP_SQR, r), function_op(AMBIT_OP_SQR, b));
  s = function_op(AMBIT_OP_SQRT, s);
  if (ambit_interval_is_empty(s)) return false;
  ambit_interval above = ambit_interval_intersect(*a, s), below = ambit_interval_intersect(*a, value_negate(s));
  *a = ambit_interval_hull(above, below);
  return !ambit_interval_is_empty(*a);
}

static bool contract(ambit_interval r, ambit_interval *a, ambit_interval *b) {
  r = ambit_interval_intersect(r, (ambit_interval) { 0, INFINITY });
  return !ambit_interval_is_empty(r) && contract_one(r, a, *b) && contract_one(r, b, *a);
}

static ambit_expr partial(ambit_graph *g, ambit_expr e, ambit_expr a, ambit_expr b, bool by_b) {
  return function_fold(g, AMBIT_OP_DIV, by_b ? b : a, e);
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  ambit_expr first = function_make_one(g, AMBIT_OP_SQR, a), second = function_make_one(g, AMBIT_OP_SQR, b);
  return function_make_one(g, AMBIT_OP_SQRT, function_make(g, AMBIT_OP_ADD, first, second));
}

const ambit_described ambit_function_hypot = { .facts = FACTS(0, -INFINITY, INFINITY, 0, 0, NULL),
  .unit = AMBIT_FUNCTION_KEEPS,
  .latex = { .head = "\\operatorname{hypot}\\left(", .middle = ", ", .tail = "\\right)" },
  .modelica = { .head = "sqrt((", .middle = ")^2 + (", .tail = ")^2)" },
  .at_pair = at_pair,
  .contract = contract,
  .partial = partial,
  .written = written };
