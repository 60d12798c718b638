/* basic.c -- + - * / and what follows from them: bounds at the ends of the operands, chosen by signs (IEEE 1788-2015
** set-based; an infinite bound is no element of the set, so 0 times it is 0).
*/
#include "sets.h"

uint32_t sets_none(set *r, uint32_t flags) {
  mpfr_set_nan(r->lo);
  mpfr_set_nan(r->hi);
  return flags | AMBIT_F_EMPTY;
}

void sets_entire(set *r) {
  mpfr_set_inf(r->lo, -1);
  mpfr_set_inf(r->hi, 1);
}

void sets_hull_of(set *r, long lo, long hi) {
  mpfr_set_si(r->lo, lo, MPFR_RNDD);
  mpfr_set_si(r->hi, hi, MPFR_RNDU);
}

uint32_t sets_ADD(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)n;
  mpfr_add(r->lo, a->lo, b->lo, MPFR_RNDD);
  mpfr_add(r->hi, a->hi, b->hi, MPFR_RNDU);
  return 0;
}

uint32_t sets_SUB(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)n;
  mpfr_sub(r->lo, a->lo, b->hi, MPFR_RNDD);
  mpfr_sub(r->hi, a->hi, b->lo, MPFR_RNDU);
  return 0;
}

uint32_t sets_NEG(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)b, (void)n;
  mpfr_neg(r->lo, a->hi, MPFR_RNDD);
  mpfr_neg(r->hi, a->lo, MPFR_RNDU);
  return 0;
}

/* -- products */

static void times(mpfr_ptr r, mpfr_srcptr x, mpfr_srcptr y, mpfr_rnd_t rounding) {
  if (mpfr_zero_p(x) || mpfr_zero_p(y))
    mpfr_set_zero(r, 1);
  else
    mpfr_mul(r, x, y, rounding);
}

/* both hold negative and positive numbers */
static void times_mixed(context *c, set *r, const set *a, const set *b) {
  times(c->work[0], a->lo, b->hi, MPFR_RNDD);
  times(r->lo, a->hi, b->lo, MPFR_RNDD);
  mpfr_min(r->lo, r->lo, c->work[0], MPFR_RNDD);
  times(c->work[0], a->lo, b->lo, MPFR_RNDU);
  times(r->hi, a->hi, b->hi, MPFR_RNDU);
  mpfr_max(r->hi, r->hi, c->work[0], MPFR_RNDU);
}

/* each bound of a set of one sign times the end of b that makes it extreme */
uint32_t sets_MUL(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)n;
  int a_up = mpfr_sgn(a->lo) >= 0, a_down = mpfr_sgn(a->hi) <= 0;
  int b_up = mpfr_sgn(b->lo) >= 0, b_down = mpfr_sgn(b->hi) <= 0;
  if (b_up) {
    times(r->lo, a->lo, a_up ? b->lo : b->hi, MPFR_RNDD);
    times(r->hi, a->hi, a_down ? b->lo : b->hi, MPFR_RNDU);
  } else if (b_down) {
    times(r->lo, a->hi, a_down ? b->hi : b->lo, MPFR_RNDD);
    times(r->hi, a->lo, a_up ? b->hi : b->lo, MPFR_RNDU);
  } else if (a_up) {
    times(r->lo, a->hi, b->lo, MPFR_RNDD);
    times(r->hi, a->hi, b->hi, MPFR_RNDU);
  } else if (a_down) {
    times(r->lo, a->lo, b->hi, MPFR_RNDD);
    times(r->hi, a->lo, b->lo, MPFR_RNDU);
  } else {
    times_mixed(c, r, a, b);
  }
  return 0;
}

/* -- quotients */

/* b >= 0 and not {0}; its 0 is left out. An infinite end of b gives 0; a 0 of b gives infinity of the sign of a. */
void sets_divide_by_positive(set *r, const set *a, const set *b) {
  int open = mpfr_zero_p(b->lo);
  if (mpfr_sgn(a->lo) >= 0)
    mpfr_div(r->lo, a->lo, b->hi, MPFR_RNDD);
  else if (open)
    mpfr_set_inf(r->lo, -1);
  else
    mpfr_div(r->lo, a->lo, b->lo, MPFR_RNDD);
  if (mpfr_sgn(a->hi) <= 0)
    mpfr_div(r->hi, a->hi, b->hi, MPFR_RNDU);
  else if (open)
    mpfr_set_inf(r->hi, 1);
  else
    mpfr_div(r->hi, a->hi, b->lo, MPFR_RNDU);
}

/* -x on the digits of x */
static set turned(const set *x) {
  set r = { { *x->hi }, { *x->lo } };
  mpfr_custom_init_set(r.lo, -mpfr_custom_get_kind(x->hi), mpfr_custom_get_exp(x->hi), mpfr_get_prec(x->hi),
      mpfr_custom_get_significand(x->hi));
  mpfr_custom_init_set(r.hi, -mpfr_custom_get_kind(x->lo), mpfr_custom_get_exp(x->lo), mpfr_get_prec(x->lo),
      mpfr_custom_get_significand(x->lo));
  return r;
}

