/* pow.c -- real powers x^y, x > 0: e^(y ln x), the exponent as a double-double. Whole y, for every x, are POWN. */
#include "functions/function.h"

/* 0 or infinity, as a limit */
static ambit_interval limit(bool infinite) { return infinite ? VALUE_INFINITY : value_point(0); }

static ambit_interval at_pair(double x, double y) {
  if (x == 1 || y == 0) return value_point(1);
  if (y == 1 && x > 0 && x < INFINITY) return value_point(x);
  if (x == 0 || x == INFINITY) return limit((x == 0) == (y < 0));
  if (isinf(y)) return limit((x > 1) == (y > 0));
  pair log = log_kernel(x);
  double size = log.h * y;
  if (size > 710) return VALUE_INFINITY;
  if (size < -746) return (ambit_interval) { 0, VALUE_TINIEST };
  if (fabs(size) < 0x1p-60) return (x > 1) == (y > 0) ? value_above(1) : value_below(1);
  pair p = two_product(log.h, y);
  p = fast_two_sum(p.h, p.l + log.l * y);
  return value_exp(p, VALUE_ERROR + fabs(size) * (1.1 * AMBIT_ERROR_LOG), 0);
}

/* ln r, where 0 is the limit at minus infinity: x^y is 0 at x = 0 as whoever writes it means it */
static ambit_interval exponent_of(ambit_interval r) {
  double hi = r.hi > 0 ? function_op(AMBIT_OP_LOG, r).hi : -DBL_MAX;
  return (ambit_interval) { r.lo > 0 ? function_op(AMBIT_OP_LOG, r).lo : -INFINITY, hi };
}

/* y ln x = ln r, solved for both factors; where r and x may be 1, y is any number, and likewise */
static bool contract(ambit_interval r, ambit_interval *a, ambit_interval *b) {
  r = ambit_interval_intersect(r, (ambit_interval) { 0, INFINITY });
  *a = ambit_interval_intersect(*a, (ambit_interval) { 0, INFINITY });
  if (ambit_interval_is_empty(r) || ambit_interval_is_empty(*a)) return false;
  ambit_interval sum = exponent_of(r), log = exponent_of(*a);
  bool free = ambit_interval_contains(sum, 0);
  if (!free || !ambit_interval_contains(*b, 0)) {
    ambit_interval quotient = ambit_interval_div(sum, *b);
    if (ambit_interval_is_empty(quotient)) return false;
    *a = ambit_interval_intersect(*a, function_op(AMBIT_OP_EXP, quotient));
  }
  if (!free || !ambit_interval_contains(log, 0)) *b = ambit_interval_intersect(*b, ambit_interval_div(sum, log));
  return !ambit_interval_is_empty(*a) && !ambit_interval_is_empty(*b);
}

static ambit_expr partial(ambit_graph *g, ambit_expr e, ambit_expr a, ambit_expr b, bool by_b) {
  if (by_b) return function_fold(g, AMBIT_OP_MUL, e, function_fold_one(g, AMBIT_OP_LOG, a));
  return function_fold(g, AMBIT_OP_DIV, function_fold(g, AMBIT_OP_MUL, b, e), a);
}

static ambit_expr written(ambit_graph *g, ambit_expr a, ambit_expr b) {
  ambit_expr log = function_make_one(g, AMBIT_OP_LOG, a);
  return function_make_one(g, AMBIT_OP_EXP, function_fold(g, AMBIT_OP_MUL, log, b));
}

const ambit_described ambit_function_pow = { .facts = FACTS(0, 0, INFINITY, 1, 0, NULL),
  .latex = { .head = "{", .middle = "^{", .tail = "}}", .tight = true },
  .modelica = { .head = "((", .middle = ")^(", .tail = "))" },
  .positive = true,
  .at_pair = at_pair,
  .contract = contract,
  .partial = partial,
  .written = written };
