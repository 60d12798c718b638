/* jets_values.h -- one order of the values of every slot, in upward mode; included once per instruction set.
**
** The dot product of two rows in midpoint-radius form [Rump, BIT 39 (1999), 534-554, here two-sided]: with all sums
** rounded up,
**   H >= sum a b,   L >= sum (-a) b,   R >= sum |a| rb + ra (|b| + rb),
** so that the set of all sums of products lies in [-(L + R), H + R]. It does not matter in which order terms are
** added, nor whether a product is rounded before it is added (portable) or not (fused): each step yields a number
** that is not below the exact one. A product that underflows is rounded up as well: at worst to the least subnormal
** or to 0 from below.
**
** The recursions are those of Moore 1966 [Griewank & Walther, Evaluating Derivatives, 2nd ed., table 13.2] with t
** d/dt, whose coefficient k is k u_k.
*/
#include "jets.h"
#include "vector.h"
#include <float.h>

/* the set [-(l + r), h + r] */
typedef struct triple {
  double h, l, r;
} triple;

static inline triple plus(triple a, triple b) { return (triple) { a.h + b.h, a.l + b.l, a.r + b.r }; }
static inline triple minus(triple a, triple b) { return (triple) { a.h + b.l, a.l + b.h, a.r + b.r }; }
static inline triple over(triple a, double positive) {
  return (triple) { a.h / positive, a.l / positive, a.r / positive };
}
static inline triple coefficient(row a, uint32_t k) { return (triple) { a.mid[k], -a.mid[k], a.rad[k] }; }
static inline triple times_order(row a, uint32_t k) {
  double order = k;
  return (triple) { order * a.mid[k], order * -a.mid[k], order * a.rad[k] };
}

/* n is rounded up to a multiple of the width: behind one of the rows there are zeros, behind the other finite numbers
*/
static inline triple dot_rows(const double *am, const double *ar, const double *bm, const double *br, size_t n) {
  vector h = splat(0), l = h, r = h, q = h;
  for (size_t i = 0; i < n; i += WIDTH) {
    vector a = load(am + i), b = load(bm + i), rb = load(br + i);
    h = multiply_add(a, b, h);
    l = multiply_add(-a, b, l);
    r = multiply_add(magnitude(a), rb, r);
    q = multiply_add(load(ar + i), magnitude(b) + rb, q);
  }
  r += q;
#if WIDTH == 4
  vector hl = __builtin_shufflevector(h, l, 0, 4, 2, 6) + __builtin_shufflevector(h, l, 1, 5, 3, 7);
  return (triple) { hl[0] + hl[2], hl[1] + hl[3], (r[0] + r[1]) + (r[2] + r[3]) };
#else
  return (triple) { h[0] + h[1], l[0] + l[1], r[0] + r[1] };
#endif
}

/* Coefficient k of a * b, a of degree da. */
static inline triple convolve(row a, uint32_t da, const slot *b, uint32_t order, uint32_t k) {
  uint32_t from = k > b->degree ? k - b->degree : 0, to = k < da ? k : da;
  if (from > to) return (triple) { 0, 0, 0 };
  size_t at = order - k + from;
  return dot_rows(a.mid + from, a.rad + from, b->reversed.mid + at, b->reversed.rad + at, to - from + 1);
}

/* t / (scale * b_0); a divisor with 0 gives infinities, which `settle` reports */
static inline triple divide_by(triple t, row b, double scale) {
  double size = fabs(b.mid[0]), low = -(scale * (b.rad[0] - size)), high = scale * (size + b.rad[0]);
  if (!(low > 0)) return (triple) { INFINITY, INFINITY, 0 };
  double h = t.h + t.r, l = t.l + t.r;
  if (b.mid[0] < 0) {
    double keep_h = h;
    h = l, l = keep_h;
  }
  return (triple) { h > 0 ? h / low : h / high, l > 0 ? l / low : l / high, 0 };
}

/* writes coefficient k wherever it is needed */
static inline void spread(const slot *s, uint32_t order, uint32_t k) {
  double mid = s->u.mid[k], rad = s->u.rad[k];
  if (s->reversed.mid) s->reversed.mid[order - k] = mid, s->reversed.rad[order - k] = rad;
  if (!s->moving.mid) return;
  double up = (double)k * mid, down = (double)k * -mid;
  s->moving.mid[k] = up;
  s->moving.rad[k] = (double)k * rad + (up + down);
}

/* An infinite or undefined midpoint has a radius that is infinite or undefined: h - mid and mid + l cannot both be
** bounded then. */
static inline void settle(jets *j, const slot *s, uint32_t k, triple t) {
  double mid = 0.5 * (t.h - t.l), above = t.h - mid, below = mid + t.l;
  double rad = t.r + (above > below ? above : below);
  if (!(rad < DBL_MAX)) {
    mid = 0, rad = DBL_MAX;
    j->flags |= AMBIT_F_UNBOUNDED;
  }
  s->u.mid[k] = mid, s->u.rad[k] = rad;
  spread(s, j->order, k);
}

static inline triple of_bounds(bounds b) { return (triple) { b.hi, -b.lo, 0 }; }