uint32_t sets_DIV(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)n;
  int down = mpfr_sgn(b->lo)<0, up = mpfr_sgn(b->hi)> 0;
  int partial = mpfr_sgn(b->lo) <= 0 && mpfr_sgn(b->hi) >= 0;
  uint32_t flags = partial ? AMBIT_F_PARTIAL : 0;
  if (!down && !up) return sets_none(r, flags);
  if (mpfr_zero_p(a->lo) && mpfr_zero_p(a->hi)) {
    sets_hull_of(r, 0, 0);
  } else if (down && up) {
    sets_entire(r);
  } else if (up) {
    sets_divide_by_positive(r, a, b);
  } else {
    const set x = turned(a), y = turned(b);
    sets_divide_by_positive(r, &x, &y);
  }
  return flags;
}

/* -- powers, roots, sizes */

/* the least and the greatest |v| in working numbers; exact */
static void sizes(context *c, const set *a, mpfr_ptr least, mpfr_ptr greatest) {
  (void)c;
  mpfr_abs(least, a->lo, MPFR_RNDN);
  mpfr_abs(greatest, a->hi, MPFR_RNDN);
  if (mpfr_cmp(least, greatest) > 0) mpfr_swap(least, greatest);
  if (mpfr_sgn(a->lo) < 0 && mpfr_sgn(a->hi) > 0) mpfr_set_zero(least, 1);
}

uint32_t sets_ABS(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b, (void)n;
  sizes(c, a, c->work[0], c->work[1]);
  mpfr_set(r->lo, c->work[0], MPFR_RNDD);
  mpfr_set(r->hi, c->work[1], MPFR_RNDU);
  return 0;
}

uint32_t sets_SQR(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b, (void)n;
  sizes(c, a, c->work[0], c->work[1]);
  mpfr_sqr(r->lo, c->work[0], MPFR_RNDD);
  mpfr_sqr(r->hi, c->work[1], MPFR_RNDU);
  return 0;
}

uint32_t sets_SQRT(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)b, (void)n;
  uint32_t flags = mpfr_sgn(a->lo) < 0 ? AMBIT_F_PARTIAL : 0;
  if (mpfr_sgn(a->hi) < 0) return sets_none(r, flags);
  if (flags)
    mpfr_set_zero(r->lo, 1);
  else
    mpfr_sqrt(r->lo, a->lo, MPFR_RNDD);
  mpfr_sqrt(r->hi, a->hi, MPFR_RNDU);
  return flags;
}

/* x^n for n < 0 on both sides of 0: falling in |x|; MPFR gives (+0)^n = inf */
static void negative_power(context *c, set *r, const set *a, long n) {
  int odd = n % 2 != 0, down = mpfr_sgn(a->lo)<0, up = mpfr_sgn(a->hi)> 0;
  if (odd && down && up) {
    sets_entire(r);
  } else if (odd) {
    mpfr_pow_si(r->lo, a->hi, n, MPFR_RNDD);
    mpfr_pow_si(r->hi, a->lo, n, MPFR_RNDU);
    if (mpfr_zero_p(a->hi)) mpfr_set_inf(r->lo, -1);
  } else {
    sizes(c, a, c->work[0], c->work[1]);
    mpfr_pow_si(r->lo, c->work[1], n, MPFR_RNDD);
    mpfr_pow_si(r->hi, c->work[0], n, MPFR_RNDU);
  }
}

static void positive_power(context *c, set *r, const set *a, long n) {
  mpfr_srcptr least = a->lo, greatest = a->hi;
  if (n % 2 == 0) sizes(c, a, c->work[0], c->work[1]), least = c->work[0], greatest = c->work[1];
  mpfr_pow_si(r->lo, least, n, MPFR_RNDD);
  mpfr_pow_si(r->hi, greatest, n, MPFR_RNDU);
}

uint32_t sets_POWN(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b;
  if (n == 0) sets_hull_of(r, 1, 1);
  if (n > 0) positive_power(c, r, a, n);
  if (n >= 0) return 0;
  uint32_t flags = mpfr_sgn(a->lo) <= 0 && mpfr_sgn(a->hi) >= 0 ? AMBIT_F_PARTIAL : 0;
  if (mpfr_zero_p(a->lo) && mpfr_zero_p(a->hi)) return sets_none(r, flags);
  negative_power(c, r, a, n);
  return flags;
}

uint32_t sets_MIN(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)n;
  mpfr_min(r->lo, a->lo, b->lo, MPFR_RNDD);
  mpfr_min(r->hi, a->hi, b->hi, MPFR_RNDU);
  return 0;
}

uint32_t sets_MAX(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)c, (void)n;
  mpfr_max(r->lo, a->lo, b->lo, MPFR_RNDD);
  mpfr_max(r->hi, a->hi, b->hi, MPFR_RNDU);
  return 0;
}
