/* loops.h -- closed loops: which speeds are independent, and the others as functions of them.
**
** dg/dt = G u + c = 0 and its time derivative G u' + gamma = 0 are solved for the dependent speeds (partition.h):
**   u = N u_i + b,   u' = N u_i' + a,   N = [1; -G_d^-1 G_i],  b = [0; -G_d^-1 c],  a = [0; -G_d^-1 gamma]
** with gamma = d(G u + c)/dt at constant u. The columns of N span the null space of G (Wehage & Haug 1982).
*/
#ifndef AMBIT_LOOPS_H
#define AMBIT_LOOPS_H
#include "mechanism/constraints.h"
#include "mechanism/loop_solver.h"

typedef struct ambit_loops {
  ambit_constraints constraints;
  ambit_partition partition;
  const double *reference; /* [nq] an assembled configuration, where pivots were chosen */
  size_t nfree;            /* independent speeds: numbers partition.independent[] */
} ambit_loops;

/* Where pivots are to be chosen: values of coordinates by name, and of "t" (else 0), replacing what was said before. And speeds, by the name
** of their coordinate or their own, that are to be independent. Names are checked when the loops are built. */
ambit_status ambit_loops_refer(
    ambit_mechanism *m, size_t n, const char *const *name, const double *value, ambit_failure *f);
ambit_status ambit_loops_choose(ambit_mechanism *m, size_t n, const char *const *name, ambit_failure *f);

/* INVALID: loops that cannot be closed from the reference, or are singular there; speeds that cannot be independent;
** the message names the loop. */
ambit_status ambit_loops_build(ambit_mechanism *m, ambit_arena *arena, ambit_loops *loops, ambit_failure *f);

typedef struct ambit_loop_motion {
  ambit_loop_solver solver;
  const ambit_expr *projection; /* [nu * nfree] N by rows */
  const ambit_expr *speed;      /* [nu] u in terms of q, u_i, t */
  const ambit_expr *bias;       /* [nu] a in terms of q, u, t */
} ambit_loop_motion;
ambit_status ambit_loop_motion_build(
    const ambit_loops *loops, ambit_arena *arena, ambit_loop_motion *motion, ambit_failure *f);
#endif
