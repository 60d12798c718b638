/* Eigenvalues and stability with the approximations of service/eigen: companion matrices of polynomials with known
** roots, Jordan blocks, sets, nonsense. */
#include "verbs/stability/eigen.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define N_MAX 8
#define ROUNDS 300

static uint64_t state = 0x853c49e6748fea9bu;
static double uniform(void) {
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return (double)((state * 0x2545f4914f6cdd1du) >> 11) * 0x1p-53;
}
static int choose(int n) { return (int)(uniform() * n); }

static ambit_eigen analyse(ambit_registry *r, size_t n, const ambit_interval *a, ambit_eigenvalue *value) {
  ambit_eigen result;
  ambit_failure f = { 0 };
  if (ambit_eigen_analyse(r, n, a, value, &result, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return result;
}

/* the companion matrix of prod (x - root_i): eigenvalues are the roots, exactly */
static void companion(size_t n, const double *root, ambit_interval *a) {
  double c[N_MAX + 1] = { 1 }; /* c[k]: coefficient of x^(degree - k); integers */
  for (size_t i = 0; i < n; i++)
    for (size_t k = i + 1; k > 0; k--) c[k] -= root[i] * c[k - 1];
  memset(a, 0, n * n * sizeof *a);
  for (size_t i = 0; i < n; i++) {
    a[i] = (ambit_interval) { -c[i + 1], -c[i + 1] };
    if (i > 0) a[i * n + i - 1] = (ambit_interval) { 1, 1 };
  }
}

static void companions_are_enclosed(void **registry) {
  int single = 0, decided = 0;
  for (int round = 0; round < ROUNDS; round++) {
    size_t n = 1 + (size_t)choose(6);
    double root[N_MAX], most = -INFINITY;
    ambit_interval a[N_MAX * N_MAX];
    ambit_eigenvalue value[N_MAX];
    for (size_t i = 0; i < n; i++) {
      root[i] = choose(17) - 8; /* sometimes several times: a Jordan block */
      most = fmax(most, root[i]);
    }
    companion(n, root, a);
    ambit_eigen result = analyse(*registry, n, a, value);
    assert_true(result.enclosed);
    for (size_t i = 0; i < n; i++) {
      uint32_t inside = 0;
      for (size_t j = 0; j < n; j++)
        inside += ambit_interval_contains(value[i].re, root[j]) && ambit_interval_contains(value[i].im, 0);
      if (inside != value[i].count)
        fail_msg("round %d: %u eigenvalues in a group of %u", round, inside, value[i].count);
      single += value[i].count == 1;
    }
    if (result.stability == AMBIT_STABILITY_STABLE) assert_true(most < 0);
    if (result.stability == AMBIT_STABILITY_UNSTABLE) assert_true(most > 0);
    decided += result.stability != AMBIT_STABILITY_UNDECIDED || most == 0;
  }
  assert_true(single > ROUNDS);
  assert_true(decided > ROUNDS * 3 / 4);
}

/* mpmath 1.2, 30 digits: eig([[1, 2, 3], [4, 5, 6], [7, 8, 10]]) */
static void other_peoples_digits(void **registry) {
  static const double list[9] = { 1, 2, 3, 4, 5, 6, 7, 8, 10 };
  static const double digits[3] = { -0.905740179521758467, 0.198246863397010127, 16.7074933161247483 };
  ambit_interval a[9];
  ambit_eigenvalue value[3];
  for (int i = 0; i < 9; i++) a[i] = (ambit_interval) { list[i], list[i] };
  assert_int_equal(analyse(*registry, 3, a, value).stability, AMBIT_STABILITY_UNSTABLE);
  for (int k = 0; k < 3; k++) {
    bool met = false;
    for (int i = 0; i < 3; i++)
      met = met ||
            (fabs(ambit_interval_mid(value[i].re) - digits[k]) < 1e-13 && ambit_interval_width(value[i].re) < 1e-12);
    if (!met) fail_msg("%.17g is missing", digits[k]);
  }
}

/* x'' + d x' + k x = 0 for d, k in intervals: stable if both are positive, for the whole set */
static void sets_are_decided_as_a_whole(void **registry) {
  ambit_interval a[4] = { { 0, 0 }, { 1, 1 }, { -1.2, -0.8 }, { -1.1, -0.9 } };
  ambit_eigenvalue value[2];
  assert_int_equal(analyse(*registry, 2, a, value).stability, AMBIT_STABILITY_STABLE);
  a[3] = (ambit_interval) { -1, 0.01 };
  assert_int_equal(analyse(*registry, 2, a, value).stability, AMBIT_STABILITY_UNDECIDED);
  a[2] = (ambit_interval) { 0.5, 1.5 }, a[3] = (ambit_interval) { -0.01, 0.01 };
  assert_int_equal(analyse(*registry, 2, a, value).stability, AMBIT_STABILITY_UNSTABLE);
}

static void nonsense_is_survived(void **registry) {
  ambit_interval a[4] = { { -INFINITY, 1 }, { 0, 0 }, { 0, 0 }, { 1, 1 } };
  ambit_eigenvalue value[2];
  ambit_eigen result = analyse(*registry, 2, a, value);
  assert_false(result.enclosed);
  assert_int_equal(result.stability, AMBIT_STABILITY_UNDECIDED);
  a[0] = (ambit_interval) { INFINITY, -INFINITY };
  assert_false(analyse(*registry, 2, a, value).enclosed);
  a[0] = (ambit_interval) { -1e300, 1e300 };
  assert_int_equal(analyse(*registry, 2, a, value).stability, AMBIT_STABILITY_UNDECIDED); /* 1 is in it */
  for (int i = 0; i < 4; i++) a[i] = (ambit_interval) { 0, 0 };
  result = analyse(*registry, 2, a, value);
  assert_true(result.enclosed && result.stability == AMBIT_STABILITY_UNDECIDED && value[0].count == 2);
  for (int i = 0; i < 4; i++) a[i] = (ambit_interval) { 1e308, 1e308 };
  analyse(*registry, 2, a, value);
}

static int set_up(void **registry) { return (*registry = ambit_registry_open(NULL)) ? 0 : -1; }
static int tear_down(void **registry) { return ambit_registry_close(*registry), 0; }

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(companions_are_enclosed), cmocka_unit_test(other_peoples_digits),
    cmocka_unit_test(sets_are_decided_as_a_whole), cmocka_unit_test(nonsense_is_survived) };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
