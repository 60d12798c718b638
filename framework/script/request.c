/* request.c -- what the verbs share: questions, options, lists and reports between Lua tables and C. */
#include "script/request.h"
#include "models/system_lua.h"
#include "script/fields.h"
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

void ambit_lua_push_report(lua_State *L, const ambit_report *r) {
#define ONE(member, kind) AMBIT_LUA_ONE(ambit_report, #member, kind, 0, member)
  static const ambit_lua_field field[] = { ONE(arithmetic, AMBIT_LUA_BUFFER), ONE(solver, AMBIT_LUA_BUFFER),
    ONE(expressions, AMBIT_LUA_COUNT), ONE(graph_nodes, AMBIT_LUA_WORK), ONE(tape_slots, AMBIT_LUA_COUNT),
    ONE(tape_constants, AMBIT_LUA_COUNT), ONE(tape_instructions, AMBIT_LUA_COUNT), ONE(tape_runs, AMBIT_LUA_COUNT),
    ONE(states, AMBIT_LUA_COUNT), ONE(parameters, AMBIT_LUA_COUNT), ONE(unknowns, AMBIT_LUA_COUNT),
    ONE(constant_slots, AMBIT_LUA_COUNT), ONE(steps, AMBIT_LUA_COUNT), ONE(seconds_build, AMBIT_LUA_NUMBER),
    ONE(seconds_run, AMBIT_LUA_NUMBER), ONE(seconds_graph, AMBIT_LUA_NUMBER), ONE(seconds_tape, AMBIT_LUA_NUMBER),
    ONE(seconds_context, AMBIT_LUA_NUMBER), ONE(seconds_open, AMBIT_LUA_NUMBER), ONE(seconds_close, AMBIT_LUA_NUMBER),
#define AMBIT_X(name, what) AMBIT_LUA_ONE(ambit_report, #name, AMBIT_LUA_WORK, 0, work.name),
    AMBIT_WORKS(AMBIT_X)
#undef AMBIT_X
  };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_report, field);
  ambit_lua_push(L, &fields, r);
}

ambit_evaluate_request ambit_lua_read_question(lua_State *L, int idx, const char *what) {
#define LIST(key, kind, flags, member, count) AMBIT_LUA_LIST(ambit_evaluate_request, key, kind, flags, member, count)
  static const ambit_lua_field field[] = { AMBIT_LUA_ONE(
                                               ambit_evaluate_request, "arithmetic", AMBIT_LUA_TEXT, 0, arithmetic),
    LIST("options", AMBIT_LUA_OPTIONS, 0, option, noption),
    LIST("expressions", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_NEEDED, expr, nexpr),
    LIST("leaves", AMBIT_LUA_EXPRESSIONS, 0, leaf, nbinding),
    LIST("values", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_SAME, value, nbinding) };
#undef LIST
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_evaluate_request, field);
  ambit_evaluate_request q = { .graph = AMBIT_LUA(L)->graph, .registry = AMBIT_LUA(L)->registry };
  ambit_lua_read(L, idx, what, &fields, &q);
  if (q.nbinding && !q.value) ambit_lua_error(L, "core.%s: `values` is missing", what);
  return q;
}

typedef struct flow {
  ambit_simulate_request q;
  size_t nx, nfinal;
} flow;

static ambit_simulate_request read_flow(lua_State *L, int idx, const char *what, bool outline) {
#define LIST(key, kind, flags, member, count) AMBIT_LUA_LIST(flow, key, kind, flags, member, count)
  static const ambit_lua_field field[] = { { .key = "system", .kind = AMBIT_LUA_OTHER },
    AMBIT_LUA_ONE(flow, "solver", AMBIT_LUA_TEXT, AMBIT_LUA_NEEDED, q.solver),
    AMBIT_LUA_ONE(flow, "arithmetic", AMBIT_LUA_TEXT, 0, q.arithmetic),
    LIST("options", AMBIT_LUA_OPTIONS, 0, q.solver_option, q.nsolver_option),
    LIST("arithmetic_options", AMBIT_LUA_OPTIONS, 0, q.arithmetic_option, q.narithmetic_option),
    LIST("initial", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_NEEDED | AMBIT_LUA_SAME, q.initial, nx),
    LIST("times", AMBIT_LUA_NUMBERS, AMBIT_LUA_NEEDED, q.time, q.ntime),
    LIST("final", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_SAME, q.final, nfinal) };
#undef LIST
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(flow, field);
  luaL_checktype(L, idx, LUA_TTABLE);
  lua_getfield(L, idx, "system");
  const ambit_lua_system *s = (outline ? ambit_lua_check_outline : ambit_lua_check_system)(L, lua_gettop(L));
  flow f = { .q = { .system = &s->system, .registry = AMBIT_LUA(L)->registry }, .nx = s->system.nx, .nfinal = 1 };
  ambit_lua_read(L, idx, what, &fields, &f);
  return f.q;
}

ambit_simulate_request ambit_lua_read_flow(lua_State *L, int idx, const char *what) {
  return read_flow(L, idx, what, false);
}

ambit_simulate_request ambit_lua_read_outline(lua_State *L, int idx, const char *what) {
  return read_flow(L, idx, what, true);
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
