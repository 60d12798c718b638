/* roots_lua.c -- verified roots of expressions as Lua values. */
#include "script/fields.h"
#include "script/receiver.h"
#include "script/request.h"
#include "verbs/stability/eigen.h"
#include "verbs/roots/equations.h"
#include <ambit/roots.h>
#include "verbs/roots/solve.h"
#include <string.h>

static void push_doubles(lua_State *L, size_t n, const double *x) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushnumber(L, x[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* What the verbs about equations are asked: { equations, unknowns, names, leaves, values } and, of `more`, what one of
** them wants besides. */
typedef struct question {
  ambit_equations q;
  ambit_roots_request r;
  double *x; /* approach: where to start */
  bool data; /* are_smooth: as functions of the data, too? */
} question;

static question read_question(lua_State *L, int idx, const char *what) {
#define LIST(key, kind, flags, member, count) AMBIT_LUA_LIST(question, key, kind, flags, member, count)
#define ONE(key, kind, member) AMBIT_LUA_ONE(question, key, kind, 0, member)
  static const ambit_lua_field field[] = { LIST("equations", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_NEEDED, q.equation, q.ne),
    LIST("unknowns", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_NEEDED, q.unknown, q.nx),
    LIST("names", AMBIT_LUA_TEXTS, AMBIT_LUA_NEEDED | AMBIT_LUA_SAME, q.name, q.nx),
    LIST("leaves", AMBIT_LUA_EXPRESSIONS, 0, q.leaf, q.nbinding),
    LIST("values", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_SAME, q.value, q.nbinding),
    LIST("box", AMBIT_LUA_ENCLOSURES, AMBIT_LUA_SAME, r.box, q.nx),
    LIST("centre", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, r.centre, q.nx), ONE("leading", AMBIT_LUA_SIZE, r.leading),
    ONE("solver", AMBIT_LUA_TEXT, r.solver), ONE("arithmetic", AMBIT_LUA_TEXT, r.arithmetic),
    LIST("options", AMBIT_LUA_OPTIONS, 0, r.solver_option, r.nsolver_option),
    LIST("arithmetic_options", AMBIT_LUA_OPTIONS, 0, r.arithmetic_option, r.narithmetic_option),
    LIST("x", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, x, q.nx), ONE("data", AMBIT_LUA_FLAG, data) };
#undef LIST
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(question, field);
  question a = { .q = { .graph = AMBIT_LUA(L)->graph }, .r = { .registry = AMBIT_LUA(L)->registry } };
  ambit_lua_read(L, idx, what, &fields, &a);
  if (a.q.nbinding && !a.q.value) ambit_lua_error(L, "core.%s: `values` is missing", what);
  return a;
}

static void push_result(lua_State *L, const ambit_receiver *to, const ambit_roots_result *result) {
#define ONE(member, kind) AMBIT_LUA_ONE(ambit_roots_result, #member, kind, 0, member)
  static const ambit_lua_field field[] = { ONE(cpu_seconds, AMBIT_LUA_NUMBER), ONE(boxes, AMBIT_LUA_COUNT),
    ONE(further, AMBIT_LUA_COUNT), ONE(rigorous, AMBIT_LUA_SWITCH) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_roots_result, field);
  ambit_lua_push(L, &fields, result);
  ambit_receiver_tell(L, to, result->status, result->code, result->reason);
}

static void need(lua_State *L, const char *what, const char *key, const void *value) {
  if (!value) ambit_lua_error(L, "core.%s: `%s` is missing", what, key);
}

/* roots{equations, ..., solver, arithmetic, options, arithmetic_options, box, centre = nil, leading = number of leading
** equations or nil} -> track of roots, result, report */
static int roots(lua_State *L) {
  question a = read_question(L, 1, "roots");
  ambit_equations q = a.q;
  ambit_roots_request request = a.r;
  need(L, "roots", "solver", request.solver);
  need(L, "roots", "box", request.box);
  request.equations = &q;
  ambit_receiver to = ambit_receiver_push(L, q.nx, q.name, 0);
  request.sink = &to.sink;
  ambit_roots_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_receiver_begin(L, &to);
  ambit_status status = ambit_roots(&request, &result, &report, &f);
  ambit_receiver_end(&to);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_result(L, &to, &result);
  ambit_lua_push_report(L, &report);
  return 3;
}

/* approach{equations, ..., x} -> {x}, {residual}, converged; nil, why */
static int approach(lua_State *L) {
  question a = read_question(L, 1, "approach");
  need(L, "approach", "x", a.x);
  double *residual = lua_newuserdatauv(L, (a.q.ne + 1) * sizeof *residual, 0);
  bool converged = false;
  ambit_failure f = { 0 };
  ambit_status status = ambit_roots_approach(&a.q, a.x, residual, &converged, &f);
  if (status == AMBIT_UNABLE) {
    lua_pushnil(L);
    lua_pushstring(L, f.message);
    return 2;
  }
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_doubles(L, a.q.nx, a.x);
  push_doubles(L, a.q.ne, residual);
  lua_pushboolean(L, converged);
  return 3;
}

/* are_smooth{equations, ..., box, data = as functions of the data, too?} -> boolean */
static int are_smooth(lua_State *L) {
  question a = read_question(L, 1, "are_smooth");
  need(L, "are_smooth", "box", a.r.box);
  bool smooth;
  ambit_failure f = { 0 };
  if (ambit_equations_are_smooth(&a.q, a.r.registry, a.r.box, a.data, &smooth, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_pushboolean(L, smooth);
  return 1;
}

/* -- matrices of enclosures, by rows */

static ambit_interval *boxes(lua_State *L, int idx, size_t n) {
  ambit_interval *box = lua_newuserdatauv(L, (n + 1) * sizeof *box, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    box[i] = ((const ambit_lua_enclosure *)luaL_checkudata(L, -1, AMBIT_TYPE_ENCLOSURE))->x;
    lua_pop(L, 1);
  }
  return box;
}

static void push_eigenvalues(lua_State *L, size_t n, const ambit_eigenvalue *value) {
  static const ambit_lua_field field[] = { AMBIT_LUA_ONE(ambit_eigenvalue, "re", AMBIT_LUA_ENCLOSURE, 0, re),
    AMBIT_LUA_ONE(ambit_eigenvalue, "im", AMBIT_LUA_ENCLOSURE, 0, im),
    AMBIT_LUA_ONE(ambit_eigenvalue, "count", AMBIT_LUA_COUNT, 0, count) };
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_eigenvalue, field);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_push(L, &fields, &value[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* spectrum(n, {enclosure}) -> {{re, im, count}} or nil, "stable", "unstable" or "undecided", how that was seen */
static int spectrum(lua_State *L) {
  static const char *const stability[] = { "undecided", "stable", "unstable" };
  size_t n = (size_t)luaL_checkinteger(L, 1);
  const ambit_interval *a = boxes(L, 2, n * n);
  ambit_eigenvalue *value = lua_newuserdatauv(L, (n + 1) * sizeof *value, 0);
  ambit_eigen result;
  ambit_failure f = { 0 };
  if (ambit_eigen_analyse(AMBIT_LUA(L)->registry, n, a, value, &result, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  if (result.enclosed)
    push_eigenvalues(L, n, value);
  else
    lua_pushnil(L);
  lua_pushstring(L, stability[result.stability]);
  lua_pushstring(L, result.by);
  return 3;
}

/* is_positive_definite(n, {enclosure}): every symmetric matrix of the set */
static int is_positive_definite(lua_State *L) {
  size_t n = (size_t)luaL_checkinteger(L, 1);
  const ambit_interval *a = boxes(L, 2, n * n);
  ambit_arena *arena = ambit_arena_open();
  bool proved = arena && ambit_is_positive_definite(n, a, arena);
  ambit_arena_close(arena);
  lua_pushboolean(L, proved);
  return 1;
}

/* lyapunov(n, {enclosure}) -> {number}: P by rows, roughly A'P + PA = -1 for the middle A; nil: there is none */
static int lyapunov(lua_State *L) {
  size_t n = (size_t)luaL_checkinteger(L, 1);
  const ambit_interval *a = boxes(L, 2, n * n);
  double *p = lua_newuserdatauv(L, (n * n + 1) * sizeof *p, 0);
  ambit_arena *arena = ambit_arena_open();
  bool found = arena && ambit_lyapunov_solve(n, a, p, arena);
  ambit_arena_close(arena);
  if (found)
    push_doubles(L, n * n, p);
  else
    lua_pushnil(L);
  return 1;
}

/* solve(n, {enclosure} by rows, {enclosure}) -> {enclosure}: all solutions; nil if the matrices are not proved
** regular */
static int solve(lua_State *L) {
  size_t n = (size_t)luaL_checkinteger(L, 1);
  const ambit_interval *a = boxes(L, 2, n * n), *b = boxes(L, 3, n);
  ambit_interval *x = lua_newuserdatauv(L, (n + 1) * sizeof *x, 0);
  double *scratch = lua_newuserdatauv(L, (2 * n * n + 1) * sizeof *scratch, 0);
  if (!ambit_solve_enclose(n, a, b, x, scratch)) return lua_pushnil(L), 1;
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_push_enclosure(L, x[i], 0);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

void ambit_lua_open_roots(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "roots", roots }, { "approach", approach }, { "are_smooth", are_smooth },
    { "spectrum", spectrum }, { "is_positive_definite", is_positive_definite }, { "lyapunov", lyapunov },
    { "solve", solve }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
