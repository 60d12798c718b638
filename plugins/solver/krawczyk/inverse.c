/* inverse.c -- Gauss-Jordan elimination with partial pivoting, in floating point: any C is allowed, a good one proves
** more. */
#include "krawczyk.h"
#include <math.h>
#include <string.h>

static uint32_t find_pivot(uint32_t n, const double *M, uint32_t k) {
  uint32_t best = k;
  for (uint32_t i = k + 1; i < n; i++)
    if (fabs(M[(size_t)i * n + k]) > fabs(M[(size_t)best * n + k])) best = i;
  return best;
}

static void swap_rows(uint32_t n, double *M, uint32_t i, uint32_t j) {
  if (i == j) return;
  for (uint32_t c = 0; c < n; c++) {
    double t = M[(size_t)i * n + c];
    M[(size_t)i * n + c] = M[(size_t)j * n + c];
    M[(size_t)j * n + c] = t;
  }
}

/* row i -= factor * row k */
static void subtract_row(uint32_t n, double *M, uint32_t i, uint32_t k, double factor) {
  for (uint32_t c = 0; c < n; c++) M[(size_t)i * n + c] -= factor * M[(size_t)k * n + c];
}

static void scale_row(uint32_t n, double *M, uint32_t i, double factor) {
  for (uint32_t c = 0; c < n; c++) M[(size_t)i * n + c] *= factor;
}

int krawczyk_invert(uint32_t n, double *M, double *C) {
  memset(C, 0, (size_t)n * n * sizeof *C);
  for (uint32_t i = 0; i < n; i++) C[(size_t)i * n + i] = 1;
  for (uint32_t k = 0; k < n; k++) {
    uint32_t p = find_pivot(n, M, k);
    swap_rows(n, M, k, p);
    swap_rows(n, C, k, p);
    double inverse = 1 / M[(size_t)k * n + k];
    if (!isfinite(inverse)) return 0;
    scale_row(n, M, k, inverse);
    scale_row(n, C, k, inverse);
    for (uint32_t i = 0; i < n; i++) {
      double factor = M[(size_t)i * n + k];
      if (i == k || factor == 0) continue;
      subtract_row(n, M, i, k, factor);
      subtract_row(n, C, i, k, factor);
    }
  }
  for (size_t i = 0; i < (size_t)n * n; i++)
    if (!isfinite(C[i])) return 0;
  return 1;
}
