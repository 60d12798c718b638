/* Sine and cosine to twice the digits, against 300 bits: everywhere, near right angles, tiny, and too large. */
#include "solver/zonotope/turn.c"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include <mpfr.h>

#define BITS 300

static double worst; /* of all errors, in units of TURN_ERROR */

static void judge(mpfr_t truth, dd x) {
  mpfr_t off;
  mpfr_init2(off, BITS);
  mpfr_sub_d(off, truth, x.hi, MPFR_RNDN), mpfr_sub_d(off, off, x.lo, MPFR_RNDN);
  double size = fabs(mpfr_get_d(off, MPFR_RNDA)) / TURN_ERROR;
  mpfr_clear(off);
  assert_true(size <= 1);
  assert_true(fabs(x.lo) <= 0x1p-52 * fabs(x.hi));
  if (size > worst) worst = size;
}

static void try_at(double c) {
  dd sine, cosine;
  mpfr_t at, s, t;
  assert_true(turn_at(c, &sine, &cosine));
  mpfr_inits2(BITS, at, s, t, (mpfr_ptr)0);
  mpfr_set_d(at, c, MPFR_RNDN), mpfr_sin_cos(s, t, at, MPFR_RNDN);
  judge(s, sine), judge(t, cosine);
  mpfr_clears(at, s, t, (mpfr_ptr)0);
}

static double draw(double lo, double hi) { return lo + (hi - lo) * ((double)rand() / RAND_MAX); }

static void sines_and_cosines_have_twice_the_digits(void **unused) {
  (void)unused;
  srand(1);
  for (int n = 0; n < 20000; n++) {
    double turns = nearbyint(ldexp(1, n % 21) * draw(-1, 1)), near = turns * (3.14159265358979323846 / 2);
    try_at(draw(-4, 4)), try_at(draw(-1.6e6, 1.6e6)), try_at(near), try_at(near + ldexp(draw(-1, 1), -(n % 60)));
    try_at(ldexp(draw(-1, 1), -(n % 900)));
  }
  try_at(0);
  assert_true(worst > 0x1p-12); /* the bound is not vacuous */
}

static void too_many_turns_are_refused(void **unused) {
  dd s, c;
  (void)unused;
  assert_false(turn_at(0x1p21 * 1.6, &s, &c) || turn_at(INFINITY, &s, &c) || turn_at(NAN, &s, &c));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(sines_and_cosines_have_twice_the_digits),
    cmocka_unit_test(too_many_turns_are_refused),
  };
  return cmocka_run_group_tests_name("zonotope: turns", tests, NULL, NULL);
}
