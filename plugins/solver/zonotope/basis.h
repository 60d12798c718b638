/* basis.h -- errors e = P_4 + G rho + discs as e = columns eps, |eps_k| <= 1: which directions eps stand for. */
#ifndef ZONOTOPE_BASIS_H
#define ZONOTOPE_BASIS_H
#include "proof.h"

typedef struct basis {
  int is_turned;   /* 0: columns are E along the axes of the states, and the matrices are not used */
  double *columns; /* [nx x nx] */
  double *inverse; /* [nx x nx] of columns, about */
  double *work;    /* [nx] */
} basis;

int basis_open(zono *z); /* 0: no memory */
/* a bound of sum_i y_i e_i between two steps: of the set at the end of the last one, the start of the next */
double basis_along(zono *z, const double *y);
/* for the set at the end of the step, whose modes are z->modes->now */
void basis_choose(zono *z);
/* y [nx], coefficients of eps := coefficients of e. Returns a bound of |y eps - (y e)|, the rounding. */
double basis_resolve(const zono *z, double *y);
#endif
