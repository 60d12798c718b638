/* eigen.c -- "ambit.eigen/1": a balanced matrix' real Schur form and back-substitution
** (plugins/shared/real_schur.h). */
#include "shared/real_schur.h"
#include <ambit/eigen.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static ambit_status find(uint32_t n, double *t, double *z, double *rest, double *re, double *im, double *vector) {
  double *scale = rest, *work = rest + n;
  for (size_t i = 0; i < (size_t)n * n; i++)
    if (!isfinite(t[i])) return AMBIT_UNABLE;
  balance_matrix(n, t, scale);
  if (!real_schur(n, t, z, work)) return AMBIT_UNABLE;
  real_schur_vectors(n, t, z, re, im, vector, work);
  for (size_t i = 0; i < (size_t)n * n; i++) vector[i] *= scale[i / n];
  return AMBIT_OK;
}

static ambit_status decompose(uint32_t n, const double *a, double *re, double *im, double *vector) {
  if (n == 0) return AMBIT_OK;
  size_t square = (size_t)n * n;
  double *memory = malloc((2 * square + 3 * (size_t)n) * sizeof *memory);
  if (!memory) return AMBIT_NOMEM;
  memcpy(memory, a, square * sizeof *a);
  ambit_status status = find(n, memory, memory + square, memory + 2 * square, re, im, vector);
  free(memory);
  return status;
}

static const ambit_eigen_service service = { sizeof service, decompose };

static const void *get(const char *interface_id) {
  return strcmp(interface_id, AMBIT_EIGEN_SERVICE) == 0 ? &service : NULL;
}

const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "service.eigen", "2.0",
  "Approximate eigenvalues and eigenvectors. The kernel loads it by itself where the stability of an equilibrium or "
  "the "
  "eigenvalues of a matrix are asked for, and encloses the true ones around them.",
  get };
