/* bound.c -- verified bounds for small matrices (bound.h). */
#include "bound.h"
#include <math.h>
#include <string.h>

#define TURNS 60
#define ROOM (1 + 0x1p-10)

void bound_multiply(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *r) {
  for (size_t i = 0; i < rows; i++) {
    double *line = r + i * cols;
    for (size_t j = 0; j < cols; j++) line[j] = 0;
    for (size_t k = 0; k < inner; k++) {
      double x = a[i * inner + k];
      for (size_t j = 0; x != 0 && j < cols; j++) line[j] += x * b[k * cols + j];
    }
  }
}

/* r := K + K X */
static void turn(size_t n, const double *K, const double *X, double *r) {
  bound_multiply(n, n, n, K, X, r);
  for (size_t i = 0; i < n * n; i++) r[i] += K[i];
}

/* 1: K + K X <= X, and nothing else counts; next := K + K X */
static int verified(size_t n, const double *K, const double *X, double *next) {
  int good = 1;
  turn(n, K, X, next);
  for (size_t j = 0; j < n * n; j++) good &= next[j] <= X[j];
  return good;
}

/* where entries that underflow do not settle, all are lifted by a little: ones shrink under K if its row sums are below
** 1 */
static int lift(size_t n, const double *K, double *X) {
  square next;
  double most = 0;
  for (size_t j = 0; j < n * n; j++) most = larger(most, X[j]);
  for (double share = 0x1p-80; share < 0x1p-20; share *= 0x1p20) {
    for (size_t j = 0; j < n * n; j++) X[j] += share * most;
    if (verified(n, K, X, next)) return 1;
  }
  return 0;
}

/* Whatever X >= 0 is: K + K X <= X makes X a bound of every partial sum, by induction, so the series converges. What
** X = (K + K X) ROOM tends to has room in every entry, also in those where K is 0. */
int bound_neumann(size_t n, const double *K, double *X) {
  square next;
  for (size_t j = 0; j < n * n; j++) X[j] = ROOM * K[j];
  for (int i = 0; i < TURNS; i++) {
    if (verified(n, K, X, next)) return 1;
    for (size_t j = 0; j < n * n; j++) {
      if (!(next[j] < 1e3)) return 0;
      X[j] = ROOM * next[j];
    }
  }
  return lift(n, K, X);
}

/* A^-1 X = (I - K)^-1 C X with K = I - C A */
int bound_solution(size_t n, const double *C, const iv *A, size_t m, const iv *X, double *r) {
  square K, E, Y;
  K[0] = Y[0] = 0; /* there may be no columns */
  iv row[N_MAX];
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < n; j++) row[j] = iv_of(i == j);
    for (size_t l = 0; l < n; l++) iv_add_scaled(n, row, A + l * n, -C[i * n + l]);
    for (size_t j = 0; j < n; j++) K[i * n + j] = iv_mag(row[j]);
  }
  if (!bound_neumann(n, K, E)) return 0;
  for (size_t i = 0; i < n; i++) {
    memset(row, 0, sizeof row);
    for (size_t l = 0; l < n; l++) iv_add_scaled(m, row, X + l * m, C[i * n + l]);
    for (size_t j = 0; j < m; j++) Y[i * m + j] = iv_mag(row[j]);
  }
  bound_multiply(n, n, m, E, Y, r);
  for (size_t i = 0; i < n * m; i++) r[i] += Y[i];
  return 1;
}

void bound_blocks(size_t n, const uint32_t *block, size_t blocks, const double *x, double *r) {
  uint32_t count[N_MAX] = { 0 };
  double only[N_MAX];
  for (size_t k = 0; k < blocks; k++) r[k] = 0;
  for (size_t i = 0; i < n; i++) {
    r[block[i]] += x[i] * x[i];
    only[block[i]] = fabs(x[i]);
    count[block[i]]++;
  }
  for (size_t k = 0; k < blocks; k++) r[k] = count[k] == 1 ? only[k] : sqrt(r[k]);
}
