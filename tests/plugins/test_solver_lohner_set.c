/* What slopes beyond their midpoints add to a move, from inside: sum_j (S_j - M_j) x_j for every S within its radius,
** and x in the piece or within the rest, is within the bounds, and some corner reaches them. MPFR is the judge. */
#include "solver/lohner/set.h"
#include "num/random.h"
#include <mpfr.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define COLUMNS 2
#define STATES 2
#define DIRECTIONS (COLUMNS + STATES)
#define BITS 300

typedef struct sample {
  field f;
  set x;
  double mid[DIRECTIONS], rad[DIRECTIONS], matrix[DIRECTIONS], from[COLUMNS], to[COLUMNS], rest[STATES], low[STATES];
} sample;

static ambit_random draws = { 1 };
static double between(double lo, double hi) { return ambit_random_in(&draws, (ambit_interval) { lo, hi }); }

static void draw(sample *x) {
  for (size_t j = 0; j < DIRECTIONS; j++) {
    x->mid[j] = between(-2, 2), x->rad[j] = between(0, 0.5);
    x->matrix[j] = x->mid[j] + between(-0.4, 0.4);
  }
  for (size_t j = 0; j < COLUMNS; j++) {
    double a = between(-1, 1), b = between(-1, 1);
    x->from[j] = a < b ? a : b, x->to[j] = a < b ? b : a;
  }
  for (size_t i = 0; i < STATES; i++) x->rest[i] = between(0, 1e-2), x->low[i] = between(-1e-3, 1e-3);
  x->f = (field) { .nx = STATES, .nc = COLUMNS, .ndir = DIRECTIONS };
  x->x = (set) { .rest = x->rest, .low = x->low };
}

/* sum += (mid +- rad - matrix) times the corner of x_j; for a state, x_j = +- (rest + |low|) */
static void add_corner(mpfr_t sum, const sample *x, size_t j, uint32_t corner) {
  mpfr_t slope, at;
  mpfr_inits2(BITS, slope, at, (mpfr_ptr)0);
  mpfr_set_d(slope, x->mid[j], MPFR_RNDN);
  (corner & 1 ? mpfr_add_d : mpfr_sub_d)(slope, slope, x->rad[j], MPFR_RNDN);
  mpfr_sub_d(slope, slope, x->matrix[j], MPFR_RNDN);
  if (j < COLUMNS) {
    mpfr_set_d(at, corner & 2 ? x->to[j] : x->from[j], MPFR_RNDN);
  } else {
    mpfr_set_d(at, x->rest[j - COLUMNS], MPFR_RNDN);
    mpfr_add_d(at, at, x->low[j - COLUMNS] < 0 ? -x->low[j - COLUMNS] : x->low[j - COLUMNS], MPFR_RNDN);
    if (corner & 2) mpfr_neg(at, at, MPFR_RNDN);
  }
  mpfr_fma(sum, slope, at, sum, MPFR_RNDN);
  mpfr_clears(slope, at, (mpfr_ptr)0);
}

static void AMBIT_WORKER beyond(sample *x, double *low, double *high) {
  slopes_beyond(&x->f, &x->x, (balls) { x->mid, x->rad }, x->matrix, (part) { x->from, x->to }, low, high);
}

static void bounds_are_those_of_the_corners(void **unused) {
  (void)unused;
  sample x;
  mpfr_t sum;
  mpfr_init2(sum, BITS);
  for (int n = 0; n < 400; n++) {
    double low, high, least = INFINITY, most = -INFINITY;
    draw(&x);
    ambit_rounding old = ambit_round_up();
    beyond(&x, &low, &high);
    ambit_rounding_restore(old);
    for (uint32_t corner = 0; corner < 1u << (2 * DIRECTIONS); corner++) {
      mpfr_set_zero(sum, 1);
      for (size_t j = 0; j < DIRECTIONS; j++) add_corner(sum, &x, j, corner >> (2 * j) & 3);
      assert_true(mpfr_cmp_d(sum, -low) >= 0 && mpfr_cmp_d(sum, high) <= 0);
      least = fmin(least, mpfr_get_d(sum, MPFR_RNDN)), most = fmax(most, mpfr_get_d(sum, MPFR_RNDN));
    }
    assert_true(high - most < 1e-13 && least + low < 1e-13); /* and not much more */
  }
  mpfr_clear(sum);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(bounds_are_those_of_the_corners) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
