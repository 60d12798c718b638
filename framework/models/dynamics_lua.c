/* dynamics_lua.c -- equations of motion as Lua values. */
#include "script/core.h"
#include "models/mechanism_lua.h"
#include "models/system_lua.h"
#include "mechanics/constrained.h"
#include "mechanics/forward.h"
#include <ambit/dynamics.h>

/* Scratch memory that Lua frees. */
static ambit_arena *scratch(lua_State *L) { return ambit_lua_push_system(L)->arena; }

/* "mass_matrix", "articulated", or nothing */
static uint32_t form_at(lua_State *L, int idx) {
  static const char *const name[] = { "auto", "mass_matrix", "articulated", NULL };
  static const uint32_t form[] = { AMBIT_FORM_AUTO, AMBIT_FORM_MASS_MATRIX, AMBIT_FORM_ARTICULATED };
  return form[luaL_checkoption(L, idx, "auto", name)];
}

/* From here on the formulas of the accelerations are long, and a solver may do without them; mistakes in them are told
** when they are written. Those of smaller mechanisms are written, and checked, at once. */
#define LATER 11u

/* dynamics(mechanism, form) -> system */
static int dynamics(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  uint32_t form = form_at(L, 2);
  ambit_lua_system *s = ambit_lua_push_system(L);
  bool later = ambit_mechanism_speeds(m, 0, NULL) >= LATER;
  ambit_status status = later ? ambit_constrained_outline(m, form, s->arena, &s->system, &f)
                              : ambit_constrained_system(m, form, s->arena, &s->system, &f);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushvalue(L, 1);
  lua_setiuservalue(L, -2, 1);
  return 1;
}

/* motion(mechanism) -> n, {M by rows}, {h}: M(q) u' = h(q, u) */
static int motion(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_motion motion = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  if (ambit_motion_build(m, scratch(L), &motion, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushinteger(L, (lua_Integer)motion.n);
  ambit_lua_push_expressions(L, motion.n * motion.n, motion.mass);
  ambit_lua_push_expressions(L, motion.n, motion.force);
  return 3;
}

/* force(mechanism) -> {h} */
static int force(lua_State *L) {
  ambit_failure f = { 0 };
  size_t n = 0;
  const ambit_expr *h = NULL;
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  if (ambit_motion_force(m, scratch(L), &n, &h, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_expressions(L, n, h);
  return 1;
}

/* Unknown forces of closed loops would be left in the result. */
static void need_no_loops(lua_State *L, ambit_mechanism *m, const ambit_forward *forward) {
  size_t n = ambit_mechanism_multipliers(m, 0, NULL);
  if (n == 0) return;
  ambit_multiplier *one = lua_newuserdatauv(L, n * sizeof *one, 0);
  ambit_mechanism_multipliers(m, n, one);
  size_t nleaf = ambit_graph_leaves(AMBIT_LUA(L)->graph, forward->variables.n, forward->du, 0, NULL);
  ambit_expr *leaf = lua_newuserdatauv(L, (nleaf + 1) * sizeof *leaf, 0);
  ambit_graph_leaves(AMBIT_LUA(L)->graph, forward->variables.n, forward->du, nleaf, leaf);
  for (size_t i = 0; i < nleaf; i++)
    for (size_t k = 0; k < n; k++)
      if (leaf[i] == one[k].lambda)
        ambit_lua_error(L,
            "forward_dynamics: `%s` closes a loop, whose forces follow from the motion of all joints together: "
            "use m:dynamics()",
            ambit_mechanism_part_name(m, one[k].part));
  lua_pop(L, 2);
}

/* forward(mechanism, form) -> {u'}, {symbol of tau}, form that was chosen */
static int forward(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_forward forward = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  if (ambit_forward_build(m, form_at(L, 2), true, scratch(L), &forward, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  need_no_loops(L, m, &forward);
  ambit_lua_push_expressions(L, forward.variables.n, forward.du);
  ambit_lua_push_expressions(L, forward.variables.n, forward.force);
  lua_pushstring(L, forward.form == AMBIT_FORM_ARTICULATED ? "articulated" : "mass_matrix");
  return 3;
}

static int push_list(
    lua_State *L, ambit_status (*build)(ambit_mechanism *m, ambit_arena *arena, ambit_list *list, ambit_failure *f)) {
  ambit_failure f = { 0 };
  ambit_list list = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  if (build(m, scratch(L), &list, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_expressions(L, list.n, list.e);
  return 1;
}

/* inverse(mechanism) -> {tau}; gravity_torque(mechanism) -> {torque} */
static int inverse(lua_State *L) { return push_list(L, ambit_inverse_dynamics); }
static int gravity_torque(lua_State *L) { return push_list(L, ambit_gravity_torque); }

/* jacobian(mechanism, part, port, {x, y, z} or nil) -> n, {entries by rows} */
static int jacobian(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_list list = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  ambit_frame frame = { (uint32_t)luaL_checkinteger(L, 2), (uint32_t)luaL_checkinteger(L, 3) };
  const ambit_expr *offset = lua_istable(L, 4) ? ambit_lua_to_array(L, 4, 3) : NULL;
  if (ambit_jacobian(m, frame, offset, scratch(L), &list, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushinteger(L, (lua_Integer)list.n);
  ambit_lua_push_expressions(L, 6 * list.n, list.e);
  return 2;
}

void ambit_lua_open_dynamics(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "dynamics", dynamics }, { "motion", motion }, { "force", force },
    { "forward", forward }, { "inverse", inverse }, { "gravity_torque", gravity_torque }, { "jacobian", jacobian },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
