/* inverse.c -- what r = op(a, b) says about a and b when r is known.
**
** Each rule is an identity solved for an operand and evaluated in intervals, so it keeps every solution. Where the
** inverse has two branches, each is intersected with the operand before the hull is taken: that is what narrows
** operands that straddle 0.
*/
#include "graph/contract.h"
#include "num/function.h"
#include "num/interval.h"

#define POSITIVE ((ambit_interval) { 0, INFINITY })
#define NEGATIVE ((ambit_interval) { -INFINITY, 0 })

static ambit_interval apply(uint32_t op, ambit_interval a) {
  ambit_interval r;
  ambit_interval_op(op, &r, a, a);
  return r;
}

static ambit_interval negate(ambit_interval a) { return (ambit_interval) { -a.hi, -a.lo }; }

static bool meet(ambit_interval *x, ambit_interval y) {
  *x = ambit_interval_intersect(*x, y);
  return !ambit_interval_is_empty(*x);
}

static bool meet_either(ambit_interval *x, ambit_interval y, ambit_interval z) {
  *x = ambit_interval_hull(ambit_interval_intersect(*x, y), ambit_interval_intersect(*x, z));
  return !ambit_interval_is_empty(*x);
}

/* x b = r: x is r / b, from the negative or the positive part of b; anything if both may be 0 */
static bool meet_quotient(ambit_interval *x, ambit_interval r, ambit_interval b) {
  if (!ambit_interval_contains(b, 0)) return meet(x, ambit_interval_div(r, b));
  if (ambit_interval_contains(r, 0)) return true;
  return meet_either(x, ambit_interval_div(r, ambit_interval_intersect(b, NEGATIVE)),
      ambit_interval_div(r, ambit_interval_intersect(b, POSITIVE)));
}

/* -- powers */

/* the n-th root of r >= 0, n > 0 */
static ambit_interval root(ambit_interval r, int32_t n) {
  ambit_interval exponent = { n, n };
  return r.hi == 0 ? r : apply(AMBIT_OP_EXP, ambit_interval_div(apply(AMBIT_OP_LOG, r), exponent));
}

static bool inverse_power(int32_t n, ambit_interval r, ambit_interval *a) {
  ambit_interval above = ambit_interval_intersect(r, POSITIVE), below = ambit_interval_intersect(r, NEGATIVE);
  ambit_interval up = ambit_interval_is_empty(above) ? above : root(above, n), down = up;
  if (n % 2) down = ambit_interval_is_empty(below) ? below : root(negate(below), n);
  return meet_either(a, up, ambit_interval_is_empty(down) ? down : negate(down));
}

bool ambit_inverse_pown(int32_t n, ambit_interval r, ambit_interval *a) {
  const ambit_interval one = { 1, 1 };
  if (n == 0 || n == INT32_MIN) return true;
  return inverse_power(n < 0 ? -n : n, n < 0 ? ambit_interval_div(one, r) : r, a);
}

static bool inverse_square(ambit_interval r, ambit_interval *a) {
  ambit_interval s = apply(AMBIT_OP_SQRT, r);
  return !ambit_interval_is_empty(s) && meet_either(a, s, negate(s));
}

/* -- hyperbolic functions: monotone inverses at the bounds */

/* log(v + sqrt(v^2 + shift)) for v >= 0 (asinh: shift 1; acosh: -1, v >= 1) */
static ambit_interval area(double v, double shift) {
  ambit_interval x = { v, v }, s = { shift, shift };
  ambit_interval radicand = ambit_interval_add(apply(AMBIT_OP_SQR, x), s);
  return apply(AMBIT_OP_LOG, ambit_interval_add(x, apply(AMBIT_OP_SQRT, radicand)));
}

static ambit_interval asinh_at(double v) { return v < 0 ? negate(area(-v, 1)) : area(v, 1); }

static bool inverse_sinh(ambit_interval r, ambit_interval *a) {
  double lo = r.lo > -INFINITY ? asinh_at(r.lo).lo : -INFINITY, hi = r.hi < INFINITY ? asinh_at(r.hi).hi : INFINITY;
  return meet(a, (ambit_interval) { lo, hi });
}

static bool inverse_cosh(ambit_interval r, ambit_interval *a) {
  if (r.hi < 1) return false;
  double hi = r.hi < INFINITY ? area(r.hi, -1).hi : INFINITY, lo = r.lo > 1 ? fmax(area(r.lo, -1).lo, 0) : 0;
  return meet_either(a, (ambit_interval) { lo, hi }, (ambit_interval) { -hi, -lo });
}

/* half the log of (1 + v) / (1 - v) */
static ambit_interval atanh_of(ambit_interval r) {
  const ambit_interval one = { 1, 1 }, half = { 0.5, 0.5 };
  ambit_interval x = apply(AMBIT_OP_LOG, ambit_interval_div(ambit_interval_add(one, r), ambit_interval_sub(one, r)));
  return ambit_interval_mul(half, x);
}

