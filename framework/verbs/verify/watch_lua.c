/* watch_lua.c -- one run of a system under watch, for ambit.verify: what is proved of conditions along it. */
#include <ambit/watch.h>
#include "graph/tape.h"
#include "script/fields.h"
#include "script/receiver.h"
#include "script/request.h"
#include "models/system_lua.h"
#include <math.h>

/* What is watched for: { conditions = { { g, kind, name, limit, rivals } }, cuts, unknowns, lo, hi: the box of data;
** threads, last, patience: as ambit_pace } */
typedef struct settings {
  ambit_watch_request w;
  const double *lo, *hi;
  uint32_t threads;
  double last, patience;
} settings;

static void read_settings(lua_State *L, int idx, settings *to) {
  static const char *const kind[] = { "always", "at_end", "once", "most", NULL }; /* AMBIT_WATCH_* in order */
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_watch_condition, key, kind, 0, member)
  static const ambit_lua_field condition[] = { ONE("g", AMBIT_LUA_EXPRESSION, g),
    { "kind", AMBIT_LUA_CHOICE, AMBIT_LUA_NEEDED, offsetof(ambit_watch_condition, kind), 0, kind },
    ONE("name", AMBIT_LUA_TEXT, name), ONE("limit", AMBIT_LUA_NUMBER, limit), ONE("rivals", AMBIT_LUA_COUNT, rivals) };
#undef ONE
  static const ambit_lua_fields conditions = AMBIT_LUA_FIELDS(ambit_watch_condition, condition);
  static const ambit_lua_field field[] = { { "conditions", AMBIT_LUA_ROWS, 0, offsetof(settings, w.condition),
                                               offsetof(settings, w.ncondition), &conditions },
    AMBIT_LUA_ONE(settings, "cuts", AMBIT_LUA_COUNT, 0, w.cuts),
    AMBIT_LUA_LIST(settings, "unknowns", AMBIT_LUA_EXPRESSIONS, 0, w.narrow, w.nnarrow),
    AMBIT_LUA_LIST(settings, "lo", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, lo, w.nnarrow),
    AMBIT_LUA_LIST(settings, "hi", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, hi, w.nnarrow),
    AMBIT_LUA_ONE(settings, "threads", AMBIT_LUA_COUNT, 0, threads),
    AMBIT_LUA_ONE(settings, "last", AMBIT_LUA_NUMBER, 0, last),
    AMBIT_LUA_ONE(settings, "patience", AMBIT_LUA_NUMBER, 0, patience) };
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(settings, field);
  to->last = NAN;
  ambit_lua_read(L, idx, "watch", &fields, to);
  if (!isnan(to->last)) to->w.last = &to->last;
  if (!to->w.nnarrow) return;
  if (!to->lo || !to->hi) ambit_lua_error(L, "core.watch: `lo` or `hi` is missing");
  ambit_interval *range = lua_newuserdatauv(L, to->w.nnarrow * sizeof *range, 0);
  for (size_t i = 0; i < to->w.nnarrow; i++) range[i] = (ambit_interval) { to->lo[i], to->hi[i] };
  to->w.range = range;
}

/* {holds, fails, undefined, lo, hi, when, value, worst}: `when` and so on only if there is something */
static void push_findings(lua_State *L, size_t n, const ambit_watch_finding *finding) {
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_watch_finding, key, kind, 0, member)
  static const ambit_lua_field field[] = { ONE("holds", AMBIT_LUA_FLAG, holds), ONE("fails", AMBIT_LUA_FLAG, fails),
    ONE("undefined", AMBIT_LUA_FLAG, undefined), ONE("lo", AMBIT_LUA_NUMBER, bound.lo),
    ONE("hi", AMBIT_LUA_NUMBER, bound.hi), ONE("when", AMBIT_LUA_ENCLOSURE, when),
    ONE("value", AMBIT_LUA_ENCLOSURE, value), ONE("worst", AMBIT_LUA_ENCLOSURE, worst) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_watch_finding, field);
  lua_createtable(L, (int)n, 0);
  for (size_t k = 0; k < n; k++) {
    ambit_lua_push(L, &fields, &finding[k]);
    lua_rawseti(L, -2, (lua_Integer)k + 1);
  }
}

typedef struct outcome {
  bool gave_up, rigorous, impossible;
  double t_reached;
} outcome;

static void push_outcome(
    lua_State *L, const ambit_receiver *to, const ambit_simulate_result *result, const ambit_watch *w) {
#define ONE(member, kind) AMBIT_LUA_ONE(outcome, #member, kind, 0, member)
  static const ambit_lua_field field[] = { ONE(gave_up, AMBIT_LUA_FLAG), ONE(rigorous, AMBIT_LUA_FLAG),
    ONE(impossible, AMBIT_LUA_FLAG), ONE(t_reached, AMBIT_LUA_NUMBER) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(outcome, field);
  const outcome o = { ambit_watch_gave_up(w), result->rigorous != 0, result->status == AMBIT_DOMAIN,
    result->t_reached };
  ambit_lua_push(L, &fields, &o);
  ambit_receiver_tell(L, to, result->status, result->code, result->reason);
}

/* watch(flow, settings) -> {finding}, {status, reason, t_reached, rigorous, impossible: no solution meets the
** constraints, gave_up: a limit is exceeded}, report */
static int watch(lua_State *L) {
  lua_settop(L, 2);
  ambit_simulate_request q = ambit_lua_read_flow(L, 1, "watch");
  settings own = { 0 };
  read_settings(L, 2, &own);
  own.w.system = q.system;
  own.w.initial = q.initial;
  if (q.ntime) own.w.start = q.time[0];
  q.nnarrow = own.w.nnarrow, q.narrow = own.w.narrow, q.range = own.w.range;
  ambit_receiver to = ambit_receiver_silent();
  to.pace.patience = own.patience;
  own.w.outer = &to.sink;
  ambit_watch_finding *finding = lua_newuserdatauv(L, (own.w.ncondition + 1) * sizeof *finding, 0);
  ambit_simulate_result result = { 0 };
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_watch *w;
  if (ambit_watch_open(&own.w, ambit_lua_push_system(L)->arena, &w, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  q.sink = ambit_watch_sink(w);
  q.extras = AMBIT_EXTRA_DENSE;
  q.threads = own.threads;
  ambit_receiver_begin(L, &to);
  ambit_status status = ambit_simulate(&q, &result, &report, &f);
  ambit_receiver_end(&to);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_watch_end(w, result.status == AMBIT_OK, finding);
  push_findings(L, own.w.ncondition, finding);
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
