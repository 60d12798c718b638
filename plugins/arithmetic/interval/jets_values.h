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

INLINE triple plus(triple a, triple b) { return (triple) { a.h + b.h, a.l + b.l, a.r + b.r }; }
INLINE triple minus(triple a, triple b) { return (triple) { a.h + b.l, a.l + b.h, a.r + b.r }; }
INLINE triple over(triple a, double positive) { return (triple) { a.h / positive, a.l / positive, a.r / positive }; }
INLINE triple coefficient(row a, uint32_t k) { return (triple) { a.mid[k], -a.mid[k], a.rad[k] }; }
INLINE triple times_order(row a, uint32_t k) {
  double order = k;
  return (triple) { order * a.mid[k], order * -a.mid[k], order * a.rad[k] };
}

typedef struct vectors { /* sets [-(l + r + q), h + r + q] */
  vector h, l, r, q;
} vectors;

INLINE void add_products(vectors *s, vector a, vector ra, vector b, vector rb) {
  s->h = multiply_add(a, b, s->h);
  s->l = subtract_product(a, b, s->l);
  s->r = multiply_add(magnitude(a), rb, s->r);
  s->q = multiply_add(ra, magnitude(b) + rb, s->q);
}

INLINE triple total(vectors s) {
  vector hl = firsts(s.h, s.l) + seconds(s.h, s.l), r = s.r + s.q;
#if WIDTH == 4
  return (triple) { hl[0] + hl[2], hl[1] + hl[3], (r[0] + r[1]) + (r[2] + r[3]) };
#else
  return (triple) { hl[0], hl[1], r[0] + r[1] };
#endif
}

/* Exactly n terms: what lies behind may have been written a moment ago, and then a vector that covers it would wait. */
INLINE triple dot_rows(const double *am, const double *ar, const double *bm, const double *br, size_t n) {
  vectors s = { splat(0), splat(0), splat(0), splat(0) };
  size_t i = 0;
  for (; i + WIDTH <= n; i += WIDTH) add_products(&s, load(am + i), load(ar + i), load(bm + i), load(br + i));
#if WIDTH == 4
  if (n & 2) add_products(&s, load_two(am + i), load_two(ar + i), load_two(bm + i), load_two(br + i)), i += 2;
#endif
  if (n & 1) add_products(&s, load_one(am + i), load_one(ar + i), load_one(bm + i), load_one(br + i));
  return total(s);
}

/* The terms a_j b_(k-j), 0 < j < k. */
INLINE triple inner_sum(const factors *f, uint32_t order, uint32_t k) {
  uint32_t from = k > f->db ? k - f->db : 1, to = k <= f->da ? k - 1 : f->da;
  size_t at = order - k + from, n = from <= to ? to - from + 1 : 0;
  return dot_rows(f->a.mid + from, f->a.rad + from, f->b.mid + at, f->b.rad + at, n);
}

/* scalar multiply_add, subtract_product */
INLINE double scalar_add(double a, double b, double c) {
#if WIDTH == 4
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}

/* t + a_i b_k */
INLINE triple with_term(triple t, row a, uint32_t i, row b, uint32_t k) {
  double mid = a.mid[i], other = b.mid[k], rad = b.rad[k];
  t.h = scalar_add(mid, other, t.h);
  t.l = scalar_add(-mid, other, t.l);
  t.r = scalar_add(a.rad[i], fabs(other) + rad, scalar_add(fabs(mid), rad, t.r));
  return t;
}

