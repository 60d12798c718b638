/* Enclosures of eigenvalues against matrices whose spectrum is known exactly: integer block-triangular matrices under
** unimodular integer transformations; definite matrices; Lyapunov's test. Approximate vectors are made here, on purpose
** also bad ones: what is enclosed must hold whatever they are. */
#include "verbs/stability/spectrum.h"
#include "num/regular.h"
#include "verbs/roots/solve.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define N_MAX 7
#define ROUNDS 400

static uint64_t state = 0x9e3779b97f4a7c15u;
static double uniform(void) {
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return (double)((state * 0x2545f4914f6cdd1du) >> 11) * 0x1p-53;
}
static int choose(int n) { return (int)(uniform() * n); }

typedef struct known {
  size_t n;
  double re[N_MAX], im[N_MAX]; /* exact eigenvalues */
  bool is_first[N_MAX];
  double a[N_MAX * N_MAX], vector[N_MAX * N_MAX]; /* exact matrix; columns of the transformation */
} known;

static void multiply(size_t n, double *r, const double *a, const double *b) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      double sum = 0;
      for (size_t k = 0; k < n; k++) sum += a[i * n + k] * b[k * n + j];
      r[i * n + j] = sum;
    }
}

/* block diagonal: integers, or a + ib, a - ib as [a b; -b a] */
static void set_blocks(known *k, double *d) {
  size_t n = k->n;
  memset(d, 0, n * n * sizeof *d);
  for (size_t i = 0; i < n;) {
    bool pair = i + 1 < n && choose(3) == 0;
    double re = choose(13) - 6, im = pair ? 1 + choose(5) : 0;
    for (size_t p = 0; p < (pair ? 2u : 1u); p++) {
      k->re[i + p] = re, k->im[i + p] = p ? -im : im, k->is_first[i + p] = pair && p == 0;
      d[(i + p) * n + i + p] = re;
    }
    if (pair) d[i * n + i + 1] = im, d[(i + 1) * n + i] = -im;
    i += pair ? 2 : 1;
  }
}

/* A = U D U^-1 with U a product of few elementary integer operations: all entries are small integers, exact */
static known make(size_t n) {
  known k = { .n = n };
  double d[N_MAX * N_MAX], u[N_MAX * N_MAX] = { 0 }, v[N_MAX * N_MAX] = { 0 }, t[N_MAX * N_MAX];
  set_blocks(&k, d);
  for (size_t i = 0; i < n; i++) u[i * n + i] = v[i * n + i] = 1;
  for (int step = 0; step < 8 && n > 1; step++) {
    size_t i = (size_t)choose((int)n), j = (size_t)choose((int)n);
    double c = choose(3) - 1;
    if (i == j) continue;
    for (size_t l = 0; l < n; l++) u[l * n + j] += c * u[l * n + i]; /* U := U E, V := E^-1 V */
    for (size_t l = 0; l < n; l++) v[i * n + l] -= c * v[j * n + l];
  }
  multiply(n, t, u, d);
  multiply(n, k.a, t, v);
  memcpy(k.vector, u, sizeof u);
  return k;
}

static void widen(const known *k, double r, ambit_interval *a) {
  for (size_t i = 0; i < k->n * k->n; i++) a[i] = (ambit_interval) { k->a[i] - r, k->a[i] + r };
}

/* each group holds as many of the known eigenvalues as it says */
static bool is_enclosed(const known *k, const double *shift, const ambit_eigenvalue *value) {
  for (size_t i = 0; i < k->n; i++) {
    uint32_t inside = 0;
    for (size_t j = 0; j < k->n; j++)
      inside +=
          ambit_interval_contains(value[i].re, k->re[j] + shift[j]) && ambit_interval_contains(value[i].im, k->im[j]);
    if (inside != value[i].count) return false;
  }
  return true;
}

static const double no_shift[N_MAX] = { 0 };

static void known_spectra_are_enclosed(void **arena) {
  int tight = 0, noticed = 0;
  for (int round = 0; round < ROUNDS; round++) {
    known k = make(1 + (size_t)choose(N_MAX));
    ambit_interval a[N_MAX * N_MAX];
    ambit_eigenvalue value[N_MAX];
    double spread;
    widen(&k, 0, a);
    assert_true(ambit_spectrum_enclose(k.n, a, k.vector, k.is_first, value, &spread, *arena));
    if (!is_enclosed(&k, no_shift, value)) fail_msg("round %d", round);
    tight += spread < 1e-10;
    k.re[0] += 1e-3; /* the comparison sees a wrong one */
    noticed += !is_enclosed(&k, no_shift, value);
  }
  assert_true(tight > ROUNDS * 9 / 10);
  assert_true(noticed > ROUNDS * 9 / 10);
}

