/* double_double.h -- double-double numbers: a value as an unevaluated sum of two doubles, in round-to-nearest.
**
** two_sum and two_product are error-free (Knuth; Dekker & Veltkamp) in round-to-nearest as long as nothing overflows;
** below 2^-969 a product loses at most a few units of 2^-1074, which every user bounds by DD_TINY for each product. The
** error bounds that rest on them are stated where they are used; everything else here is approximate.
*/
#ifndef AMBIT_ABI_DOUBLE_DOUBLE_H
#define AMBIT_ABI_DOUBLE_DOUBLE_H
#include <math.h>

#define DD_U 0x1p-53      /* rounding unit of a double */
#define DD_TINY 0x1p-1000 /* far more than what underflow can lose in one operation */

typedef struct dd {
  double hi, lo;
} dd;

static inline dd dd_make(double hi, double lo) {
  dd x;
  x.hi = hi, x.lo = lo;
  return x;
}

static inline dd two_sum(double a, double b) {
  double s = a + b, v = s - a;
  return dd_make(s, (a - (s - v)) + (b - v));
}

static inline dd dd_halves(double a) { /* a = hi + lo, each with 26 bits */
  double c = 134217729.0 * a, hi = c - (c - a);
  return dd_make(hi, a - hi);
}

static inline dd two_product(double a, double b) {
  dd x = dd_halves(a), y = dd_halves(b);
  double p = a * b;
  return dd_make(p, ((x.hi * y.hi - p) + x.hi * y.lo + x.lo * y.hi) + x.lo * y.lo);
}

/* error at most 4 u^2 (|a| + |b|): u |a.lo + b.lo|, then u times the sum of both low parts */
static inline dd dd_add(dd a, dd b) {
  dd s = two_sum(a.hi, b.hi);
  return two_sum(s.hi, s.lo + (a.lo + b.lo));
}

/* error at most 8 u^2 |a b|: a.lo b.lo is left out, five roundings of terms below u |a b| */
static inline dd dd_mul(dd a, dd b) {
  dd p = two_product(a.hi, b.hi);
  return two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

static inline dd dd_neg(dd a) { return dd_make(-a.hi, -a.lo); }
static inline dd dd_sub(dd a, dd b) { return dd_add(a, dd_neg(b)); }
static inline dd dd_scale(dd a, double b) { return dd_mul(a, dd_make(b, 0)); }

/* approximate; with a finite quotient the error is a few units of u^2 */
static inline dd dd_div(dd a, dd b) {
  double q = a.hi / b.hi;
  dd r = dd_sub(a, dd_scale(b, q));
  double q2 = r.hi / b.hi;
  r = dd_sub(r, dd_scale(b, q2));
  return dd_add(two_sum(q, q2), dd_make(r.hi / b.hi, 0));
}

static inline dd dd_sqrt(dd a) { /* approximate, a > 0 */
  double r = sqrt(a.hi);
  dd rest = dd_sub(a, two_product(r, r));
  return two_sum(r, rest.hi / (2 * r));
}

static inline dd dd_of(long double x) { /* exact where a long double has at most 106 bits */
  double hi = (double)x;
  return two_sum(hi, (double)(x - (long double)hi));
}

static inline long double dd_long(dd a) { return (long double)a.hi + (long double)a.lo; }
#endif
