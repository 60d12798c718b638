/* inverse.c -- the balances read the other way round, and velocities as linear functions of the speeds.
**
** r(q, u, u') is what all forces leave over along a speed; a generalised force tau = -r makes it vanish. It is the
** recursive Newton-Euler method, because that is what the elements write: motion outwards, forces back (Featherstone
** 2008, ch. 5). Of gravity: r is affine in the field, which the world frame feels as its acceleration; the part of -r
** that is linear in it, at rest, is what weights ask for.
*/
#include "mechanics/balance.h"
#include "mechanics/affine_in.h"
#include "mechanics/cut.h"

#define SIMPLIFY_TERMS 64u

/* The list, or each entry as short as it can be written, whichever has fewer operations. */
static ambit_status shorten(ambit_graph *g, ambit_arena *arena, size_t n, ambit_expr *e, ambit_failure *f) {
  ambit_expr *apart = ambit_expressions(arena, n);
  if (!apart) return ambit_no_memory(f);
  for (size_t i = 0; i < n; i++) {
    if (e[i] == AMBIT_NO_EXPR) return ambit_no_memory(f);
    apart[i] = ambit_graph_simplify(g, e[i], SIMPLIFY_TERMS);
  }
  if (ambit_graph_size(g, n, apart) < ambit_graph_size(g, n, e)) memcpy(e, apart, n * sizeof *e);
  return AMBIT_OK;
}

ambit_status ambit_inverse_dynamics(ambit_mechanism *m, ambit_arena *arena, ambit_list *tau, ambit_failure *f) {
  ambit_graph *g = ambit_mechanism_graph(m);
  ambit_variables v;
  ambit_status status = ambit_variables_read(m, arena, &v, f);
  if (status != AMBIT_OK) return status;
  ambit_expr *e = ambit_expressions(arena, v.n);
  if (!e) return ambit_no_memory(f);
  status = ambit_balances_pull(m, &v, e, f);
  if (status != AMBIT_OK) return status;
  for (size_t i = 0; i < v.n; i++) e[i] = ambit_graph_op(g, AMBIT_OP_NEG, e[i], 0);
  *tau = (ambit_list) { v.n, e };
  return shorten(g, arena, v.n, e, f);
}

/* -- gravity */

/* The balances with symbols for the field; slope [n*3]: by the field. */
static ambit_status by_field(
    ambit_mechanism *m, const ambit_variables *v, const ambit_expr *field, ambit_expr *slope, ambit_failure *f) {
  ambit_cut *cut = ambit_cut_open(m);
  ambit_affine *affine = ambit_affine_open(ambit_mechanism_graph(m), 3, field);
  ambit_arena *arena = ambit_arena_open();
  ambit_expr *balance = arena ? ambit_expressions(arena, 2 * v->n) : NULL;
  ambit_status status = cut && affine && balance ? AMBIT_OK : ambit_no_memory(f);
  if (status == AMBIT_OK) status = ambit_cut_give(cut, AMBIT_NOWHERE, AMBIT_FIELD, field, f);
  if (status == AMBIT_OK) status = ambit_balances_pull(m, v, balance, f);
  if (status == AMBIT_OK) {
    status = ambit_affine_in(affine, v->n, balance, 3, field, slope, balance + v->n);
    if (status == AMBIT_DOMAIN)
      status = ambit_fail(f, AMBIT_INVALID, "the forces of the mechanism are not linear in the field of gravity");
    else if (status != AMBIT_OK)
      status = ambit_no_memory(f);
  }
  ambit_affine_close(affine);
  ambit_cut_close(cut);
  ambit_arena_close(arena);
  return status;
}

