/* jets_start.c -- order 0 of a nonlinear step, and the slope of a function of one set; all in upward mode.
**
** Slope of f over U about u0: f(u) - f(u0) = s (u - u0) with s in f'(hull of U and u0) (mean value theorem), and, by
** Taylor's theorem, s in f'(u0) + f''(hull)/2 (U - u0); where f'' costs nothing, both are intersected.
** A step that depends on a choice (ABS, MIN, MAX) is a power series only as long as the choice stays the same: it
** must be clear at order 0, with room to spare if the operands move. The same holds for the cut of the angle along
** the negative x axis.
*/
#include "jets.h"
#include <math.h>

static const bounds entire = { -INFINITY, INFINITY };

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

bounds jets_bounds(row u) { return (bounds) { -(u.rad[0] - u.mid[0]), u.mid[0] + u.rad[0] }; }

static bounds negated(bounds a) { return (bounds) { -a.hi, -a.lo }; }
static bounds sum(bounds a, bounds b) { return (bounds) { -(-a.lo - b.lo), a.hi + b.hi }; }
static bounds hull(bounds a, bounds b) { return (bounds) { smaller(a.lo, b.lo), larger(a.hi, b.hi) }; }
static int has_zero(bounds a) { return a.lo <= 0 && a.hi >= 0; }
static int within(bounds a, bounds b) { return b.lo <= a.lo && a.hi <= b.hi; }

/* of two enclosures of the same number; a if they are disjoint, which rounding cannot cause */
bounds jets_intersect(bounds a, bounds b) {
  bounds r = { larger(a.lo, b.lo), smaller(a.hi, b.hi) };
  return r.lo <= r.hi ? r : a;
}

/* of bounded sets */
static bounds product(bounds a, bounds b) {
  double hi = larger(larger(a.lo * b.lo, a.lo * b.hi), larger(a.hi * b.lo, a.hi * b.hi));
  double down = larger(larger(-a.lo * b.lo, -a.lo * b.hi), larger(-a.hi * b.lo, -a.hi * b.hi));
  return (bounds) { -down, hi };
}

static bounds square(bounds a) {
  double small = larger(0, larger(a.lo, -a.hi)), large = larger(-a.lo, a.hi);
  return (bounds) { -(-small * small), large * large };
}

/* b without 0 */
static bounds quotient(bounds a, bounds b) {
  if (b.hi < 0) a = negated(a), b = negated(b);
  double hi = a.hi > 0 ? a.hi / b.lo : a.hi / b.hi, down = a.lo < 0 ? -a.lo / b.lo : -a.lo / b.hi;
  return (bounds) { -down, hi };
}

static bounds elementary(const jets *j, uint32_t op, bounds a) {
  bounds r;
  j->num->elementary(op, 1, &a.lo, &a.hi, NULL, NULL, &r.lo, &r.hi);
  return r;
}

/* with flags where the operand leaves the domain */
static uint32_t mapped(const jets *j, uint32_t op, bounds a, bounds b, bounds *r) {
  double x[2] = { a.lo, a.hi }, y[2] = { b.lo, b.hi }, z[2];
  uint32_t flags = j->num->map(op, 1, z, x, y, 0);
  *r = flags & AMBIT_F_EMPTY ? entire : (bounds) { z[0], z[1] };
  return flags;
}

static uint32_t divided(bounds a, bounds b, bounds *r) {
  *r = entire;
  if (has_zero(b)) return AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED;
  *r = quotient(a, b);
  return 0;
}

static int touches_cut(bounds y, bounds x) { return y.lo <= 0 && y.hi >= 0 && x.lo <= 0; }

static int decide(const step *s, bounds a, bounds b) {
  if (s->op == AMBIT_OP_ABS) b = negated(a);                 /* |a| is the larger of a and -a */
  if (s->op == AMBIT_OP_MIN) a = negated(a), b = negated(b); /* now everything is a maximum */
  int still = s->degree == 0;
  if (a.lo > b.hi || (still && a.lo == b.hi)) return 1;
  if (b.lo > a.hi || (still && b.lo == a.hi)) return -1;
  return 0;
}

/* the operand over the box and at the centre */
static bounds span_of(const jets *j, const slot *box, uint32_t index) {
  bounds u = jets_bounds(box->u);
  return j->centre ? hull(u, jets_bounds(j->centre->slot[index].u)) : u;
}

int jets_choice(const jets *j, const step *s) {
  return decide(s, span_of(j, s->a, s->a_index), span_of(j, s->b, s->b_index));
}

