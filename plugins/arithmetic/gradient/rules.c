/* rules.c -- how value, centre, derivatives and slopes go through the operations with two operands, NEG, and the
** mean-value form.
**
** For r = op(a, b): derivative_j = p a_j + q b_j with p, q enclosing the partial derivatives of op over the boxes of
** the operands (Clarke's chain rule for kinks), and slope_j = p a_j + q b_j with p, q such that
** op(a, b) - op(a', b') = p (a - a') + q (b - b') for all (a, b) of the box and a', b' at the centre:
**   a b - a' b' = (b + b')/2 (a - a') + (a + a')/2 (b - b')
**   a / b - a' / b' = 1/b (a - a') - (a' / b')/b (b - b')
**   max(a, b) - max(a', b') = t (a - a') + (1 - t)(b - b') for some t of [0, 1]: if a' >= b' the difference lies
**   between a - a' and, where b > a, b - b' + (b' - a') <= b - b'
** and by the mean value theorem otherwise. Then f(x) is in f(c) + sum_j |slope_j| [-1, 1] (Neumaier, Interval Methods
** for Systems of Equations, 1990, section 2.3; Krawczyk and Neumaier 1985 for slopes).
*/
#include "gradient.h"

static const pair ONE = { -1, 1 }, NOTHING = { -INFINITY, -INFINITY };

uint32_t gradient_write_empty(element *r) {
  r->value = r->centre = NOTHING, r->known = 0;
  return AMBIT_F_EMPTY;
}

static uint32_t bounded(pair x) { return pair_is_bounded(x) ? 0 : AMBIT_F_UNBOUNDED; }

uint32_t gradient_finish(element *r, uint32_t known, double moved) {
  pair inside = pair_meet(r->centre, r->value);
  if (inside.h >= -inside.n) r->centre = inside;
  if (known & KNOWN_SLOPE) {
    pair mean = pair_meet(r->value, (pair) { r->centre.n + moved, r->centre.h + moved });
    if (mean.h >= -mean.n) r->value = mean;
  }
  r->known = known;
  return bounded(r->value);
}

/* the interval part only, because the rest proves nothing or is not wanted */
uint32_t gradient_write_value(element *r, pair value, uint32_t flags, uint32_t known) {
  if (flags & AMBIT_F_EMPTY) return flags | gradient_write_empty(r);
  r->value = r->centre = value;
  r->known = flags & AMBIT_F_PARTIAL ? 0 : known;
  return flags;
}

/* p x, p finite */
static factor factor_of(pair p) {
  if (p.n <= 0) return (factor) { p.h, -p.n, 0, 0 };
  if (p.h <= 0) return (factor) { p.n, -p.h, 1, 1 };
  return (factor) { p.h, p.n, 0, 1 };
}

static double write_part(
    const gradient_context *c, double *r, const pair factors[2], const double *x, const double *y) {
  if (x && y) return c->loops->combine(c->width, r, factor_of(factors[0]), x, factor_of(factors[1]), y);
  if (x) return c->loops->scale(c->width, r, factor_of(factors[0]), x);
  return c->loops->scale(c->width, r, factor_of(factors[1]), y);
}

uint32_t gradient_write(
    const gradient_context *c, element *r, const rule *z, uint32_t known, const element *a, const element *b) {
  int first = a->known & VARIES ? 1 : 0, second = b && b->known & VARIES ? 1 : 0;
  double moved = 0;
  for (int part = DERIVATIVE; part <= SLOPE; part++) {
    uint32_t flag = part == SLOPE ? KNOWN_SLOPE : KNOWN_DERIVATIVE;
    const pair *factors = part == SLOPE ? z->slope : z->derivative;
    int finite = (!first || pair_is_bounded(factors[0])) && (!second || pair_is_bounded(factors[1]));
    if (!(known & flag) || !finite) {
      known &= ~flag;
      continue;
    }
    const double *x = first ? part_in(c, a, part) : NULL, *y = second ? part_in(c, b, part) : NULL;
    moved = write_part(c, part_of(c, r, part), factors, x, y);
    if (!(moved < INFINITY)) known &= ~flag;
  }
  r->value = z->value, r->centre = z->centre;
  return gradient_finish(r, known, moved);
}

/* -- sums and products */

