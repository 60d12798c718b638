/* field_functions.c -- quotients, roots and elementary functions of polynomials of s and the unknowns.
**
** a = b + r, b the centre with the tail, r the rest. With |w| <= W < 1 and coefficients |g_k| <= 1,
**   1/a = (1/b) sum (-w)^k,  sqrt a = sqrt b sum binomial(1/2, k) w^k,  log a = log b + sum -(-w)^k / k,  w = r / b,
**   exp a = e^b sum r^k / k!,  sin a = sin b cos r + cos b sin r, ...
** and what is left out beyond degree D is at most W^(D+1) / (1 - W). Functions of b: functions.c. Where W >= 1, and for
** all other functions, r goes to the tail.
*/
#include "field.h"

#define SLACK (1 + 0x1p-40)
#define LARGEST 300 /* e^2a of what is below has room in a double */

enum { RECIPROCAL, ROOT, LOGARITHM, EXPONENTIAL, EVEN, ODD, EVEN_SIGNED, ODD_SIGNED };

static double coefficient(int kind, uint32_t k) {
  double x = 1;
  for (uint32_t i = 1; i <= k; i++) x *= kind == ROOT ? (1.5 - i) / i : kind >= EXPONENTIAL ? 1.0 / i : 1;
  double alternate = k % 2 ? -1 : 1, turn = k / 2 % 2 ? -1 : 1;
  switch (kind) {
  case RECIPROCAL: return alternate;
  case LOGARITHM: return k ? -alternate / k : 0;
  case EVEN: return k % 2 ? 0 : x;
  case ODD: return k % 2 ? x : 0;
  case EVEN_SIGNED: return k % 2 ? 0 : x * turn;
  case ODD_SIGNED: return k % 2 ? x * turn : 0;
  default: return x;
  }
}

/* r := sum_k g_k w^k, w without a centre but with a tail; 0: W is too large. Scratch 4 and 5.
** A coefficient is off by at most 60 u. */
static int compose(fields *f, int kind, field *r, const field *w) {
  uint32_t D = f->terms->degree;
  field *next = &f->scratch[4];
  double W = (field_rest(f, w) + poly_norm(&w->c)) * SLACK, power = 1;
  if (!(W < 0.9)) return 0;
  field_constant(f, r, (dd) { coefficient(kind, D), 0 }, 0);
  for (uint32_t k = D; k-- > 0;) {
    field_mul(f, next, r, w);
    poly g = { 1, &(double) { coefficient(kind, k) }, &(double) { 0 }, 0 };
    field_copy(f, r, next);
    poly_add(&f->scratch[5].c, &next->c, &g, 1);
    poly_copy(&r->c, &f->scratch[5].c);
  }
  for (uint32_t k = 0; k <= D; k++) power *= W * SLACK;
  r->c.tail = (r->c.tail + (power + 64 * DD_U * W) / (1 - W) * SLACK) * SLACK;
  return 1;
}

static void centre_of(const fields *f, field *r, const field *a, uint32_t op) {
  field_constant(f, r, (dd) { 0, 0 }, 0);
  series_function(f->base, op, &r->c, &a->c, &a->c);
}

static void rest_of(const fields *f, field *r, const field *a) {
  field_copy(f, r, a);
  poly_constant(&r->c, (dd) { 0, 0 }, 0);
}

/* r := 1 / b, b the centre of a */
static void invert_centre(fields *f, field *r, const field *a) {
  const poly one = { 1, &(double) { 1 }, &(double) { 0 }, 0 };
  field_constant(f, r, (dd) { 0, 0 }, 0);
  series_function(f->base, AMBIT_OP_DIV, &r->c, &one, &a->c);
}

/* r := g(b) composed with w = r / b */
static int by_quotient(fields *f, uint32_t op, int kind, field *r, const field *a) {
  field *inverse = &f->scratch[0], *rest = &f->scratch[1], *w = &f->scratch[2], *sum = &f->scratch[3];
  invert_centre(f, inverse, a);
  if (!(inverse->c.tail < INFINITY)) return 0;
  rest_of(f, rest, a);
  field_mul(f, w, rest, inverse);
  if (!compose(f, kind, sum, w)) return 0;
  if (kind == RECIPROCAL) {
    field_mul(f, r, sum, inverse);
    return 1;
  }
  centre_of(f, rest, a, op);
  if (kind == LOGARITHM)
    field_add(f, r, rest, sum, 1);
  else
    field_mul(f, r, rest, sum);
  return 1;
}

/* r := g(b) A(r) + sign g'(b) B(r) */
static int by_addition(
    fields *f, uint32_t op, uint32_t other, int even, int odd, double sign, field *r, const field *a) {
  field *rest = &f->scratch[0], *sum = &f->scratch[1], *first = &f->scratch[2], *outer = &f->scratch[3];
  rest_of(f, rest, a);
  if (!compose(f, even, sum, rest)) return 0;
  centre_of(f, outer, a, op);
  field_mul(f, first, outer, sum);
  if (!compose(f, odd, sum, rest)) return 0;
  centre_of(f, outer, a, other);
  field_mul(f, rest, outer, sum);
  field_add(f, r, first, rest, sign);
  return 1;
}

