/* functions.c -- monotone functions at the ends of their operands, cosh at the sizes, and atan2 at the corners. */
#include "sets.h"

static void rising(set *r, const set *a, function f) {
  f(r->lo, a->lo, MPFR_RNDD);
  f(r->hi, a->hi, MPFR_RNDU);
}

#define RISING(OP, f)                                                                                                  \
  uint32_t sets_##OP(context *c, set *r, const set *a, const set *b, int32_t n) {                                      \
    (void)c, (void)b, (void)n;                                                                                         \
    rising(r, a, f);                                                                                                   \
    return 0;                                                                                                          \
  }
RISING(EXP, mpfr_exp)
RISING(ATAN, mpfr_atan)
RISING(SINH, mpfr_sinh)
RISING(TANH, mpfr_tanh)

uint32_t sets_LOG(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)b, (void)n;
  uint32_t flags = mpfr_sgn(a->lo) <= 0 ? AMBIT_F_PARTIAL : 0;
  if (mpfr_sgn(a->hi) <= 0) return sets_none(r, flags);
  rising(r, a, mpfr_log);
  if (flags) mpfr_set_inf(r->lo, -1);
  return flags;
}

uint32_t sets_COSH(context *c, set *r, const set *a, const set *b, int32_t n) {
  set size = { { *c->work[2] }, { *c->work[3] } };
  sets_ABS(c, &size, a, b, n);
  rising(r, &size, mpfr_cosh);
  return 0;
}

/* -- arcs: what is outside [-1, 1] is left out */

static uint32_t clipped(context *c, set *inside, const set *a) {
  *inside = (set) { { *c->work[0] }, { *c->work[1] } };
  mpfr_set(inside->lo, a->lo, MPFR_RNDD);
  mpfr_set(inside->hi, a->hi, MPFR_RNDU);
  int below = mpfr_cmp_si(a->lo, -1)<0, above = mpfr_cmp_si(a->hi, 1)> 0;
  if (below) mpfr_set_si(inside->lo, -1, MPFR_RNDD);
  if (above) mpfr_set_si(inside->hi, 1, MPFR_RNDU);
  uint32_t none = mpfr_cmp(inside->lo, inside->hi) > 0 ? AMBIT_F_EMPTY : 0;
  return none | (below || above ? AMBIT_F_PARTIAL : 0);
}

uint32_t sets_ASIN(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b, (void)n;
  set inside;
  uint32_t flags = clipped(c, &inside, a);
  if (flags & AMBIT_F_EMPTY) return sets_none(r, flags);
  rising(r, &inside, mpfr_asin);
  return flags;
}

uint32_t sets_ACOS(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b, (void)n;
  set inside;
  uint32_t flags = clipped(c, &inside, a);
  if (flags & AMBIT_F_EMPTY) return sets_none(r, flags);
  mpfr_acos(r->lo, inside.hi, MPFR_RNDD);
  mpfr_acos(r->hi, inside.lo, MPFR_RNDU);
  return flags;
}

/* -- the angle of (x, y). Above the axis y = 0 it falls with x, and rises with y where x > 0, falls where x < 0. Below
** it is minus the angle of (x, -y). Corners are never (0, 0) and never both infinite. */

static void angle_above(set *r, const set *y, const set *x) {
  mpfr_atan2(r->lo, mpfr_sgn(x->hi) > 0 ? y->lo : y->hi, x->hi, MPFR_RNDD);
  mpfr_atan2(r->hi, mpfr_sgn(x->lo) < 0 ? y->lo : y->hi, x->lo, MPFR_RNDU);
}

static void angle_below(set *r, const set *y, const set *x) {
  mpfr_atan2(r->lo, mpfr_sgn(x->lo) < 0 ? y->hi : y->lo, x->lo, MPFR_RNDD);
  mpfr_atan2(r->hi, mpfr_sgn(x->hi) > 0 ? y->hi : y->lo, x->hi, MPFR_RNDU);
}

/* y = 0: the angle is 0 for x > 0 and pi for x < 0 */
static uint32_t angle_on_axis(set *r, const set *x, uint32_t flags) {
  int left = mpfr_sgn(x->lo)<0, right = mpfr_sgn(x->hi)> 0;
  if (!left && !right) return sets_none(r, flags);
  sets_hull_of(r, 0, 0);
  if (left) mpfr_const_pi(r->hi, MPFR_RNDU);
  if (!right) mpfr_const_pi(r->lo, MPFR_RNDD);
  return flags;
}

uint32_t sets_ATAN2(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)n;
  int up = mpfr_sgn(a->hi) > 0, down = mpfr_sgn(a->lo) < 0, left = mpfr_sgn(b->lo) < 0;
  int through = mpfr_sgn(a->lo) <= 0 && mpfr_sgn(a->hi) >= 0; /* meets y = 0 */
  uint32_t flags = through && mpfr_sgn(b->lo) <= 0 && mpfr_sgn(b->hi) >= 0 ? AMBIT_F_PARTIAL : 0;
  if (!up && !down) return angle_on_axis(r, b, flags);
  if (left && down && through) { /* across the cut: from -pi, which is not reached, to pi */
    mpfr_const_pi(r->hi, MPFR_RNDU);
    mpfr_neg(r->lo, r->hi, MPFR_RNDD);
  } else if (!down) {
    angle_above(r, a, b);
  } else if (!up) {
    angle_below(r, a, b);
  } else {
    mpfr_atan2(r->lo, a->lo, b->lo, MPFR_RNDD);
    mpfr_atan2(r->hi, a->hi, b->lo, MPFR_RNDU);
  }
  return flags;
}
