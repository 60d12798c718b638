/* verbs.c -- evaluate, simulate and sample: Lua tables -> kernel requests -> Lua values. */
#include "lua/core.h"
#include "lua/interrupt.h"
#include "lua/progress.h"
#include "lua/request.h"
#include "lua/system.h"
#include "lua/track.h"
#include "model/evaluate.h"
#include "model/sample.h"
#include "model/simulate.h"
#include <string.h>

/* (arithmetic, options, {expression}, {leaf}, {value}) at 1..5 */
static ambit_evaluate_request evaluate_request(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_evaluate_request q = { .graph = core->graph, .registry = core->registry, .arithmetic = luaL_checkstring(L, 1) };
  q.option = ambit_lua_options(L, 2, &q.noption);
  q.nexpr = (size_t)luaL_len(L, 3);
  q.expr = ambit_lua_to_array(L, 3, q.nexpr);
  q.nbinding = (size_t)luaL_len(L, 4);
  q.leaf = ambit_lua_to_array(L, 4, q.nbinding);
  q.value = ambit_lua_to_array(L, 5, q.nbinding);
  return q;
}

static void push_enclosures(lua_State *L, size_t n, const ambit_interval *x, uint32_t flags) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_push_enclosure(L, x[i], flags);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* evaluate(arithmetic, options, {expression}, {leaf}, {value}) -> {enclosure}, report */
static int evaluate(lua_State *L) {
  ambit_evaluate_request q = evaluate_request(L);
  ambit_interval *out = lua_newuserdatauv(L, (q.nexpr + 1) * sizeof *out, 0);
  uint32_t flags = 0;
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  if (ambit_evaluate(&q, out, &flags, &report, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  push_enclosures(L, q.nexpr, out, flags);
  ambit_lua_push_report(L, &report);
  return 2;
}

/* sample_expressions(arithmetic, options, {expression}, {leaf}, {value}, draws, seed) -> {enclosure}, {defined draws},
** report */
static int sample_expressions(lua_State *L) {
  size_t draws = (size_t)luaL_checkinteger(L, 6);
  uint64_t seed = (uint64_t)luaL_checkinteger(L, 7);
  ambit_evaluate_request q = evaluate_request(L);
  ambit_interval *out = lua_newuserdatauv(L, (q.nexpr + 1) * sizeof *out, 0);
  size_t *defined = lua_newuserdatauv(L, (q.nexpr + 1) * sizeof *defined, 0);
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  if (ambit_sample_expressions(&q, draws, seed, out, defined, &report, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  push_enclosures(L, q.nexpr, out, 0);
  lua_createtable(L, (int)q.nexpr, 0);
  for (size_t i = 0; i < q.nexpr; i++) {
    lua_pushinteger(L, (lua_Integer)defined[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  ambit_lua_push_report(L, &report);
  return 3;
}

/* -- simulate */

typedef struct receiver {
  ambit_sink sink; /* first: what the solver sees */
  ambit_track *track;
  ambit_records *records;
  const char *const *name;
  ambit_progress progress;
  ambit_failure failure; /* why the receiver stopped the run: memory, a full disk */
} receiver;

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  receiver *to = (receiver *)(void *)s;
  if (!ambit_track_append(to->track, r)) {
    ambit_fail(&to->failure, AMBIT_NOMEM, "out of memory for the steps of this run");
    return 1;
  }
  if (to->records && ambit_records_step(to->records, r, to->name, &to->failure) != AMBIT_OK) return 1;
  return ambit_interrupt_pending();
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  receiver *to = (receiver *)(void *)s;
  ambit_progress_draw(&to->progress, done, message);
  return ambit_interrupt_pending();
}

static const char *outcome(const receiver *to, const ambit_simulate_result *result) {
  if (to->failure.status != AMBIT_OK) return "stopped";
  switch (result->status) {
  case AMBIT_OK: return "complete";
  case AMBIT_STOPPED: return "stopped";
  default: return "unable";
  }
}

static void push_result(lua_State *L, const receiver *to, const ambit_simulate_result *result) {
  lua_createtable(L, 0, 6);
  ambit_lua_set_text(L, "status", outcome(to, result));
  ambit_lua_set_text(L, "reason", to->failure.status != AMBIT_OK ? to->failure.message : result->reason);
  ambit_lua_set_number(L, "t_reached", result->t_reached);
  ambit_lua_set_number(L, "cpu_seconds", result->cpu_seconds);
  ambit_lua_set_count(L, "step_count", result->steps);
  lua_pushboolean(L, result->rigorous != 0);
  lua_setfield(L, -2, "rigorous");
}

/* (system, solver, arithmetic or nil, solver options, arithmetic options, {initial}, {time}) at 1..7 */
static ambit_simulate_request simulate_request(lua_State *L) {
  ambit_lua_system *s = ambit_lua_check_system(L, 1);
  ambit_simulate_request q = { .system = &s->system, .registry = AMBIT_LUA(L)->registry };
  q.solver = luaL_checkstring(L, 2);
  q.arithmetic = luaL_optstring(L, 3, NULL);
  q.solver_option = ambit_lua_options(L, 4, &q.nsolver_option);
  q.arithmetic_option = ambit_lua_options(L, 5, &q.narithmetic_option);
  q.initial = ambit_lua_to_array(L, 6, s->system.nx);
  q.time = ambit_lua_times(L, 7, &q.ntime);
  return q;
}

/* simulate(system, solver, arithmetic or nil, solver options, arithmetic options, {initial}, {time}) -> track, result,
** report */
static int simulate(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_simulate_request q = simulate_request(L);
  receiver to = { .sink = { sizeof(ambit_sink), emit, progress }, .records = core->records, .name = q.system->name };
  to.track = ambit_track_push(L, q.system->nx);
  q.sink = &to.sink;
  ambit_simulate_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_interrupt interrupt;
  ambit_progress_begin(&to.progress, core->progress);
  ambit_interrupt_begin(&interrupt);
  ambit_status status = ambit_simulate(&q, &result, &report, &f);
  ambit_interrupt_end(&interrupt);
  ambit_progress_end(&to.progress);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_result(L, &to, &result);
  ambit_lua_push_report(L, &report);
  return 3;
}

/* sample_system(as simulate, draws, seed) -> {enclosure} by instant and state, {status, reason, draws, failed,
** cpu_seconds}, report */
static int sample_system(lua_State *L) {
  size_t draws = (size_t)luaL_checkinteger(L, 8);
  uint64_t seed = (uint64_t)luaL_checkinteger(L, 9);
  ambit_simulate_request q = simulate_request(L);
  receiver to = { .sink = { sizeof(ambit_sink), NULL, progress } };
  q.sink = &to.sink;
  size_t n = q.ntime * q.system->nx;
  ambit_interval *out = lua_newuserdatauv(L, (n + 1) * sizeof *out, 0);
  ambit_sample_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_interrupt interrupt;
  ambit_progress_begin(&to.progress, AMBIT_LUA(L)->progress);
  ambit_interrupt_begin(&interrupt);
  ambit_status status = ambit_sample_system(&q, draws, seed, out, &result, &report, &f);
  ambit_interrupt_end(&interrupt);
  ambit_progress_end(&to.progress);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_enclosures(L, n, out, 0);
  lua_createtable(L, 0, 5);
  ambit_lua_set_text(L, "status", result.status == AMBIT_OK ? "complete" : ambit_status_name(result.status));
  ambit_lua_set_text(L, "reason", result.reason);
  ambit_lua_set_number(L, "cpu_seconds", result.cpu_seconds);
  ambit_lua_set_count(L, "draws", (uint32_t)result.draws);
  ambit_lua_set_count(L, "failed", (uint32_t)result.failed);
  ambit_lua_push_report(L, &report);
  return 3;
}

void ambit_lua_open_verbs(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "evaluate", evaluate }, { "simulate", simulate },
    { "sample_expressions", sample_expressions }, { "sample_system", sample_system }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
