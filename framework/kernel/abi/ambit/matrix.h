/* matrix.h -- linear equations in doubles, by elimination: matrices by rows. Nothing is proved of what they return;
** proofs take it as a guess, and hold for any.
*/
#ifndef AMBIT_ABI_MATRIX_H
#define AMBIT_ABI_MATRIX_H
#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* x -= factor y */
static inline void ambit_matrix_subtract(size_t n, double *__restrict x, double factor, const double *__restrict y) {
  for (size_t k = 0; k < n; k++) x[k] -= factor * y[k];
}

static inline void ambit_matrix_swap(size_t n, double *x, double *y) {
  for (size_t k = 0; k < n; k++) {
    double keep = x[k];
    x[k] = y[k], y[k] = keep;
  }
}

/* The row, k or below, with the largest entry in column k; n: all are zero, or it is no number. */
static inline size_t ambit_matrix_pivot(size_t n, const double *A, size_t k) {
  size_t best = k;
  for (size_t i = k + 1; i < n; i++)
    if (fabs(A[i * n + k]) > fabs(A[best * n + k])) best = i;
  return fabs(A[best * n + k]) > 0 && fabs(A[best * n + k]) < INFINITY ? best : n;
}

/* C := roughly the inverse of A [n x n], which is destroyed; 0: A seems singular. */
static inline int ambit_matrix_invert(size_t n, double *A, double *C) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) C[i * n + j] = i == j;
  for (size_t k = 0; k < n; k++) {
    size_t best = ambit_matrix_pivot(n, A, k);
    if (best == n) return 0;
    if (best != k) ambit_matrix_swap(n, A + best * n, A + k * n), ambit_matrix_swap(n, C + best * n, C + k * n);
    double scale = 1 / A[k * n + k];
    for (size_t j = k + 1; j < n; j++) A[k * n + j] *= scale; /* what is before is not looked at again */
    for (size_t j = 0; j < n; j++) C[k * n + j] *= scale;
    for (size_t i = 0; i < n; i++) {
      double factor = A[i * n + k];
      if (i == k || factor == 0) continue;
      ambit_matrix_subtract(n - k - 1, A + i * n + k + 1, factor, A + k * n + k + 1);
      ambit_matrix_subtract(n, C + i * n, factor, C + k * n);
    }
  }
  for (size_t i = 0; i < n * n; i++)
    if (!isfinite(C[i])) return 0;
  return 1;
}

/* A [n x n] := its factors L and U, with the exchanges of rows in row [n]; 0: it seems singular. */
static inline int ambit_matrix_factor(size_t n, double *A, uint32_t *row) {
  for (size_t k = 0; k < n; k++) {
    size_t best = ambit_matrix_pivot(n, A, k);
    if (best == n) return 0;
    row[k] = (uint32_t)best;
    if (best != k) ambit_matrix_swap(n, A + k * n, A + best * n);
    for (size_t i = k + 1; i < n; i++) {
      if (A[i * n + k] == 0) continue;
      A[i * n + k] /= A[k * n + k];
      ambit_matrix_subtract(n - k - 1, A + i * n + k + 1, A[i * n + k], A + k * n + k + 1);
    }
  }
  return 1;
}

/* b [n x m] := A^-1 b, of a matrix with these factors */
static inline void ambit_matrix_solve(size_t n, const double *A, const uint32_t *row, size_t m, double *b) {
  for (size_t k = 0; k < n; k++)
    if (row[k] != k) ambit_matrix_swap(m, b + k * m, b + row[k] * m);
  for (size_t i = 1; i < n; i++)
    for (size_t k = 0; k < i; k++) ambit_matrix_subtract(m, b + i * m, A[i * n + k], b + k * m);
  for (size_t i = n; i-- > 0;) {
    for (size_t k = n; k-- > i + 1;) ambit_matrix_subtract(m, b + i * m, A[i * n + k], b + k * m);
    for (size_t j = 0; j < m; j++) b[i * m + j] /= A[i * n + i];
  }
}

/* x := A^-1 x for a symmetric A, of which the lower triangle is read, and becomes Cholesky's factor; 0: not definite */
static inline int ambit_matrix_solve_definite(size_t n, double *A, double *x) {
  for (size_t j = 0; j < n; j++)
    for (size_t i = j; i < n; i++) {
      double sum = A[i * n + j];
      for (size_t k = 0; k < j; k++) sum -= A[i * n + k] * A[j * n + k];
      if (i == j && !(sum > 0)) return 0;
      A[i * n + j] = i == j ? sqrt(sum) : sum / A[j * n + j];
    }
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < i; k++) x[i] -= A[i * n + k] * x[k];
    x[i] /= A[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; k++) x[i] -= A[k * n + i] * x[k];
    x[i] /= A[i * n + i];
  }
  return 1;
}
#endif
