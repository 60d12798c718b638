/* dynamics.h -- equations of motion from the graph: M(q) u' = h(q, u), and the system x = (q, u).
**
** Every joint's AMBIT_BALANCE r(q, u, u') is pulled; it is affine in u'. M = -dr/du', h = r at u' = 0. M is symmetric
** positive definite for physical masses (kinetostatic method, Kecskemethy & Hiller 1994). Multipliers of constraints
** are symbols that h may contain.
*/
#ifndef AMBIT_DYNAMICS_H
#define AMBIT_DYNAMICS_H
#include "mechanics/balance.h"
#include "graph/system.h"

typedef struct ambit_motion {
  size_t n;
  ambit_variables variables;
  const ambit_expr *mass;  /* [n*n] M by rows, simplified */
  const ambit_expr *force; /* [n] h */
} ambit_motion;

/* INVALID: no coordinates; a coordinate that moves no mass (named); M singular for all q (named). */
ambit_status ambit_motion_build(ambit_mechanism *m, ambit_arena *arena, ambit_motion *motion, ambit_failure *f);
/* h alone: (*force)[*n] */
ambit_status ambit_motion_force(
    ambit_mechanism *m, ambit_arena *arena, size_t *n, const ambit_expr **force, ambit_failure *f);
/* du[n] := M^-1 (h + applied); applied [n] or NULL */
ambit_status ambit_motion_accelerations(
    ambit_graph *g, const ambit_motion *motion, const ambit_expr *applied, ambit_expr *du, ambit_failure *f);
/* How the accelerations are written. The mass matrix eliminated: tightest and shortest for few joints. The
** articulated-body form: grows linearly with their number. AUTO: see forward.h. */
#define AMBIT_FORM_AUTO 0u
#define AMBIT_FORM_MASS_MATRIX 1u
#define AMBIT_FORM_ARTICULATED 2u
/* A system without right-hand sides, of these variables: states q, then u: names "beta1", "beta2", "beta1'",
** "beta2'" */
ambit_status ambit_dynamics_states(
    ambit_graph *g, const ambit_variables *v, ambit_arena *arena, ambit_system *system, ambit_failure *f);
#endif
