/* constant.c -- decimal texts of constants to double-double: "0.04", "-3e7", "8/3", "pi". */
#include "constant.h"
#include <stdlib.h>
#include <string.h>

#define DIGITS_MAX 60
#define EXPONENT_MAX 200

/* relative errors are counted in units of u^2 and added up: each operation on double-doubles below makes at most 16 */
typedef struct number {
  dd x;
  double units;
} number;

static number times(number a, dd b) { return (number) { dd_mul(a.x, b), a.units + 16 }; }

/* a / b: dd_div has no proved bound, so the quotient q is judged by a - q b */
static int over(number a, number b, number *q) {
  if (b.x.hi == 0) return 0;
  q->x = dd_div(a.x, b.x);
  dd rest = dd_sub(a.x, dd_mul(q->x, b.x));
  double off = fabs(rest.hi) / fabs(a.x.hi) / (DD_U * DD_U);
  q->units = a.units + b.units + 4 * off + 64; /* 64: roundings of the rest */
  return a.x.hi == 0 ? (q->units = 0, 1) : off < 1e6;
}

static int scale(number *a, long exponent) {
  number power = { { 1, 0 }, 0 };
  if (labs(exponent) > EXPONENT_MAX) return 0;
  for (long i = labs(exponent); i > 0; i--) power = times(power, (dd) { 10, 0 });
  if (exponent < 0) return over(*a, power, a);
  *a = times(*a, power.x);
  a->units += power.units;
  return 1;
}

/* an unsigned decimal; moves *text behind it */
static int read_decimal(const char **text, number *a) {
  const char *c = *text;
  long exponent = 0;
  int digits = 0, point = 0;
  *a = (number) { { 0, 0 }, 0 };
  for (; (*c >= '0' && *c <= '9') || (*c == '.' && !point); c++) {
    if (*c == '.') {
      point = 1;
      continue;
    }
    if (++digits > DIGITS_MAX) return 0;
    *a = times(*a, (dd) { 10, 0 });
    a->x = dd_add(a->x, (dd) { *c - '0', 0 }); /* both nonnegative: a relative error */
    exponent -= point;
  }
  if (!digits) return 0;
  if (*c == 'e' || *c == 'E') {
    char *end;
    exponent += strtol(c + 1, &end, 10);
    if (end == c + 1) return 0;
    c = end;
  }
  *text = c;
  return scale(a, exponent);
}

int constant_read(const char *text, dd *x, double *error) {
  number a, b;
  int negative = *text == '-';
  text += negative;
  if (strcmp(text, "pi") == 0) { /* Dekker's pair of pi; the rest is below 2^-107 */
    a = (number) { { 0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53 }, 4 };
    text += 2;
  } else if (!read_decimal(&text, &a))
    return 0;
  if (*text == '/') {
    text++;
    if (!read_decimal(&text, &b) || !over(a, b, &a)) return 0;
  }
  if (*text) return 0;
  *x = negative ? dd_neg(a.x) : a.x;
  *error = 1.01 * a.units * DD_U * DD_U * fabs(a.x.hi) + DD_TINY;
  return 1;
}

double constant_at(const ambit_tape *t, uint32_t i, dd *x) {
  double lo = t->lo[i], hi = t->hi[i], middle = 0.5 * lo + 0.5 * hi, error;
  const char *text = t->text ? t->text[i] : NULL;
  *x = dd_make(middle, 0);
  if (!(lo < hi)) return 0;
  double radius = fmax(hi - middle, middle - lo) * (1 + 0x1p-40) + DD_TINY;
  dd read;
  if (!text || !constant_read(text, &read, &error) || !(error < radius && read.hi >= lo && read.hi <= hi))
    return radius;
  *x = read;
  return error;
}
