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
static const double touching = 0.43429448190325182;
#define BASE 10
#include "functions/log_base.h"

const ambit_described ambit_function_log10 = { .facts = FACTS(AMBIT_CONCAVE, 0, INFINITY, 1, 0, touch),
  .latex = { .head = "\\log_{10}\\left(", .tail = "\\right)" },
  .modelica = { .head = "log10(", .tail = ")" },
  .image = { -INFINITY, INFINITY },
  .at = at,
  .taylor = taylor,
  .inverse = inverse,
  .slope = slope,
  .written = written };
