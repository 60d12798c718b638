/* loop_motion.h -- closed loops: the dependent speeds and accelerations as functions of the independent ones.
**
** dg/dt = G u + c = 0 and its time derivative G u' + gamma = 0 are solved for the dependent speeds (partition.h):
**   u = N u_i + b,   u' = N u_i' + a,   N = [1; -G_d^-1 G_i],  b = [0; -G_d^-1 c],  a = [0; -G_d^-1 gamma]
** with gamma = d(G u + c)/dt at constant u. The columns of N span the null space of G (Wehage & Haug 1982).
*/
#ifndef AMBIT_LOOP_MOTION_H
#define AMBIT_LOOP_MOTION_H
#include "mechanics/loop_solver.h"
#include "mechanics/loops.h"

typedef struct ambit_loop_motion {
  ambit_loop_solver solver;
  const ambit_expr *projection; /* [nu * nfree] N by rows */
  const ambit_expr *speed;      /* [nu] u in terms of q, u_i, t */
  const ambit_expr *bias;       /* [nu] a in terms of q, u, t */
} ambit_loop_motion;
ambit_status ambit_loop_motion_build(
    const ambit_loops *loops, ambit_arena *arena, ambit_loop_motion *motion, ambit_failure *f);
#endif
