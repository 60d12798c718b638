/* dynamics.c -- equations of motion as Lua values. */
#include "model/dynamics.h"
#include "lua/core.h"
#include "lua/mechanism.h"
#include "lua/system.h"

/* dynamics(mechanism) -> system */
static int dynamics(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  ambit_lua_system *s = ambit_lua_push_system(L);
  if (ambit_dynamics_system(m, s->arena, &s->system, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return 1;
}

/* motion(mechanism) -> n, {M by rows}, {h}: M(q) q'' = h(q, q') */
static int motion(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_motion motion = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  ambit_lua_system *scratch = ambit_lua_push_system(L); /* its arena is Lua's to free */
  if (ambit_motion_build(m, scratch->arena, &motion, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushinteger(L, (lua_Integer)motion.n);
  ambit_lua_push_expressions(L, motion.n * motion.n, motion.mass);
  ambit_lua_push_expressions(L, motion.n, motion.force);
  return 3;
}

void ambit_lua_open_dynamics(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "dynamics", dynamics }, { "motion", motion }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
