/* eigen.h -- "ambit.eigen/1": approximate eigenvalues and eigenvectors, of which nothing is believed: the kernel
** encloses the spectrum around them (framework/verbs/stability/spectrum.h). The plugin service/eigen.so is loaded when
** they are first asked for.
*/
#ifndef AMBIT_EIGEN_SERVICE_H
#define AMBIT_EIGEN_SERVICE_H
#include "base.h"

#define AMBIT_EIGEN_SERVICE "ambit.eigen/1"

typedef struct ambit_eigen_service {
  uint32_t size;
  /* [any] a [n x n] by rows, finite. Eigenvalue j is re[j] + i im[j]; of a conjugate pair the one with im > 0 comes
  ** first, the other one is next. vector [n x n] by rows: column j is the eigenvector of a real eigenvalue; columns j
  ** and j + 1 are the real and the imaginary part of that of the first of a pair. UNABLE: it did not converge. */
  ambit_status (*decompose)(uint32_t n, const double *a, double *re, double *im, double *vector);
} ambit_eigen_service;
#endif
