/* watch_lua.c -- one run of a system under watch, for ambit.verify: what is proved of conditions along it. */
#include "verbs/verify/watch.h"
#include "graph/tape.h"
#include "script/receiver.h"
#include "script/request.h"
#include "models/system_lua.h"

/* {g}, {name}, {"always", "at_end", "once" or "most"} at 8..10; {limit}, {rivals} at 15, 16 or nothing */
static ambit_watch_condition *conditions(lua_State *L, size_t *n) {
  static const char *const kind[] = { "always", "at_end", "once", "most", NULL }; /* AMBIT_WATCH_* in order */
  const char **name = ambit_lua_texts(L, 9, n);
  const ambit_expr *g = ambit_lua_to_array(L, 8, *n);
  ambit_watch_condition *c = lua_newuserdatauv(L, (*n + 1) * sizeof *c, 0);
  for (size_t k = 0; k < *n; k++) {
    lua_rawgeti(L, 10, (lua_Integer)k + 1);
    c[k] =
        (ambit_watch_condition) { .g = g[k], .kind = (uint32_t)luaL_checkoption(L, -1, NULL, kind), .name = name[k] };
    lua_pop(L, 1);
  }
  if (lua_isnoneornil(L, 15)) return c;
  size_t limits, rivals;
  const double *limit = ambit_lua_numbers(L, 15, &limits), *rival = ambit_lua_numbers(L, 16, &rivals);
  for (size_t k = 0; k < *n && k < limits && k < rivals; k++) {
    c[k].limit = limit[k];
    c[k].rivals = (uint32_t)rival[k];
  }
  return c;
}

/* {unknown}, {lo}, {hi} at 11..13 */
static void read_box(lua_State *L, ambit_watch_request *w, ambit_simulate_request *q) {
  size_t n;
  const double *lo = ambit_lua_numbers(L, 12, &n), *hi = ambit_lua_numbers(L, 13, &n);
  ambit_interval *range = lua_newuserdatauv(L, (n + 1) * sizeof *range, 0);
  for (size_t i = 0; i < n; i++) range[i] = (ambit_interval) { lo[i], hi[i] };
  w->nnarrow = q->nnarrow = n;
  w->narrow = q->narrow = ambit_lua_to_array(L, 11, n);
  w->range = q->range = range;
}

static void set_enclosure(lua_State *L, const char *key, ambit_interval x) {
  if (ambit_interval_is_empty(x)) return;
  ambit_lua_push_enclosure(L, x, 0);
  lua_setfield(L, -2, key);
}

static void set_flag(lua_State *L, const char *key, bool value) {
  lua_pushboolean(L, value);
  lua_setfield(L, -2, key);
}

/* {holds, fails, undefined, lo, hi, when, value, worst}: `when` and so on only if there is something */
static void push_findings(lua_State *L, size_t n, const ambit_watch_finding *finding) {
  lua_createtable(L, (int)n, 0);
  for (size_t k = 0; k < n; k++) {
    lua_createtable(L, 0, 8);
    set_flag(L, "holds", finding[k].holds);
    set_flag(L, "fails", finding[k].fails);
    set_flag(L, "undefined", finding[k].undefined);
    ambit_lua_set_number(L, "lo", finding[k].bound.lo);
    ambit_lua_set_number(L, "hi", finding[k].bound.hi);
    set_enclosure(L, "when", finding[k].when);
    set_enclosure(L, "value", finding[k].value);
    set_enclosure(L, "worst", finding[k].worst);
    lua_rawseti(L, -2, (lua_Integer)k + 1);
  }
}

static void push_outcome(
    lua_State *L, const ambit_receiver *to, const ambit_simulate_result *result, const ambit_watch *w) {
  lua_createtable(L, 0, 6);
  set_flag(L, "gave_up", ambit_watch_gave_up(w));
  ambit_receiver_tell(L, to, result->status, result->code, result->reason);
  ambit_lua_set_number(L, "t_reached", result->t_reached);
  set_flag(L, "rigorous", result->rigorous != 0);
  set_flag(L, "impossible", result->status == AMBIT_DOMAIN);
}

/* watch(as simulate, {g}, {name}, {kind}, {unknown}, {lo}, {hi}, cuts [, {limit}, {rivals} [, threads [, last
** [, patience]]]]) -> {finding},
** {status, reason, t_reached, rigorous, impossible: no solution meets the constraints, gave_up: a limit is exceeded},
** report */
static int watch(lua_State *L) {
  lua_settop(L, 19);
  ambit_simulate_request q = ambit_lua_simulate_request(L);
  ambit_watch_request request = { .system = q.system, .cuts = (uint32_t)luaL_checkinteger(L, 14) };
  request.initial = q.initial;
  if (q.ntime) request.start = q.time[0];
  double last = luaL_optnumber(L, 18, 0);
  if (!lua_isnoneornil(L, 18)) request.last = &last;
  request.condition = conditions(L, &request.ncondition);
  read_box(L, &request, &q);
  ambit_receiver to = ambit_receiver_silent();
  to.pace.patience = luaL_optnumber(L, 19, 0);
  request.outer = &to.sink;
  ambit_watch_finding *finding = lua_newuserdatauv(L, (request.ncondition + 1) * sizeof *finding, 0);
  ambit_simulate_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_watch *w;
  if (ambit_watch_open(&request, ambit_lua_push_system(L)->arena, &w, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  q.sink = ambit_watch_sink(w);
  q.wish = AMBIT_WISH_DENSE;
  q.threads = (uint32_t)luaL_optinteger(L, 17, 0);
  ambit_receiver_begin(L, &to);
  ambit_status status = ambit_simulate(&q, &result, &report, &f);
  ambit_receiver_end(&to);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_watch_end(w, result.status == AMBIT_OK, finding);
  push_findings(L, request.ncondition, finding);
  push_outcome(L, &to, &result, w);
  ambit_lua_push_report(L, &report);
  return 3;
}

/* jumps({expression}): may it jump where its derivatives do not: is there an atan2 in it? */
static int jumps(lua_State *L) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  const ambit_expr *e = ambit_lua_to_array(L, 1, 1);
  size_t n = ambit_graph_leaves(g, 1, e, 0, NULL);
  ambit_expr *leaf = lua_newuserdatauv(L, (n + 1) * sizeof *leaf, 0);
  ambit_graph_leaves(g, 1, e, n, leaf);
  const ambit_tape *t;
  ambit_failure f = { 0 };
  ambit_status status = ambit_tape_seal(g, ambit_lua_push_system(L)->arena, 1, e, n, leaf, 0, 0, &t, &f);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  bool found = false;
  for (uint32_t i = 0; i < t->ninstr; i++) found = found || t->op[i] == AMBIT_OP_ATAN2;
  lua_pushboolean(L, found);
  return 1;
}

void ambit_lua_open_watch(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "watch", watch }, { "jumps", jumps }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
