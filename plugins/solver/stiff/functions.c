/* functions.c -- quotients, roots and elementary functions of polynomials with remainders.
**
** The polynomial q of the result is computed by the usual recurrences of its differential equation, without any care;
** what counts is the bound of q - g(a) that follows from a residual, which is computed with all care (poly.c):
**   a/b:     |q - a/b|      <= sup|a - q b| / inf|b|
**   sqrt a:  |q - sqrt a|   <= sup|a - q^2| / (inf q + sqrt inf a)
** and for the others, with alpha the polynomial of a without its tail T, by the differential equation that q solves up
** to a residual rho over |s| <= 1, and then by the Lipschitz constant of g for the tail (docs/numerics/stiff.md). Their
** values at s = 0 are the kernel's, in double precision.
*/
#include "series.h"

#define SLACK (1 + 0x1p-40)

static void give_up(poly *r) { poly_constant(r, (dd) { 0, 0 }, INFINITY); }

/* an interval function of the kernel, outward */
static void enclose(const series *s, uint32_t op, double lo, double hi, double *rlo, double *rhi) {
  double a[2] = { lo, hi }, r[2];
  s->num->map(op, 1, r, a, NULL, 0);
  *rlo = r[0], *rhi = r[1];
}

static double enclose_above(const series *s, uint32_t op, double x) {
  double lo, hi;
  enclose(s, op, x, x, &lo, &hi);
  return hi;
}

static double positive(double x) { return x > 0 ? x : 0; }

/* the value at s = 0 of g(alpha), as middle; returns how far it may be off */
static double at_zero(const series *s, uint32_t op, const poly *alpha, double *middle) {
  dd x = poly_get(alpha, 0);
  double lo, hi;
  enclose(s, op, x.lo < 0 ? nextafter(x.hi, -INFINITY) : x.hi, x.lo > 0 ? nextafter(x.hi, INFINITY) : x.hi, &lo, &hi);
  *middle = 0.5 * lo + 0.5 * hi;
  double radius = fmax(hi - *middle, *middle - lo);
  return isfinite(*middle) ? radius * SLACK + DD_TINY : INFINITY;
}

static void start(poly *q, uint32_t n, double first) {
  for (uint32_t k = 0; k < n; k++) poly_set(q, k, (dd) { 0, 0 });
  q->hi[0] = first, q->n = n, q->tail = 0;
}

/* sup |x - y|; destroys x */
static double difference(poly *x, const poly *y) {
  poly_add(x, x, y, -1);
  return poly_norm(x);
}

/* -- algebra */

static void quotient(series *s, poly *r, const poly *a, const poly *b) {
  uint32_t n = s->order + 1;
  double lo, hi;
  poly *q = &s->scratch[0], *product = &s->scratch[1];
  poly_range(b, &lo, &hi);
  double least = lo > 0 ? lo : -hi;
  if (!(least > 0)) {
    give_up(r);
    return;
  }
  if (b->n == 1 && a->n < n) n = a->n ? a->n : 1; /* by a constant */
  start(q, n, 0);
  for (uint32_t k = 0; k < n; k++) {
    dd rest = dd_sub(poly_get(a, k), poly_dot(b, q, 1, k, k));
    poly_set(q, k, dd_div(rest, poly_get(b, 0)));
  }
  poly_mul(product, 2 * s->order + 3, q, b);
  q->tail = difference(product, a) / least * SLACK + DD_TINY;
  poly_copy(r, q);
}

static void root(series *s, poly *r, const poly *a) {
  uint32_t n = s->order + 1;
  double lo, hi, below, above;
  poly *q = &s->scratch[0], *product = &s->scratch[1];
  poly_range(a, &lo, &hi);
  if (!(lo > 0)) {
    give_up(r);
    return;
  }
  start(q, n, 0);
  poly_set(q, 0, dd_sqrt(poly_get(a, 0)));
  for (uint32_t k = 1; k < n; k++) {
    dd rest = dd_sub(poly_get(a, k), poly_dot(q, q, 1, k - 1, k));
    poly_set(q, k, dd_div(rest, dd_scale(poly_get(q, 0), 2)));
  }
  enclose(s, AMBIT_OP_SQRT, lo, lo, &below, &above);
  poly_range(q, &lo, &hi);
  poly_mul(product, 2 * s->order + 3, q, q);
  q->tail = below + lo > 0 ? difference(product, a) / (below + lo) * SLACK + DD_TINY : INFINITY;
  poly_copy(r, q);
}

/* -- functions: alpha is a without its tail, D its derivative (scratch 2, 3) */

