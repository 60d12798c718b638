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
static const double touching = 1.4426950408889634;
#define BASE 2
#include "functions/log_base.h"

const ambit_described ambit_function_log2 = { .facts = FACTS(AMBIT_CONCAVE, 0, INFINITY, 1, 0, touch),
  .latex = { .head = "\\log_{2}\\left(", .tail = "\\right)" },
  .modelica = { .head = "(log(", .tail = ")/log(2))" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
