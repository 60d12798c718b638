/* axes.h -- principal axes of a symmetric matrix by Jacobi's rotations [J. reine angew. Math. 30 (1846)]; only as good
** as plain arithmetic. frame [n x n] := columns that are nearly orthogonal; shape [n x n] becomes nearly diagonal. What
** is not finite is left as it is found. */
#ifndef SHARED_AXES_H
#define SHARED_AXES_H
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#define SHARED_SWEEPS 12
#define SHARED_NEGLIGIBLE 0x1p-60

static inline void shared_identity(uint32_t n, double *Q) {
  memset(Q, 0, (size_t)n * n * sizeof *Q);
  for (uint32_t i = 0; i < n; i++) Q[(size_t)i * n + i] = 1;
}

/* rows or columns a and b, `stride` apart within, turned by (c, s) */
static inline void shared_turn(uint32_t n, double *a, double *b, size_t stride, double c, double s) {
  for (uint32_t k = 0; k < n; k++) {
    double x = a[k * stride], y = b[k * stride];
    a[k * stride] = c * x - s * y;
    b[k * stride] = s * x + c * y;
  }
}

/* makes A[p][q] vanish */
static inline void shared_rotate(uint32_t n, double *A, double *Q, uint32_t p, uint32_t q) {
  double off = A[(size_t)p * n + q];
  if (off == 0) return;
  double theta = (A[(size_t)q * n + q] - A[(size_t)p * n + p]) / (2 * off);
  double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1);
  shared_turn(n, A + (size_t)p * n, A + (size_t)q * n, 1, c, t * c);
  shared_turn(n, A + p, A + q, n, c, t * c);
  shared_turn(n, Q + p, Q + q, n, c, t * c);
}

static inline double shared_off_diagonal(uint32_t n, const double *A, double *diagonal) {
  double off = 0;
  *diagonal = 0;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t j = 0; j < n; j++)
      if (i == j)
        *diagonal += fabs(A[(size_t)i * n + j]);
      else
        off += fabs(A[(size_t)i * n + j]);
  return off;
}

static inline void shared_axes(uint32_t n, double *shape, double *frame) {
  shared_identity(n, frame);
  for (int sweep = 0; sweep < SHARED_SWEEPS; sweep++) {
    double diagonal, off = shared_off_diagonal(n, shape, &diagonal);
    if (!(off > SHARED_NEGLIGIBLE * diagonal) || !(off < DBL_MAX)) return;
    for (uint32_t p = 0; p + 1 < n; p++)
      for (uint32_t q = p + 1; q < n; q++) shared_rotate(n, shape, frame, p, q);
  }
}
#endif
