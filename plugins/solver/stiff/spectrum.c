/* spectrum.c -- eigenvectors by GSL (spectrum.h). Its workspaces are allocated once. */
#include "spectrum.h"
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdlib.h>

struct eigen_memory {
  gsl_matrix *A;
  gsl_vector_complex *value;
  gsl_matrix_complex *vector;
  gsl_eigen_nonsymmv_workspace *work;
  gsl_matrix *Z;
  gsl_eigen_nonsymm_workspace *schur;
};

eigen_memory *eigen_open(size_t n) {
  eigen_memory *e = malloc(sizeof *e);
  if (!e) return NULL;
  gsl_set_error_handler_off(); /* GSL's own would abort; what fails says so by its status */
  *e = (eigen_memory) { gsl_matrix_alloc(n, n), gsl_vector_complex_alloc(n), gsl_matrix_complex_alloc(n, n),
    gsl_eigen_nonsymmv_alloc(n), gsl_matrix_alloc(n, n), gsl_eigen_nonsymm_alloc(n) };
  if (e->A && e->value && e->vector && e->work && e->Z && e->schur) {
    gsl_eigen_nonsymm_params(1, 0, e->schur);
    return e;
  }
  eigen_close(e);
  return NULL;
}

void eigen_close(eigen_memory *e) {
  if (!e) return;
  if (e->A) gsl_matrix_free(e->A);
  if (e->value) gsl_vector_complex_free(e->value);
  if (e->vector) gsl_matrix_complex_free(e->vector);
  if (e->work) gsl_eigen_nonsymmv_free(e->work);
  if (e->Z) gsl_matrix_free(e->Z);
  if (e->schur) gsl_eigen_nonsymm_free(e->schur);
  free(e);
}

static void sort(const eigen_memory *e, size_t n, size_t *order, size_t *count) {
  *count = 0;
  for (size_t i = 0; i < n; i++) {
    size_t at = (*count)++;
    double x = GSL_REAL(gsl_vector_complex_get(e->value, i));
    for (; at > 0 && GSL_REAL(gsl_vector_complex_get(e->value, order[at - 1])) > x; at--) order[at] = order[at - 1];
    order[at] = i;
    if (GSL_IMAG(gsl_vector_complex_get(e->value, i)) != 0) i++; /* the conjugate follows */
  }
}

/* column c of V := real or imaginary part of eigenvector i */
static void take(const eigen_memory *e, size_t n, size_t i, int imaginary, size_t c, double *V) {
  for (size_t k = 0; k < n; k++) {
    gsl_complex z = gsl_matrix_complex_get(e->vector, k, i);
    V[k * n + c] = imaginary ? GSL_IMAG(z) : GSL_REAL(z);
  }
}

static void normalise(size_t n, size_t c, size_t columns, double *V) {
  double sum = 0;
  for (size_t k = 0; k < n; k++)
    for (size_t j = c; j < c + columns; j++) sum += V[k * n + j] * V[k * n + j];
  for (size_t k = 0; k < n && sum > 0; k++)
    for (size_t j = c; j < c + columns; j++) V[k * n + j] /= sqrt(sum);
}

void eigen_find(eigen_memory *e, size_t n, const double *J, const double *scale, spectrum *r) {
  size_t order[N_MAX], count, c = 0;
  r->ok = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      double x = J[i * n + j] * (scale[j] / scale[i]);
      if (!(fabs(x) < 1e150)) return; /* GSL may not end on NaN */
      gsl_matrix_set(e->A, i, j, x);
    }
  if (gsl_eigen_nonsymmv(e->A, e->value, e->vector, e->work)) return;
  sort(e, n, order, &count);
  for (size_t k = 0; k < count; k++) {
    size_t i = order[k];
    gsl_complex z = gsl_vector_complex_get(e->value, i);
    int pair = GSL_IMAG(z) != 0;
    if (c + (size_t)pair >= n) return;
    r->real[c] = GSL_REAL(z), r->kind[c] = pair ? PAIR : SINGLE;
    take(e, n, i, 0, c, r->V);
    if (pair) {
      r->real[c + 1] = GSL_REAL(z), r->kind[c + 1] = SECOND;
      take(e, n, i, 1, c + 1, r->V);
    }
    normalise(n, c, 1 + (size_t)pair, r->V);
    c += 1 + (size_t)pair;
  }
  for (size_t k = 0; k < n * n; k++) r->V[k] *= scale[k / n];
  r->ok = c == n;
}

#define ROUNDING 1e-12 /* of the norm, below the diagonal */

/* what is beside A in a larger matrix is zero, and its block of Z stays apart; what that is worth is judged by T */
int eigen_schur(eigen_memory *e, size_t n, const double *A, double *Z, double *T, int *second) {
  square AZ, transposed;
  gsl_matrix_set_zero(e->A);
  for (size_t i = 0; i < n * n; i++) {
    if (!(fabs(A[i]) < 1e150)) return 0;
    gsl_matrix_set(e->A, i / n, i % n, A[i]);
  }
  if (gsl_eigen_nonsymm_Z(e->A, e->value, e->Z, e->schur)) return 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++) transposed[k * n + i] = Z[i * n + k] = gsl_matrix_get(e->Z, i, k);
  matrix_multiply(n, n, n, A, Z, AZ);
  matrix_multiply(n, n, n, transposed, AZ, T);
  double norm = matrix_row_sum_norm(n, n, T);
  for (size_t i = 0; i < n; i++) {
    second[i] = i > 0 && !second[i - 1] && fabs(T[i * n + i - 1]) > ROUNDING * norm;
    for (size_t k = 0; k + 1 < i + (size_t)!second[i]; k++)
      if (!(fabs(T[i * n + k]) <= ROUNDING * norm)) return 0;
  }
  return 1;
}