static bool inverse_tanh(ambit_interval r, ambit_interval *a) {
  double lo = r.lo > -1 ? atanh_of((ambit_interval) { r.lo, r.lo }).lo : -INFINITY;
  double hi = r.hi < 1 ? atanh_of((ambit_interval) { r.hi, r.hi }).hi : INFINITY;
  return r.lo < 1 && r.hi > -1 && meet(a, (ambit_interval) { lo, hi });
}

/* -- two operands */

/* r = angle of the point (b, a) */
static bool inverse_atan2(ambit_interval r, ambit_interval *a, ambit_interval *b) {
  const ambit_interval pi = ambit_interval_pi();
  if (r.lo >= 0 && !meet(a, POSITIVE)) return false;
  if (r.hi <= 0 && !meet(a, NEGATIVE)) return false;
  if (r.lo < -pi.lo / 2 || r.hi > pi.lo / 2) return true;
  return meet(b, POSITIVE) && meet(a, ambit_interval_mul(*b, apply(AMBIT_OP_TAN, r)));
}

/* r = min(a, b) */
static bool inverse_min(ambit_interval r, ambit_interval *a, ambit_interval *b) {
  const ambit_interval above = { r.lo, INFINITY };
  if (!meet(a, above) || !meet(b, above)) return false;
  if (a->lo > r.hi) return meet(b, r);
  return !(b->lo > r.hi) || meet(a, r);
}

static bool inverse_max(ambit_interval r, ambit_interval *a, ambit_interval *b) {
  ambit_interval minus_a = negate(*a), minus_b = negate(*b);
  bool some = inverse_min(negate(r), &minus_a, &minus_b);
  *a = negate(minus_a), *b = negate(minus_b);
  return some;
}

/* a is r's preimage under a function that is one to one on the set `principal` of values */
static bool meet_image(uint32_t op, ambit_interval r, ambit_interval principal, ambit_interval *a) {
  return meet(&r, principal) && meet(a, apply(op, r));
}

static ambit_interval half_turn(void) {
  double half = ambit_interval_pi().hi / 2;
  return (ambit_interval) { -half, half };
}

static bool inverse_function(uint32_t op, ambit_interval r, ambit_interval *a, ambit_interval *b) {
  const ambit_described *f = ambit_function_of(op);
  if (ambit_op_arity(op) == 2) return f->contract(r, a, b);
  return meet(&r, f->image) && meet(a, f->inverse(r));
}

bool ambit_inverse(uint32_t op, ambit_interval r, ambit_interval *a, ambit_interval *b) {
  if (ambit_op_is_function(op)) return inverse_function(op, r, a, b);
  switch (op) {
  case AMBIT_OP_ADD: return meet(a, ambit_interval_sub(r, *b)) && meet(b, ambit_interval_sub(r, *a));
  case AMBIT_OP_SUB: return meet(a, ambit_interval_add(r, *b)) && meet(b, ambit_interval_sub(*a, r));
  case AMBIT_OP_NEG: return meet(a, negate(r));
  case AMBIT_OP_MUL: return meet_quotient(a, r, *b) && meet_quotient(b, r, *a);
  case AMBIT_OP_SQR: return inverse_square(r, a);
  case AMBIT_OP_DIV: return meet(a, ambit_interval_mul(r, *b)) && meet_quotient(b, *a, r);
  case AMBIT_OP_SQRT: return meet_image(AMBIT_OP_SQR, r, POSITIVE, a);
  case AMBIT_OP_EXP: return meet(a, apply(AMBIT_OP_LOG, r));
  case AMBIT_OP_LOG: return meet(a, apply(AMBIT_OP_EXP, r));
  case AMBIT_OP_SIN: return ambit_inverse_sin(r, a);
  case AMBIT_OP_COS: return ambit_inverse_cos(r, a);
  case AMBIT_OP_TAN: return ambit_inverse_tan(r, a);
  case AMBIT_OP_ASIN: return meet_image(AMBIT_OP_SIN, r, half_turn(), a);
  case AMBIT_OP_ACOS: return meet_image(AMBIT_OP_COS, r, (ambit_interval) { 0, ambit_interval_pi().hi }, a);
  case AMBIT_OP_ATAN: return meet_image(AMBIT_OP_TAN, r, half_turn(), a);
  case AMBIT_OP_ATAN2: return inverse_atan2(r, a, b);
  case AMBIT_OP_SINH: return inverse_sinh(r, a);
  case AMBIT_OP_COSH: return inverse_cosh(r, a);
  case AMBIT_OP_TANH: return inverse_tanh(r, a);
  case AMBIT_OP_ABS: return meet(&r, POSITIVE) && meet_either(a, r, negate(r));
  case AMBIT_OP_MIN: return inverse_min(r, a, b);
  case AMBIT_OP_MAX: return inverse_max(r, a, b);
  default: return true;
  }
}
