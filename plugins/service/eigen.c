/* eigen.c -- "ambit.eigen/1" by the GNU Scientific Library: balanced Hessenberg form, Francis' QR algorithm,
** back-substitution. */
#include <ambit/eigen.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <string.h>

typedef struct room {
  gsl_matrix *a;
  gsl_vector_complex *value;
  gsl_matrix_complex *vector;
  gsl_eigen_nonsymmv_workspace *work;
} room;

static void release(room *r) {
  if (r->a) gsl_matrix_free(r->a);
  if (r->value) gsl_vector_complex_free(r->value);
  if (r->vector) gsl_matrix_complex_free(r->vector);
  if (r->work) gsl_eigen_nonsymmv_free(r->work);
}

static int acquire(room *r, uint32_t n) {
  gsl_set_error_handler_off(); /* GSL's own ends the process */
  r->a = gsl_matrix_alloc(n, n);
  r->value = gsl_vector_complex_alloc(n);
  r->vector = gsl_matrix_complex_alloc(n, n);
  r->work = gsl_eigen_nonsymmv_alloc(n);
  return r->a && r->value && r->vector && r->work;
}

static void copy_out(const room *r, uint32_t n, double *re, double *im, double *vector) {
  for (uint32_t j = 0; j < n; j++) {
    gsl_complex value = gsl_vector_complex_get(r->value, j);
    re[j] = GSL_REAL(value), im[j] = GSL_IMAG(value);
    for (uint32_t i = 0; i < n; i++) {
      gsl_complex v = gsl_matrix_complex_get(r->vector, i, im[j] < 0 ? j - 1 : j);
      vector[(size_t)i * n + j] = im[j] < 0 ? GSL_IMAG(v) : GSL_REAL(v);
    }
  }
}

/* are complex values in pairs, as promised? */
static int is_paired(uint32_t n, const double *im) {
  for (uint32_t j = 0; j < n; j++) {
    if (im[j] == 0) continue;
    if (!(im[j] > 0 && j + 1 < n && im[j + 1] < 0)) return 0;
    j++;
  }
  return 1;
}

static ambit_status decompose(uint32_t n, const double *a, double *re, double *im, double *vector) {
  if (n == 0) return AMBIT_OK;
  room r = { 0 };
  ambit_status status = AMBIT_NOMEM;
  if (acquire(&r, n)) {
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t j = 0; j < n; j++) gsl_matrix_set(r.a, i, j, a[(size_t)i * n + j]);
    status = gsl_eigen_nonsymmv(r.a, r.value, r.vector, r.work) == GSL_SUCCESS ? AMBIT_OK : AMBIT_UNABLE;
  }
  if (status == AMBIT_OK) {
    for (uint32_t j = 0; j < n; j++) im[j] = GSL_IMAG(gsl_vector_complex_get(r.value, j));
    status = is_paired(n, im) ? AMBIT_OK : AMBIT_UNABLE;
  }
  if (status == AMBIT_OK) copy_out(&r, n, re, im, vector);
  release(&r);
  return status;
}

static const ambit_eigen_service service = { sizeof service, decompose };

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_EIGEN_SERVICE) == 0 ? &service : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.eigen", "1.0",
  "Approximate eigenvalues and eigenvectors by the GNU Scientific Library. The kernel loads it by itself where the "
  "stability of an equilibrium or the eigenvalues of a matrix are asked for, and encloses the true ones around them.",
  get };
