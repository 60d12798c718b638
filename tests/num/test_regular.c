/* test_regular.c -- regular and singular interval matrices: judged by determinants in exact integer arithmetic. */
#include "num/regular.h"
#include "num/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#define N_MAX 6
#define ROUNDS 4000

static long long whole(ambit_random *r, int most) {
  return (long long)(ambit_random_bits(r) % (uint64_t)(2 * most + 1)) - most;
}

/* exact for small entries */
static long long determinant(int n, const long long *a) {
  if (n == 0) return 1;
  long long sum = 0;
  for (int j = 0; j < n; j++) {
    long long minor[N_MAX * N_MAX];
    for (int i = 1; i < n; i++)
      for (int k = 0, to = 0; k < n; k++)
        if (k != j) minor[(i - 1) * (n - 1) + to++] = a[i * n + k];
    sum += (j % 2 ? -1 : 1) * a[j] * determinant(n - 1, minor);
  }
  return sum;
}

static void points_as_their_determinants(void **state) {
  (void)state;
  ambit_random r = { 1 };
  double scratch[2 * N_MAX * N_MAX];
  int proved = 0, vanishing = 0;
  for (int round = 0; round < ROUNDS; round++) {
    int n = 1 + (int)(ambit_random_bits(&r) % N_MAX);
    long long a[N_MAX * N_MAX];
    ambit_interval b[N_MAX * N_MAX];
    for (int i = 0; i < n * n; i++) a[i] = whole(&r, 3);
    if (round % 3 == 0 && n > 1) /* two rows depend on each other */
      for (int j = 0; j < n; j++) a[n + j] = 2 * a[j];
    for (int i = 0; i < n * n; i++) b[i] = (ambit_interval) { (double)a[i], (double)a[i] };
    long long d = determinant(n, a);
    bool regular = ambit_is_regular((size_t)n, b, scratch), singular = ambit_is_singular((size_t)n, b);
    if (d == 0) assert_false(regular);
    assert_int_equal(singular, d == 0); /* integers: no rounding */
    proved += regular;
    vanishing += d == 0;
    if (d != 0) assert_true(regular); /* condition below 1e6 */
  }
  assert_true(proved > ROUNDS / 3 && vanishing > ROUNDS / 5);
}

/* A set that holds a singular matrix, at a corner or inside, is never called regular. */
static void sets_with_a_singular_matrix(void **state) {
  (void)state;
  ambit_random r = { 2 };
  double scratch[2 * N_MAX * N_MAX];
  int wide_and_regular = 0;
  for (int round = 0; round < ROUNDS; round++) {
    int n = 2 + (int)(ambit_random_bits(&r) % (N_MAX - 1));
    long long a[N_MAX * N_MAX];
    ambit_interval b[N_MAX * N_MAX];
    for (int i = 0; i < n * n; i++) a[i] = whole(&r, 3);
    for (int j = 0; j < n; j++) a[n + j] = -a[j];
    for (int i = 0; i < n * n; i++) {
      double from = ambit_random_in(&r, (ambit_interval) { 0, 0.5 }), to = round % 2 ? from : 0;
      b[i] = (ambit_interval) { (double)a[i] - from, (double)a[i] + to };
    }
    assert_false(ambit_is_regular((size_t)n, b, scratch));
    for (int i = 0; i < n * n; i++) { /* diagonally dominant: regular whatever the entries are */
      b[i] = i % (n + 1) ? (ambit_interval) { -0.5 / n, 0.5 / n } : (ambit_interval) { 1, 2 };
    }
    wide_and_regular += ambit_is_regular((size_t)n, b, scratch);
    assert_false(ambit_is_singular((size_t)n, b));
  }
  assert_true(wide_and_regular == ROUNDS);
}

static void nasty_entries_prove_nothing(void **state) {
  (void)state;
  double scratch[8];
  const ambit_interval nasty[] = { { -INFINITY, INFINITY }, { INFINITY, -INFINITY }, { 1, INFINITY }, { 0, 0 },
    { -1e308, 1e308 } };
  for (size_t k = 0; k < sizeof nasty / sizeof *nasty; k++) {
    ambit_interval b[4] = { nasty[k], { 0, 0 }, { 0, 0 }, { 1, 1 } };
    assert_false(ambit_is_regular(2, b, scratch));
    assert_int_equal(ambit_is_singular(2, b), nasty[k].lo == 0 && nasty[k].hi == 0);
  }
  ambit_interval edge[4] = { { 0, 1 }, { 0, 0 }, { 0, 0 }, { -1, 0 } }; /* holds regular matrices, too */
  assert_false(ambit_is_singular(1, edge) || ambit_is_singular(1, edge + 3) || ambit_is_singular(2, edge));
  ambit_interval tiny[1] = { { 0x1p-1074, 0x1p-1074 } }; /* its inverse overflows */
  assert_false(ambit_is_regular(1, tiny, scratch));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(points_as_their_determinants),
    cmocka_unit_test(sets_with_a_singular_matrix),
    cmocka_unit_test(nasty_entries_prove_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
