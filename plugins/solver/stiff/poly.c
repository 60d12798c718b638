/* poly.c -- sums and products of polynomials with remainders (series.h).
**
** Tails are sums and products of nonnegative doubles in round-to-nearest, so a computed bound is at least (1 - u)^m
** times the exact one with m below 2^12 here; the factor SLACK makes up for it.
*/
#include "series.h"
#include <string.h>

#define SLACK (1 + 0x1p-40)

void poly_constant(poly *r, dd x, double tail) {
  r->n = x.hi != 0;
  poly_set(r, 0, x);
  r->tail = tail;
}

void poly_copy(poly *r, const poly *a) {
  r->n = a->n, r->tail = a->tail;
  memcpy(r->hi, a->hi, a->n * sizeof *r->hi);
  memcpy(r->lo, a->lo, a->n * sizeof *r->lo);
}

/* rounding: 4 u^2 (|a_k| + |b_k|) each (double_double.h) */
void poly_add(poly *r, const poly *a, const poly *b, double sign) {
  uint32_t n = a->n > b->n ? a->n : b->n;
  double size = 0;
  for (uint32_t k = 0; k < n; k++) {
    dd x = poly_get(a, k), y = poly_get(b, k);
    y.hi *= sign, y.lo *= sign;
    if (x.hi != 0 && y.hi != 0) {
      size += fabs(x.hi) + fabs(y.hi);
      poly_set(r, k, dd_add(x, y));
    } else
      poly_set(r, k, x.hi != 0 ? x : y); /* exact */
  }
  r->n = n;
  r->tail = (a->tail + b->tail + 5 * DD_U * DD_U * size + (size > 0 ? DD_TINY : 0)) * SLACK;
}

/* What a product of two polynomials leaves: powers from `room` on, and everything with a tail. */
static double product_tail(const poly *a, const poly *b, uint32_t room) {
  double A = 0, B = 0, above = 0, suffix = 0;
  for (uint32_t k = 0; k < b->n; k++) B += fabs(b->hi[k]);
  uint32_t from = b->n; /* suffix = sum of |b_j| for j >= from */
  for (uint32_t i = 0; i < a->n; i++) {
    double x = fabs(a->hi[i]);
    A += x;
    uint32_t start = room > i ? room - i : 0;
    while (from > start) suffix += fabs(b->hi[--from]);
    above += x * suffix;
  }
  double tail = above * (1 + 4 * DD_U);
  if (a->tail > 0) tail += a->tail * (B * (1 + 2 * DD_U) + b->tail);
  if (b->tail > 0) tail += b->tail * A * (1 + 2 * DD_U);
  return tail;
}

/* A coefficient is a sum of m products, added up with its errors [Ogita, Rump & Oishi 2005]: if S is the sum of
** |a_j b_(k-j)|, what is collected in `low` are at most (m + 3) u S in magnitude, each through at most m + 5 roundings,
** and u^2 S is left out: the error is below (m + 6)^2 u^2 S. */
void poly_mul(poly *r, uint32_t room, const poly *a, const poly *b) {
  double size = 0, tail = product_tail(a, b, room);
  uint32_t n = a->n && b->n ? a->n + b->n - 1 : 0;
  if (n > room) n = room;
  for (uint32_t k = 0; k < n; k++) {
    uint32_t from = k >= b->n ? k - b->n + 1 : 0, to = k < a->n ? k : a->n - 1;
    double sum = 0, low = 0, S = 0;
    for (uint32_t j = from; j <= to; j++) {
      double x = a->hi[j], y = b->hi[k - j];
      dd p = two_product(x, y), t = two_sum(sum, p.hi);
      sum = t.hi;
      low += (t.lo + p.lo) + (x * b->lo[k - j] + a->lo[j] * y);
      S += fabs(p.hi);
    }
    double m = to - from + 7.0;
    size += m * m * S;
    poly_set(r, k, two_sum(sum, low));
  }
  r->n = n;
  r->tail = (tail + 1.01 * DD_U * DD_U * size + (n ? n * DD_TINY : 0)) * SLACK;
}

void poly_derive(poly *r, const poly *a) {
  double size = 0;
  r->n = a->n ? a->n - 1 : 0;
  for (uint32_t k = 0; k < r->n; k++) {
    poly_set(r, k, dd_scale(poly_get(a, k + 1), k + 1.0));
    size += (k + 1.0) * fabs(a->hi[k + 1]) * 8 * DD_U * DD_U + DD_TINY;
  }
  r->tail = size * SLACK;
}

double poly_norm(const poly *a) {
  double sum = 0;
  for (uint32_t k = 0; k < a->n; k++) sum += fabs(a->hi[k]);
  return (sum * (1 + 2 * DD_U) + a->tail) * SLACK;
}

void poly_range(const poly *a, double *lo, double *hi) {
  double sum = 0, middle = a->n ? a->hi[0] : 0;
  for (uint32_t k = 1; k < a->n; k++) sum += fabs(a->hi[k]);
  double radius = (sum + a->tail + fabs(middle) * 4 * DD_U) * SLACK + DD_TINY;
  *lo = nextafter(middle - radius, -INFINITY);
  *hi = nextafter(middle + radius, INFINITY);
  if (!(radius < INFINITY)) *lo = -INFINITY, *hi = INFINITY;
}

dd poly_dot(const poly *a, const poly *b, uint32_t from, uint32_t to, uint32_t k) {
  dd sum = { 0, 0 };
  for (uint32_t j = from; j <= to && j < a->n; j++)
    if (k - j < b->n) sum = dd_add(sum, dd_mul(poly_get(a, j), poly_get(b, k - j)));
  return sum;
}