typedef struct argument {
  poly alpha;
  const poly *D;
  double T, lo, hi; /* the tail of a; bounds of a with it */
} argument;

static argument argue(series *s, const poly *a, uint32_t where) {
  argument x = { .alpha = *a, .D = &s->scratch[where], .T = a->tail };
  x.alpha.tail = 0;
  poly_derive(&s->scratch[where], &x.alpha);
  poly_range(a, &x.lo, &x.hi);
  return x;
}

/* q := solution of q' = D p coefficient by coefficient; one order of it: q_k */
static void integrate_order(poly *q, const poly *D, const poly *p, uint32_t k, double sign) {
  poly_set(q, k, dd_div(poly_dot(D, p, 0, k - 1, k - 1), (dd) { sign * k, 0 }));
}

/* sup |q' - sign D p| */
static double residual(series *s, const poly *q, const poly *D, const poly *p, double sign) {
  poly *slope = &s->scratch[4], *product = &s->scratch[5];
  poly bare = *p;
  bare.tail = 0;
  poly_derive(slope, q);
  poly_mul(product, 2 * s->order + 3, D, &bare);
  poly_add(slope, slope, product, -sign);
  return poly_norm(slope);
}

/* (q/e)' = rho/e for e = exp alpha: |q - e| <= sup e (|q(0) - e(0)|/inf e + rho/inf e) */
static void exponential(series *s, poly *r, const poly *a) {
  argument x = argue(s, a, 3);
  poly *q = &s->scratch[0];
  double first, error = at_zero(s, AMBIT_OP_EXP, &x.alpha, &first), least, unused;
  start(q, s->order + 1, first);
  for (uint32_t k = 1; k <= s->order; k++) integrate_order(q, x.D, q, k, 1);
  error += residual(s, q, x.D, q, 1);
  enclose(s, AMBIT_OP_EXP, x.lo, x.lo, &least, &unused);
  double most = enclose_above(s, AMBIT_OP_EXP, x.hi);
  q->tail = (most * (error / least) + most * x.T) * SLACK + DD_TINY;
  if (!(least > 0)) q->tail = INFINITY;
  poly_copy(r, q);
}

/* The pair (sin, cos) or (sinh, cosh): e' = D (+-) f + rho, f' = D e + rho'. For the first, |(e, f)| grows by rho +
** rho'
** only, being turned; for the second e + f and e - f are at most multiplied by exp of what alpha varies. */
static void waves(series *s, uint32_t op, poly *r, const poly *a) {
  int is_circle = op == AMBIT_OP_SIN || op == AMBIT_OP_COS, odd = op == AMBIT_OP_SIN || op == AMBIT_OP_SINH;
  double sign = is_circle ? -1 : 1, first, second, growth = 1, lipschitz = 1;
  argument x = argue(s, a, 3);
  poly *p = &s->scratch[0], *q = &s->scratch[1]; /* odd and even function */
  double error = at_zero(s, is_circle ? AMBIT_OP_SIN : AMBIT_OP_SINH, &x.alpha, &first);
  error += at_zero(s, is_circle ? AMBIT_OP_COS : AMBIT_OP_COSH, &x.alpha, &second);
  start(p, s->order + 1, first), start(q, s->order + 1, second);
  for (uint32_t k = 1; k <= s->order; k++) integrate_order(p, x.D, q, k, 1), integrate_order(q, x.D, p, k, sign);
  error += residual(s, p, x.D, q, 1) + residual(s, q, x.D, p, sign);
  if (!is_circle) {
    double furthest = fmax(fabs(x.lo), fabs(x.hi));
    growth = enclose_above(s, AMBIT_OP_EXP, (x.hi - x.lo) * SLACK);
    lipschitz = enclose_above(s, AMBIT_OP_COSH, furthest);
  }
  poly *result = odd ? p : q;
  result->tail = (error * growth + lipschitz * x.T) * SLACK + DD_TINY;
  poly_copy(r, result);
}

/* |integral of D from 0 to s| <= the sum of all coefficients of alpha but the first */
static double swing_of(const poly *alpha) {
  double sum = 0;
  for (uint32_t k = 1; k < alpha->n; k++) sum += fabs(alpha->hi[k]) + fabs(alpha->lo[k]);
  return sum * SLACK;
}

/* r := the range of tanh over the range of a, if what is known of r is no better */
static void saturate(series *s, poly *r, double from, double to) {
  double lo, hi;
  enclose(s, AMBIT_OP_TANH, from, to, &lo, &hi);
  double middle = 0.5 * lo + 0.5 * hi, radius = fmax(hi - middle, middle - lo) * SLACK;
  if (!(r->tail <= radius)) poly_constant(r, (dd) { middle, 0 }, radius);
}

