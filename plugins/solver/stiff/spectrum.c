/* spectrum.c -- eigenvectors in the order and length that frames want (spectrum.h). */
#include "spectrum.h"
#include "shared/real_schur.h"
#include <math.h>
#include <string.h>

static void sort(size_t n, const double *re, const double *im, size_t *order, size_t *count) {
  *count = 0;
  for (size_t i = 0; i < n; i++) {
    size_t at = (*count)++;
    for (; at > 0 && re[order[at - 1]] > re[i]; at--) order[at] = order[at - 1];
    order[at] = i;
    if (im[i] != 0) i++; /* the conjugate follows */
  }
}

static void normalise(size_t n, size_t c, size_t columns, double *V) {
  double sum = 0;
  for (size_t k = 0; k < n; k++)
    for (size_t j = c; j < c + columns; j++) sum += V[k * n + j] * V[k * n + j];
  for (size_t k = 0; k < n && sum > 0; k++)
    for (size_t j = c; j < c + columns; j++) V[k * n + j] /= sqrt(sum);
}

/* a Schur form of T; 0: not found, or not finite */
static int decompose(size_t n, double *T, double *Z) {
  double work[N_MAX];
  for (size_t i = 0; i < n * n; i++)
    if (!(fabs(T[i]) < 1e150)) return 0;
  return real_schur(n, T, Z, work);
}

void eigen_find(size_t n, const double *J, const double *scale, spectrum *r) {
  square T, Z, vector;
  double re[N_MAX], im[N_MAX], work[2 * N_MAX];
  size_t order[N_MAX], count, c = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++) T[i * n + k] = J[i * n + k] * (scale[k] / scale[i]);
  r->ok = decompose(n, T, Z);
  if (!r->ok) return;
  real_schur_vectors(n, T, Z, re, im, vector, work);
  sort(n, re, im, order, &count);
  for (size_t k = 0; k < count; k++) {
    size_t from = order[k], columns = im[from] != 0 ? 2 : 1;
    for (size_t j = 0; j < columns; j++) {
      r->real[c + j] = re[from], r->kind[c + j] = j ? SECOND : columns == 2 ? PAIR : SINGLE;
      for (size_t i = 0; i < n; i++) r->V[i * n + c + j] = vector[i * n + from + j];
    }
    normalise(n, c, columns, r->V);
    c += columns;
  }
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++) r->V[i * n + k] *= scale[i];
}

int eigen_schur(size_t n, const double *A, double *Z, double *T, int *second) {
  memcpy(T, A, n * n * sizeof *T);
  if (!decompose(n, T, Z)) return 0;
  for (size_t i = 0; i < n; i++) second[i] = i > 0 && T[i * n + i - 1] != 0;
  return 1;
}
