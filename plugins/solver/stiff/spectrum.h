/* spectrum.h -- eigenvalues, eigenvectors and Schur vectors of small real matrices; approximate. */
#ifndef STIFF_SPECTRUM_H
#define STIFF_SPECTRUM_H
#include "linear.h"
#include <ambit/solver.h>

enum { SINGLE, PAIR, SECOND }; /* a real eigenvector; real and imaginary part of a complex one */

/* Eigenvalues ascend by real part. Columns of V: eigenvectors, of unit length when divided by the scale. */
typedef struct spectrum {
  int ok;
  double real[N_MAX];
  uint32_t kind[N_MAX];
  square V;
} spectrum;

/* of J [n x n], computed for S^-1 J S with S = diag(scale) */
void eigen_find(size_t n, const double *J, const double *scale, spectrum *r);
/* Z [n x n] orthogonal with T := Z^T A Z triangular but for blocks of two, for A [n x n]; second[k]: column k is the
** second one of a block. 0: not found */
int eigen_schur(size_t n, const double *A, double *Z, double *T, int *second);
#endif