/* t / (scale * b_0); a divisor with 0 gives infinities, which `settle` reports */
INLINE triple divide_by(triple t, row b, double scale) {
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
INLINE void spread(const slot *s, uint32_t order, uint32_t k) {
  double mid = s->u.mid[k], rad = s->u.rad[k];
  if (s->reversed.mid) s->reversed.mid[order - k] = mid, s->reversed.rad[order - k] = rad;
  if (!s->moving.mid) return;
  double up = (double)k * mid, down = (double)k * -mid;
  s->moving.mid[k] = up;
  s->moving.rad[k] = (double)k * rad + (up + down);
}

/* An infinite or undefined midpoint has a radius that is infinite or undefined: h - mid and mid + l cannot both be
** bounded then. */
INLINE void settle(jets *j, const slot *s, uint32_t k, triple t) {
  double mid = 0.5 * (t.h - t.l), above = t.h - mid, below = mid + t.l;
  double rad = t.r + (above > below ? above : below);
  if (!(rad < DBL_MAX)) {
    mid = 0, rad = DBL_MAX;
    j->flags |= AMBIT_F_UNBOUNDED;
  }
  s->u.mid[k] = mid, s->u.rad[k] = rad;
  spread(s, j->order, k);
}

INLINE triple of_bounds(bounds b) { return (triple) { b.hi, -b.lo, 0 }; }

/* order 0 of a product also as a product of intervals: tighter for wide operands, as the other is for thin ones */
INLINE triple sharpened(triple t, bounds b) {
  return of_bounds(jets_intersect((bounds) { -(t.l + t.r), t.h + t.r }, b));
}

/* coefficient k > 0 of a * b from its inner terms */
INLINE triple product_value(triple inner, const slot *a, const slot *b, uint32_t k) {
  return with_term(with_term(inner, a->u, 0, b->u, k), a->u, k, b->u, 0);
}

INLINE triple quotient_value(triple inner, const step *s, uint32_t k) {
  triple known = with_term(inner, s->r->u, 0, s->b->u, k);
  return divide_by(minus(coefficient(s->a->u, k), known), s->b->u, 1);
}

INLINE triple root_value(triple inner, const step *s, uint32_t k) {
  return divide_by(minus(coefficient(s->a->u, k), inner), s->r->u, 2);
}

/* LOG: u r' = u';  ATAN: w r' = u' with w = 1 + u^2 */
INLINE triple logarithmic_value(triple inner, const step *s, const slot *w, uint32_t k) {
  return divide_by(minus(times_order(s->a->u, k), inner), w->u, k);
}

/* of a' f; the term of a'_0 is 0 */
INLINE triple derived_value(triple inner, const slot *a, const slot *f, uint32_t k) {
  return with_term(inner, a->moving, k, f->u, 0);
}

/* w r' = b a' - a b' with w = a^2 + b^2 */
INLINE triple angle_value(const triple *inner, const step *s, uint32_t k) {
  triple turn = minus(derived_value(inner[1], s->a, s->b, k), derived_value(inner[2], s->b, s->a, k));
  return divide_by(minus(turn, inner[0]), s->aux->u, k);
}

INLINE triple chosen_value(const jets *j, const step *s, uint32_t k) {
  if (jets_choice(j, s) > 0) return coefficient(s->a->u, k);
  triple none = { 0, 0, 0 };
  return s->op == AMBIT_OP_ABS ? minus(none, coefficient(s->a->u, k)) : coefficient(s->b->u, k);
}

/* r' = other a', other' = -+ r a'; returns r */
INLINE triple pair_value(jets *j, const triple *inner, const step *s, uint32_t k) {
  triple cosine = over(derived_value(inner[1], s->a, s->r, k), k), none = { 0, 0, 0 };
  settle(j, s->other, k, s->op == AMBIT_OP_SIN ? minus(none, cosine) : cosine);
  return over(derived_value(inner[0], s->a, s->other, k), k);
}

/* any but ADD, SUB, NEG */
INLINE triple later_value(jets *j, const step *s, uint32_t k) {
  triple inner[3];
  for (uint32_t i = 0; i < s->nproduct; i++) inner[i] = inner_sum(&s->product[i], j->order, k);
  switch (s->op) {
  case AMBIT_OP_MUL: return product_value(inner[0], s->a, s->b, k);
  case AMBIT_OP_SQR: return product_value(inner[0], s->a, s->a, k);
  case AMBIT_OP_DIV: return quotient_value(inner[0], s, k);
  case AMBIT_OP_SQRT: return root_value(inner[0], s, k);
  case AMBIT_OP_EXP: return over(derived_value(inner[0], s->a, s->r, k), k);
  case AMBIT_OP_TANH: return over(derived_value(inner[0], s->a, s->aux, k), k);
  case AMBIT_OP_LOG: return logarithmic_value(inner[0], s, s->a, k);
  case AMBIT_OP_ATAN: return logarithmic_value(inner[0], s, s->aux, k);
  case AMBIT_OP_ATAN2: return angle_value(inner, s, k);
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return chosen_value(j, s, k);
  default: return pair_value(j, inner, s, k);
  }
}

INLINE triple first_value(jets *j, const step *s) {
  bounds r, other;
  j->flags |= jets_start(j, s, &r, &other);
  if (s->other != s->r) settle(j, s->other, 0, of_bounds(other));
  const triple none = { 0, 0, 0 };
  const slot *b = s->op == AMBIT_OP_MUL ? s->b : s->a;
  if (s->op == AMBIT_OP_MUL || s->op == AMBIT_OP_SQR) return sharpened(with_term(none, s->a->u, 0, b->u, 0), r);
  return of_bounds(r);
}

INLINE triple any_value(jets *j, const step *s, uint32_t k) {
  triple none = { 0, 0, 0 };
  switch (s->op) {
  case AMBIT_OP_ADD: return plus(coefficient(s->a->u, k), coefficient(s->b->u, k));
  case AMBIT_OP_SUB: return minus(coefficient(s->a->u, k), coefficient(s->b->u, k));
  case AMBIT_OP_NEG: return minus(none, coefficient(s->a->u, k));
  case STEP_COPY: return coefficient(s->a->u, k);
  default: return k ? later_value(j, s, k) : first_value(j, s);
  }
}

INLINE void value(jets *j, const step *s, uint32_t k) { settle(j, s->r, k, any_value(j, s, k)); }