ambit_status ambit_gravity_torque(ambit_mechanism *m, ambit_arena *arena, ambit_list *torque, ambit_failure *f) {
  ambit_graph *g = ambit_mechanism_graph(m);
  ambit_variables v;
  ambit_status status = ambit_variables_read(m, arena, &v, f);
  const ambit_expr *field = status == AMBIT_OK ? ambit_mechanism_pull(m, AMBIT_NOWHERE, AMBIT_FIELD, f) : NULL;
  if (!field) return AMBIT_INVALID;
  ambit_expr symbol[3], *e = ambit_expressions(arena, v.n), *slope = ambit_expressions(arena, 3 * v.n);
  for (int k = 0; k < 3; k++)
    if ((symbol[k] = ambit_graph_unknown(g, NULL, AMBIT_ENTIRE)) == AMBIT_NO_EXPR) return ambit_no_memory(f);
  if (!e || !slope) return ambit_no_memory(f);
  status = by_field(m, &v, symbol, slope, f);
  for (size_t i = 0; status == AMBIT_OK && i < v.n; i++)
    for (size_t k = 0; k < 3; k++)
      e[i] = ambit_graph_op(g, AMBIT_OP_SUB, e[i], ambit_graph_op(g, AMBIT_OP_MUL, slope[3 * i + k], field[k]));
  if (status == AMBIT_OK) status = ambit_graph_substitute(g, v.n, e, v.n, v.du, v.zero, f);
  if (status == AMBIT_OK) status = ambit_graph_substitute(g, v.n, e, v.n, v.u, v.zero, f);
  *torque = (ambit_list) { v.n, e };
  return status == AMBIT_OK ? shorten(g, arena, v.n, e, f) : status;
}

/* -- velocities */

/* a + b c */
static ambit_expr plus(ambit_graph *g, ambit_expr a, ambit_expr b, ambit_expr c) {
  return ambit_graph_op(g, AMBIT_OP_ADD, a, ambit_graph_op(g, AMBIT_OP_MUL, b, c));
}

/* Angular velocity and velocity of the point, in world axes: R w, R (v + w x p). */
static ambit_status pull_velocity(
    ambit_mechanism *m, ambit_frame frame, const ambit_expr *offset, ambit_expr velocity[6], ambit_failure *f) {
  ambit_graph *g = ambit_mechanism_graph(m);
  const ambit_expr *pose = ambit_mechanism_pull(m, frame, AMBIT_POSE, f);
  const ambit_expr *twist = pose ? ambit_mechanism_pull(m, frame, AMBIT_TWIST, f) : NULL;
  if (!twist) return AMBIT_INVALID;
  ambit_expr own[6];
  memcpy(own, twist, sizeof own);
  for (int i = 0; i < 3 && offset; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    own[3 + i] = plus(g, own[3 + i], twist[j], offset[k]);
    own[3 + i] = ambit_graph_op(g, AMBIT_OP_SUB, own[3 + i], ambit_graph_op(g, AMBIT_OP_MUL, twist[k], offset[j]));
  }
  for (int i = 0; i < 6; i++) {
    velocity[i] = 0;
    for (int k = 0; k < 3; k++) velocity[i] = plus(g, velocity[i], pose[3 * (i % 3) + k], own[3 * (i / 3) + k]);
    if (velocity[i] == AMBIT_NO_EXPR) return ambit_no_memory(f);
  }
  return AMBIT_OK;
}

ambit_status ambit_jacobian(ambit_mechanism *m, ambit_frame frame, const ambit_expr *offset, ambit_arena *arena,
    ambit_list *jacobian, ambit_failure *f) {
  ambit_variables v;
  ambit_expr velocity[6], rest[6];
  ambit_status status = ambit_variables_read(m, arena, &v, f);
  if (status == AMBIT_OK) status = pull_velocity(m, frame, offset, velocity, f);
  if (status != AMBIT_OK) return status;
  ambit_graph *g = ambit_mechanism_graph(m);
  ambit_expr *e = ambit_expressions(arena, 6 * v.n);
  ambit_affine *affine = ambit_affine_open(g, v.n, v.u);
  status = e && affine ? ambit_affine_in(affine, 6, velocity, v.n, v.u, e, rest) : AMBIT_NOMEM;
  ambit_affine_close(affine);
  if (status == AMBIT_DOMAIN)
    return ambit_fail(f, AMBIT_INVALID, "the velocity of the frame is not linear in the speeds of the joints");
  if (status != AMBIT_OK) return ambit_no_memory(f);
  *jacobian = (ambit_list) { v.n, e };
  return shorten(g, arena, 6 * v.n, e, f);
}
