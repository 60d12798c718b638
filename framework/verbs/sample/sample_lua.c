/* sample_lua.c -- the verb sample: Lua tables -> kernel requests -> Lua values. */
#include "script/fields.h"
#include "script/receiver.h"
#include "script/request.h"
#include "verbs/sample/sampled_lua.h"
#include "verbs/run/context.h"
#include <ambit/sample.h>
#include <math.h>

/* The plan of a sample. cpu: s of CPU time, after which it is stopped; 0: never. */
typedef struct settings {
  ambit_sample_plan plan;
  double cpu;
} settings;

static settings read_settings(lua_State *L, int idx, const char *what) {
#define ONE(key, kind, flags, member) AMBIT_LUA_ONE(settings, key, kind, flags, member)
  static const ambit_lua_field field[] = { ONE("draws", AMBIT_LUA_SIZE, AMBIT_LUA_NEEDED, plan.draws),
    ONE("seed", AMBIT_LUA_WORK, AMBIT_LUA_NEEDED, plan.seed), ONE("points", AMBIT_LUA_TEXT, 0, plan.points),
    ONE("no_corners", AMBIT_LUA_FLAG, 0, plan.no_corners), ONE("polish", AMBIT_LUA_FLAG, 0, plan.polish),
    ONE("threads", AMBIT_LUA_COUNT, 0, plan.threads), ONE("relative", AMBIT_LUA_NUMBER, 0, plan.relative),
    ONE("absolute", AMBIT_LUA_NUMBER, 0, plan.absolute), ONE("cpu", AMBIT_LUA_NUMBER, 0, cpu) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(settings, field);
  settings w = { 0 };
  ambit_lua_read(L, idx, what, &fields, &w);
  return w;
}

static void begin(lua_State *L, ambit_receiver *to, settings *w) {
  to->deadline = 0;
  w->plan.sink = &to->sink;
  ambit_receiver_begin(L, to);
  double own = ambit_context_seconds() + w->cpu;
  if (w->cpu > 0 && (to->deadline <= 0 || own < to->deadline)) to->deadline = own;
}

static void push_numbers(lua_State *L, size_t n, const double *x) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushnumber(L, x[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* error [n]: of the bounds; NaN: not known */
static void push_facts(lua_State *L, const ambit_sample_result *r, size_t n, const double *error) {
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_sample_result, key, kind, 0, member)
  static const ambit_lua_field field[] = { ONE("reason", AMBIT_LUA_BUFFER, reason),
    ONE("points", AMBIT_LUA_BUFFER, points), ONE("points_reason", AMBIT_LUA_BUFFER, why),
    ONE("method", AMBIT_LUA_BUFFER, method), ONE("draws", AMBIT_LUA_SIZE, draws), ONE("failed", AMBIT_LUA_SIZE, failed),
    ONE("off", AMBIT_LUA_SIZE, off), ONE("polished", AMBIT_LUA_SIZE, polished),
    ONE("one_by_one", AMBIT_LUA_SIZE, one_by_one), ONE("threads", AMBIT_LUA_COUNT, threads),
    ONE("cpu_seconds", AMBIT_LUA_NUMBER, cpu_seconds), ONE("wall_seconds", AMBIT_LUA_NUMBER, wall_seconds) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_sample_result, field);
  ambit_lua_push(L, &fields, r);
  ambit_lua_set_text(L, "status", r->status == AMBIT_OK ? "complete" : "stopped");
  push_numbers(L, n, error);
  lua_setfield(L, -2, "errors");
}

/* Entry i of the sampled ranges on top: some draws have no value. */
static void mark_partial(lua_State *L, lua_Integer i) {
  lua_rawgeti(L, -1, i);
  ambit_lua_sampled *x = luaL_checkudata(L, -1, AMBIT_TYPE_ENCLOSURE);
  x->own.flags |= AMBIT_F_PARTIAL;
  lua_pop(L, 1);
}

/* sample_expressions(question: arithmetic nil is real, plan) -> {sampled}, {defined draws}, report, facts */
static int sample_expressions(lua_State *L) {
  settings w = read_settings(L, 2, "sample_expressions");
  ambit_evaluate_request q = ambit_lua_read_question(L, 1, "sample_expressions");
  ambit_interval *hull = lua_newuserdatauv(L, (q.nexpr + 1) * sizeof *hull, 0);
  double *error = lua_newuserdatauv(L, (q.nexpr + 1) * sizeof *error, 0);
  size_t *defined = lua_newuserdatauv(L, (q.nexpr + 1) * sizeof *defined, 0);
  ambit_sample_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_receiver to = ambit_receiver_silent();
  begin(L, &to, &w);
  ambit_status status = ambit_sample_expressions(&q, &w.plan, hull, error, defined, &result, &report, &f);
  ambit_receiver_end(&to);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_sampled(L, q.nexpr, hull, error);
  for (size_t i = 0; i < q.nexpr; i++)
    if (defined[i] < result.draws) mark_partial(L, (lua_Integer)i + 1);
  lua_createtable(L, (int)q.nexpr, 0);
  for (size_t i = 0; i < q.nexpr; i++) {
    lua_pushinteger(L, (lua_Integer)defined[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  ambit_lua_push_report(L, &report);
  push_facts(L, &result, q.nexpr, error);
  return 4;
}

/* sample_system(flow, plan) -> {sampled} by instant and state, facts, report. Solver "": lanes. */
static int sample_system(lua_State *L) {
  settings w = read_settings(L, 2, "sample_system");
  ambit_simulate_request q = ambit_lua_read_flow(L, 1, "sample_system");
  if (q.solver && !q.solver[0]) q.solver = NULL;
  size_t n = q.ntime * q.system->nx;
  ambit_interval *hull = lua_newuserdatauv(L, (n + 1) * sizeof *hull, 0);
  double *error = lua_newuserdatauv(L, (n + 1) * sizeof *error, 0);
  ambit_sample_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_receiver to = ambit_receiver_silent();
  begin(L, &to, &w);
  ambit_status status = ambit_sample_system(&q, &w.plan, hull, error, &result, &report, &f);
  ambit_receiver_end(&to);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_sampled(L, n, hull, error);
  push_facts(L, &result, n, error);
  ambit_lua_push_report(L, &report);
  return 3;
}

void ambit_lua_open_sample(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "sample_expressions", sample_expressions },
    { "sample_system", sample_system }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
