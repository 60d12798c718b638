/* roots.c -- verified roots of expressions as Lua values. */
#include "lua/interrupt.h"
#include "lua/progress.h"
#include "lua/request.h"
#include "lua/system.h"
#include "lua/track.h"
#include "model/roots.h"
#include <string.h>

static const char **texts(lua_State *L, int idx, size_t n) {
  const char **text = lua_newuserdatauv(L, (n + 1) * sizeof *text, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    text[i] = luaL_checkstring(L, -1); /* the table keeps it */
    lua_pop(L, 1);
  }
  return text;
}

static double *doubles(lua_State *L, int idx, size_t n) {
  double *x = lua_newuserdatauv(L, (n + 1) * sizeof *x, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    x[i] = luaL_checknumber(L, -1);
    lua_pop(L, 1);
  }
  return x;
}

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
  q.name = texts(L, first + 2, q.nx);
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

typedef struct receiver {
  ambit_sink sink; /* first: what the solver sees */
  ambit_track *track;
  ambit_records *records;
  const char *const *name;
  ambit_progress progress;
  ambit_failure failure;
} receiver;

/* {"record": "root", "proved": "unique", "x": {...}} */
static ambit_status write_record(ambit_records *to, const ambit_record *r, const char *const *name, ambit_failure *f) {
  ambit_records_begin(to, "root");
  ambit_records_text(to, "proved", r->event == AMBIT_ROOT_UNIQUE ? "unique" : "undecided");
  ambit_records_open_object(to, "x");
  for (uint32_t i = 0; i < r->nx; i++) ambit_records_interval(to, name[i], (ambit_interval) { r->lo[i], r->hi[i] });
  ambit_records_close_object(to);
  return ambit_records_end(to, f);
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  receiver *to = (receiver *)(void *)s;
  if (!ambit_track_append(to->track, r)) {
    ambit_fail(&to->failure, AMBIT_NOMEM, "out of memory for the roots");
    return 1;
  }
  if (to->records && write_record(to->records, r, to->name, &to->failure) != AMBIT_OK) return 1;
  return ambit_interrupt_pending();
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  receiver *to = (receiver *)(void *)s;
  ambit_progress_draw(&to->progress, done, message);
  return ambit_interrupt_pending();
}

static void push_result(lua_State *L, const receiver *to, const ambit_roots_result *result) {
  bool failed = to->failure.status != AMBIT_OK;
  const char *status = result->status == AMBIT_OK ? "complete" : "unable";
  if (failed || result->status == AMBIT_STOPPED) status = "stopped";
  lua_createtable(L, 0, 6);
  ambit_lua_set_text(L, "status", status);
  ambit_lua_set_text(L, "reason", failed ? to->failure.message : result->reason);
  ambit_lua_set_number(L, "cpu_seconds", result->cpu_seconds);
  ambit_lua_set_count(L, "boxes", result->boxes);
  ambit_lua_set_count(L, "further", result->further);
  lua_pushboolean(L, result->rigorous != 0);
  lua_setfield(L, -2, "rigorous");
}

/* roots(solver, arithmetic or nil, solver options, arithmetic options, {equation}, {unknown}, {name}, {leaf}, {value},
** {box}, {centre} or nil) -> track of roots, result, report */
static int roots(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  lua_settop(L, 11);
  ambit_equations q = equations(L, 5);
  ambit_roots_request request = { .equations = &q, .registry = core->registry };
  request.solver = luaL_checkstring(L, 1);
  request.arithmetic = luaL_optstring(L, 2, NULL);
  request.solver_option = ambit_lua_options(L, 3, &request.nsolver_option);
  request.arithmetic_option = ambit_lua_options(L, 4, &request.narithmetic_option);
  request.box = boxes(L, 10, q.nx);
  request.centre = lua_isnil(L, 11) ? NULL : doubles(L, 11, q.nx);
  receiver to = { .sink = { sizeof(ambit_sink), emit, progress }, .records = core->records, .name = q.name };
  to.track = ambit_track_push(L, q.nx);
  request.sink = &to.sink;
  ambit_roots_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_interrupt interrupt;
  ambit_progress_begin(&to.progress, core->progress);
  ambit_interrupt_begin(&interrupt);
  ambit_status status = ambit_roots(&request, &result, &report, &f);
  ambit_interrupt_end(&interrupt);
  ambit_progress_end(&to.progress);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_result(L, &to, &result);
  ambit_lua_push_report(L, &report);
  return 3;
}

/* approach({equation}, {unknown}, {name}, {leaf}, {value}, {x}) -> {x}, {residual}, converged; nil, why */
static int approach(lua_State *L) {
  lua_settop(L, 6);
  ambit_equations q = equations(L, 1);
  double *x = doubles(L, 6, q.nx), *residual = lua_newuserdatauv(L, (q.ne + 1) * sizeof *residual, 0);
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

/* system_invariants(system) -> {expression} that vanish along every solution */
static int system_invariants(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_system(L, 1)->system;
  ambit_lua_push_expressions(L, s->ninvariant, s->invariant);
  return 1;
}

void ambit_lua_open_roots(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "roots", roots }, { "approach", approach },
    { "system_invariants", system_invariants }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