/* q' = (1 - q^2) D up to rho: e = q - tanh alpha obeys e' = rho - (q + tanh alpha) D e */
static void tangent(series *s, poly *r, const poly *a) {
  argument x = argue(s, a, 3);
  poly *q = &s->scratch[0], *W = &s->scratch[1];
  double first, error = at_zero(s, AMBIT_OP_TANH, &x.alpha, &first);
  start(q, s->order + 1, first), start(W, s->order + 1, 0);
  for (uint32_t k = 0; k <= s->order; k++) {
    if (k) integrate_order(q, x.D, W, k, 1);
    poly_set(W, k, dd_sub((dd) { k == 0, 0 }, poly_dot(q, q, 0, k, k)));
  }
  poly *square = &s->scratch[6], *one = &s->scratch[7];
  poly_mul(square, 2 * s->order + 3, q, q);
  poly_constant(one, (dd) { 1, 0 }, 0);
  poly_add(W, one, square, -1);
  error += residual(s, q, x.D, W, 1) + poly_norm(x.D) * W->tail;
  double growth = enclose_above(s, AMBIT_OP_EXP, (1 + poly_norm(q)) * swing_of(&x.alpha) * SLACK);
  q->tail = (error * growth + x.T) * SLACK + DD_TINY;
  saturate(s, q, x.lo, x.hi);
  poly_copy(r, q);
}

/* q' W = numerator up to rho, W > 0: |q - g| <= |q(0) - g(0)| + rho / inf W; q_0 is set */
static double by_quotient(series *s, poly *q, const poly *W, const poly *numerator) {
  poly *slope = &s->scratch[4], *product = &s->scratch[5];
  double lo, hi;
  poly_range(W, &lo, &hi);
  if (!(lo > 0)) return INFINITY;
  start(slope, s->order, 0); /* of q, order by order */
  for (uint32_t k = 0; k < s->order; k++) {
    dd rest = dd_sub(poly_get(numerator, k), poly_dot(W, slope, 1, k, k));
    poly_set(slope, k, dd_div(rest, poly_get(W, 0)));
    poly_set(q, k + 1, dd_div(poly_get(slope, k), (dd) { k + 1.0, 0 }));
  }
  poly_derive(slope, q);
  poly_mul(product, 2 * s->order + 3, slope, W);
  return difference(product, numerator) / lo * SLACK;
}

static void logarithm(series *s, poly *r, const poly *a) {
  argument x = argue(s, a, 3);
  poly *q = &s->scratch[0];
  if (!(x.lo > 0)) {
    give_up(r);
    return;
  }
  double first, error = at_zero(s, AMBIT_OP_LOG, &x.alpha, &first);
  start(q, s->order + 1, first);
  q->tail = (error + by_quotient(s, q, &x.alpha, x.D) + x.T / x.lo) * SLACK + DD_TINY;
  poly_copy(r, q);
}

static void arc_tangent(series *s, poly *r, const poly *a) {
  argument x = argue(s, a, 3);
  poly *q = &s->scratch[0], *W = &s->scratch[2], *one = &s->scratch[6];
  poly_mul(W, s->order + 1, &x.alpha, &x.alpha);
  poly_constant(one, (dd) { 1, 0 }, 0);
  poly_add(W, W, one, 1);
  double first, error = at_zero(s, AMBIT_OP_ATAN, &x.alpha, &first);
  start(q, s->order + 1, first);
  q->tail = (error + by_quotient(s, q, W, x.D) + x.T) * SLACK + DD_TINY;
  poly_copy(r, q);
}

/* the angle of (b, a); its box must not touch the cut b <= 0, a = 0 */
static void angle(series *s, poly *r, const poly *a, const poly *b) {
  argument y = argue(s, a, 3), x = argue(s, b, 6);
  poly *q = &s->scratch[0], *W = &s->scratch[2], *numerator = &s->scratch[7], *other = &s->scratch[8];
  if (!(x.lo > 0 || y.lo > 0 || y.hi < 0)) {
    give_up(r);
    return;
  }
  poly_mul(W, s->order + 1, &y.alpha, &y.alpha);
  poly_mul(other, s->order + 1, &x.alpha, &x.alpha);
  poly_add(W, W, other, 1);
  poly_mul(numerator, 2 * s->order + 3, &x.alpha, y.D);
  poly_mul(other, 2 * s->order + 3, &y.alpha, x.D);
  poly_add(numerator, numerator, other, -1);
  dd y0 = poly_get(&y.alpha, 0), x0 = poly_get(&x.alpha, 0);
  double A[2] = { nextafter(y0.hi, -INFINITY), nextafter(y0.hi, INFINITY) }, result[2];
  double B[2] = { nextafter(x0.hi, -INFINITY), nextafter(x0.hi, INFINITY) };
  s->num->map(AMBIT_OP_ATAN2, 1, result, A, B, 0);
  double first = 0.5 * result[0] + 0.5 * result[1], error = (result[1] - result[0]) * SLACK;
  start(q, s->order + 1, first);
  /* the nearest point of the box to the origin is no closer than its nearer side */
  double nearest = fmax(positive(x.lo), fmax(positive(y.lo), positive(-y.hi)));
  q->tail = (error + by_quotient(s, q, W, numerator) + (x.T + y.T) / nearest) * SLACK + DD_TINY;
  poly_copy(r, q);
}

