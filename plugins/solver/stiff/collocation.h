/* collocation.h -- Radau IIA collocation of x' = f: an accurate polynomial through a long stiff step, without any
** proof.
**
** On a step from t over h, tau in [-1, 1], p(tau) = x + sum_{k=1..N} c_k (T_k(tau) - T_k(-1)) solves the equation at
** the N right Radau nodes [Hairer & Wanner, Solving ODEs II, IV.5 and IV.8]. The nodes are the zeros of P_N - P_(N-1),
** computed when opened.
*/
#ifndef STIFF_COLLOCATION_H
#define STIFF_COLLOCATION_H
#include "linear.h"
#include "real.h"

#define NODES_MAX 20

typedef struct collocation {
  uint32_t N, nx, np, uses_time;
  real *rhs, *jacobian; /* of the tapes; Jacobian [nx x nx] */
  /* nodes 1 .. N, 0 is -1; D: derivative of the interpolant by tau at nodes 1 .. N; V: values at nodes, less that at
  ** node 0, to Chebyshev coefficients 1 .. N */
  long double node[NODES_MAX + 1], D[NODES_MAX][NODES_MAX + 1], V[NODES_MAX][NODES_MAX];

  /* -- a step */
  long double *x;       /* [nx + np] start and parameters */
  long double *Z;       /* [N x nx] at the nodes, less the start */
  long double *c;       /* [(N + 1) x nx] Chebyshev coefficients; row 0 is zero */
  double *size;         /* [nx + np] largest |x_i| on the step */
  double *least;        /* [nx] size of a state that is smaller */
  double *lost;         /* [nx] the same, by what rounding of the equations does to it in the step */
  double tolerance;     /* of errors relative to units */
  double *unit;         /* [nx] what errors are measured by: how far x_i moves on the step, and a share of its size */
  double *scale;        /* [nx + np] the same with a smaller share: how directions of errors are compared */
  double *A, *residual; /* [nx N x nx N], [nx N] */
  double *J;            /* [N x nx x nx] at the nodes */
  long double *f;       /* [nx] */
  uint32_t *row;        /* [nx N] */
  double error;         /* how large the last coefficients are, relative to units */
} collocation;

int collocation_open(const ambit_host *h, collocation *q);
/* 0: Newton's method failed */
int collocation_solve(collocation *q, double t, double h);
/* States that are at nothing against what they will be by the last time have no digits to be computed to as long as
** what moves them is lost in rounding: they get a least size from a crude look ahead, in steps from h on, each twice
** the last. Undone for each by collocation_outgrow. */
void collocation_look_ahead(collocation *q, double t, double h, double last);
void collocation_outgrow(collocation *q); /* for states that x holds above their least size */
/* the matrix of Newton's method at the solution, factored in A and row; its rows and columns are in units */
int collocation_linearise(collocation *q, double t, double h);
void collocation_value(const collocation *q, long double tau, long double *y); /* y [nx] */
#endif