/* order 0 of a product also as a product of intervals: tighter for wide operands, as the other is for thin ones */
static inline triple sharpened(triple t, bounds b) {
  return of_bounds(jets_intersect((bounds) { -(t.l + t.r), t.h + t.r }, b));
}

/* the coefficient that a dot product with its own result must not see */
static inline void clear(row a, uint32_t at) { a.mid[at] = 0, a.rad[at] = 0; }

static inline triple quotient_value(const jets *j, const step *s, uint32_t k) {
  if (s->b->degree == 0) return divide_by(coefficient(s->a->u, k), s->b->u, 1);
  clear(s->r->u, k);
  triple known = convolve(s->r->u, s->degree, s->b, j->order, k);
  return divide_by(minus(coefficient(s->a->u, k), known), s->b->u, 1);
}

static inline triple root_value(const jets *j, const step *s, uint32_t k) {
  clear(s->r->u, k), clear(s->r->reversed, j->order - k);
  triple known = convolve(s->r->u, s->degree, s->r, j->order, k);
  return divide_by(minus(coefficient(s->a->u, k), known), s->r->u, 2);
}

/* LOG: u r' = u';  ATAN: w r' = u' with w = 1 + u^2 */
static inline triple logarithmic_value(const jets *j, const step *s, const slot *w, uint32_t k) {
  clear(s->r->moving, k);
  triple known = convolve(s->r->moving, s->degree, w, j->order, k);
  return divide_by(minus(times_order(s->a->u, k), known), w->u, k);
}

/* w r' = b a' - a b' with w = a^2 + b^2 */
static inline triple angle_value(const jets *j, const step *s, uint32_t k) {
  clear(s->r->moving, k);
  triple turn = minus(
      convolve(s->a->moving, s->a->degree, s->b, j->order, k), convolve(s->b->moving, s->b->degree, s->a, j->order, k));
  triple known = convolve(s->r->moving, s->degree, s->aux, j->order, k);
  return divide_by(minus(turn, known), s->aux->u, k);
}

static inline triple chosen_value(const jets *j, const step *s, uint32_t k) {
  if (jets_choice(j, s) > 0) return coefficient(s->a->u, k);
  triple none = { 0, 0, 0 };
  return s->op == AMBIT_OP_ABS ? minus(none, coefficient(s->a->u, k)) : coefficient(s->b->u, k);
}

/* r' = other a', other' = -+ r a' */
static inline void pair_value(jets *j, const step *s, uint32_t k) {
  triple sine = over(convolve(s->a->moving, s->a->degree, s->other, j->order, k), k);
  triple cosine = over(convolve(s->a->moving, s->a->degree, s->r, j->order, k), k);
  triple none = { 0, 0, 0 };
  settle(j, s->r, k, sine);
  settle(j, s->other, k, s->op == AMBIT_OP_SIN ? minus(none, cosine) : cosine);
}

static inline triple later_value(const jets *j, const step *s, uint32_t k) {
  switch (s->op) {
  case AMBIT_OP_MUL: return convolve(s->a->u, s->a->degree, s->b, j->order, k);
  case AMBIT_OP_SQR: return convolve(s->a->u, s->a->degree, s->a, j->order, k);
  case AMBIT_OP_DIV: return quotient_value(j, s, k);
  case AMBIT_OP_SQRT: return root_value(j, s, k);
  case AMBIT_OP_EXP: return over(convolve(s->a->moving, s->a->degree, s->r, j->order, k), k);
  case AMBIT_OP_LOG: return logarithmic_value(j, s, s->a, k);
  case AMBIT_OP_ATAN: return logarithmic_value(j, s, s->aux, k);
  case AMBIT_OP_ATAN2: return angle_value(j, s, k);
  default: return chosen_value(j, s, k);
  }
}

static inline void first_value(jets *j, const step *s) {
  bounds r, other;
  j->flags |= jets_start(j, s, &r, &other);
  triple t = of_bounds(r);
  if (s->op == AMBIT_OP_MUL) t = sharpened(convolve(s->a->u, s->a->degree, s->b, j->order, 0), r);
  if (s->op == AMBIT_OP_SQR) t = sharpened(convolve(s->a->u, s->a->degree, s->a, j->order, 0), r);
  settle(j, s->r, 0, t);
  if (s->other != s->r) settle(j, s->other, 0, of_bounds(other));
}

static inline void value(jets *j, const step *s, uint32_t k) {
  triple none = { 0, 0, 0 };
  switch (s->op) {
  case AMBIT_OP_ADD: settle(j, s->r, k, plus(coefficient(s->a->u, k), coefficient(s->b->u, k))); return;
  case AMBIT_OP_SUB: settle(j, s->r, k, minus(coefficient(s->a->u, k), coefficient(s->b->u, k))); return;
  case AMBIT_OP_NEG: settle(j, s->r, k, minus(none, coefficient(s->a->u, k))); return;
  case STEP_COPY: settle(j, s->r, k, coefficient(s->a->u, k)); return;
  default: break;
  }
  if (k == 0)
    first_value(j, s);
  else if (s->other != s->r)
    pair_value(j, s, k);
  else
    settle(j, s->r, k, later_value(j, s, k));
}
