/* dynamics.h -- equations of motion from the graph: M(q) q'' = h(q, q'), and the system x = (q, q').
**
** Every joint's AMBIT_BALANCE r(q, q', q'') is pulled; it is affine in q''. M = -dr/dq'', h = r at q'' = 0. M is
** symmetric positive definite for physical masses; it is factored as L D L^T inside the graph, without pivoting
** (kinetostatic method, Kecskemethy & Hiller 1994).
*/
#ifndef AMBIT_DYNAMICS_H
#define AMBIT_DYNAMICS_H
#include "model/mechanism.h"
#include "model/system.h"

typedef struct ambit_motion {
  size_t n;
  const ambit_coordinate *coordinate; /* [n] */
  const ambit_expr *mass;             /* [n*n] M by rows, simplified */
  const ambit_expr *force;            /* [n] h */
} ambit_motion;

/* INVALID: no coordinates; a coordinate that moves no mass (named); M singular for all q (named). */
ambit_status ambit_motion_build(ambit_mechanism *m, ambit_arena *arena, ambit_motion *motion, ambit_failure *f);
/* [n] */
ambit_status ambit_motion_accelerations(ambit_graph *g, const ambit_motion *motion, ambit_expr *qdd, ambit_failure *f);
/* states q (in order), then q': names "beta1", "beta2", "beta1'", "beta2'" */
ambit_status ambit_dynamics_system(ambit_mechanism *m, ambit_arena *arena, ambit_system *system, ambit_failure *f);
#endif
