/* dynamics.h -- equations of motion from the graph: M(q) u' = h(q, u), and the system x = (q, u).
**
** Every joint's AMBIT_BALANCE r(q, u, u') is pulled; it is affine in u'. M = -dr/du', h = r at u' = 0. M is symmetric
** positive definite for physical masses (kinetostatic method, Kecskemethy & Hiller 1994). Multipliers of constraints
** are symbols that h may contain.
*/
#ifndef AMBIT_DYNAMICS_H
#define AMBIT_DYNAMICS_H
#include <ambit/arena.h>
#include <ambit/mechanism.h>
#include <ambit/system.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the equations of motion are of. */
typedef struct ambit_variables {
  size_t ncoordinate, n;
  const ambit_coordinate *coordinate; /* [ncoordinate] */
  const ambit_speed *speed;           /* [n], one for each degree of freedom */
  const ambit_expr *u, *du, *zero;    /* [n] symbols of the speeds, of their time derivatives; zeros */
} ambit_variables;

typedef struct ambit_motion {
  size_t n;
  ambit_variables variables;
  const ambit_expr *mass;  /* [n*n] M by rows, simplified */
  const ambit_expr *force; /* [n] h */
} ambit_motion;

/* INVALID: no coordinates; a coordinate that moves no mass (named); M singular for all q (named). */
AMBIT_EXPORT ambit_status ambit_motion_build(
    ambit_mechanism *m, ambit_arena *arena, ambit_motion *motion, ambit_failure *f);
/* h alone: (*force)[*n] */
AMBIT_EXPORT ambit_status ambit_motion_force(
    ambit_mechanism *m, ambit_arena *arena, size_t *n, const ambit_expr **force, ambit_failure *f);
/* du[n] := M^-1 (h + applied); applied [n] or NULL */
AMBIT_EXPORT ambit_status ambit_motion_accelerations(
    ambit_graph *g, const ambit_motion *motion, const ambit_expr *applied, ambit_expr *du, ambit_failure *f);
/* How the accelerations are written. The mass matrix eliminated: tightest and shortest for few joints. The
** articulated-body form: grows linearly with their number. AUTO: the shorter one. */
#define AMBIT_FORM_AUTO 0u
#define AMBIT_FORM_MASS_MATRIX 1u
#define AMBIT_FORM_ARTICULATED 2u
/* The system of a mechanism, with constraints or without; form: AMBIT_FORM_*, of mechanisms without loops. */
AMBIT_EXPORT ambit_status ambit_constrained_system(
    ambit_mechanism *m, uint32_t form, ambit_arena *arena, ambit_system *system, ambit_failure *f);

/* What is asked of a mechanism with its motion given is a list of expressions, one for each speed (or one row for
** each). */
typedef struct ambit_list {
  size_t n;
  const ambit_expr *e;
} ambit_list;

/* tau [n]: the generalised forces along the speeds that make the mechanism move with q, u, u': M u' + bias. */
AMBIT_EXPORT ambit_status ambit_inverse_dynamics(
    ambit_mechanism *m, ambit_arena *arena, ambit_list *tau, ambit_failure *f);
/* [n]: the generalised forces that hold the mechanism at rest against the field of gravity, and nothing else */
AMBIT_EXPORT ambit_status ambit_gravity_torque(
    ambit_mechanism *m, ambit_arena *arena, ambit_list *torque, ambit_failure *f);
/* e [6*n] by rows: d(angular velocity, velocity)/du in world axes, of the point at `offset` [3] in the frame's axes, or
** of the frame's origin (NULL) */
AMBIT_EXPORT ambit_status ambit_jacobian(ambit_mechanism *m, ambit_frame frame, const ambit_expr *offset,
    ambit_arena *arena, ambit_list *jacobian, ambit_failure *f);

#ifdef __cplusplus
}
#endif
#endif
