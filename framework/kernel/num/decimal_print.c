/* decimal_print.c -- doubles to text: shortest round trip, and rounded outward.
**
** glibc's printf prints exactly rounded digits in the current mode (tested against MPFR).
*/
#include "num/decimal.h"
#include "num/environment.h"
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static int infinite(char *out, double x) {
  return snprintf(out, AMBIT_DECIMAL_MAX, "%s", x < 0 ? "-inf" : x > 0 ? "inf" : "nan");
}

int ambit_decimal_shortest(char out[AMBIT_DECIMAL_MAX], double x) {
  if (!isfinite(x)) return infinite(out, x);
  ambit_environment old = ambit_environment_enter();
  int n = 0;
  /* 15 digits name a normal double uniquely if any fewer do; a subnormal one may need less */
  for (int digits = fabs(x) < DBL_MIN ? 1 : 15; digits <= 17; digits++) {
    n = snprintf(out, AMBIT_DECIMAL_MAX, "%.*g", digits, x);
    if (strtod(out, NULL) == x) break;
  }
  ambit_environment_leave(old);
  return n;
}

int ambit_decimal_down(char out[AMBIT_DECIMAL_MAX], double x, int digits) {
  if (!isfinite(x)) return infinite(out, x);
  ambit_environment old = ambit_environment_enter();
  ambit_environment_down();
  int n = snprintf(out, AMBIT_DECIMAL_MAX, "%.*g", digits, x);
  ambit_environment_leave(old);
  return n;
}

int ambit_decimal_up(char out[AMBIT_DECIMAL_MAX], double x, int digits) {
  if (!isfinite(x)) return infinite(out, x);
  ambit_environment old = ambit_environment_enter();
  ambit_environment_up();
  int n = snprintf(out, AMBIT_DECIMAL_MAX, "%.*g", digits, x);
  ambit_environment_leave(old);
  return n;
}

/* significant digits that show `digits` digits of the width */
static int visible_digits(ambit_interval x, int digits) {
  double width = ambit_interval_width(x), mag = ambit_interval_mag(x);
  if (!ambit_interval_is_bounded(x) || width == 0 || mag == 0) return width == 0 ? 17 : digits;
  double n = floor(log10(mag)) - floor(log10(width)) + digits;
  return n > 17 ? 17 : n < 1 ? 1 : (int)n;
}

/* A point is shown bare only if the shortest text is exactly the number. */
int ambit_decimal_interval(char out[3 * AMBIT_DECIMAL_MAX], ambit_interval x, int digits) {
  if (ambit_interval_is_empty(x)) return snprintf(out, 3 * AMBIT_DECIMAL_MAX, "[empty]");
  if (x.lo == -INFINITY && x.hi == INFINITY) return snprintf(out, 3 * AMBIT_DECIMAL_MAX, "[entire]");
  char lo[AMBIT_DECIMAL_MAX], hi[AMBIT_DECIMAL_MAX];
  if (ambit_interval_is_point(x)) {
    ambit_decimal_shortest(lo, x.lo);
    ambit_interval back;
    bool exact = ambit_decimal_read(lo, &back, NULL, NULL) == AMBIT_OK && ambit_interval_is_point(back);
    if (exact) return snprintf(out, 3 * AMBIT_DECIMAL_MAX, "%s", lo);
  }
  int shown = visible_digits(x, digits < 1 ? 1 : digits > 17 ? 17 : digits);
  ambit_decimal_down(lo, x.lo, shown);
  ambit_decimal_up(hi, x.hi, shown);
  return snprintf(out, 3 * AMBIT_DECIMAL_MAX, "[%s, %s]", lo, hi);
}

/* digits >= 2: then there are ten units of the last digit at least between the bounds, which cannot pass each other */
int ambit_decimal_inner(char out[3 * AMBIT_DECIMAL_MAX], ambit_interval x, int digits) {
  if (!ambit_interval_is_bounded(x) || !(x.lo < x.hi)) return ambit_decimal_interval(out, x, digits);
  char lo[AMBIT_DECIMAL_MAX], hi[AMBIT_DECIMAL_MAX];
  int shown = visible_digits(x, digits < 2 ? 2 : digits > 17 ? 17 : digits);
  ambit_decimal_up(lo, x.lo, shown);
  ambit_decimal_down(hi, x.hi, shown);
  return snprintf(out, 3 * AMBIT_DECIMAL_MAX, "[%s, %s]", lo, hi);
}