/* vectors that are wrong in every digit, or nonsense */
static void bad_vectors_harm_nobody(void **arena) {
  int enclosed = 0;
  for (int round = 0; round < ROUNDS; round++) {
    known k = make(1 + (size_t)choose(N_MAX));
    ambit_interval a[N_MAX * N_MAX];
    ambit_eigenvalue value[N_MAX];
    double spread, error = pow(10, -12 * uniform());
    widen(&k, 0, a);
    for (size_t i = 0; i < k.n * k.n; i++) k.vector[i] += error * (2 * uniform() - 1);
    if (!ambit_spectrum_enclose(k.n, a, k.vector, k.is_first, value, &spread, *arena)) continue;
    enclosed++;
    if (!is_enclosed(&k, no_shift, value)) fail_msg("round %d, error %g", round, error);
  }
  assert_true(enclosed > ROUNDS * 3 / 4);
  known k = make(3);
  ambit_interval a[9];
  ambit_eigenvalue value[3];
  double spread;
  widen(&k, 0, a);
  memset(k.vector, 0, sizeof k.vector);
  assert_false(ambit_spectrum_enclose(3, a, k.vector, k.is_first, value, &spread, *arena));
  k.vector[0] = NAN;
  assert_false(ambit_spectrum_enclose(3, a, k.vector, k.is_first, value, &spread, *arena));
  k = make(3);
  a[4] = (ambit_interval) { -INFINITY, 1 };
  assert_false(ambit_spectrum_enclose(3, a, k.vector, k.is_first, value, &spread, *arena));
}

/* A + c 1 with |c| <= r is a member of the set A +- r, with a known spectrum */
static void members_of_wide_sets_are_enclosed(void **arena) {
  for (int round = 0; round < ROUNDS; round++) {
    known k = make(1 + (size_t)choose(N_MAX));
    ambit_interval a[N_MAX * N_MAX];
    ambit_eigenvalue value[N_MAX];
    double spread, r = ldexp(1, -3 - choose(30)), shift[N_MAX];
    widen(&k, r, a);
    if (!ambit_spectrum_enclose(k.n, a, k.vector, k.is_first, value, &spread, *arena)) continue;
    for (int s = 0; s < 8; s++) {
      double c = s == 0 ? r : s == 1 ? -r : ldexp(floor(ldexp(r * (2 * uniform() - 1), 40)), -40);
      for (size_t j = 0; j < k.n; j++) shift[j] = c;
      if (!is_enclosed(&k, shift, value)) fail_msg("round %d: shift %g of %g", round, c, r);
    }
  }
}

/* J'J + 1 is definite, and -1 more on the diagonal of a singular one is not */
static void definite_means_definite(void **arena) {
  for (int round = 0; round < ROUNDS; round++) {
    known k = make(2 + (size_t)choose(N_MAX - 1));
    size_t n = k.n;
    ambit_interval g[N_MAX * N_MAX];
    double v[N_MAX];
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < n; j++) {
        double sum = i == j;
        for (size_t l = 0; l < n; l++) sum += k.a[l * n + i] * k.a[l * n + j];
        g[i * n + j] = (ambit_interval) { sum - 1e-9, sum + 1e-9 };
      }
    assert_true(ambit_is_positive_definite(n, g, *arena));
    for (size_t i = 0; i < n; i++) v[i] = choose(5) - 2;
    double form = 0, square = 0; /* G - c 1 with v'(G - c 1)v <= 0 is not definite */
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < n; j++) form += v[i] * v[j] * ambit_interval_mid(g[i * n + j]);
    for (size_t i = 0; i < n; i++) square += v[i] * v[i];
    if (square == 0) continue;
    for (size_t i = 0; i < n; i++) g[i * n + i].lo -= 1.001 * form / square;
    assert_false(ambit_is_positive_definite(n, g, *arena));
  }
}

