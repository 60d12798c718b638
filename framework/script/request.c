/* request.c -- what the verbs share: options, instants, fields and reports between Lua tables and C. */
#include "script/request.h"
#include <string.h>

/* {name, text, name, text, ...} at idx -> options owned by Lua */
ambit_option *ambit_lua_options(lua_State *L, int idx, size_t *n) {
  *n = (size_t)luaL_len(L, idx) / 2;
  ambit_option *option = lua_newuserdatauv(L, (*n + 1) * sizeof *option, 0);
  memset(option, 0, (*n + 1) * sizeof *option);
  for (size_t i = 0; i < *n; i++) {
    lua_rawgeti(L, idx, 2 * (lua_Integer)i + 1);
    lua_rawgeti(L, idx, 2 * (lua_Integer)i + 2);
    option[i] = (ambit_option) { luaL_checkstring(L, -2), luaL_checkstring(L, -1) }; /* the table keeps both */
    lua_pop(L, 2);
  }
  return option;
}

void ambit_lua_set_number(lua_State *L, const char *key, double value) {
  lua_pushnumber(L, value);
  lua_setfield(L, -2, key);
}

void ambit_lua_set_count(lua_State *L, const char *key, uint32_t value) {
  lua_pushinteger(L, value);
  lua_setfield(L, -2, key);
}

void ambit_lua_set_text(lua_State *L, const char *key, const char *value) {
  lua_pushstring(L, value);
  lua_setfield(L, -2, key);
}

static void set_work(lua_State *L, const char *key, uint64_t value) {
  lua_pushinteger(L, (lua_Integer)value);
  lua_setfield(L, -2, key);
}

void ambit_lua_push_report(lua_State *L, const ambit_report *r) {
  lua_createtable(L, 0, 40);
  ambit_lua_set_text(L, "arithmetic", r->arithmetic);
  if (r->solver[0]) ambit_lua_set_text(L, "solver", r->solver);
  ambit_lua_set_count(L, "expressions", r->expressions);
  set_work(L, "graph_nodes", r->graph_nodes);
  ambit_lua_set_count(L, "tape_slots", r->tape_slots);
  ambit_lua_set_count(L, "tape_constants", r->tape_constants);
  ambit_lua_set_count(L, "tape_instructions", r->tape_instructions);
  ambit_lua_set_count(L, "tape_runs", r->tape_runs);
  ambit_lua_set_count(L, "states", r->states);
  ambit_lua_set_count(L, "parameters", r->parameters);
  ambit_lua_set_count(L, "unknowns", r->unknowns);
  ambit_lua_set_count(L, "constant_slots", r->constant_slots);
  ambit_lua_set_count(L, "steps", r->steps);
  ambit_lua_set_number(L, "seconds_build", r->seconds_build);
  ambit_lua_set_number(L, "seconds_run", r->seconds_run);
  ambit_lua_set_number(L, "seconds_graph", r->seconds_graph);
  ambit_lua_set_number(L, "seconds_tape", r->seconds_tape);
  ambit_lua_set_number(L, "seconds_context", r->seconds_context);
  ambit_lua_set_number(L, "seconds_open", r->seconds_open);
  ambit_lua_set_number(L, "seconds_close", r->seconds_close);
#define AMBIT_X(name, what) set_work(L, #name, r->work.name);
  AMBIT_WORKS(AMBIT_X)
#undef AMBIT_X
}

double *ambit_lua_numbers(lua_State *L, int idx, size_t *n) {
  *n = (size_t)luaL_len(L, idx);
  double *t = lua_newuserdatauv(L, (*n + 1) * sizeof *t, 0);
  for (size_t i = 0; i < *n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    t[i] = luaL_checknumber(L, -1);
    lua_pop(L, 1);
  }
  return t;
}

const char **ambit_lua_texts(lua_State *L, int idx, size_t *n) {
  *n = (size_t)luaL_len(L, idx);
  const char **text = lua_newuserdatauv(L, (*n + 1) * sizeof *text, 0);
  for (size_t i = 0; i < *n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    text[i] = luaL_checkstring(L, -1); /* the table keeps it */
    lua_pop(L, 1);
  }
  return text;
}
