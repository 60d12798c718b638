/* eigen.h -- the eigenvalues of an interval matrix, enclosed, and what they say about x' = A x. */
#ifndef AMBIT_EIGEN_H
#define AMBIT_EIGEN_H
#include <ambit/registry.h>
#include "verbs/stability/spectrum.h"

typedef enum ambit_stability {
  AMBIT_STABILITY_UNDECIDED,
  AMBIT_STABILITY_STABLE,  /* all real parts are negative, for every matrix of the set */
  AMBIT_STABILITY_UNSTABLE /* some real part is positive, for every matrix of the set */
} ambit_stability;

typedef struct ambit_eigen {
  ambit_stability stability;
  const char *by; /* "eigenvalues", "Lyapunov's equation" or "" */
  bool enclosed;  /* are the eigenvalues? */
} ambit_eigen;

/* a [n x n] by rows, value [n]. Loads service/eigen: its failure to load is one of this call. Anything that cannot be
** enclosed or decided is left so. */
ambit_status ambit_eigen_analyse(ambit_registry *registry, size_t n, const ambit_interval *a, ambit_eigenvalue *value,
    ambit_eigen *result, ambit_failure *f);
#endif
