/* balance.h -- the variables of a mechanism and the balances of its joints: what forward and inverse dynamics start
** from.
*/
#ifndef AMBIT_BALANCE_H
#define AMBIT_BALANCE_H
#include "mechanics/affine_in.h"
#include <ambit/dynamics.h>
#include <string.h>

/* INVALID: an element fails; nothing moves. */
ambit_status ambit_variables_read(ambit_mechanism *m, ambit_arena *arena, ambit_variables *v, ambit_failure *f);
/* A system without right-hand sides, of these variables: states q, then u: names "beta1", "beta2", "beta1'",
** "beta2'" */
ambit_status ambit_dynamics_states(
    ambit_graph *g, const ambit_variables *v, ambit_arena *arena, ambit_system *system, ambit_failure *f);
/* Number of speed `index` of the part among v->speed; v->n: it is not a variable. */
size_t ambit_variables_find(const ambit_variables *v, uint32_t part, uint32_t index);
/* balance[n]: r(q, u, u'), the power of all wrenches and efforts along each speed per unit of it. A joint whose
** coordinate is a function of others (a gear) adds its share to theirs. */
ambit_status ambit_balances_pull(ambit_mechanism *m, const ambit_variables *v, ambit_expr *balance, ambit_failure *f);
/* Calls `visit` for every joint that an element makes, in the order of the parts, until one fails; `first`: the number
** that the joint's first speed has among those of its part. */
typedef ambit_status (*ambit_joint_visit)(void *user, ambit_frame joint, uint32_t first, uint32_t dof);
ambit_status ambit_joints_visit(ambit_mechanism *m, ambit_joint_visit visit, void *user);

/* The first part one of whose data (a law of force) depends on what `affine` was opened for; their number: none */
uint32_t ambit_laws_find(const ambit_mechanism *m, ambit_affine *affine);

/* The joint of a speed, for messages: "%.*s" */
#define AMBIT_JOINT_NAME(speed) (int)strcspn((speed)->name, "'"), (speed)->name

/* [n] of them in the arena; NULL: out of memory */
static inline ambit_expr *ambit_expressions(ambit_arena *arena, size_t n) {
  return ambit_arena_alloc(arena, (n + 1) * sizeof(ambit_expr));
}
#endif
