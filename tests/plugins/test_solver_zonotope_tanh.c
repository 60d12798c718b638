/* The line that stands for tanh, and by how much it differs from it at most: against 200 bits, over the range for which
** the line was made and over any other, at the places where the difference is greatest. */
#include "solver/zonotope/tanh.c"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include <mpfr.h>

#define BITS 200

static double draw(double lo, double hi) { return lo + (hi - lo) * ((double)rand() / RAND_MAX); }

/* values as the kernel gives them: up to 3 units in the last place above */
static uint32_t give_above(uint32_t op, size_t n, double *r, const double *a, const double *b, int32_t exponent) {
  (void)b, (void)exponent;
  assert_int_equal(op, AMBIT_OP_TANH);
  assert_int_equal(n, 1);
  MPFR_DECL_INIT(x, 53);
  mpfr_set_d(x, a[1], MPFR_RNDN), mpfr_tanh(x, x, MPFR_RNDU);
  r[1] = mpfr_get_d(x, MPFR_RNDU);
  for (int more = rand() % 3; more > 0; more--) r[1] = nextafter(r[1], INFINITY);
  r[0] = -r[1];
  return 0;
}

/* | tanh x - slope x - offset |, rounded up */
static double off_at(const kink *k, double x) {
  MPFR_DECL_INIT(y, BITS);
  MPFR_DECL_INIT(l, BITS);
  mpfr_set_d(y, x, MPFR_RNDN), mpfr_mul_d(l, y, k->slope, MPFR_RNDN), mpfr_tanh(y, y, MPFR_RNDN);
  mpfr_sub(y, y, l, MPFR_RNDN), mpfr_sub_d(y, y, k->offset, MPFR_RNDN), mpfr_abs(y, y, MPFR_RNDN);
  return mpfr_get_d(y, MPFR_RNDU);
}

/* the greatest one that is found in [lo, hi] */
static double most_of(const kink *k, double lo, double hi) {
  double most = fmax(off_at(k, lo), off_at(k, hi)), top = k->slope > 0 && k->slope < 1 ? atanh(sqrt(1 - k->slope)) : 0;
  for (int n = 0; n < 20; n++) most = fmax(most, off_at(k, fmax(lo, fmin(hi, draw(lo, hi)))));
  for (int side = -1; side <= 1; side++) {
    double x = side * top;
    if (x >= lo && x <= hi) most = fmax(most, off_at(k, x));
  }
  return most;
}

static void choose(double *lo, double *hi) {
  double size = ldexp(draw(0.5, 1), rand() % 12 - 7), middle = rand() % 3 ? draw(-2, 2) : size * draw(-1, 1);
  *lo = middle - size * draw(0, 1), *hi = middle + size * draw(0, 1);
}

static void no_value_of_tanh_is_missed(void **unused) {
  (void)unused;
  static const ambit_num_service service = { .map = give_above };
  zono z = { .num = &service };
  double loosest = 0;
  srand(1);
  for (int n = 0; n < 12000; n++) {
    double lo, hi, from, to;
    kink k = { 0 };
    choose(&lo, &hi), choose(&from, &to);
    tanh_line(&z, &k, lo, hi);
    if (n % 4 == 0) k.slope = draw(0, 1), k.offset = draw(-1, 1);
    double miss = tanh_miss(&z, &k, lo, hi), most = most_of(&k, lo, hi);
    assert_true(most <= miss);
    loosest = fmax(loosest, miss / (most + 1e-12));
    assert_true(most_of(&k, from, to) <= tanh_miss(&z, &k, from, to));
  }
  print_message("bounds are at most %.3f of what is found\n", loosest);
  assert_true(loosest < 1.01);
  for (int n = 0; n < 2; n++) {
    kink k = { .slope = 0.5 * n };
    assert_true(tanh_miss(&z, &k, -INFINITY, 1) == INFINITY && tanh_miss(&z, &k, 0, INFINITY) == INFINITY);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(no_value_of_tanh_is_missed) };
  return cmocka_run_group_tests_name("zonotope: a line for tanh", tests, NULL, NULL);
}
