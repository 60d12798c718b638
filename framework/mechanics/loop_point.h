/* loop_point.h -- the constraints of a mechanism in doubles at one configuration: what pivots are chosen by. Nothing
** here proves anything; uncertain data count at the midpoints of their ranges.
*/
#ifndef AMBIT_LOOP_POINT_H
#define AMBIT_LOOP_POINT_H
#include "mechanics/constraints.h"

typedef struct ambit_loop_point {
  const ambit_constraints *c;
  const ambit_tape *tape;
  ambit_interval *in, *slot;
  size_t *place; /* [nq] number of the tape's input, SIZE_MAX: not one of them */
  size_t time;
  double *g;        /* [n + npure] after evaluate */
  double *slope;    /* [(n + npure) * nq] */
  double *velocity; /* [n * nu] */
  double *drive;    /* [n] */
  double *scratch;
} ambit_loop_point;

ambit_status ambit_loop_point_open(
    const ambit_constraints *c, ambit_arena *arena, ambit_loop_point *p, ambit_failure *f);
/* false: something is not defined or not finite there */
bool ambit_loop_point_evaluate(ambit_loop_point *p, const double *q, double t);
/* Moves q onto g = 0 by damped Gauss-Newton steps; false: no convergence. Afterwards p holds the values there. */
bool ambit_loop_point_close(ambit_loop_point *p, double *q, double t);
/* The row whose residual is largest at the point last evaluated. */
size_t ambit_loop_point_worst(const ambit_loop_point *p);
#endif
