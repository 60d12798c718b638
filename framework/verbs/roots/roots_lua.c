/* roots_lua.c -- verified roots of expressions as Lua values. */
#include "script/receiver.h"
#include "script/request.h"
#include "models/system_lua.h"
#include "verbs/stability/eigen.h"
#include "verbs/roots/equations.h"
#include "verbs/roots/roots.h"
#include "verbs/roots/solve.h"
#include <string.h>

static void push_doubles(lua_State *L, size_t n, const double *x) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushnumber(L, x[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* ({equation}, {unknown}, {name}, {leaf}, {value}) at first .. first + 4 */
static ambit_equations equations(lua_State *L, int first) {
  ambit_equations q = { .graph = AMBIT_LUA(L)->graph };
  q.ne = (size_t)luaL_len(L, first);
  q.nx = (size_t)luaL_len(L, first + 1);
  q.nbinding = (size_t)luaL_len(L, first + 3);
  q.equation = ambit_lua_to_array(L, first, q.ne);
  q.unknown = ambit_lua_to_array(L, first + 1, q.nx);
  q.name = ambit_lua_texts(L, first + 2, &q.nx);
  q.leaf = ambit_lua_to_array(L, first + 3, q.nbinding);
  q.value = ambit_lua_to_array(L, first + 4, q.nbinding);
  return q;
}

static ambit_interval *boxes(lua_State *L, int idx, size_t n) {
  ambit_interval *box = lua_newuserdatauv(L, (n + 1) * sizeof *box, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    box[i] = ((const ambit_lua_enclosure *)luaL_checkudata(L, -1, AMBIT_TYPE_ENCLOSURE))->x;
    lua_pop(L, 1);
  }
  return box;
}

static void push_result(lua_State *L, const ambit_receiver *to, const ambit_roots_result *result) {
  lua_createtable(L, 0, 6);
  ambit_receiver_tell(L, to, result->status, result->code, result->reason);
  ambit_lua_set_number(L, "cpu_seconds", result->cpu_seconds);
  ambit_lua_set_count(L, "boxes", result->boxes);
  ambit_lua_set_count(L, "further", result->further);
  lua_pushboolean(L, result->rigorous != 0);
  lua_setfield(L, -2, "rigorous");
}

/* roots(solver, arithmetic or nil, solver options, arithmetic options, {equation}, {unknown}, {name}, {leaf}, {value},
** {box}, {centre} or nil, number of leading equations or nil) -> track of roots, result, report */
static int roots(lua_State *L) {
  lua_settop(L, 12);
  ambit_equations q = equations(L, 5);
  ambit_roots_request request = { .equations = &q, .registry = AMBIT_LUA(L)->registry };
  request.solver = luaL_checkstring(L, 1);
  request.arithmetic = luaL_optstring(L, 2, NULL);
  request.solver_option = ambit_lua_options(L, 3, &request.nsolver_option);
  request.arithmetic_option = ambit_lua_options(L, 4, &request.narithmetic_option);
  request.box = boxes(L, 10, q.nx);
  request.centre = lua_isnil(L, 11) ? NULL : ambit_lua_numbers(L, 11, &q.nx);
  request.leading = (size_t)luaL_optinteger(L, 12, 0);
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

/* approach({equation}, {unknown}, {name}, {leaf}, {value}, {x}) -> {x}, {residual}, converged; nil, why */
static int approach(lua_State *L) {
  lua_settop(L, 6);
  ambit_equations q = equations(L, 1);
  double *x = ambit_lua_numbers(L, 6, &q.nx), *residual = lua_newuserdatauv(L, (q.ne + 1) * sizeof *residual, 0);
  bool converged = false;
  ambit_failure f = { 0 };
  ambit_status status = ambit_roots_approach(&q, x, residual, &converged, &f);
  if (status == AMBIT_UNABLE) {
    lua_pushnil(L);
    lua_pushstring(L, f.message);
    return 2;
  }
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_doubles(L, q.nx, x);
  push_doubles(L, q.ne, residual);
  lua_pushboolean(L, converged);
  return 3;
}

/* are_smooth({equation}, {unknown}, {name}, {leaf}, {value}, {box}, as functions of the data too?) -> boolean */
static int are_smooth(lua_State *L) {
  lua_settop(L, 7);
  ambit_equations q = equations(L, 1);
  const ambit_interval *box = boxes(L, 6, q.nx);
  bool smooth;
  ambit_failure f = { 0 };
  if (ambit_equations_are_smooth(&q, AMBIT_LUA(L)->registry, box, lua_toboolean(L, 7), &smooth, &f) != AMBIT_OK)
    ambit_lua_raise(L, &f);
  lua_pushboolean(L, smooth);
  return 1;
}

/* -- matrices of enclosures, by rows */

static void push_eigenvalues(lua_State *L, size_t n, const ambit_eigenvalue *value) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_createtable(L, 0, 3);
    ambit_lua_push_enclosure(L, value[i].re, 0);
    lua_setfield(L, -2, "re");
    ambit_lua_push_enclosure(L, value[i].im, 0);
    lua_setfield(L, -2, "im");
    ambit_lua_set_count(L, "count", value[i].count);
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
    { "spectrum", spectrum }, { "is_positive_definite", is_positive_definite }, { "solve", solve }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
