/* decimal_digits.h -- natural numbers as decimal digits of any length: what exact literals need of arithmetic. */
#ifndef AMBIT_DECIMAL_DIGITS_H
#define AMBIT_DECIMAL_DIGITS_H
#include <stddef.h>

/* n digits 0..9, most significant first; leading zeros are allowed, n = 0 is zero */
typedef struct ambit_digits {
  unsigned char *d;
  size_t n;
} ambit_digits;

/* -1, 0, 1 */
int ambit_digits_compare(ambit_digits a, ambit_digits b);
/* r := a + b, into room for the longer operand and one digit more */
void ambit_digits_add(ambit_digits *r, ambit_digits a, ambit_digits b);
/* r := a - b, a >= b, into room for the longer operand; r may be a */
void ambit_digits_subtract(ambit_digits *r, ambit_digits a, ambit_digits b);
/* q := floor(a 10^places / b), b > 0, into room for a.n + places digits; rest: room for b.n + 1 digits. Returns whether
** the quotient is exact. */
int ambit_digits_divide(ambit_digits *q, ambit_digits *rest, ambit_digits a, size_t places, ambit_digits b);
#endif
