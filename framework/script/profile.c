/* profile.c -- where the time of a scene goes, and the work that it took, counted.
**
** While a profile is taken each function of the core has a frame named after it. A Lua error must not leave that frame
** open, so the function is called protected and the error passed on.
*/
#include "base/meter.h"
#include "script/core.h"
#include "script/request.h"
#include <ambit/work.h>
#include <stdio.h>
#include <string.h>

static const char names_key = 0; /* its address: the table of names by function, in the Lua registry */

/* -- frames around functions */

/* the table of the names, pushed */
static void push_names(lua_State *L) { lua_rawgetp(L, LUA_REGISTRYINDEX, &names_key); }

/* Functions in the table at the top are called by their field, behind `prefix`. */
static void add_names(lua_State *L, const char *prefix) {
  int from = lua_gettop(L);
  push_names(L);
  lua_pushnil(L);
  while (lua_next(L, from)) {
    if (lua_iscfunction(L, -1) && lua_type(L, -2) == LUA_TSTRING && lua_getupvalue(L, -1, 2)) {
      lua_pushfstring(L, "%s%s", prefix, lua_tostring(L, -3));
      lua_rawsetp(L, from + 1, lua_topointer(L, -2));
      lua_pop(L, 1);
    }
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
}

static void name_functions(lua_State *L) {
  static const char *const type[] = { AMBIT_TYPE_EXPRESSION, AMBIT_TYPE_ENCLOSURE, AMBIT_TYPE_MECHANISM,
    AMBIT_TYPE_SYSTEM, AMBIT_TYPE_TRACK };
  lua_newtable(L);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &names_key);
  luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
  lua_getfield(L, -1, "ambit.core");
  add_names(L, "");
  lua_pop(L, 2);
  for (size_t i = 0; i < sizeof type / sizeof *type; i++) {
    if (luaL_getmetatable(L, type[i]) == LUA_TTABLE) add_names(L, type[i] + sizeof "ambit" - 1);
    lua_pop(L, 1);
  }
}

static bool is_verb(const char *name) {
  static const char *const verb[] = { "evaluate", "simulate", "roots", "reduce", "watch", "sample_expressions",
    "sample_system" };
  for (size_t i = 0; i < sizeof verb / sizeof *verb; i++)
    if (strcmp(verb[i], name) == 0) return true;
  return false;
}

/* "simulate lohner interval, scene.lua:12": the solver and the arithmetic of its request, and where the script asks for
** it */
static void enter_verb(lua_State *L, const char *name) {
  char text[AMBIT_FRAME_NAME];
  size_t used = (size_t)snprintf(text, sizeof text, "%s", name);
  static const char *const key[] = { "solver", "arithmetic" };
  for (size_t i = 0; i < sizeof key / sizeof *key && lua_istable(L, 1); i++) {
    if (lua_getfield(L, 1, key[i]) == LUA_TSTRING && used < sizeof text)
      used += (size_t)snprintf(text + used, sizeof text - used, " %.24s", lua_tostring(L, -1));
    lua_pop(L, 1);
  }
  ambit_lua_where(L);
  const char *where = lua_tostring(L, -1);
  size_t length = strlen(where);
  if (length > 2 && used < sizeof text) snprintf(text + used, sizeof text - used, ", %.*s", (int)length - 2, where);
  lua_pop(L, 1);
  ambit_meter_enter(AMBIT_FRAME_VERB, text);
}

static void enter_function(lua_State *L) {
  push_names(L);
  lua_rawgetp(L, -1, lua_topointer(L, lua_upvalueindex(2)));
  const char *name = lua_tostring(L, -1);
  if (name && is_verb(name))
    enter_verb(L, name);
  else
    ambit_meter_enter(AMBIT_FRAME_CORE, name ? name : "other");
  lua_pop(L, 2);
}

/* The function is called by itself. A hook of the scene (debug.sethook) may call others in between. */
bool ambit_lua_is_framed(lua_State *L) {
  lua_Debug self, caller;
  if (!lua_getstack(L, 1, &caller) || !lua_getstack(L, 0, &self)) return false;
  luaL_checkstack(L, 2, "too many arguments");
  lua_getinfo(L, "f", &self);
  lua_getinfo(L, "f", &caller);
  bool same = lua_rawequal(L, -1, -2);
  lua_pop(L, 2);
  return same;
}

int ambit_lua_call_framed(lua_State *L) {
  lua_Debug self;
  uint32_t depth = ambit_meter_depth();
  int arguments = lua_gettop(L);
  luaL_checkstack(L, arguments + 8, "too many arguments");
  enter_function(L);
  lua_getstack(L, 0, &self);
  lua_getinfo(L, "f", &self);
  lua_insert(L, 1);
  int outcome = lua_pcall(L, arguments, LUA_MULTRET, 0);
  ambit_meter_unwind(depth);
  return outcome == LUA_OK ? lua_gettop(L) : lua_error(L);
}

