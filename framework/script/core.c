/* core.c -- the module `ambit` and its C half `ambit.core`. */
#include "script/core.h"
#include "script/limit.h"
#include "base/meter.h"
#include "num/rounding.h"
#include "models/default.h"
#include <stdlib.h>
#include <string.h>

static const char state_key = 0; /* its address is the key in the Lua registry */

static int in_standard_environment(lua_State *L);

static int state_close(lua_State *L) {
  ambit_lua *core = lua_touserdata(L, 1);
  ambit_profile_close(core->profile);
  ambit_limit_records(NULL);
  if (core->records) ambit_records_close(core->records, NULL);
  if (core->graph) ambit_graph_close(core->graph);
  if (core->registry) ambit_registry_close(core->registry);
  ambit_arena_close(core->arena);
  memset(core, 0, sizeof *core);
  return 0;
}

/* The state is made before everything that points to it, so Lua finalises it last. */
static ambit_lua *state_get(lua_State *L) {
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &state_key) == LUA_TUSERDATA) {
    ambit_lua *core = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return core;
  }
  lua_pop(L, 1);
  ambit_lua *core = lua_newuserdatauv(L, sizeof *core, 0);
  memset(core, 0, sizeof *core);
  lua_createtable(L, 0, 1);
  lua_pushcfunction(L, state_close);
  lua_setfield(L, -2, "__gc");
  lua_setmetatable(L, -2);
  core->arena = ambit_arena_open();
  core->graph = ambit_graph_open();
  core->registry = ambit_registry_open(NULL);
  if (!core->arena || !core->graph || !core->registry) luaL_error(L, "ambit: out of memory");
  const char *every = getenv("AMBIT_COLLECT_ALWAYS"); /* for tests */
  if (every) ambit_graph_collect_always(core->graph, strtoull(every, NULL, 10));
  core->holder.mark = ambit_lua_mark_boxes;
  ambit_graph_hold(core->graph, &core->holder);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &state_key);
  return core;
}

/* How many functions of the core are running in L, below the one that has just been called. */
static int running(lua_State *L) {
  lua_Debug frame;
  int n = 0;
  for (int level = 1; lua_getstack(L, level, &frame); level++) {
    lua_getinfo(L, "f", &frame);
    n += lua_tocfunction(L, -1) == in_standard_environment;
    lua_pop(L, 1);
  }
  return n;
}

/* Between two functions of the core all expressions are held (graph/collect.h); while one runs that has called Lua, it
** may have some in its hands. Errors leave the count of running functions too large; on the main thread, below which
** no other one runs, it is put right. */
static void collect(lua_State *L, ambit_lua *core) {
  bool main = lua_pushthread(L) == 1;
  lua_pop(L, 1);
  if (core->depth > 0 && main) core->depth = running(L);
  if (core->depth == 0)
    ambit_graph_collect(core->graph);
  else
    ambit_graph_postpone(core->graph);
}

/* A Lua error that passes leaves the standard environment behind. */
static int in_standard_environment(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  if (core->profile && !ambit_lua_is_framed(L)) return ambit_lua_call_framed(L);
  lua_CFunction f = lua_tocfunction(L, lua_upvalueindex(2));
  ambit_rounding outside = ambit_round_nearest();
  if (ambit_graph_is_due(core->graph)) collect(L, core);
  core->depth++;
  int results = f(L);
  core->depth--;
  ambit_rounding_restore(outside);
  return results;
}

void ambit_lua_push_function(lua_State *L, ambit_lua *core, lua_CFunction f, int n) {
  lua_pushlightuserdata(L, core);
  lua_pushcfunction(L, f);
  lua_rotate(L, -2 - n, 2);
  lua_pushcclosure(L, in_standard_environment, 2 + n);
}

void ambit_lua_set_functions(lua_State *L, ambit_lua *core, const luaL_Reg *functions) {
  for (; functions->name; functions++) {
    ambit_lua_push_function(L, core, functions->func, 0);
    lua_setfield(L, -2, functions->name);
  }
}

void ambit_lua_new_type(lua_State *L, ambit_lua *core, const char *type, const luaL_Reg *functions) {
  luaL_newmetatable(L, type);
  lua_pushstring(L, type);
  lua_setfield(L, -2, "__metatable"); /* getmetatable(x) is the type's name: nobody pokes into it */
  ambit_lua_set_functions(L, core, functions);
}

static void set_defaults(lua_State *L) {
#define SET(name, plugin) lua_pushliteral(L, plugin), lua_setfield(L, -2, #name);
  lua_newtable(L);
  AMBIT_DEFAULTS(SET)
#undef SET
  lua_setfield(L, -2, "default");
}

int luaopen_ambit_core(lua_State *L) {
  ambit_lua *core = state_get(L);
  lua_newtable(L);
  set_defaults(L);
  ambit_lua_open_functions(L, core);
  ambit_lua_open_expression(L, core);
  ambit_lua_open_enclosure(L, core);
  ambit_lua_open_units(L, core);
  ambit_lua_open_data(L, core);
  ambit_lua_open_plugins(L, core);
  ambit_lua_open_mechanism(L, core);
  ambit_lua_open_dynamics(L, core);
  ambit_lua_open_loops(L, core);
  ambit_lua_open_roots(L, core);
  ambit_lua_open_system(L, core);
  ambit_lua_open_verbs(L, core);
  ambit_lua_open_sample(L, core);
  ambit_lua_open_variation(L, core);
  ambit_lua_open_term_tree(L, core);
  ambit_lua_open_structure(L, core);
  ambit_lua_open_source(L, core);
  ambit_lua_open_difference(L, core);
  ambit_lua_open_reduction(L, core);
  ambit_lua_open_schedule(L, core);
  ambit_lua_open_watch(L, core);
  ambit_lua_open_events(L, core);
  ambit_lua_open_track(L, core);
  ambit_lua_open_records(L, core);
  ambit_lua_open_output(L, core);
  ambit_lua_open_process(L, core);
  ambit_lua_open_child(L, core);
  ambit_lua_open_profile(L, core);
  ambit_lua_open_text(L, core);
  ambit_lua_open_foreign(L, core);
  ambit_lua_open_sandbox(L, core);
  return 1;
}
