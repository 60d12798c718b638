/* decimal_digits.c -- schoolbook arithmetic on decimal digits. */
#include "num/decimal_digits.h"
#include <string.h>

static unsigned digit(ambit_digits a, size_t place) { return place < a.n ? a.d[a.n - 1 - place] : 0; }
static size_t longer(ambit_digits a, ambit_digits b) { return a.n > b.n ? a.n : b.n; }

int ambit_digits_compare(ambit_digits a, ambit_digits b) {
  for (size_t place = longer(a, b); place-- > 0;) {
    unsigned x = digit(a, place), y = digit(b, place);
    if (x != y) return x < y ? -1 : 1;
  }
  return 0;
}

void ambit_digits_add(ambit_digits *r, ambit_digits a, ambit_digits b) {
  unsigned carry = 0;
  r->n = longer(a, b) + 1;
  for (size_t place = 0; place < r->n; place++) {
    unsigned sum = digit(a, place) + digit(b, place) + carry;
    r->d[r->n - 1 - place] = (unsigned char)(sum % 10);
    carry = sum / 10;
  }
}

void ambit_digits_subtract(ambit_digits *r, ambit_digits a, ambit_digits b) {
  unsigned borrow = 0;
  size_t n = longer(a, b);
  for (size_t place = 0; place < n; place++) {
    unsigned x = digit(a, place) + 10 - digit(b, place) - borrow;
    r->d[n - 1 - place] = (unsigned char)(x % 10);
    borrow = x < 10;
  }
  r->n = n;
}

/* rest := 10 rest + next, as exactly width digits; what leaves in front is 0 */
static void shift_in(ambit_digits *rest, size_t width, unsigned char next) {
  memmove(rest->d, rest->d + 1, width - 1);
  rest->d[width - 1] = next;
}

int ambit_digits_divide(ambit_digits *q, ambit_digits *rest, ambit_digits a, size_t places, ambit_digits b) {
  size_t width = b.n + 1; /* rest < b before a digit comes in */
  memset(rest->d, 0, width);
  rest->n = width;
  q->n = a.n + places;
  for (size_t i = 0; i < q->n; i++) {
    shift_in(rest, width, i < a.n ? a.d[i] : 0);
    unsigned char count = 0;
    while (ambit_digits_compare(*rest, b) >= 0) {
      ambit_digits_subtract(rest, *rest, b);
      count++;
    }
    q->d[i] = count;
  }
  for (size_t i = 0; i < width; i++)
    if (rest->d[i]) return 0;
  return 1;
}
