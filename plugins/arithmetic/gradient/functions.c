/* functions.c -- functions of one variable g: derivative g'(A) and slope over the operand's range A.
**
** slope = {(g(a) - g(c)) / (a - c)}: by the mean value theorem inside g'(A). Where g is convex on A, the quotient grows
** with a and with c, so its range is [q(lo A, lo C), q(hi A, hi C)] with the enclosure C of the centre value; concave:
** the other way round. Quotients suffer cancellation on narrow sets, so both bounds are taken and the better ones kept.
** a^2 - c^2 = (a + c)(a - c) and sqrt a - sqrt c = (a - c) / (sqrt a + sqrt c) need no quotient.
** Where g' is not bounded (sqrt at 0, asin at 1) there is no derivative; a slope may still exist.
*/
#include "gradient.h"

typedef struct call {
  const gradient_context *c;
  uint32_t op;
  int32_t exponent;
  pair a, centre, value; /* operand, its centre, result */
} call;

static pair image_of(const call *f, uint32_t op, int32_t exponent, pair a, uint32_t *flags) {
  double x[2] = { pair_lo(a), a.h }, r[2];
  uint32_t raised = f->c->num->map(op, 1, r, x, NULL, exponent);
  if (flags) *flags = raised;
  return raised & AMBIT_F_EMPTY ? (pair) { -INFINITY, -INFINITY } : pair_of(r[0], r[1]);
}

static pair by_op(const call *f, uint32_t op) { return image_of(f, op, 0, f->a, NULL); }
static const pair UNKNOWN = { INFINITY, INFINITY };

static pair inverse_of(pair x) { return pair_above(x) ? pair_inverse(x) : UNKNOWN; }

/* 1 / sqrt((1 - t)(1 + t)) for a number t of [0, 1] */
static pair arc_derivative_at(const call *f, double t) {
  pair square = pair_mul(pair_difference(1, t), pair_add(pair_point(1), pair_point(t)));
  return pair_above(square) ? inverse_of(image_of(f, AMBIT_OP_SQRT, 0, square, NULL)) : UNKNOWN;
}

/* it grows with |a| */
static pair arc_derivative(const call *f) {
  return (pair) { arc_derivative_at(f, pair_mig(f->a)).n, arc_derivative_at(f, pair_mag(f->a)).h };
}

static pair power_derivative(const call *f) {
  pair n = pair_point(f->exponent);
  if (f->exponent == 0) return pair_point(0);
  if (f->exponent == INT32_MIN) return pair_mul(n, pair_div(f->value, f->a)); /* a without 0 */
  return pair_mul(n, image_of(f, AMBIT_OP_POWN, f->exponent - 1, f->a, NULL));
}

/* where a has one sign, |a| is a or -a on the whole box */
static pair sign_derivative(pair a) {
  if (a.n <= 0) return pair_point(1);
  return a.h <= 0 ? pair_point(-1) : (pair) { 1, 1 };
}

static pair one_plus_square(const call *f, pair x) {
  return pair_add(pair_point(1), image_of(f, AMBIT_OP_SQR, 0, x, NULL));
}

/* of a function that the kernel describes */
static pair described_derivative(const call *f) {
  double c[4];
  f->c->num->taylor(f->op, 1, c, pair_lo(f->a), f->a.h);
  return pair_of(c[2], c[3]);
}

static pair derivative_of(const call *f) {
  if (ambit_op_is_function(f->op)) return described_derivative(f);
  switch (f->op) {
  case AMBIT_OP_SQR: return pair_add(f->a, f->a);
  case AMBIT_OP_POWN: return power_derivative(f);
  case AMBIT_OP_SQRT: return inverse_of(pair_add(f->value, f->value));
  case AMBIT_OP_EXP: return f->value;
  case AMBIT_OP_LOG: return inverse_of(f->a);
  case AMBIT_OP_SIN: return by_op(f, AMBIT_OP_COS);
  case AMBIT_OP_COS: return pair_neg(by_op(f, AMBIT_OP_SIN));
  case AMBIT_OP_TAN: return one_plus_square(f, f->value);
  case AMBIT_OP_ASIN: return arc_derivative(f);
  case AMBIT_OP_ACOS: return pair_neg(arc_derivative(f));
  case AMBIT_OP_ATAN: return inverse_of(one_plus_square(f, f->a));
  case AMBIT_OP_SINH: return by_op(f, AMBIT_OP_COSH);
  case AMBIT_OP_COSH: return by_op(f, AMBIT_OP_SINH);
  case AMBIT_OP_TANH: return inverse_of(image_of(f, AMBIT_OP_SQR, 0, by_op(f, AMBIT_OP_COSH), NULL));
  default: return sign_derivative(f->a); /* ABS */
  }
}