/* what Lyapunov's test says is what the spectrum is */
static void lyapunov_agrees_with_the_spectrum(void **arena) {
  int decided = 0, counted = 0;
  for (int round = 0; round < ROUNDS; round++) {
    known k = make(1 + (size_t)choose(5));
    size_t n = k.n;
    ambit_interval a[N_MAX * N_MAX], p_set[N_MAX * N_MAX];
    double p[N_MAX * N_MAX], most = -INFINITY;
    bool singular = false; /* two eigenvalues whose sum is 0 */
    for (size_t i = 0; i < n; i++) {
      most = fmax(most, k.re[i]);
      for (size_t j = 0; j < n; j++) singular = singular || (k.re[i] + k.re[j] == 0 && k.im[i] + k.im[j] == 0);
    }
    widen(&k, 1e-12, a);
    bool holds = ambit_lyapunov_solve(n, a, p, *arena) && ambit_lyapunov_holds(n, a, p, *arena);
    if (holds) assert_false(singular);
    if (singular) continue;
    counted++;
    decided += holds;
    for (size_t i = 0; i < n * n; i++) p_set[i] = (ambit_interval) { p[i], p[i] };
    if (holds) assert_true(ambit_is_positive_definite(n, p_set, *arena) == (most < 0));
  }
  assert_true(decided > counted * 9 / 10);
}

static void linear_equations_are_solved(void **arena) {
  (void)arena;
  for (int round = 0; round < ROUNDS; round++) {
    known k = make(1 + (size_t)choose(N_MAX));
    size_t n = k.n;
    ambit_interval a[N_MAX * N_MAX], b[N_MAX], x[N_MAX];
    double scratch[2 * N_MAX * N_MAX], exact[N_MAX];
    bool singular = false;
    for (size_t i = 0; i < n; i++) singular = singular || (k.re[i] == 0 && k.im[i] == 0);
    widen(&k, choose(2) ? 1e-9 : 0, a);
    for (size_t i = 0; i < n; i++) exact[i] = choose(9) - 4;
    for (size_t i = 0; i < n; i++) {
      double sum = 0;
      for (size_t j = 0; j < n; j++) sum += k.a[i * n + j] * exact[j];
      b[i] = (ambit_interval) { sum, sum };
    }
    bool solved = ambit_solve_enclose(n, a, b, x, scratch);
    assert_true(solved != singular);
    for (size_t i = 0; solved && i < n; i++) {
      assert_true(ambit_interval_contains(x[i], exact[i]));
      assert_true(ambit_interval_width(x[i]) < 1e-4);
    }
  }
}

/* All of [1 - r, 1 + r] x = [-1, 1] together: x in [-1 / (1 - r), 1 / (1 - r)], coupled or not. */
static void wide_right_sides_are_covered(void **arena) {
  (void)arena;
  for (size_t n = 1; n <= 4; n++) {
    const double r = 0.25;
    ambit_interval a[16], b[4], x[4];
    double scratch[32];
    for (size_t i = 0; i < n * n; i++)
      a[i] = i % (n + 1) ? (ambit_interval) { 0, 0 } : (ambit_interval) { 1 - r, 1 + r };
    for (size_t i = 0; i < n; i++) b[i] = (ambit_interval) { -1, 1 };
    assert_true(ambit_solve_enclose(n, a, b, x, scratch));
    for (size_t i = 0; i < n; i++) assert_true(x[i].lo <= -1 / (1 - r) && x[i].hi >= 1 / (1 - r));
    b[n - 1] = AMBIT_ENTIRE;
    assert_false(ambit_solve_enclose(n, a, b, x, scratch));
    a[0] = AMBIT_EMPTY;
    assert_false(ambit_solve_enclose(n, a, b, x, scratch));
  }
}

static int set_up(void **arena) { return (*arena = ambit_arena_open()) ? 0 : -1; }
static int tear_down(void **arena) { return ambit_arena_close(*arena), 0; }

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(known_spectra_are_enclosed),
    cmocka_unit_test(bad_vectors_harm_nobody), cmocka_unit_test(members_of_wide_sets_are_enclosed),
    cmocka_unit_test(definite_means_definite), cmocka_unit_test(lyapunov_agrees_with_the_spectrum),
    cmocka_unit_test(linear_equations_are_solved), cmocka_unit_test(wide_right_sides_are_covered) };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
