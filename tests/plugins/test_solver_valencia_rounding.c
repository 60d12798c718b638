/* valencia's step from inside: the error at its start covers what the rounded curve p and the rounded frame B leave of
** the set, |p(-1) - P| + |B(-1) - B| w; what is rounded at its end covers |p(1) - P| + |B(1) - B| w; the frame of the
** next step holds every sum of generators. MPFR is the judge. The frames differ from the set by up to 1e-3, far more
** than in a run, so that a part left out shows. */
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

/* -- the next frame: sum_c g_c e_c weight_c = B y with |y| <= w for all |e_c| <= 1 */

typedef struct move {
  sample end;
  double basis[STATES * STATES], last[STATES], error[STATES], tube[STATES], scale[STATES], shape[3 * STATES * STATES];
  double sum[3 * STATES], directions[STATES * STATES], next_w[STATES], scratch[STATES], before[STATES];
  uint32_t first[STATES + 1];
} move;

/* size: of the generators; scale: of the states, which may be so much larger that quotients underflow */
static void draw_move(move *m, double size, double scale, int blocks) {
  sample *x = &m->end;
  draw(x, 1e-3, 1e-3);
  for (size_t k = 0; k < sizeof x->frame / sizeof *x->frame; k++) x->frame[k] *= size;
  for (size_t k = 0; k < sizeof x->curve / sizeof *x->curve; k++) x->curve[k] = scale > 1e30 ? 0 : x->curve[k];
  for (uint32_t j = 0; j < STATES; j++) {
    for (uint32_t i = 0; i < STATES; i++) m->basis[i * STATES + j] = size * between(-1, 1);
    m->last[j] = size == 1 ? between(0, 1e-3) : 0, m->error[j] = 0, m->tube[j] = 1, m->scale[j] = scale;
    m->before[j] = x->w[j], x->shift[j] = 0;
  }
  for (uint32_t j = 0; j <= STATES; j++) m->first[j] = blocks && j ? j + (j < STATES) : j;
  valencia *s = &x->s;
  s->basis = (basis) { .v = m->basis, .first = m->first, .nblock = blocks ? STATES - 1 : STATES };
  s->last = m->last, s->error = m->error, s->tube_lo = s->tube_hi = m->tube, s->scale = m->scale, s->shape = m->shape;
  s->sum = m->sum, s->directions = m->directions, s->next_w = m->next_w, s->scratch = m->scratch, s->frozen = 0;
}

static void AMBIT_WORKER next_frame(valencia *s) { valencia_move(s); }

static void determinant(mpfr_t r, mpfr_t a[STATES][STATES]) {
  mpfr_t x;
  mpfr_init2(x, BITS);
  mpfr_set_zero(r, 1);
  for (uint32_t j = 0; j < STATES; j++)
    for (int side = 1; side <= 2; side++) { /* Sarrus' rule */
      uint32_t second = (j + (uint32_t)side) % STATES, third = (j + 3 - (uint32_t)side) % STATES;
      mpfr_mul(x, a[0][j], a[1][second], MPFR_RNDN);
      mpfr_mul(x, x, a[2][third], MPFR_RNDN);
      (side == 1 ? mpfr_add : mpfr_sub)(r, r, x, MPFR_RNDN);
    }
  mpfr_clear(x);
}

/* r := component k of B^-1 g, by Cramer's rule; g [STATES] the column c of the generators */
static void component(mpfr_t r, const sample *x, uint32_t k, uint32_t c) {
  mpfr_t a[STATES][STATES], whole;
  mpfr_init2(whole, BITS);
  for (int with = 0; with < 2; with++) {
    for (uint32_t i = 0; i < STATES; i++)
      for (uint32_t j = 0; j < STATES; j++) {
        if (!with) mpfr_init2(a[i][j], BITS);
        mpfr_set_d(a[i][j], with && j == k ? x->generator[i * 3 * STATES + c] : x->b[i * STATES + j], MPFR_RNDN);
      }
    determinant(with ? r : whole, a);
  }
  mpfr_div(r, r, whole, MPFR_RNDN);
  for (uint32_t i = 0; i < STATES; i++)
    for (uint32_t j = 0; j < STATES; j++) mpfr_clear(a[i][j]);
  mpfr_clear(whole);
}

/* the weights are those that the parts of the end had: of the old frame, of r, of what was rounded */
static void check_move(move *m) {
  sample *x = &m->end;
  double weight[3 * STATES];
  ambit_rounding old = ambit_round_up();
  finish(&x->s, weight + 2 * STATES);
  for (uint32_t j = 0; j < STATES; j++) weight[j] = m->before[j];
  for (uint32_t b = 0; b < x->s.basis.nblock; b++)
    for (uint32_t j = m->first[b]; j < m->first[b + 1]; j++) weight[STATES + j] = m->last[b];
  next_frame(&x->s);
  ambit_rounding_restore(old);
  for (uint32_t k = 0; k < STATES; k++) {
    mpfr_t need, part;
    mpfr_init2(need, BITS), mpfr_init2(part, BITS);
    mpfr_set_zero(need, 1);
    for (uint32_t c = 0; c < 3 * STATES; c++) {
      component(part, x, k, c);
      mpfr_abs(part, part, MPFR_RNDN);
      mpfr_mul_d(part, part, weight[c], MPFR_RNDN);
      mpfr_add(need, need, part, MPFR_RNDN);
    }
    assert_true(mpfr_cmp_d(need, x->w[k]) <= 0);
    mpfr_mul_d(need, need, 1 + 1e-9, MPFR_RNDU);
    mpfr_add_d(need, need, 1e-13, MPFR_RNDU);
    assert_true(mpfr_cmp_d(need, x->w[k]) >= 0); /* and not much more */
    mpfr_clear(need), mpfr_clear(part);
  }
}

static void next_frame_holds_the_generators(void **unused) {
  (void)unused;
  static const double size[] = { 1, 1, 1e-200, 1e-308 }, scale[] = { 1, 256, 0x1p400, 0x1p900 };
  move m;
  for (int n = 0; n < 4000; n++) {
    draw_move(&m, size[n % 4], scale[n % 4], n / 4 % 2);
    check_move(&m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(start_covers_curve_and_frame),
    cmocka_unit_test(end_covers_what_is_rounded), cmocka_unit_test(next_frame_holds_the_generators) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
