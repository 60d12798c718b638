/* sample_lanes.h -- x' = f(x, p, t) from many starts at once, in ordinary floating point.
**
** The lanes share their steps: one evaluation of the tape serves all of them, and the lane with the largest error
** decides. Method: sample_tableau.h. A lane that gets no step (its solution escapes, or f is not defined) is dropped
** and the others go on; if steps are short because the method is unstable with longer ones, all are given up: the
** system is stiff. The estimate of a step's error is that of one step: errors add up over a run, so tolerances say
** nothing certain about the end.
*/
#ifndef AMBIT_SAMPLE_LANES_H
#define AMBIT_SAMPLE_LANES_H
#include <ambit/status.h>
#include <ambit/solver.h>
#include <ambit/work.h>
#include <stdbool.h>

typedef struct ambit_lanes ambit_lanes;

/* For up to `width` lanes. Of the problem: nx, np, rhs, uses_time, time; it and the context must outlive the lanes. */
ambit_status ambit_lanes_open(const ambit_problem *p, const ambit_arithmetic *arithmetic, void *ctx, size_t width,
    ambit_lanes **lanes, ambit_failure *f);
const ambit_work *ambit_lanes_work(const ambit_lanes *lanes);
void ambit_lanes_close(ambit_lanes *lanes); /* NULL is allowed */

typedef enum ambit_lanes_outcome {
  AMBIT_LANES_DONE,
  AMBIT_LANES_STIFF,  /* none of the lanes that were left reached the end */
  AMBIT_LANES_STOPPED /* by `pause` */
} ambit_lanes_outcome;

typedef struct ambit_lanes_run {
  size_t n;                  /* lanes */
  const double *x0, *p;      /* [nx][n], [np][n] */
  double relative, absolute; /* error allowed in a step: absolute + relative |x_i|, root mean square over i */
  double longest;            /* step; 0: any */
  /* the states x [nx][n] at time[k], k = 1, ...; of the lanes that are not lost */
  void (*take)(void *user, uint32_t k, size_t n, const double *x, const bool *lost);
  int32_t (*pause)(void *user); /* before each step; nonzero: stop. May be NULL */
  void *user;
  bool *lost; /* [n] false at first; which lanes did not reach the end */
} ambit_lanes_run;

/* No allocation. *steps: accepted ones. */
ambit_lanes_outcome ambit_lanes_integrate(ambit_lanes *lanes, const ambit_lanes_run *run, size_t *steps);
#endif