static int sign_of(pair x) { return x.n <= 0 ? 1 : x.h <= 0 ? -1 : 0; }

/* 1: convex on A, -1: concave, 0: neither or not known. The sign of g'' by that of the operand or of the result. */
static int curvature(const call *f) {
  const ambit_function_facts *facts = f->c->num->facts(f->op);
  if (facts) {
    int right = facts->shape == AMBIT_CONVEX || facts->shape == AMBIT_CONVEX_RIGHT ? 1 : -1;
    return facts->shape >= AMBIT_CONVEX_RIGHT ? right * sign_of(f->a) : right;
  }
  switch (f->op) {
  case AMBIT_OP_EXP:
  case AMBIT_OP_COSH:
  case AMBIT_OP_ABS: return 1;
  case AMBIT_OP_LOG: return -1;
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_ATAN:
  case AMBIT_OP_TANH: return -sign_of(f->value);
  case AMBIT_OP_TAN:
  case AMBIT_OP_ASIN:
  case AMBIT_OP_SINH: return sign_of(f->value);
  case AMBIT_OP_ACOS: return -sign_of(f->a);
  case AMBIT_OP_POWN:
    if (f->exponent == 0 || f->exponent == 1) return 0;
    return f->exponent % 2 ? sign_of(f->a) : 1; /* negative exponents: A without 0 */
  default: return 0;
  }
}

/* (g(x) - g(y)) / (x - y) for two numbers, gx and gy enclosing g */
static pair secant(double x, double y, pair gx, pair gy) {
  pair below = pair_difference(x, y);
  return x == y || pair_lo(below) == 0 || below.h == 0 ? UNKNOWN : pair_div(pair_sub(gx, gy), below);
}

/* The derivative's range as narrowed by the secants from the ends of the operand to the centre; also the image of the
** centre, so that the kernel is called once. */
static pair narrowed(const call *f, pair derivative, pair *centre_value) {
  int bend = curvature(f);
  double lo = pair_lo(f->a), hi = f->a.h, width = hi + f->a.n, from = pair_lo(f->centre), to = f->centre.h;
  int useless = bend == 0 || !(width < INFINITY) || width < 0x1p-24 * pair_mag(f->a);
  double x[10] = { from, to, lo, lo, hi, hi, from, from, to, to }, g[10];
  f->c->num->map(f->op, useless ? 1 : 5, g, x, NULL, f->exponent);
  *centre_value = pair_of(g[0], g[1]);
  if (useless) return derivative;
  pair left = secant(lo, from, pair_of(g[2], g[3]), pair_of(g[6], g[7]));
  pair right = secant(hi, to, pair_of(g[4], g[5]), pair_of(g[8], g[9]));
  pair r = pair_meet(derivative, bend > 0 ? (pair) { left.n, right.h } : (pair) { right.n, left.h });
  return r.h >= -r.n ? r : derivative;
}

static pair slope_of(const call *f, pair derivative, pair *centre_value) {
  pair r = narrowed(f, derivative, centre_value);
  if (f->op == AMBIT_OP_SQR) return pair_add(f->a, f->centre);
  if (f->op == AMBIT_OP_SQRT) return inverse_of(pair_add(f->value, *centre_value));
  return r;
}

uint32_t gradient_function(const gradient_context *c, uint32_t op, int32_t exponent, element *r, const element *a) {
  call f = { c, op, exponent, a->value, a->centre, { 0, 0 } };
  uint32_t flags, known = (uint32_t)a->known;
  f.value = image_of(&f, op, exponent, f.a, &flags);
  if (flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY) || !(known & VARIES) || !(known & ~VARIES))
    return gradient_write_value(r, f.value, flags, known);
  rule z = { .value = f.value, .centre = f.value };
  z.derivative[0] = derivative_of(&f);
  z.slope[0] = known & KNOWN_SLOPE ? slope_of(&f, z.derivative[0], &z.centre) : UNKNOWN;
  gradient_write(c, r, &z, known, a, NULL);
  return pair_is_bounded(r->value) ? flags & ~AMBIT_F_UNBOUNDED : flags;
}