static uint32_t sum(
    const gradient_context *c, element *r, const element *a, const element *b, uint32_t known, int sub) {
  pair second = sub ? pair_neg(ONE) : ONE, y = sub ? pair_neg(b->value) : b->value,
       y_centre = sub ? pair_neg(b->centre) : b->centre;
  rule z = { pair_add(a->value, y), pair_add(a->centre, y_centre), { ONE, second }, { ONE, second } };
  return known & VARIES ? gradient_write(c, r, &z, known, a, b)
                        : gradient_write_value(r, z.value, bounded(z.value), known);
}

static uint32_t negative(const gradient_context *c, element *r, const element *a) {
  rule z = { pair_neg(a->value), pair_neg(a->centre), { pair_neg(ONE) }, { pair_neg(ONE) } };
  if (!(a->known & VARIES)) return gradient_write_value(r, z.value, bounded(z.value), (uint32_t)a->known);
  return gradient_write(c, r, &z, (uint32_t)a->known, a, NULL);
}

static uint32_t product(const gradient_context *c, element *r, const element *a, const element *b, uint32_t known) {
  rule z = { .value = pair_mul(a->value, b->value) };
  if (!(known & VARIES)) return gradient_write_value(r, z.value, bounded(z.value), known);
  z.centre = pair_mul(a->centre, b->centre);
  z.derivative[0] = b->value, z.derivative[1] = a->value;
  z.slope[0] = pair_half(pair_add(b->value, b->centre)), z.slope[1] = pair_half(pair_add(a->value, a->centre));
  return gradient_write(c, r, &z, known, a, b);
}

/* an operation by the kernel's interval function */
static uint32_t served(const gradient_context *c, uint32_t op, pair *r, pair x, pair y) {
  double a[2] = { pair_lo(x), x.h }, b[2] = { pair_lo(y), y.h }, z[2];
  uint32_t flags = c->num->map(op, 1, z, a, b, 0);
  *r = flags & AMBIT_F_EMPTY ? NOTHING : pair_of(z[0], z[1]);
  return flags;
}

static uint32_t quotient(const gradient_context *c, element *r, const element *a, const element *b, uint32_t known) {
  rule z;
  uint32_t flags = served(c, AMBIT_OP_DIV, &z.value, a->value, b->value);
  if (flags & AMBIT_F_PARTIAL || !(known & VARIES)) return gradient_write_value(r, z.value, flags, known & ~VARIES);
  pair inverse = pair_inverse(b->value);
  served(c, AMBIT_OP_DIV, &z.centre, a->centre, b->centre);
  z.derivative[0] = z.slope[0] = inverse;
  z.derivative[1] = pair_neg(pair_mul(z.value, inverse));
  z.slope[1] = pair_neg(pair_mul(z.centre, inverse));
  return gradient_write(c, r, &z, known, a, b);
}

/* p / (p^2 + q^2), also as 1 / (p + q^2 / p); no bounds if the square underflows */
static pair over_square(const gradient_context *c, pair p, pair q) {
  pair square[2], r = { INFINITY, INFINITY };
  served(c, AMBIT_OP_SQR, &square[0], p, p);
  served(c, AMBIT_OP_SQR, &square[1], q, q);
  pair sum = pair_add(square[0], square[1]);
  if (pair_above(sum)) r = pair_div(p, sum);
  if (!pair_above(p) && !pair_below(p)) return r;
  pair other = pair_inverse(pair_add(p, pair_div(square[1], p)));
  return pair_meet(r, other);
}

/* The derivatives are b / (a^2 + b^2) and -a / (a^2 + b^2). The angle jumps across the negative half of the axis
** a = 0 where a becomes negative; there it is not continuous, although defined. */
static uint32_t angle(const gradient_context *c, element *r, const element *a, const element *b, uint32_t known) {
  rule z;
  uint32_t flags = served(c, AMBIT_OP_ATAN2, &z.value, a->value, b->value);
  int jumps = b->value.n > 0 && a->value.n > 0 && a->value.h >= 0;
  if (jumps) known = 0;
  if (flags & AMBIT_F_PARTIAL || !(known & VARIES)) return gradient_write_value(r, z.value, flags, known & ~VARIES);
  served(c, AMBIT_OP_ATAN2, &z.centre, a->centre, b->centre);
  z.derivative[0] = over_square(c, b->value, a->value);
  z.derivative[1] = pair_neg(over_square(c, a->value, b->value));
  z.slope[0] = z.derivative[0], z.slope[1] = z.derivative[1];
  return gradient_write(c, r, &z, known, a, b);
}

