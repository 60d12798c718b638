/* forward.c -- chooses how accelerations are written. */
#include "mechanics/forward.h"
#include "mechanics/articulated.h"
#include <stdio.h>

/* measured: tests/bench/dynamics.c */
#define FEW 2u
#define MANY 10u

/* tau_beta1; symbols are found by name, so no joint may be called that */
static ambit_status make_forces(
    ambit_graph *g, const ambit_variables *v, ambit_arena *arena, const ambit_expr **force, ambit_failure *f) {
  ambit_expr *list = ambit_expressions(arena, v->n);
  if (!list) return ambit_no_memory(f);
  for (size_t i = 0; i < v->n; i++) {
    char name[160];
    const char *prime = strchr(v->speed[i].name, '\''), *unit = v->speed[i].unit;
    snprintf(name, sizeof name, "tau_%.*s%s", AMBIT_JOINT_NAME(&v->speed[i]), prime ? prime + 1 : "");
    for (size_t j = 0; j < v->ncoordinate; j++)
      if (strcmp(v->coordinate[j].name, name) == 0)
        return ambit_fail(f, AMBIT_INVALID, "joint `%s` has the name of the force along `%.*s`: call it otherwise",
            name, AMBIT_JOINT_NAME(&v->speed[i]));
    list[i] = ambit_graph_symbol(g, name, strncmp(unit, "rad", 3) == 0 ? "N m" : "N");
    if (list[i] == AMBIT_NO_EXPR) return ambit_no_memory(f);
  }
  *force = list;
  return AMBIT_OK;
}

static ambit_status by_mass_matrix(
    ambit_mechanism *m, const ambit_forward *forward, ambit_arena *arena, ambit_expr *du, ambit_failure *f) {
  ambit_motion motion;
  ambit_status status = ambit_motion_build(m, arena, &motion, f);
  if (status != AMBIT_OK) return status;
  return ambit_motion_accelerations(ambit_mechanism_graph(m), &motion, forward->force, du, f);
}

/* Both, and the one with fewer operations; the articulated-body form may not fit. */
static ambit_status by_shorter(
    ambit_mechanism *m, ambit_forward *forward, ambit_arena *arena, ambit_expr *du, ambit_failure *f) {
  size_t n = forward->variables.n;
  ambit_failure why = { 0 };
  ambit_status status = ambit_articulated_accelerations(m, &forward->variables, forward->force, du, &why);
  if (status == AMBIT_OK && n > MANY) {
    forward->form = AMBIT_FORM_ARTICULATED;
    return AMBIT_OK;
  }
  ambit_expr *other = ambit_expressions(arena, n);
  if (!other) return ambit_no_memory(f);
  ambit_status second = by_mass_matrix(m, forward, arena, other, f);
  if (second != AMBIT_OK) return second;
  ambit_graph *g = ambit_mechanism_graph(m);
  bool shorter = status == AMBIT_OK && ambit_graph_size(g, n, du) < ambit_graph_size(g, n, other);
  if (!shorter) memcpy(du, other, n * sizeof *du);
  forward->form = shorter ? AMBIT_FORM_ARTICULATED : AMBIT_FORM_MASS_MATRIX;
  return AMBIT_OK;
}

ambit_status ambit_forward_build(
    ambit_mechanism *m, uint32_t form, bool with_force, ambit_arena *arena, ambit_forward *forward, ambit_failure *f) {
  *forward = (ambit_forward) { 0 };
  ambit_status status = ambit_variables_read(m, arena, &forward->variables, f);
  if (status != AMBIT_OK) return status;
  size_t n = forward->variables.n;
  ambit_expr *du = ambit_expressions(arena, n);
  if (!du) return ambit_no_memory(f);
  if (with_force) status = make_forces(ambit_mechanism_graph(m), &forward->variables, arena, &forward->force, f);
  if (status != AMBIT_OK) return status;
  forward->du = du;
  forward->form = form;
  if (form == AMBIT_FORM_ARTICULATED)
    return ambit_articulated_accelerations(m, &forward->variables, forward->force, du, f);
  if (form == AMBIT_FORM_AUTO && n > FEW) return by_shorter(m, forward, arena, du, f);
  forward->form = AMBIT_FORM_MASS_MATRIX;
  return by_mass_matrix(m, forward, arena, du, f);
}
