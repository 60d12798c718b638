/* factor.c -- systems of linear equations: Gaussian elimination with row pivoting, solved transposed for several right
** sides. In a singular matrix a pivot of 0 becomes one as small as rounding would have left: solutions are large then.
*/
#include "reduce.h"
#include <float.h>
#include <math.h>
#include <string.h>

static double largest(uint32_t n, const double *x) {
  double size = 0;
  for (uint32_t i = 0; i < n; i++) size = fmax(size, fabs(x[i]));
  return size;
}

static void swap_rows(uint32_t n, double *M, uint32_t *row, uint32_t a, uint32_t b) {
  uint32_t r = row[a];
  row[a] = row[b], row[b] = r;
  for (uint32_t j = 0; j < n; j++) {
    double x = M[(size_t)a * n + j];
    M[(size_t)a * n + j] = M[(size_t)b * n + j];
    M[(size_t)b * n + j] = x;
  }
}

void factor_decompose(uint32_t n, double *M, uint32_t *row) {
  for (uint32_t i = 0; i < n; i++) row[i] = i;
  for (uint32_t k = 0; k < n; k++) {
    uint32_t best = k;
    for (uint32_t i = k + 1; i < n; i++)
      if (fabs(M[(size_t)i * n + k]) > fabs(M[(size_t)best * n + k])) best = i;
    if (best != k) swap_rows(n, M, row, best, k);
    double *pivot = &M[(size_t)k * n];
    if (fabs(pivot[k]) < DBL_MIN) pivot[k] = fmax(DBL_EPSILON * largest(n - k, pivot + k), DBL_MIN);
    for (uint32_t i = k + 1; i < n; i++) {
      double *line = &M[(size_t)i * n], factor = line[k] /= pivot[k];
      if (factor == 0) continue; /* most entries of large systems are */
      for (uint32_t j = k + 1; j < n; j++) line[j] -= factor * pivot[j];
    }
  }
}

static void subtract(uint32_t count, double factor, const double *from, double *to) {
  if (factor == 0) return;
  for (uint32_t c = 0; c < count; c++) to[c] -= factor * from[c];
}

/* M^T = U^T L^T P: forward, backward, and the rows back to their places */
void factor_solve_transposed(uint32_t n, const duals *d, uint32_t count, const double *b, double *x) {
  const double *M = d->matrix;
  double *y = d->scratch;
  size_t stride = d->stride;
  for (uint32_t i = 0; i < n; i++) memcpy(y + i * stride, b + i * stride, count * sizeof *y);
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t c = 0; c < count; c++) y[i * stride + c] /= M[(size_t)i * n + i];
    for (uint32_t k = i + 1; k < n; k++) subtract(count, M[(size_t)i * n + k], y + i * stride, y + k * stride);
  }
  for (uint32_t i = n; i-- > 0;)
    for (uint32_t k = 0; k < i; k++) subtract(count, M[(size_t)i * n + k], y + i * stride, y + k * stride);
  for (uint32_t i = 0; i < n; i++) memcpy(x + d->row[i] * stride, y + i * stride, count * sizeof *x);
}