/* -- the smaller and the larger one */

static pair extreme_pair(pair x, pair y, int larger) {
  if (larger) return (pair) { pair_min(x.n, y.n), pair_max(x.h, y.h) };
  return (pair) { pair_max(x.n, y.n), pair_min(x.h, y.h) };
}

/* both may be the result: the hull of each derivative and slope; a constant has zeros */
static uint32_t extreme_parts(
    const gradient_context *c, element *r, const element *a, const element *b, uint32_t known) {
  static const factor none = { 0, 0, 0, 0 };
  double moved = 0;
  for (int part = DERIVATIVE; part <= SLOPE; part++) {
    uint32_t flag = part == SLOPE ? KNOWN_SLOPE : KNOWN_DERIVATIVE;
    if (!(known & flag)) continue;
    double *to = part_of(c, r, part);
    const double *x = part_in(c, a, part), *y = part_in(c, b, part);
    if (!(a->known & VARIES)) c->loops->scale(c->width, to, none, y), x = to;
    if (!(b->known & VARIES)) c->loops->scale(c->width, to, none, x), y = to;
    moved = c->loops->hull(c->width, to, x, y);
  }
  return gradient_finish(r, known, moved);
}

static uint32_t extreme(
    const gradient_context *c, element *r, const element *a, const element *b, uint32_t known, int larger) {
  pair value = extreme_pair(a->value, b->value, larger);
  if (!(known & VARIES)) return gradient_write_value(r, value, bounded(value), known);
  const element *high = larger ? a : b, *low = larger ? b : a;
  rule z = { value, extreme_pair(a->centre, b->centre, larger), { ONE }, { ONE } };
  const element *only = pair_lo(high->value) >= low->value.h ? a : pair_lo(low->value) >= high->value.h ? b : NULL;
  if (only && !(only->known & VARIES)) return gradient_write_value(r, value, bounded(value), known & ~VARIES);
  if (only) return gradient_write(c, r, &z, known, only, NULL);
  r->value = value, r->centre = z.centre;
  return extreme_parts(c, r, a, b, known);
}

/* -- a run */

static uint32_t binary(const gradient_context *c, uint32_t op, element *r, const element *a, const element *b) {
  if (pair_is_empty(a->value) || pair_is_empty(b->value)) return gradient_write_empty(r);
  uint32_t known = (uint32_t)((a->known & b->known & ~VARIES) | ((a->known | b->known) & VARIES));
  switch (op) {
  case AMBIT_OP_ADD: return sum(c, r, a, b, known, 0);
  case AMBIT_OP_SUB: return sum(c, r, a, b, known, 1);
  case AMBIT_OP_MUL: return product(c, r, a, b, known);
  case AMBIT_OP_DIV: return quotient(c, r, a, b, known);
  case AMBIT_OP_ATAN2: return angle(c, r, a, b, known);
  default: return extreme(c, r, a, b, known, op == AMBIT_OP_MAX);
  }
}

static int is_binary(uint32_t op) {
  return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 ||
         op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}

static uint32_t unary(const gradient_context *c, uint32_t op, int32_t exponent, element *r, const element *a) {
  if (pair_is_empty(a->value)) return gradient_write_empty(r);
  if (op == AMBIT_OP_NEG) return negative(c, r, a);
  return gradient_function(c, op, exponent, r, a);
}

AMBIT_WORKER uint32_t gradient_run(const gradient_context *c, uint32_t op, void *base, size_t pitch, size_t lanes,
    size_t count, const uint32_t *dst, const uint32_t *a, const uint32_t *b) {
  uint32_t flags = 0;
  int two = is_binary(op);
  for (size_t i = 0; i < count; i++)
    for (size_t lane = 0; lane < lanes; lane++) {
      element *r = element_at(c, base, pitch * dst[i] + lane);
      const element *x = element_at(c, base, pitch * a[i] + lane);
      if (two)
        flags |= binary(c, op, r, x, element_at(c, base, pitch * b[i] + lane));
      else
        flags |= unary(c, op, op == AMBIT_OP_POWN ? (int32_t)b[i] : 0, r, x);
    }
  return flags;
}
