/* linear.c -- unverified linear algebra (linear.h). */
#include "linear.h"
#include <ambit/matrix.h>
#include <math.h>
#include <string.h>

/* the power of two near 1 / the largest entry of a row; 0: there is none */
static double row_unit(size_t n, const double *row) {
  double most = 0;
  int exponent;
  for (size_t j = 0; j < n; j++) most = fmax(most, fabs(row[j]));
  if (!(most > 0 && most < INFINITY)) return 0;
  frexp(most, &exponent);
  return ldexp(1, -exponent);
}

/* Rows of states that are small by many orders would lose all digits in the elimination: all become of one size. */
int matrix_inverse(size_t n, const double *A, double *inverse) {
  square factors;
  uint32_t row[N_MAX];
  for (size_t i = 0; i < n; i++) {
    double unit = row_unit(n, A + i * n);
    for (size_t j = 0; j < n; j++) {
      factors[i * n + j] = unit * A[i * n + j];
      inverse[i * n + j] = i == j ? unit : 0;
    }
  }
  if (!ambit_matrix_factor(n, factors, row)) return 0;
  ambit_matrix_solve(n, factors, row, n, inverse);
  return 1;
}

/* r += sum of four rows of b, so that r is loaded once */
static inline void add_four(size_t n, double *restrict r, const double *restrict x, const double *restrict b) {
  for (size_t j = 0; j < n; j++) r[j] += (x[0] * b[j] + x[1] * b[n + j]) + (x[2] * b[2 * n + j] + x[3] * b[3 * n + j]);
}

void matrix_multiply(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *r) {
  memset(r, 0, rows * cols * sizeof *r);
  for (size_t i = 0; i < rows; i++) {
    const double *x = a + i * inner;
    size_t k = 0;
    for (; k + 4 <= inner; k += 4)
      if (x[k] != 0 || x[k + 1] != 0 || x[k + 2] != 0 || x[k + 3] != 0)
        add_four(cols, r + i * cols, x + k, b + k * cols);
    for (; k < inner; k++) ambit_matrix_subtract(cols, r + i * cols, -x[k], b + k * cols);
  }
}

double matrix_row_sum_norm(size_t rows, size_t cols, const double *a) {
  double most = 0;
  for (size_t i = 0; i < rows; i++) {
    double sum = 0;
    for (size_t j = 0; j < cols; j++) sum += fabs(a[i * cols + j]);
    if (!(sum <= most)) most = sum; /* NaN is kept */
  }
  return most;
}

#define SQUARINGS 6

double matrix_radius(size_t n, double *A) {
  square next;
  double logarithm = 0; /* of what A was divided by */
  for (int k = 0; k <= SQUARINGS; k++) {
    double most = 0, trace = 0;
    for (size_t i = 0; i < n * n; i++) most = fmax(most, fabs(A[i]));
    if (!(most > 0 && most < INFINITY)) return 0;
    for (size_t i = 0; i < n; i++) trace += fabs(A[i * n + i]);
    if (k == SQUARINGS) return trace > 0 ? exp((log(trace) + logarithm) / (1 << SQUARINGS)) : 0;
    for (size_t i = 0; i < n * n; i++) A[i] = fabs(A[i]) / most;
    logarithm = 2 * (logarithm + log(most));
    matrix_multiply(n, n, n, A, A, next);
    memcpy(A, next, n * n * sizeof *A);
  }
  return 0;
}

static double product(size_t n, size_t m, const double *A, size_t i, size_t j, const double *scale) {
  double sum = 0;
  for (size_t k = 0; k < n; k++) sum += (A[k * m + i] / scale[k]) * (A[k * m + j] / scale[k]);
  return sum;
}

/* Gram-Schmidt, twice */
int orthonormalise(size_t n, size_t m, double *A, const double *scale, double *R) {
  for (size_t i = 0; R && i < m * m; i++) R[i] = 0;
  for (size_t j = 0; j < m; j++) {
    double before = sqrt(product(n, m, A, j, j, scale));
    for (int pass = 0; pass < 2; pass++)
      for (size_t i = 0; i < j; i++) {
        double share = product(n, m, A, i, j, scale);
        for (size_t k = 0; k < n; k++) A[k * m + j] -= share * A[k * m + i];
        if (R) R[i * m + j] += share;
      }
    double length = sqrt(product(n, m, A, j, j, scale));
    if (!(length > 1e-15 * before)) return 0;
    for (size_t k = 0; k < n; k++) A[k * m + j] /= length;
    if (R) R[j * m + j] = length;
  }
  return 1;
}

double scaled_condition(size_t n, const double *A, const double *scale) {
  square S, inverse;
  S[0] = 0;
  double norm = 0, other = 0;
  for (size_t j = 0; j < n; j++) {
    double length = sqrt(product(n, n, A, j, j, scale));
    for (size_t i = 0; i < n; i++) S[i * n + j] = A[i * n + j] / scale[i] / length;
  }
  if (!matrix_inverse(n, S, inverse)) return INFINITY;
  for (size_t i = 0; i < n * n; i++) norm += S[i] * S[i], other += inverse[i] * inverse[i];
  double condition = sqrt(norm * other);
  return condition >= 0 ? condition : INFINITY;
}

void join_columns(size_t n, size_t ma, const double *a, size_t mb, const double *b, double *r) {
  for (size_t i = 0; i < n; i++) {
    memcpy(r + i * (ma + mb), a + i * ma, ma * sizeof *a);
    memcpy(r + i * (ma + mb) + ma, b + i * mb, mb * sizeof *b);
  }
}
