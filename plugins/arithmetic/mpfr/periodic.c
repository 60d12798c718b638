/* periodic.c -- sin, cos and tan: extrema and poles are counted by signs of the derivative.
**
** A piece of the operand that is shorter than pi holds at most one zero of the derivative (-sin or cos). So it holds
** one strictly inside if and only if the derivative has opposite signs at its ends: falling from + to -, the function
** reaches 1 there, otherwise -1; and else it is monotone on the piece. MPFR's correctly rounded values have the right
** signs at any argument. Operands up to 2 pi wide are cut in three. Poles of the tangent are the zeros of the cosine.
** An argument whose exponent is beyond every double's would need as many bits of pi: then nothing is said about it.
*/
#include "sets.h"

#define LARGEST_EXPONENT 65536

enum { POINTS = 4 };

typedef struct cut { /* the operand's ends and what is between, pieces shorter than pi */
  mpfr_srcptr at[POINTS];
  int count;
} cut;

static int is_huge(mpfr_srcptr x) { return !mpfr_zero_p(x) && mpfr_get_exp(x) > LARGEST_EXPONENT; }

/* 0: wider than 2 pi, or too large to reduce */
static int cut_up(context *c, const set *a, cut *p) {
  if (!mpfr_number_p(a->lo) || !mpfr_number_p(a->hi) || is_huge(a->lo) || is_huge(a->hi)) return 0;
  mpfr_ptr width = c->fine[0], step = c->fine[2];
  mpfr_sub(width, a->hi, a->lo, MPFR_RNDU);
  if (mpfr_cmp_d(width, 6.2832) > 0) return 0;
  if (mpfr_cmp_d(width, 3.14) < 0) {
    *p = (cut) { { a->lo, a->hi }, 2 };
    return 1;
  }
  mpfr_div_ui(step, width, 3, MPFR_RNDN); /* at most 2.0945, and 64 bits finer than the ends */
  mpfr_add(c->fine[1], a->lo, step, MPFR_RNDN);
  mpfr_sub(c->fine[0], a->hi, step, MPFR_RNDN);
  *p = (cut) { { a->lo, c->fine[1], c->fine[0], a->hi }, POINTS };
  return 1;
}

/* sign of the derivative: of the sine cos x, of the cosine -sin x */
static int slope_sign(context *c, mpfr_srcptr x, int of_sine) {
  if (of_sine)
    mpfr_cos(c->work[0], x, MPFR_RNDN);
  else
    mpfr_sin(c->work[0], x, MPFR_RNDN);
  return of_sine ? mpfr_sgn(c->work[0]) : -mpfr_sgn(c->work[0]);
}

static uint32_t wave(context *c, set *r, const set *a, int of_sine) {
  function f = of_sine ? mpfr_sin : mpfr_cos;
  cut p;
  sets_hull_of(r, -1, 1);
  if (!cut_up(c, a, &p)) return 0;
  mpfr_ptr least = c->work[1], greatest = c->work[2], value = c->work[3];
  mpfr_set_inf(least, 1);
  mpfr_set_inf(greatest, -1);
  for (int i = 0, sign = 0; i < p.count; i++) {
    f(value, p.at[i], MPFR_RNDD);
    mpfr_min(least, least, value, MPFR_RNDD);
    f(value, p.at[i], MPFR_RNDU);
    mpfr_max(greatest, greatest, value, MPFR_RNDU);
    int before = sign;
    sign = slope_sign(c, p.at[i], of_sine);
    if (before * sign < 0) mpfr_set_si(before > 0 ? greatest : least, before, MPFR_RNDN);
  }
  mpfr_set(r->lo, least, MPFR_RNDD);
  mpfr_set(r->hi, greatest, MPFR_RNDU);
  return 0;
}

uint32_t sets_SIN(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b, (void)n;
  return wave(c, r, a, 1);
}

uint32_t sets_COS(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b, (void)n;
  return wave(c, r, a, 0);
}

uint32_t sets_TAN(context *c, set *r, const set *a, const set *b, int32_t n) {
  (void)b, (void)n;
  cut p;
  int whole = cut_up(c, a, &p), first = whole ? slope_sign(c, a->lo, 1) : 0;
  for (int i = 1; whole && i < p.count; i++) whole = slope_sign(c, p.at[i], 1) == first;
  if (!whole) {
    sets_entire(r);
    return AMBIT_F_PARTIAL;
  }
  mpfr_tan(r->lo, a->lo, MPFR_RNDD);
  mpfr_tan(r->hi, a->hi, MPFR_RNDU);
  return 0;
}
