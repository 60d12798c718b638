/* described.c -- AMBIT_FUNCTIONS, by MPFR's function of the same name.
**
** With one operand it increases on its domain. With two its extremes over a box are at corners or where an operand is
** 0, since it is monotone in each on either side of 0. What is outside the domain is left out; a limit at its end is
** what MPFR gives for infinities and at poles.
*/
#include "sets.h"

typedef int (*function_of_pair)(mpfr_ptr r, mpfr_srcptr x, mpfr_srcptr y, mpfr_rnd_t rounding);
#define ONE_1(symbol) mpfr_##symbol
#define ONE_2(symbol) 0
#define TWO_1(symbol) 0
#define TWO_2(symbol) mpfr_##symbol

static const function of_one[] = {
#define ROW(NAME, arity, symbol) ONE_##arity(symbol),
  AMBIT_FUNCTIONS(ROW)
#undef ROW
};
static const function_of_pair of_two[] = {
#define ROW(NAME, arity, symbol) TWO_##arity(symbol),
  AMBIT_FUNCTIONS(ROW)
#undef ROW
};

/* inside := the part of a in the domain; flags */
static uint32_t clipped(const context *c, set *inside, const set *a) {
  const ambit_function_facts *f = c->facts;
  mpfr_set(inside->lo, a->lo, MPFR_RNDD);
  mpfr_set(inside->hi, a->hi, MPFR_RNDU);
  int below = mpfr_cmp_d(a->lo, f->least), above = mpfr_cmp_d(a->hi, f->most);
  if (below < 0) mpfr_set_d(inside->lo, f->least, MPFR_RNDD);
  if (above > 0) mpfr_set_d(inside->hi, f->most, MPFR_RNDU);
  int finite_least = f->least >= -1e308, finite_most = f->most <= 1e308;
  int outside =
      below < 0 || above > 0 || (f->open && finite_least && below == 0) || (f->open && finite_most && above == 0);
  int bare = f->open && (mpfr_cmp_d(inside->hi, f->least) == 0 || mpfr_cmp_d(inside->lo, f->most) == 0);
  uint32_t none = bare || mpfr_cmp(inside->lo, inside->hi) > 0 ? AMBIT_F_EMPTY : 0;
  return none | (outside ? AMBIT_F_PARTIAL : 0);
}

/* the ends of x, and 0 if it is between them */
static int corners(const set *x, mpfr_srcptr at[3], mpfr_srcptr zero) {
  int n = 0;
  at[n++] = x->lo, at[n++] = x->hi;
  if (mpfr_sgn(x->lo) < 0 && mpfr_sgn(x->hi) > 0) at[n++] = zero;
  return n;
}

static void extremes(context *c, function_of_pair f, set *r, const set *a, const set *b) {
  mpfr_srcptr x[3], y[3];
  mpfr_set_zero(c->work[2], 1);
  int nx = corners(a, x, c->work[2]), ny = corners(b, y, c->work[2]);
  for (int i = 0; i < nx; i++)
    for (int j = 0; j < ny; j++) {
      f(c->work[3], x[i], y[j], MPFR_RNDD);
      if ((i == 0 && j == 0) || mpfr_less_p(c->work[3], r->lo)) mpfr_set(r->lo, c->work[3], MPFR_RNDD);
      f(c->work[3], x[i], y[j], MPFR_RNDU);
      if ((i == 0 && j == 0) || mpfr_greater_p(c->work[3], r->hi)) mpfr_set(r->hi, c->work[3], MPFR_RNDU);
    }
}

uint32_t sets_function(context *c, set *r, const set *a, const set *b, int32_t n) {
  uint32_t which = (uint32_t)n - AMBIT_OP_FUNCTIONS;
  set inside = { { *c->work[0] }, { *c->work[1] } };
  uint32_t flags = clipped(c, &inside, a);
  if (flags & AMBIT_F_EMPTY) return sets_none(r, flags);
  if (of_two[which]) {
    extremes(c, of_two[which], r, &inside, b);
  } else {
    of_one[which](r->lo, inside.lo, MPFR_RNDD);
    of_one[which](r->hi, inside.hi, MPFR_RNDU);
  }
  return flags;
}
