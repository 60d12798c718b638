/* valencia's step from inside: the error at its start covers what the rounded curve p and the rounded frame B leave of
** the set, |p(-1) - P| + |B(-1) - B| w; what is rounded at its end covers |p(1) - P| + |B(1) - B| w. MPFR is the judge.
** The frames differ from the set by up to 1e-3, far more than in a run, so that a part left out shows. */
/* bound_start and round_end are theirs alone */
#include "solver/valencia/frame.c"
#include "solver/valencia/verify.c"
#include "num/random.h"
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

#define STATES 3
#define MONOMIALS 4
#define POINTS 6
#define BITS 300

typedef struct sample {
  valencia s;
  double p[STATES * MONOMIALS], b[STATES * STATES], w[STATES];
  double curve[STATES * MONOMIALS * POINTS], frame[STATES * STATES * POINTS];
  double start[STATES], rounding[STATES], reach[STATES], shift[STATES], generator[3 * STATES * STATES];
} sample;

static ambit_random draws = { 1 };
static double between(double lo, double hi) { return ambit_random_in(&draws, (ambit_interval) { lo, hi }); }

/* |value - sum of side^m c_m| times weight, added to sum; side: 1 or -1 */
static void add_gap(mpfr_t sum, int side, double value, const double *c, double weight) {
  mpfr_t gap;
  mpfr_init2(gap, BITS);
  mpfr_set_d(gap, value, MPFR_RNDN);
  for (uint32_t m = 0; m < POINTS; m++) (side < 0 && m % 2 ? mpfr_add_d : mpfr_sub_d)(gap, gap, c[m], MPFR_RNDN);
  mpfr_abs(gap, gap, MPFR_RNDN);
  mpfr_mul_d(gap, gap, weight, MPFR_RNDN);
  mpfr_add(sum, sum, gap, MPFR_RNDN);
  mpfr_clear(gap);
}

/* Chebyshev coefficients whose polynomial is nearly `value` at -1. */
static void fill(double *c, double value, double off) {
  double left = value;
  for (uint32_t m = 1; m < POINTS; m++) c[m] = between(-1, 1), left += m % 2 ? c[m] : -c[m];
  c[0] = left + between(-off, off);
}

static void draw(sample *x, double off_curve, double off_frame) {
  for (uint32_t k = 0; k < STATES * MONOMIALS; k++) {
    x->p[k] = between(-2, 2);
    fill(x->curve + (size_t)k * POINTS, x->p[k], off_curve);
  }
  for (uint32_t k = 0; k < STATES * STATES; k++) {
    x->b[k] = between(-2, 2);
    fill(x->frame + (size_t)k * POINTS, x->b[k], off_frame);
  }
  for (uint32_t j = 0; j < STATES; j++) x->w[j] = between(0, 3);
  x->s = (valencia) { .nx = STATES,
    .stages.n = POINTS - 1,
    .terms.n = MONOMIALS,
    .p = x->p,
    .b = x->b,
    .w = x->w,
    .curve = x->curve,
    .frame = x->frame,
    .start = x->start,
    .rounding = x->rounding,
    .reach_z = x->reach,
    .shift = x->shift,
    .generator = x->generator };
}

static void AMBIT_WORKER run(valencia *s) { bound_start(s); }

static void check(sample *x) {
  ambit_rounding old = ambit_round_up();
  run(&x->s);
  ambit_rounding_restore(old);
  for (uint32_t i = 0; i < STATES; i++) {
    mpfr_t need;
    mpfr_init2(need, BITS);
    mpfr_set_zero(need, 1);
    for (uint32_t k = 0; k < MONOMIALS; k++)
      add_gap(need, -1, x->p[i * MONOMIALS + k], x->curve + (size_t)(i * MONOMIALS + k) * POINTS, 1);
    for (uint32_t j = 0; j < STATES; j++)
      add_gap(need, -1, x->b[i * STATES + j], x->frame + (size_t)(i * STATES + j) * POINTS, x->w[j]);
    assert_true(mpfr_cmp_d(need, x->start[i]) <= 0);
    mpfr_mul_d(need, need, 1 + 1e-9, MPFR_RNDU);
    mpfr_add_d(need, need, 1e-13, MPFR_RNDU);
    assert_true(mpfr_cmp_d(need, x->start[i]) >= 0); /* and not much more */
    mpfr_clear(need);
  }
}

static void AMBIT_WORKER finish(valencia *s, double *left) { round_end(s, left); }

static void check_end(sample *x) {
  double left[STATES];
  ambit_rounding old = ambit_round_up();
  finish(&x->s, left);
  ambit_rounding_restore(old);
  for (uint32_t i = 0; i < STATES; i++) {
    mpfr_t need;
    mpfr_init2(need, BITS);
    mpfr_set_zero(need, 1);
    for (uint32_t k = 0; k < MONOMIALS; k++)
      add_gap(need, 1, x->p[i * MONOMIALS + k], x->curve + (size_t)(i * MONOMIALS + k) * POINTS, 1);
    for (uint32_t j = 0; j < STATES; j++)
      add_gap(need, 1, x->generator[i * 3 * STATES + j], x->frame + (size_t)(i * STATES + j) * POINTS, x->w[j]);
    assert_true(mpfr_cmp_d(need, left[i]) <= 0);
    assert_true(left[i] < 1e-11);
    mpfr_clear(need);
  }
}

static void end_covers_what_is_rounded(void **unused) {
  (void)unused;
  sample x;
  for (int n = 0; n < 2000; n++) {
    draw(&x, 1e-3, 1e-3);
    for (uint32_t j = 0; j < STATES; j++) x.w[j] *= n % 2 ? 1 : 100, x.shift[j] = 0;
    check_end(&x);
  }
}

static void start_covers_curve_and_frame(void **unused) {
  (void)unused;
  static const double off[] = { 0, 1e-15, 1e-3 };
  sample x;
  for (int n = 0; n < 2000; n++) {
    draw(&x, off[n % 3], off[n / 3 % 3]);
    check(&x);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(start_covers_curve_and_frame),
    cmocka_unit_test(end_covers_what_is_rounded) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