uint32_t jets_start(const jets *j, const step *s, bounds *r, bounds *other) {
  bounds a = jets_bounds(s->a->u), b = jets_bounds(s->b->u);
  int fixed = s->degree == 0; /* constant in time: its value is all there is */
  *r = *other = entire;
  switch (s->op) {
  case AMBIT_OP_MUL: *r = product(a, b); return 0;
  case AMBIT_OP_SQR: *r = square(a); return 0;
  case AMBIT_OP_DIV: return divided(a, b, r);
  case AMBIT_OP_EXP:
  case AMBIT_OP_TANH:
  case AMBIT_OP_ATAN: *r = elementary(j, s->op, a); return 0;
  case AMBIT_OP_SIN:
    *r = elementary(j, AMBIT_OP_SIN, a);
    *other = elementary(j, AMBIT_OP_COS, a);
    return 0;
  case AMBIT_OP_SINH:
    *r = elementary(j, AMBIT_OP_SINH, a);
    *other = elementary(j, AMBIT_OP_COSH, a);
    return 0;
  case AMBIT_OP_ATAN2: {
    uint32_t flags = mapped(j, s->op, a, b, r);
    return touches_cut(a, b) && !fixed ? flags | AMBIT_F_UNBOUNDED : flags;
  }
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: {
    uint32_t flags = mapped(j, s->op, a, b, r);
    return fixed || jets_choice(j, s) ? flags : flags | AMBIT_F_UNBOUNDED;
  }
  default: return mapped(j, s->op, a, b, r); /* SQRT, LOG */
  }
}

typedef struct pair {
  bounds r, other;
} pair;

/* the values of a step's functions over `span`: those at hand if it is the box */
static pair values(const jets *j, const step *s, bounds span, bounds box) {
  pair p = { jets_bounds(s->r->u), jets_bounds(s->other->u) };
  if (within(span, box)) return p;
  if (s->op == AMBIT_OP_EXP || s->op == AMBIT_OP_TANH) p.r = p.other = elementary(j, s->op, span);
  if (s->op == AMBIT_OP_SIN) p = (pair) { elementary(j, AMBIT_OP_SIN, span), elementary(j, AMBIT_OP_COS, span) };
  if (s->op == AMBIT_OP_SINH) p = (pair) { elementary(j, AMBIT_OP_SINH, span), elementary(j, AMBIT_OP_COSH, span) };
  return p;
}

/* first and second derivatives of both functions of a step, from their values */
typedef struct derivatives {
  bounds r1, r2, other1, other2;
} derivatives;

/* 1 - f^2 and -2 f f' */
static derivatives derive_tanh(bounds f) {
  bounds first = sum((bounds) { 1, 1 }, negated(square(f))), second = product((bounds) { -2, -2 }, product(f, first));
  return (derivatives) { first, second, first, second };
}

static derivatives derive(uint32_t op, pair f) {
  if (op == AMBIT_OP_EXP) return (derivatives) { f.r, f.r, f.r, f.r };
  if (op == AMBIT_OP_TANH) return derive_tanh(f.r);
  if (op == AMBIT_OP_SINH) return (derivatives) { f.other, f.r, f.r, f.other };
  return (derivatives) { f.other, negated(f.r), negated(f.r), negated(f.other) };
}

static bounds taylor(bounds at_centre, bounds second, bounds away) {
  bounds bend = product(second, away);
  return sum(at_centre, (bounds) { -(-0.5 * bend.lo), 0.5 * bend.hi });
}

static uint32_t slope_of_pair(const jets *j, const step *s, bounds box, bounds *first, bounds *second) {
  if (!j->centre) {
    derivatives d = derive(s->op, values(j, s, box, box));
    *first = d.r1, *second = d.other1;
    return 0;
  }
  const slot *there = j->centre->slot;
  bounds u0 = jets_bounds(there[s->a_index].u), span = hull(box, u0);
  derivatives d = derive(s->op, values(j, s, span, box));
  pair centre = { jets_bounds(there[s->r_index].u), jets_bounds(there[s->other_index].u) };
  derivatives d0 = derive(s->op, centre);
  bounds away = sum(box, negated(u0));
  *first = jets_intersect(d.r1, taylor(d0.r1, d.r2, away));
  *second = jets_intersect(d.other1, taylor(d0.other1, d.other2, away));
  return 0;
}

static uint32_t slope_of_angle(bounds y, bounds x, bounds *first, bounds *second) {
  bounds distance = sum(square(x), square(y));
  if (touches_cut(y, x) || !(distance.lo > 0)) return AMBIT_F_UNBOUNDED;
  *first = quotient(x, distance);
  *second = quotient(negated(y), distance);
  return 0;
}

uint32_t jets_start_slope(const jets *j, const step *s, bounds *first, bounds *second) {
  bounds a = span_of(j, s->a, s->a_index), b = span_of(j, s->b, s->b_index), one = { 1, 1 };
  *first = *second = entire;
  switch (s->op) {
  case AMBIT_OP_LOG: return divided(one, a, first);
  case AMBIT_OP_ATAN: *first = quotient(one, sum(one, square(a))); return 0;
  case AMBIT_OP_ATAN2: return slope_of_angle(a, b, first, second);
  default: return slope_of_pair(j, s, jets_bounds(s->a->u), first, second);
  }
}