static int exponential(fields *f, field *r, const field *a) {
  field *rest = &f->scratch[0], *sum = &f->scratch[1], *outer = &f->scratch[2];
  rest_of(f, rest, a);
  if (!compose(f, EXPONENTIAL, sum, rest)) return 0;
  centre_of(f, outer, a, AMBIT_OP_EXP);
  field_mul(f, r, outer, sum);
  return 1;
}

/* all but the centre becomes uncertainty */
static void collapse(fields *f, uint32_t op, field *r, const field *a, const field *b) {
  poly *x = &f->scratch[0].c, *y = &f->scratch[1].c;
  poly_copy(x, &a->c);
  poly_copy(y, &b->c);
  x->tail = (x->tail + field_rest(f, a)) * SLACK, y->tail = (y->tail + field_rest(f, b)) * SLACK;
  field_constant(f, r, (dd) { 0, 0 }, 0);
  series_function(f->base, op, &r->c, x, y);
}

static int has_rest(const fields *f, const field *a) { return field_rest(f, a) > 0; }

static int quotient(fields *f, field *r, const field *a, const field *b) {
  field *inverse = &f->scratch[5];
  if (!has_rest(f, b))
    invert_centre(f, inverse, b);
  else {
    if (!by_quotient(f, AMBIT_OP_DIV, RECIPROCAL, r, b)) return 0;
    field_copy(f, inverse, r);
  }
  field_mul(f, r, a, inverse);
  return 1;
}

/* 1 - 2 / (1 + e^2a), where that has room in a double */
static int tangent(fields *f, field *r, const field *a) {
  field *number = &f->scratch[4];
  double lo, hi, rest = field_rest(f, a);
  poly_range(&a->c, &lo, &hi);
  if (!(lo - rest > -LARGEST && hi + rest < LARGEST)) return 0;
  field_add(f, r, a, a, 1);
  if (!exponential(f, r, r)) return 0;
  field_constant(f, number, (dd) { 1, 0 }, 0);
  field_add(f, r, r, number, 1);
  if (!by_quotient(f, AMBIT_OP_DIV, RECIPROCAL, r, r)) return 0;
  field_add(f, r, r, r, 1);
  field_constant(f, number, (dd) { 1, 0 }, 0);
  field_add(f, r, number, r, -1);
  return 1;
}

static int smooth(fields *f, uint32_t op, field *r, const field *a, const field *b) {
  switch (op) {
  case AMBIT_OP_DIV: return quotient(f, r, a, b);
  case AMBIT_OP_SQRT: return by_quotient(f, op, ROOT, r, a);
  case AMBIT_OP_LOG: return by_quotient(f, op, LOGARITHM, r, a);
  case AMBIT_OP_EXP: return exponential(f, r, a);
  case AMBIT_OP_TANH: return tangent(f, r, a);
  case AMBIT_OP_SIN: return by_addition(f, op, AMBIT_OP_COS, EVEN_SIGNED, ODD_SIGNED, 1, r, a);
  case AMBIT_OP_COS: return by_addition(f, op, AMBIT_OP_SIN, EVEN_SIGNED, ODD_SIGNED, -1, r, a);
  case AMBIT_OP_SINH: return by_addition(f, op, AMBIT_OP_COSH, EVEN, ODD, 1, r, a);
  case AMBIT_OP_COSH: return by_addition(f, op, AMBIT_OP_SINH, EVEN, ODD, 1, r, a);
  default: return 0;
  }
}

void field_function(fields *f, uint32_t op, field *r, const field *a, const field *b) {
  int plain = !has_rest(f, a) && !has_rest(f, b);
  if (plain || !smooth(f, op, r, a, b)) collapse(f, op, r, a, b);
}

/* a^n in the centre's arithmetic, the rest as uncertainty */
static void collapse_power(fields *f, field *r, const field *a, int32_t n) {
  poly *x = &f->scratch[0].c;
  poly_copy(x, &a->c);
  x->tail = (x->tail + field_rest(f, a)) * SLACK;
  field_constant(f, r, (dd) { 0, 0 }, 0);
  series_power(f->base, &r->c, x, n);
}

/* by_quotient takes its argument's centre and rest before it needs scratch 3 */
void field_power(fields *f, field *r, const field *a, int32_t n) {
  field *power = &f->scratch[3], *next = &f->scratch[2];
  uint32_t count = n < 0 ? 0u - (uint32_t)n : (uint32_t)n;
  if (count == 0 || count > 64 || !has_rest(f, a)) {
    collapse_power(f, r, a, n);
    return;
  }
  field_copy(f, power, a);
  for (; count > 1; count--) {
    field_mul(f, next, power, a);
    field_copy(f, power, next);
  }
  if (n > 0)
    field_copy(f, r, power);
  else if (!has_rest(f, power) || !by_quotient(f, AMBIT_OP_DIV, RECIPROCAL, r, power))
    collapse_power(f, r, a, n);
}
