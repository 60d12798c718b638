/* test_shared_real_schur.c -- form and vectors of random and nasty matrices against what defines them, and eigenvalues
** that are known. */
#include "shared/real_schur.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { MOST = 40 };

static uint64_t state = 0x853c49e6748fea9bu;
static double uniform(void) {
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return (double)((state * 0x2545f4914f6cdd1du) >> 11) * 0x1p-52 - 1;
}

typedef struct decomposition {
  size_t n;
  double a[MOST * MOST], t[MOST * MOST], z[MOST * MOST], vector[MOST * MOST], re[MOST], im[MOST];
} decomposition;

static double norm_of(size_t n, const double *a) {
  double norm = 0;
  for (size_t i = 0; i < n * n; i++) norm = fmax(norm, fabs(a[i]));
  return norm * (double)n;
}

static void decompose(decomposition *d) {
  double work[2 * MOST];
  memcpy(d->t, d->a, d->n * d->n * sizeof *d->a);
  assert_true(real_schur(d->n, d->t, d->z, work));
  real_schur_vectors(d->n, d->t, d->z, d->re, d->im, d->vector, work);
}

/* Z'Z = I, A Z = Z T, T nearly triangular with the promised blocks */
static void check_form(const decomposition *d) {
  size_t n = d->n;
  double small = 1e-14 * (double)(n + 4), norm = norm_of(n, d->a) + DBL_MIN;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      double turned = i == j ? -1 : 0, left = 0, right = 0;
      for (size_t k = 0; k < n; k++) {
        turned += d->z[k * n + i] * d->z[k * n + j];
        left += d->a[i * n + k] / norm * d->z[k * n + j];
        right += d->z[i * n + k] * (d->t[k * n + j] / norm);
      }
      assert_true(fabs(turned) < small);
      assert_true(fabs(left - right) < small);
      if (j + 1 < i) assert_true(d->t[i * n + j] == 0);
    }
  for (size_t k = 1; k < n; k++) {
    double below = d->t[k * n + k - 1], above = d->t[(k - 1) * n + k];
    if (below == 0) continue;
    assert_true((below < 0) != (above < 0) && above != 0);
    assert_true(d->t[k * n + k] == d->t[(k - 1) * n + k - 1]);
    if (k + 1 < n) assert_true(d->t[(k + 1) * n + k] == 0);
  }
}

/* A v = lambda v, the largest component 1 */
static void check_vectors(const decomposition *d) {
  size_t n = d->n;
  double norm = norm_of(n, d->a) + DBL_MIN;
  for (size_t j = 0; j < n; j++) {
    size_t pair = d->im[j] > 0;
    double size = 0;
    assert_true(d->im[j] >= 0 && (!pair || (d->im[j + 1] == -d->im[j] && d->re[j + 1] == d->re[j])));
    for (size_t i = 0; i < n; i++) {
      double x = 0, y = 0, u = d->vector[i * n + j], v = pair ? d->vector[i * n + j + 1] : 0;
      for (size_t k = 0; k < n; k++) {
        x += d->a[i * n + k] / norm * d->vector[k * n + j];
        if (pair) y += d->a[i * n + k] / norm * d->vector[k * n + j + 1];
      }
      x -= d->re[j] / norm * u - d->im[j] / norm * v, y -= d->re[j] / norm * v + d->im[j] / norm * u;
      assert_true(fabs(x) < 1e-13 * (double)(n + 4) && fabs(y) < 1e-13 * (double)(n + 4));
      size = fmax(size, hypot(u, v));
    }
    assert_true(fabs(size - 1) < 1e-12);
    j += pair;
  }
}

static void random_matrices(void **unused) {
  (void)unused;
  decomposition *d = malloc(sizeof *d);
  assert_non_null(d);
  for (int round = 0; round < 600; round++) {
    d->n = 1 + (size_t)round % MOST;
    int kind = round / MOST % 5;
    for (size_t i = 0; i < d->n; i++)
      for (size_t j = 0; j < d->n; j++) {
        double x = uniform();
        if (kind == 1) x = rint(2 * x);                                          /* many equal values */
        if (kind == 2) x = fabs(x) < 0.7 ? 0 : x;                                /* sparse */
        if (kind == 3) x = ldexp(x, (int)(i + j) * 3 - 120);                     /* graded */
        if (kind == 4) x = i <= j ? x : i == j + 1 ? 1e-9 * x : 0, x *= 0x1p300; /* huge, nearly triangular */
        d->a[i * d->n + j] = x;
      }
    decompose(d);
    check_form(d);
    check_vectors(d);
  }
  free(d);
}

static int compare(const void *a, const void *b) {
  const double *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

/* rings of n (double shifts alone do not move them), Jordan's blocks, zero, turns, a symmetric chain */
static void known_values(void **unused) {
  (void)unused;
  decomposition *d = malloc(sizeof *d);
  const double pi = acos(-1);
  assert_non_null(d);
  for (int kind = 0; kind < 5; kind++)
    for (size_t n = 1; n <= 24; n++) {
      double known[MOST], tolerance = 1e-12;
      memset(d->a, 0, sizeof d->a);
      d->n = n;
      for (size_t i = 0; i < n; i++) {
        known[i] = 0;
        if (kind == 0) d->a[i * n + (i + 1) % n] = 1, known[i] = cos(2 * pi * (double)i / (double)n);
        if (kind == 1) d->a[i * n + i] = 3, known[i] = 3, tolerance = 1e-12;
        if (kind == 1 && i + 1 < n) d->a[i * n + i + 1] = 1;
        if (kind == 3 && i + 1 < n && i % 2 == 0) d->a[i * n + i + 1] = -2, d->a[(i + 1) * n + i] = 2;
        if (kind == 4) d->a[i * n + i] = 2, known[i] = 2 - 2 * cos(pi * (double)(i + 1) / (double)(n + 1));
        if (kind == 4 && i + 1 < n) d->a[i * n + i + 1] = d->a[(i + 1) * n + i] = -1;
      }
      decompose(d);
      check_form(d);
      check_vectors(d);
      qsort(known, n, sizeof *known, compare), qsort(d->re, n, sizeof *d->re, compare);
      for (size_t i = 0; i < n; i++) assert_true(fabs(known[i] - d->re[i]) < tolerance);
      for (size_t i = 0; kind == 3 && i + 1 < n; i += 2) assert_true(fabs(fabs(d->im[i]) - 2) < tolerance);
    }
  free(d);
}

/* D^-1 A D has rows and columns alike, and by powers of 2 no digit is lost */
static void balancing(void **unused) {
  (void)unused;
  enum { N = 9 };
  double a[N * N], b[N * N], scale[N];
  for (size_t i = 0; i < N; i++)
    for (size_t j = 0; j < N; j++) a[i * N + j] = b[i * N + j] = ldexp(uniform(), 20 * ((int)i - (int)j));
  balance_matrix(N, b, scale);
  for (size_t i = 0; i < N; i++) {
    double row = 0, column = 0;
    for (size_t j = 0; j < N; j++) {
      assert_true(b[i * N + j] == a[i * N + j] / scale[i] * scale[j]);
      if (i != j) row = fmax(row, fabs(b[i * N + j])), column = fmax(column, fabs(b[j * N + i]));
    }
    assert_true(row < 8 * column && column < 8 * row);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(random_matrices), cmocka_unit_test(known_values),
    cmocka_unit_test(balancing) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