/* -- the profile */

/* profile_begin(): from now on */
static int begin(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  if (core->profile) return luaL_error(L, "a profile is being taken already");
  name_functions(L);
  core->profile = ambit_profile_begin();
  if (!core->profile) ambit_lua_error(L, "out of memory for a profile");
  return 0;
}

/* { title, columns, rows = {{ name, value, ...}, ...} } */
static void push_table(lua_State *L, const ambit_meter_table *t) {
  lua_createtable(L, 0, 3);
  ambit_lua_set_text(L, "title", t->title);
  lua_createtable(L, (int)t->rows, 0);
  for (uint32_t i = 0; i < t->rows; i++) {
    lua_createtable(L, (int)t->columns, 1);
    ambit_lua_set_text(L, "name", t->name[i]);
    for (uint32_t k = 0; k < t->columns; k++) {
      lua_pushnumber(L, t->value[(size_t)i * t->columns + k]);
      lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  lua_setfield(L, -2, "rows");
}

static void push_tables(lua_State *L, const ambit_profile *p, const ambit_meter_frame *f) {
  lua_Integer n = 0;
  lua_newtable(L);
  for (const ambit_meter_table *t = ambit_profile_tables(p); t; t = t->next) {
    if (t->frame != f) continue;
    push_table(L, t);
    lua_rawseti(L, -2, ++n);
  }
}

static void push_frames(lua_State *L, const ambit_profile *p, const ambit_meter_frame *f) {
  static const char *const kind[] = { "script", "core", "verb", "load", "stage", "element", "solver", "arithmetic",
    "service", "operation", "thread" };
  luaL_checkstack(L, 8, "frames too deep");
  lua_createtable(L, 0, 7);
  ambit_lua_set_text(L, "kind", kind[f->kind]);
  ambit_lua_set_text(L, "name", f->name);
  ambit_lua_set_number(L, "count", (double)f->count);
  ambit_lua_set_number(L, "self", ambit_profile_self_seconds(p, f));
  ambit_lua_set_number(L, "cost", ambit_profile_cost_seconds(p, f));
  lua_newtable(L);
  lua_Integer n = 0;
  for (const ambit_meter_frame *child = f->child; child; child = child->next) {
    push_frames(L, p, child);
    lua_rawseti(L, -2, ++n);
  }
  lua_setfield(L, -2, "frames");
  push_tables(L, p, f);
  lua_setfield(L, -2, "tables");
}

/* profile_end() -> the root { kind, name, count, self, cost, frames = {..}, tables = {..} }; were frames left out?;
** s of wall time */
static int end(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  if (!core->profile) return luaL_error(L, "no profile is being taken");
  ambit_profile *p = core->profile;
  const ambit_meter_frame *root = ambit_profile_end(p);
  push_frames(L, p, root);
  lua_pushboolean(L, ambit_profile_is_cut(p));
  lua_pushnumber(L, ambit_profile_wall_seconds(p));
  core->profile = NULL;
  ambit_profile_close(p);
  return 3;
}

/* -- counted work */

/* work -> {{name, what it counts}, ...}: the fields of a report that are counted, in order */
static void push_works(lua_State *L) {
  static const char *const work[][2] = {
#define AMBIT_X(name, what) { #name, what },
    AMBIT_WORKS(AMBIT_X)
#undef AMBIT_X
  };
  lua_newtable(L);
  for (size_t i = 0; i < sizeof work / sizeof *work; i++) {
    lua_createtable(L, 2, 0);
    for (int k = 0; k < 2; k++) {
      lua_pushstring(L, work[i][k]);
      lua_rawseti(L, -2, k + 1);
    }
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* opcodes -> {"ADD", ...} in the order of the opcodes; "" where there is none */
static void push_operations(lua_State *L) {
  static const char *const name[AMBIT_OP_END] = {
#define AMBIT_X(name, arity, symbol) [AMBIT_OP_##name] = #name,
    AMBIT_OPS(AMBIT_X) AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
  };
  lua_createtable(L, AMBIT_OP_END, 0);
  for (int op = 0; op < AMBIT_OP_END; op++) {
    lua_pushstring(L, name[op] ? name[op] : "");
    lua_rawseti(L, -2, op + 1);
  }
}

void ambit_lua_open_profile(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "profile_begin", begin }, { "profile_end", end }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
  push_works(L);
  lua_setfield(L, -2, "work");
  push_operations(L);
  lua_setfield(L, -2, "opcodes");
}
