/* inverse.h -- what is asked of a mechanism with its motion given: generalised forces, weights, Jacobians. */
#ifndef AMBIT_INVERSE_H
#define AMBIT_INVERSE_H
#include "mechanics/balance.h"

/* A list of expressions, one for each speed (or one row for each). */
typedef struct ambit_list {
  size_t n;
  const ambit_expr *e;
} ambit_list;

/* tau [n]: the generalised forces along the speeds that make the mechanism move with q, u, u': M u' + bias. */
ambit_status ambit_inverse_dynamics(ambit_mechanism *m, ambit_arena *arena, ambit_list *tau, ambit_failure *f);
/* [n]: the generalised forces that hold the mechanism at rest against the field of gravity, and nothing else */
ambit_status ambit_gravity_torque(ambit_mechanism *m, ambit_arena *arena, ambit_list *torque, ambit_failure *f);
/* e [6*n] by rows: d(angular velocity, velocity)/du in world axes, of the point at `offset` [3] in the frame's axes, or
** of the frame's origin (NULL) */
ambit_status ambit_jacobian(ambit_mechanism *m, ambit_frame frame, const ambit_expr *offset, ambit_arena *arena,
    ambit_list *jacobian, ambit_failure *f);
#endif
