/* verbs.c -- evaluate and simulate: Lua tables -> kernel requests -> Lua values. */
#include "script/fields.h"
#include "script/receiver.h"
#include "script/request.h"
#include "verbs/event/events_lua.h"
#include <ambit/evaluate.h>
#include <ambit/simulate.h>
#include "verbs/simulate/suggest.h"
#include "models/default.h"
#include <string.h>

void ambit_lua_push_enclosures(lua_State *L, size_t n, const ambit_interval *x, const uint8_t *partial) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_push_enclosure(L, x[i], partial && partial[i] ? AMBIT_F_PARTIAL : 0);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* evaluate(question; no arithmetic: that of ranges) -> {enclosure}, report, the operation that left its domain first or
** "", is the arithmetic rigorous? */
static int evaluate(lua_State *L) {
  ambit_evaluate_request q = ambit_lua_read_question(L, 1, "evaluate");
  if (!q.arithmetic) q.arithmetic = AMBIT_DEFAULT_RANGES;
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

/* What is asked of `simulate` besides: a run that is a part of another verb's work is `silent`, it writes no records of
** its own; patience, due, reach: as ambit_pace. The data to cut come in three lists; a band, if there is one, as
** `band_lo` and `band_hi`, time by time, with what else ambit_cut_band has. */
typedef struct settings {
  uint32_t threads, pieces;
  bool dense, last, silent;
  double patience, due, reach;
  size_t ncut;
  const ambit_cut *cut;
  size_t nband;
  ambit_cut_band band;
} settings;

static settings read_settings(lua_State *L, int idx) {
#define ONE(member, kind) AMBIT_LUA_ONE(settings, #member, kind, 0, member)
  static const ambit_lua_field cut[] = { AMBIT_LUA_ONE(ambit_cut, "unknown", AMBIT_LUA_EXPRESSION, 0, unknown),
    AMBIT_LUA_ONE(ambit_cut, "name", AMBIT_LUA_TEXT, 0, name),
    AMBIT_LUA_ONE(ambit_cut, "parts", AMBIT_LUA_COUNT, 0, parts) };
  static const ambit_lua_fields cuts = AMBIT_LUA_FIELDS(ambit_cut, cut);
  static const ambit_lua_field field[] = { ONE(threads, AMBIT_LUA_COUNT), ONE(pieces, AMBIT_LUA_COUNT),
    ONE(dense, AMBIT_LUA_FLAG), ONE(last, AMBIT_LUA_FLAG), ONE(silent, AMBIT_LUA_FLAG), ONE(patience, AMBIT_LUA_NUMBER),
    ONE(due, AMBIT_LUA_NUMBER), ONE(reach, AMBIT_LUA_NUMBER),
    AMBIT_LUA_LIST(settings, "band_lo", AMBIT_LUA_NUMBERS, 0, band.lo, nband),
    AMBIT_LUA_LIST(settings, "band_hi", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, band.hi, nband),
    AMBIT_LUA_ONE(settings, "band_runs", AMBIT_LUA_COUNT, 0, band.most),
    AMBIT_LUA_ONE(settings, "band_limit", AMBIT_LUA_NUMBER, 0, band.limit),
    AMBIT_LUA_ONE(settings, "band_work", AMBIT_LUA_NUMBER, 0, band.work),
    { "cuts", AMBIT_LUA_ROWS, 0, offsetof(settings, cut), offsetof(settings, ncut), &cuts } };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(settings, field);
  settings w = { 0 };
  if (!lua_isnoneornil(L, idx)) ambit_lua_read(L, idx, "simulate", &fields, &w);
  return w;
}

static void push_result(lua_State *L, const ambit_receiver *to, const ambit_simulate_result *result) {
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_simulate_result, key, kind, 0, member)
  static const ambit_lua_field field[] = { ONE("t_reached", AMBIT_LUA_NUMBER, t_reached),
    ONE("cpu_seconds", AMBIT_LUA_NUMBER, cpu_seconds), ONE("wall_seconds", AMBIT_LUA_NUMBER, wall_seconds),
    ONE("step_count", AMBIT_LUA_COUNT, steps), ONE("threads", AMBIT_LUA_COUNT, threads),
    ONE("pieces", AMBIT_LUA_COUNT, pieces), ONE("rigorous", AMBIT_LUA_SWITCH, rigorous) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_simulate_result, field);
  ambit_lua_push(L, &fields, result);
  ambit_receiver_tell(L, to, result->status, result->code, result->reason);
}

/* simulate(flow, events or nil, settings or nil) -> track, result, report */
static int simulate(lua_State *L) {
  lua_settop(L, 3);
  ambit_lua_events *events = luaL_testudata(L, 2, AMBIT_TYPE_EVENTS);
  settings w = read_settings(L, 3);
  /* for events everybody needs the rates */
  ambit_simulate_request q = events ? ambit_lua_read_flow(L, 1, "simulate") : ambit_lua_read_outline(L, 1, "simulate");
  q.threads = w.threads, q.pieces = w.pieces, q.ncut = w.ncut, q.cut = w.cut;
  if (w.nband) {
    if (!w.band.hi || w.nband != (q.ntime - 1) * q.system->nx)
      ambit_lua_error(L, "core.simulate: a band is two numbers for each state and each time behind the first");
    q.band = &w.band;
  }
  q.extras = AMBIT_EXTRA_SET | (w.dense ? AMBIT_EXTRA_DENSE : 0);
  uint32_t keep = (w.dense ? AMBIT_TRACK_DENSE : 0) | (w.last ? AMBIT_TRACK_LAST : 0);
  ambit_receiver to = ambit_receiver_push(L, q.system->nx, q.system->name, keep);
  if (w.silent) to.records = NULL;
  to.pace = (ambit_pace) {
    .patience = w.patience, .due = w.due, .reach = w.reach, .first = q.time[0], .last = q.time[q.ntime - 1]
  };
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

/* look(flow) -> facts by which a solver is chosen, or nil and why there are none */
static int look(lua_State *L) {
#define ONE(member, kind) AMBIT_LUA_ONE(ambit_suggest_facts, #member, kind, 0, member)
  static const ambit_lua_field field[] = { ONE(states, AMBIT_LUA_COUNT), ONE(parameters, AMBIT_LUA_COUNT),
    ONE(unknowns, AMBIT_LUA_COUNT), ONE(varying, AMBIT_LUA_COUNT), ONE(invariants, AMBIT_LUA_COUNT),
    ONE(kinks, AMBIT_LUA_COUNT), ONE(horizon, AMBIT_LUA_NUMBER), ONE(seen, AMBIT_LUA_NUMBER),
    ONE(width, AMBIT_LUA_NUMBER), ONE(spread, AMBIT_LUA_NUMBER), ONE(bend, AMBIT_LUA_NUMBER),
    ONE(decay, AMBIT_LUA_NUMBER), ONE(swing, AMBIT_LUA_NUMBER), ONE(steps, AMBIT_LUA_COUNT),
    ONE(kink, AMBIT_LUA_BUFFER) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_suggest_facts, field);
  ambit_simulate_request q = ambit_lua_read_flow(L, 1, "look");
  ambit_suggest_facts facts;
  ambit_failure f = { 0 };
  if (ambit_suggest_look(&q, &facts, &f) != AMBIT_OK) {
    lua_pushnil(L);
    lua_pushstring(L, f.message);
    return 2;
  }
  ambit_lua_push(L, &fields, &facts);
  return 1;
}

void ambit_lua_open_verbs(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "evaluate", evaluate }, { "simulate", simulate }, { "look", look },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
