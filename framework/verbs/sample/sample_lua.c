/* sample_lua.c -- the verb sample: Lua tables -> kernel requests -> Lua values. */
#include "script/core.h"
#include "script/receiver.h"
#include "script/request.h"
#include "verbs/sample/sampled_lua.h"
#include "verbs/run/context.h"
#include "verbs/sample/sample.h"
#include <math.h>

/* What the plan { points, corners, polish, threads, relative, absolute, cpu } at idx says; nil: nothing. cpu: s of CPU
** time, after which the sample is stopped. */
typedef struct wishes {
  ambit_sample_plan plan;
  double cpu;
} wishes;

static double number_field(lua_State *L, int idx, const char *key) {
  lua_getfield(L, idx, key);
  double value = luaL_optnumber(L, -1, 0);
  lua_pop(L, 1);
  return value;
}

/* of a flag that is nil: `fallback` */
static bool flag_field(lua_State *L, int idx, const char *key, bool fallback) {
  bool value = lua_getfield(L, idx, key) == LUA_TNIL ? fallback : lua_toboolean(L, -1);
  lua_pop(L, 1);
  return value;
}

/* draws, seed, plan at idx, idx + 1, idx + 2 */
static wishes read_wishes(lua_State *L, int idx) {
  wishes w = { .plan = {
                   .draws = (size_t)luaL_checkinteger(L, idx), .seed = (uint64_t)luaL_checkinteger(L, idx + 1) } };
  idx += 2;
  if (lua_isnoneornil(L, idx)) return w;
  luaL_checktype(L, idx, LUA_TTABLE);
  lua_getfield(L, idx, "points");
  w.plan.points = luaL_optstring(L, -1, NULL); /* the table keeps it */
  lua_pop(L, 1);
  w.plan.no_corners = !flag_field(L, idx, "corners", true);
  w.plan.polish = flag_field(L, idx, "polish", false);
  w.plan.threads = (uint32_t)number_field(L, idx, "threads");
  w.plan.relative = number_field(L, idx, "relative");
  w.plan.absolute = number_field(L, idx, "absolute");
  w.cpu = number_field(L, idx, "cpu");
  return w;
}

static void begin(lua_State *L, ambit_receiver *to, wishes *w) {
  to->deadline = 0;
  w->plan.sink = &to->sink;
  ambit_receiver_begin(L, to);
  double own = ambit_context_seconds() + w->cpu;
  if (w->cpu > 0 && (to->deadline <= 0 || own < to->deadline)) to->deadline = own;
}

static void set_size(lua_State *L, const char *key, size_t value) {
  lua_pushinteger(L, (lua_Integer)value);
  lua_setfield(L, -2, key);
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
  lua_createtable(L, 0, 14);
  ambit_lua_set_text(L, "status", r->status == AMBIT_OK ? "complete" : "stopped");
  if (r->reason[0]) ambit_lua_set_text(L, "reason", r->reason);
  ambit_lua_set_text(L, "points", r->points);
  if (r->why[0]) ambit_lua_set_text(L, "points_reason", r->why);
  if (r->method[0]) ambit_lua_set_text(L, "method", r->method);
  set_size(L, "draws", r->draws);
  set_size(L, "failed", r->failed);
  set_size(L, "off", r->off);
  set_size(L, "polished", r->polished);
  set_size(L, "one_by_one", r->one_by_one);
  set_size(L, "threads", r->threads);
  ambit_lua_set_number(L, "cpu_seconds", r->cpu_seconds);
  ambit_lua_set_number(L, "wall_seconds", r->wall_seconds);
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

/* sample_expressions(arithmetic, options, {expression}, {leaf}, {value}, draws, seed, plan or nil) -> {sampled},
** {defined draws}, report, facts */
static int sample_expressions(lua_State *L) {
  wishes w = read_wishes(L, 6);
  ambit_evaluate_request q = ambit_lua_evaluate_request(L);
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

/* sample_system(as simulate, draws, seed, plan or nil) -> {sampled} by instant and state, facts, report. Solver "":
** lanes. */
static int sample_system(lua_State *L) {
  wishes w = read_wishes(L, 8);
  ambit_simulate_request q = ambit_lua_simulate_request(L);
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
