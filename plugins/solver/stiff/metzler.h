/* metzler.h -- bounds of the solutions of u' = M u + d for a matrix M whose entries off the diagonal are nonnegative.
** */
#ifndef STIFF_METZLER_H
#define STIFF_METZLER_H
#include "bound.h"
#include <ambit/num.h>

/* A system on [0, length] with u(0) <= first, and what is known of it: u <= most on all of it. n < N_MAX; all but the
** diagonal of M nonnegative. */
typedef struct metzler {
  const ambit_num_service *num;
  size_t n;
  const double *M, *d, *first; /* [n x n] [n] [n] */
  double length;
  double *most; /* [n] is made smaller */
} metzler;

/* last >= u(length). In upward mode. 0: no bound. */
int metzler_propagate(const metzler *m, double *last);
/* the same by the exponential alone, for systems that are not stiff */
int metzler_exponential(const ambit_num_service *num, size_t n, const double *M, const double *d, double length,
    const double *first, double *last);
/* an upper bound of e^x */
double exp_above(const ambit_num_service *num, double x);
#endif
