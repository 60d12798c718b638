/* frame.c -- orthogonal frames: principal axes by Jacobi's rotations, Gram-Schmidt with pivoting, and how far a frame
** is from orthogonal.
**
** A frame need not be exact: whoever changes coordinates with it pads by the proved defect (history.c). Sources:
** Jacobi, J. reine angew. Math. 30 (1846); pivoting by length times width: Lohner 1988, Nedialkov 1999.
*/
#include "history.h"
#include <float.h>
#include <string.h>

static double dot(uint32_t n, const double *a, const double *b, size_t stride) {
  double s = 0;
  for (uint32_t i = 0; i < n; i++) s += a[i * stride] * b[i * stride];
  return s;
}

/* column c of Q made orthogonal to those before it; its length */
static double reject(uint32_t n, double *Q, uint32_t c) {
  for (int pass = 0; pass < 2; pass++)
    for (uint32_t d = 0; d < c; d++) {
      double s = dot(n, Q + d, Q + c, n);
      for (uint32_t i = 0; i < n; i++) Q[(size_t)i * n + c] -= s * Q[(size_t)i * n + d];
    }
  return sqrt(dot(n, Q + c, Q + c, n));
}

/* Some unit vector has at least the share 1/n of its square outside any c < n directions. */
static double complete(uint32_t n, double *Q, uint32_t c) {
  double length = 0;
  for (uint32_t k = 0; k < n && !(length * length * n > 0.5); k++) {
    for (uint32_t i = 0; i < n; i++) Q[(size_t)i * n + c] = i == k;
    length = reject(n, Q, c);
  }
  return length;
}

static void sort(uint32_t n, uint32_t *order, const double *size) {
  for (uint32_t i = 0; i < n; i++) {
    uint32_t at = i;
    for (; at > 0 && size[order[at - 1]] < size[i]; at--) order[at] = order[at - 1];
    order[at] = i;
  }
}

void frame_orthogonal(
    uint32_t n, const double *A, size_t pitch, const double *weight, double *frame, uint32_t *order, double *size) {
  for (uint32_t c = 0; c < n; c++) size[c] = sqrt(dot(n, A + c, A + c, pitch)) * weight[c];
  sort(n, order, size);
  for (uint32_t c = 0; c < n; c++) {
    double before = 0;
    for (uint32_t i = 0; i < n; i++) {
      double x = frame[(size_t)i * n + c] = A[i * pitch + order[c]];
      before = larger(before, fabs(x));
    }
    double length = reject(n, frame, c);
    if (!(length > 0x1p-40 * before)) length = complete(n, frame, c);
    for (uint32_t i = 0; i < n; i++) frame[(size_t)i * n + c] /= length;
  }
}

double frame_defect(uint32_t n, const double *frame) {
  double worst = 0;
  for (uint32_t i = 0; i < n; i++) {
    double row = 0;
    for (uint32_t j = 0; j < n; j++) {
      double above = -(i == j), below = i == j; /* of (Q^T Q - I)_ij and of its negative */
      for (uint32_t k = 0; k < n; k++) {
        double a = frame[(size_t)k * n + i], b = frame[(size_t)k * n + j];
        above += a * b;
        below += (-a) * b;
      }
      row += larger(above, below);
      if (!(row < INFINITY)) return INFINITY;
    }
    worst = larger(worst, row);
  }
  return worst;
}