/* -- combinations; scratch 9 and 10 are theirs */

static void ratio(series *s, uint32_t op, uint32_t below, poly *r, const poly *a) {
  waves(s, op, &s->scratch[9], a);
  waves(s, below, &s->scratch[10], a);
  quotient(s, r, &s->scratch[9], &s->scratch[10]);
}

/* the angle of (sqrt(1 - a^2), a), or of (a, sqrt(1 - a^2)) */
static void arc(series *s, uint32_t op, poly *r, const poly *a) {
  poly *square = &s->scratch[9], *other = &s->scratch[10];
  poly_mul(square, s->order + 1, a, a);
  poly_constant(&s->scratch[0], (dd) { 1, 0 }, 0);
  poly_add(square, &s->scratch[0], square, -1);
  root(s, other, square);
  if (!(other->tail < INFINITY))
    give_up(r);
  else if (op == AMBIT_OP_ASIN)
    angle(s, r, a, other);
  else
    angle(s, r, other, a);
}

void series_power(series *s, poly *r, const poly *a, int32_t n) {
  poly *base = &s->scratch[9], *power = &s->scratch[10], *product = &s->scratch[7];
  uint32_t left = n < 0 ? 0u - (uint32_t)n : (uint32_t)n;
  poly_copy(base, a);
  poly_constant(power, (dd) { 1, 0 }, 0);
  for (; left; left >>= 1) {
    if (left & 1) poly_mul(product, s->order + 1, power, base), poly_copy(power, product);
    if (left > 1) poly_mul(product, s->order + 1, base, base), poly_copy(base, product);
  }
  if (n >= 0) {
    poly_copy(r, power);
    return;
  }
  poly_constant(base, (dd) { 1, 0 }, 0);
  quotient(s, r, base, power);
}

/* -- kinks: only where it is decided which side it is */

static void choose(series *s, uint32_t op, poly *r, const poly *a, const poly *b) {
  poly *gap = &s->scratch[0];
  double lo, hi;
  if (op == AMBIT_OP_ABS)
    poly_copy(gap, a);
  else
    poly_add(gap, a, b, -1);
  poly_range(gap, &lo, &hi);
  if (!(lo > 0 || hi < 0))
    give_up(r);
  else if (op != AMBIT_OP_ABS)
    poly_copy(r, (lo > 0) == (op == AMBIT_OP_MAX) ? a : b);
  else {
    poly_constant(&s->scratch[1], (dd) { 0, 0 }, 0);
    poly_add(r, &s->scratch[1], a, lo > 0 ? 1 : -1);
  }
}

void series_function(series *s, uint32_t op, poly *r, const poly *a, const poly *b) {
  if (!(a->tail < INFINITY && b->tail < INFINITY)) {
    give_up(r);
    return;
  }
  switch (op) {
  case AMBIT_OP_DIV: quotient(s, r, a, b); break;
  case AMBIT_OP_SQRT: root(s, r, a); break;
  case AMBIT_OP_EXP: exponential(s, r, a); break;
  case AMBIT_OP_LOG: logarithm(s, r, a); break;
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: waves(s, op, r, a); break;
  case AMBIT_OP_ATAN: arc_tangent(s, r, a); break;
  case AMBIT_OP_ATAN2: angle(s, r, a, b); break;
  case AMBIT_OP_TAN: ratio(s, AMBIT_OP_SIN, AMBIT_OP_COS, r, a); break;
  case AMBIT_OP_TANH: tangent(s, r, a); break;
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: arc(s, op, r, a); break;
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: choose(s, op, r, a, b); break;
  default: give_up(r);
  }
  if (!(r->tail >= 0)) r->tail = INFINITY; /* NaN */
}
