/* eigen.c -- a basis in which a matrix is nearly diagonal, with blocks of two columns for complex pairs.
**
** Eigenvectors are approximate ones of the matrix in units of the states. They are only a good choice; what is proved
** is an enclosure of the inverse. With W near V^-1, E = I - W V and e = |E| < 1 in the row-sum norm, V^-1 = (I - E)^-1
** W differs from W by at most e / (1 - e) max_k |W_kj| in column j.
*/
#include "shared/real_schur.h"
#include "valencia.h"
#include <ambit/matrix.h>

#define CONDITION_MAX 1e5
#define CLOSE_MAX 1e-4 /* of e */

/* columns of the vectors, in units of the states, and where blocks begin */
static void collect(valencia *s, const double *im, const double *vector) {
  basis *z = &s->basis;
  uint32_t n = s->nx;
  z->nblock = 0;
  for (uint32_t k = 0; k < n; k++)
    if (im[k] >= 0) z->first[z->nblock++] = k;
  z->first[z->nblock] = n;
  for (size_t k = 0; k < (size_t)n * n; k++) z->v[k] = vector[k] * s->size[k / n];
}

static int enclose_inverse(basis *z, uint32_t n, const double *w) {
  double error = 0, largest = 0;
  for (uint32_t i = 0; i < n; i++) {
    double row = 0;
    for (uint32_t j = 0; j < n; j++) {
      interval sum = point(i == j);
      for (uint32_t k = 0; k < n; k++) sum = minus(sum, scaled(point(w[(size_t)i * n + k]), z->v[(size_t)k * n + j]));
      row += magnitude(sum);
    }
    error = larger_or_nan(error, row);
  }
  if (!(error < CLOSE_MAX)) return 0;
  double spread = error / -(error - 1);
  for (uint32_t j = 0; j < n; j++, largest = 0) {
    for (uint32_t k = 0; k < n; k++) largest = larger_or_nan(largest, fabs(w[(size_t)k * n + j]));
    for (uint32_t i = 0; i < n; i++)
      z->inverse[(size_t)i * n + j] = plus(point(w[(size_t)i * n + j]), within(spread * largest));
  }
  return 1;
}

/* in units of the states */
static int is_well_conditioned(const valencia *s, const double *w) {
  double v_norm = 0, w_norm = 0;
  for (uint32_t i = 0; i < s->nx; i++) {
    double v_row = 0, w_row = 0;
    for (uint32_t j = 0; j < s->nx; j++) {
      v_row += fabs(s->basis.v[(size_t)i * s->nx + j]) / s->size[i];
      w_row += fabs(w[(size_t)i * s->nx + j]) * s->size[j];
    }
    v_norm = larger(v_norm, v_row), w_norm = larger(w_norm, w_row);
  }
  return v_norm * w_norm < CONDITION_MAX;
}

int valencia_eigenbasis(valencia *s, const double *a) {
  uint32_t n = s->nx;
  size_t square = (size_t)n * n;
  double *t = s->eigen_room, *q = t + square, *vector = q + square, *re = vector + square, *im = re + n, *work = im + n;
  for (uint32_t i = 0; i < n; i++) s->size[i] = exp2(rint(log2(s->magnitude[i] + 1e-300)));
  for (size_t k = 0; k < square; k++) {
    t[k] = a[k] * s->size[k % n] / s->size[k / n];
    if (!isfinite(t[k])) return 0;
  }
  if (!real_schur(n, t, q, work)) return 0;
  real_schur_vectors(n, t, q, re, im, vector, work);
  collect(s, im, vector);
  for (size_t k = 0; k < square; k++) t[k] = s->basis.v[k];
  return ambit_matrix_invert(n, t, q) && is_well_conditioned(s, q) && enclose_inverse(&s->basis, n, q);
}

void valencia_unit_basis(valencia *s) {
  basis *z = &s->basis;
  z->nblock = s->nx;
  for (uint32_t i = 0; i < s->nx; i++) {
    z->first[i] = i;
    for (uint32_t j = 0; j < s->nx; j++) {
      z->v[(size_t)i * s->nx + j] = i == j;
      z->inverse[(size_t)i * s->nx + j] = point(i == j);
    }
  }
  z->first[s->nx] = s->nx;
}
