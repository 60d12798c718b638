/* definite.c -- positive definite interval matrices, and Lyapunov's equation.
**
** With W, roughly the inverse of a Cholesky factor of the middle, the set W H W' is nearly the identity. If in each row
** the diagonal outweighs what is beside it (Gershgorin), every symmetric matrix in it is positive definite; then W is
** regular and H positive definite too (Sylvester).
*/
#include "verbs/stability/spectrum.h"
#include "num/regular.h"
#include "num/interval.h"
#include <math.h>
#include <string.h>

typedef ambit_interval interval;

static interval point(double x) { return (interval) { x, x }; }

/* -- positive definite */

/* w := the inverse of the lower Cholesky factor of the middle of a; false: it has none */
static bool invert_cholesky(size_t n, const interval *a, double *w, double *l) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j <= i; j++) {
      double sum = ambit_interval_mid(a[i * n + j]);
      for (size_t k = 0; k < j; k++) sum -= l[i * n + k] * l[j * n + k];
      if (i == j && !(sum > 0)) return false;
      l[i * n + j] = i == j ? sqrt(sum) : sum / l[j * n + j];
    }
  memset(w, 0, n * n * sizeof *w);
  for (size_t j = 0; j < n; j++)
    for (size_t i = j; i < n; i++) {
      double sum = i == j;
      for (size_t k = j; k < i; k++) sum -= l[i * n + k] * w[k * n + j];
      w[i * n + j] = sum / l[i * n + i];
      if (!isfinite(w[i * n + j])) return false;
    }
  return true;
}

/* sum_k w_ik a_kj */
static interval times_row(size_t n, const double *w, size_t i, const interval *a, size_t j) {
  interval sum = { 0, 0 };
  for (size_t k = 0; k <= i; k++) sum = ambit_interval_add(sum, ambit_interval_mul(point(w[i * n + k]), a[k * n + j]));
  return sum;
}

/* does the diagonal of row i of W A W' outweigh the rest? row [n]: scratch */
static bool is_dominant(size_t n, const double *w, size_t i, const interval *a, interval *row) {
  interval rest = { 0, 0 }, diagonal = rest;
  for (size_t j = 0; j < n; j++) row[j] = times_row(n, w, i, a, j);
  for (size_t j = 0; j < n; j++) {
    interval x = { 0, 0 };
    for (size_t k = 0; k <= j; k++) x = ambit_interval_add(x, ambit_interval_mul(row[k], point(w[j * n + k])));
    if (i == j)
      diagonal = x;
    else
      rest = ambit_interval_add(rest, point(ambit_interval_mag(x)));
  }
  return diagonal.lo > rest.hi;
}

bool ambit_is_positive_definite(size_t n, const ambit_interval *a, ambit_arena *arena) {
  double *w = ambit_arena_alloc(arena, (n * n + 1) * sizeof *w), *l = ambit_arena_alloc(arena, (n * n + 1) * sizeof *l);
  interval *row = ambit_arena_alloc(arena, (n + 1) * sizeof *row);
  if (!w || !l || !row) return false;
  for (size_t i = 0; i < n * n; i++)
    if (ambit_interval_is_empty(a[i]) || !ambit_interval_is_bounded(a[i])) return false;
  if (!invert_cholesky(n, a, w, l)) return false;
  for (size_t i = 0; i < n; i++)
    if (!is_dominant(n, w, i, a, row)) return false;
  return true;
}

/* -- Lyapunov's equation, with the upper triangle of P as unknowns */

static size_t place(size_t n, size_t i, size_t j) { return i <= j ? i * n - i * (i + 1) / 2 + j : place(n, j, i); }

/* row (i, j) of the equations: sum_k A_ki P_kj + P_ik A_kj = -[i = j] */
static void set_rows(size_t n, const interval *a, interval *m) {
  size_t unknowns = n * (n + 1) / 2;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i; j < n; j++) {
      interval *row = m + place(n, i, j) * unknowns;
      for (size_t k = 0; k < n; k++) {
        row[place(n, k, j)].lo += ambit_interval_mid(a[k * n + i]);
        row[place(n, i, k)].lo += ambit_interval_mid(a[k * n + j]);
      }
    }
  for (size_t i = 0; i < unknowns * unknowns; i++) m[i].hi = m[i].lo;
}

bool ambit_lyapunov_solve(size_t n, const ambit_interval *a, double *p, ambit_arena *arena) {
  size_t unknowns = n * (n + 1) / 2;
  if (n > AMBIT_LYAPUNOV_MAX) return false;
  interval *m = ambit_arena_alloc(arena, (unknowns * unknowns + 1) * sizeof *m);
  double *inverse = ambit_arena_alloc(arena, 2 * (unknowns * unknowns + 1) * sizeof *inverse);
  if (!m || !inverse) return false;
  set_rows(n, a, m);
  if (!ambit_invert_middle(unknowns, m, inverse)) return false;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i; j < n; j++) {
      double sum = 0;
      for (size_t k = 0; k < n; k++) sum -= inverse[place(n, i, j) * unknowns + place(n, k, k)];
      if (!isfinite(sum)) return false;
      p[i * n + j] = p[j * n + i] = sum;
    }
  return true;
}

bool ambit_lyapunov_holds(size_t n, const ambit_interval *a, const double *p, ambit_arena *arena) {
  interval *h = ambit_arena_alloc(arena, (n * n + 1) * sizeof *h);
  if (!h) return false;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      interval sum = { 0, 0 };
      for (size_t k = 0; k < n; k++) {
        sum = ambit_interval_sub(sum, ambit_interval_mul(a[k * n + i], point(p[k * n + j])));
        sum = ambit_interval_sub(sum, ambit_interval_mul(point(p[i * n + k]), a[k * n + j]));
      }
      h[i * n + j] = sum;
    }
  return ambit_is_positive_definite(n, h, arena);
}

bool ambit_is_negative_along(size_t n, const double *p, const double *v) {
  interval sum = { 0, 0 };
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      sum = ambit_interval_add(
          sum, ambit_interval_mul(ambit_interval_mul(point(v[i]), point(v[j])), point(p[i * n + j])));
  return sum.hi < 0;
}
