/* verbs.c -- evaluate and simulate: Lua tables -> kernel requests -> Lua values. */
#include "script/core.h"
#include "script/receiver.h"
#include "script/request.h"
#include "script/run_options.h"
#include "models/system_lua.h"
#include "verbs/event/events_lua.h"
#include "verbs/evaluate/evaluate.h"
#include "verbs/simulate/simulate.h"
#include "verbs/simulate/suggest.h"
#include <string.h>

ambit_evaluate_request ambit_lua_evaluate_request(lua_State *L) {
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

void ambit_lua_push_enclosures(lua_State *L, size_t n, const ambit_interval *x, const uint8_t *partial) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_push_enclosure(L, x[i], partial && partial[i] ? AMBIT_F_PARTIAL : 0);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* evaluate(arithmetic, options, {expression}, {leaf}, {value}) -> {enclosure}, report, the operation that left its
** domain first or "", is the arithmetic rigorous? */
static int evaluate(lua_State *L) {
  ambit_evaluate_request q = ambit_lua_evaluate_request(L);
  ambit_interval *out = lua_newuserdatauv(L, (q.nexpr + 1) * sizeof *out, 0);
  q.partial = lua_newuserdatauv(L, q.nexpr + 1, 0);
  char blame[AMBIT_BLAME_MAX] = "";
  q.blame = blame;
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  if (ambit_evaluate(&q, out, NULL, &report, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  const ambit_arithmetic *arithmetic = NULL;
  ambit_registry_arithmetic(q.registry, q.arithmetic, &arithmetic, &f);
  ambit_lua_push_enclosures(L, q.nexpr, out, q.partial);
  ambit_lua_push_report(L, &report);
  lua_pushstring(L, blame);
  lua_pushboolean(L, arithmetic && arithmetic->rigorous);
  return 4;
}

/* -- simulate */

static void push_result(lua_State *L, const ambit_receiver *to, const ambit_simulate_result *result) {
  lua_createtable(L, 0, 9);
  ambit_receiver_tell(L, to, result->status, result->code, result->reason);
  ambit_lua_set_number(L, "t_reached", result->t_reached);
  ambit_lua_set_number(L, "cpu_seconds", result->cpu_seconds);
  ambit_lua_set_number(L, "wall_seconds", result->wall_seconds);
  ambit_lua_set_count(L, "step_count", result->steps);
  ambit_lua_set_count(L, "threads", result->threads);
  ambit_lua_set_count(L, "pieces", result->pieces);
  lua_pushboolean(L, result->rigorous != 0);
  lua_setfield(L, -2, "rigorous");
}

static ambit_simulate_request request_of(lua_State *L, const ambit_lua_system *s) {
  ambit_simulate_request q = { .system = &s->system, .registry = AMBIT_LUA(L)->registry };
  q.solver = luaL_checkstring(L, 2);
  q.arithmetic = luaL_optstring(L, 3, NULL);
  q.solver_option = ambit_lua_options(L, 4, &q.nsolver_option);
  q.arithmetic_option = ambit_lua_options(L, 5, &q.narithmetic_option);
  q.initial = ambit_lua_to_array(L, 6, s->system.nx);
  q.time = ambit_lua_numbers(L, 7, &q.ntime);
  return q;
}

ambit_simulate_request ambit_lua_simulate_request(lua_State *L) { return request_of(L, ambit_lua_check_system(L, 1)); }

/* A run that is a part of another verb's work writes no records of its own: { silent = true } at idx. */
static bool is_silent(lua_State *L, int idx) {
  if (lua_isnoneornil(L, idx)) return false;
  lua_getfield(L, idx, "silent");
  bool silent = lua_toboolean(L, -1);
  lua_pop(L, 1);
  return silent;
}

/* Seconds of CPU time after which the run ends if its own end is out of reach, { patience = s } at idx, or if it does
** not go on steadily, with so many times what it took to the end, { due = s, reach = times }; 0: never. */
static double number_of(lua_State *L, int idx, const char *key) {
  if (lua_isnoneornil(L, idx)) return 0;
  lua_getfield(L, idx, key);
  double s = lua_tonumber(L, -1);
  lua_pop(L, 1);
  return s;
}

/* simulate(system, solver, arithmetic or nil, solver options, arithmetic options, {initial}, {time}, events or nil,
** run options or nil) -> track, result, report */
static int simulate(lua_State *L) {
  ambit_lua_events *events = ambit_lua_find_events(L, 8);
  bool watches = !lua_isnoneornil(L, 8); /* for events everybody needs the rates */
  ambit_simulate_request q = request_of(L, watches ? ambit_lua_check_system(L, 1) : ambit_lua_check_outline(L, 1));
  q.wish = AMBIT_WISH_SET;
  uint32_t keep = ambit_lua_run_options(L, 9, &q);
  ambit_receiver to = ambit_receiver_push(L, q.system->nx, q.system->name, keep);
  if (is_silent(L, 9)) to.records = NULL;
  to.pace = (ambit_pace) { .patience = number_of(L, 9, "patience"),
    .due = number_of(L, 9, "due"),
    .reach = number_of(L, 9, "reach"),
    .first = q.time[0],
    .last = q.time[q.ntime - 1] };
  q.sink = &to.sink;
  q.prepared = ambit_receiver_prepared;
  q.prepared_user = &to;
  ambit_simulate_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_lua_events_begin(events, &q, &to);
  ambit_receiver_begin(L, &to);
  ambit_status status = ambit_simulate(&q, &result, &report, &f);
  ambit_lua_events_end(events);
  ambit_receiver_end(&to);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_result(L, &to, &result);
  ambit_lua_push_report(L, &report);
  return 3;
}

/* look(system, solver or "", arithmetic, options, options, {initial}, {time}) -> facts by which a solver is chosen, or
** nil and why there are none */
static int look(lua_State *L) {
  ambit_simulate_request q = ambit_lua_simulate_request(L);
  ambit_suggest_facts facts;
  ambit_failure f = { 0 };
  if (ambit_suggest_look(&q, &facts, &f) != AMBIT_OK) {
    lua_pushnil(L);
    lua_pushstring(L, f.message);
    return 2;
  }
  lua_createtable(L, 0, 15);
  ambit_lua_set_count(L, "states", facts.states);
  ambit_lua_set_count(L, "parameters", facts.parameters);
  ambit_lua_set_count(L, "unknowns", facts.unknowns);
  ambit_lua_set_count(L, "varying", facts.varying);
  ambit_lua_set_count(L, "invariants", facts.invariants);
  ambit_lua_set_count(L, "kinks", facts.kinks);
  ambit_lua_set_number(L, "horizon", facts.horizon);
  ambit_lua_set_number(L, "seen", facts.seen);
  ambit_lua_set_number(L, "width", facts.width);
  ambit_lua_set_number(L, "spread", facts.spread);
  ambit_lua_set_number(L, "bend", facts.bend);
  ambit_lua_set_number(L, "decay", facts.decay);
  ambit_lua_set_number(L, "swing", facts.swing);
  ambit_lua_set_count(L, "steps", facts.steps);
  if (facts.kink[0]) ambit_lua_set_text(L, "kink", facts.kink);
  return 1;
}

void ambit_lua_open_verbs(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "evaluate", evaluate }, { "simulate", simulate }, { "look", look },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
