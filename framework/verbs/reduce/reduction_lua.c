/* reduction_lua.c -- the solver that chooses what a model may leave out; proofs are Lua functions.
**
** A callback runs in protected mode, inside the solver: an error in it is kept, the solver is told to stop, and the
** error is raised again once everything is closed. Ctrl-C stops as any verb.
*/
#include "script/fields.h"
#include "script/receiver.h"
#include "script/request.h"
#include "verbs/reduce/reduction.h"
#include "models/default.h"
#include <stdio.h>
#include <string.h>

#define STACK 64 /* slots that the fields' arrays and the callbacks need */

/* what the callbacks know: places on the stack of core.reduce */
typedef struct caller {
  lua_State *L;
  ambit_receiver *to;
  const ambit_reduction_request *q;
  int prove, tried, rankings, error;
  bool raised; /* the value at `error` */
  uint32_t how;
  const uint8_t *cut;
  double *bound;
  ambit_status answer;
  char why[AMBIT_MESSAGE_MAX]; /* it was stopped, as `prove` says */
  const ambit_try *attempt;
  uint32_t ranking;
  const double *rank;
} caller;

/* -- the request */

typedef struct row { /* a reference: data are one value each, or one row for each time */
  uint32_t scenario;
  size_t ntime, nx, ndata;
  double *time, *x, *data;
} row;

typedef struct question {
  ambit_reduction_request q;
  size_t nrow;
  double *candidate, *state; /* of each effect, from 1 */
  row *row;
} question;

static void check_length(lua_State *L, const char *key, size_t n, size_t expected) {
  if (n != expected) ambit_lua_error(L, "core.reduce: `%s` has %d entries, not %d", key, (int)n, (int)expected);
}

/* indices from 1 -> from 0; 0 and what is no index become UINT32_MAX, which the kernel refuses */
static const uint32_t *indices(lua_State *L, size_t n, const double *x) {
  uint32_t *index = lua_newuserdatauv(L, (n + 1) * sizeof *index, 0);
  for (size_t i = 0; i < n; i++) index[i] = x[i] >= 1 && x[i] < UINT32_MAX ? (uint32_t)x[i] - 1 : UINT32_MAX;
  return index;
}

static double *repeated(lua_State *L, const row *r, size_t ndata) {
  if (r->ndata != ndata) check_length(L, "data", r->ndata, r->ntime * ndata);
  size_t n = r->ntime * ndata;
  double *rows = lua_newuserdatauv(L, (n + 1) * sizeof *rows, 0);
  for (size_t i = 0; i < n; i++) rows[i] = r->data[i % r->ndata];
  return rows;
}

/* The arrays of each reference are kept in one table, so that the stack does not grow with their number. */
static const ambit_reduction_reference *references(lua_State *L, const question *a) {
  const ambit_reduction_request *q = &a->q;
  ambit_reduction_reference *r = lua_newuserdatauv(L, (a->nrow + 1) * sizeof *r, 0);
  lua_createtable(L, (int)a->nrow, 0);
  for (size_t i = 0; i < a->nrow; i++) {
    const row *from = &a->row[i];
    check_length(L, "x", from->nx, from->ntime * q->nx);
    r[i] = (ambit_reduction_reference) { .scenario = from->scenario ? from->scenario : 1,
      .ntime = from->ntime,
      .time = from->time,
      .x = from->x,
      .data = repeated(L, from, q->ndata) };
    luaL_ref(L, -2);
  }
  return r;
}

/* [1] the table of fields */
static ambit_reduction_request request(lua_State *L) {
#define LIST(key, kind, flags, member, count) AMBIT_LUA_LIST(question, key, kind, flags, member, count)
#define NEEDED(key, member, count) AMBIT_LUA_LIST(row, key, AMBIT_LUA_NUMBERS, AMBIT_LUA_NEEDED, member, count)
  static const ambit_lua_field of_row[] = { AMBIT_LUA_ONE(row, "scenario", AMBIT_LUA_COUNT, 0, scenario),
    NEEDED("t", time, ntime), NEEDED("x", x, nx), NEEDED("data", data, ndata) };
  static const ambit_lua_fields rows = AMBIT_LUA_FIELDS(row, of_row);
  static const ambit_lua_field field[] = { AMBIT_LUA_ONE(question, "solver", AMBIT_LUA_TEXT, 0, q.solver),
    LIST("options", AMBIT_LUA_OPTIONS, 0, q.solver_option, q.nsolver_option),
    LIST("states", AMBIT_LUA_TEXTS, 0, q.state, q.nx),
    LIST("symbols", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_SAME, q.symbol, q.nx),
    LIST("rates", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_SAME, q.rate, q.nx),
    LIST("data", AMBIT_LUA_EXPRESSIONS, 0, q.data, q.ndata), LIST("outputs", AMBIT_LUA_TEXTS, 0, q.output, q.noutput),
    LIST("output_expressions", AMBIT_LUA_EXPRESSIONS, AMBIT_LUA_SAME, q.output_expression, q.noutput),
    LIST("bounds", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, q.bound, q.noutput),
    LIST("candidates", AMBIT_LUA_TEXTS, 0, q.candidate, q.ncandidate),
    LIST("effect", AMBIT_LUA_EXPRESSIONS, 0, q.effect, q.neffect),
    LIST("effect_candidate", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, candidate, q.neffect),
    LIST("effect_state", AMBIT_LUA_NUMBERS, AMBIT_LUA_SAME, state, q.neffect),
    { "references", AMBIT_LUA_ROWS, 0, offsetof(question, row), offsetof(question, nrow), &rows },
    AMBIT_LUA_ONE(question, "prove", AMBIT_LUA_OTHER, AMBIT_LUA_NEEDED, q.prove),
    AMBIT_LUA_ONE(question, "tried", AMBIT_LUA_OTHER, 0, q.tried) };
#undef LIST
#undef NEEDED
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(question, field);
  question a = {
    .q = { .graph = AMBIT_LUA(L)->graph, .registry = AMBIT_LUA(L)->registry, .solver = AMBIT_DEFAULT_STRATEGY }
  };
  ambit_lua_read(L, 1, "reduce", &fields, &a);
  a.q.effect_candidate = indices(L, a.candidate ? a.q.neffect : 0, a.candidate);
  a.q.effect_state = indices(L, a.state ? a.q.neffect : 0, a.state);
  a.q.nreference = a.nrow;
  a.q.reference = references(L, &a);
  return a.q;
}

/* the function in a field: its place on the stack, or 0 */
static int function(lua_State *L, const char *key) {
  int type = lua_getfield(L, 1, key);
  if (type == LUA_TNIL) return 0;
  if (type != LUA_TFUNCTION)
    ambit_lua_error(L, "core.reduce: `%s` must be a function, not a %s", key, luaL_typename(L, -1));
  return lua_gettop(L);
}

/* -- callbacks: first the part in protected mode, then what the kernel calls */

static void push_indices(lua_State *L, size_t n, const uint8_t *cut) {
  lua_newtable(L);
  lua_Integer count = 0;
  for (size_t k = 0; k < n; k++) {
    if (!cut[k]) continue;
    lua_pushinteger(L, (lua_Integer)k + 1);
    lua_rawseti(L, -2, ++count);
  }
}

static void push_doubles(lua_State *L, size_t n, const double *x) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushnumber(L, x[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

/* the error of each output in the table on top, by number or by name */
static void read_errors(lua_State *L, const caller *c) {
  for (size_t o = 0; o < c->q->noutput; o++) {
    if (lua_rawgeti(L, -1, (lua_Integer)o + 1) == LUA_TNIL) {
      lua_pop(L, 1);
      lua_getfield(L, -1, c->q->output[o]);
    }
    int is_number;
    c->bound[o] = lua_tonumberx(L, -1, &is_number);
    if (!is_number || !(c->bound[o] >= 0))
      luaL_error(L, "core.reduce: `prove` gave no error of output `%s` that is 0 or greater", c->q->output[o]);
    lua_pop(L, 1);
  }
}

/* (caller, prove) */
static int protected_prove(lua_State *L) {
  caller *c = lua_touserdata(L, 1);
  push_indices(L, c->q->ncandidate, c->cut);
  lua_pushstring(L, c->how == AMBIT_PROVE_FULL ? "full" : "lowered");
  lua_call(L, 2, 3);
  const char *status = lua_tostring(L, 2), *why = lua_tostring(L, 4);
  if (status && strcmp(status, "proved") == 0) {
    luaL_checktype(L, 3, LUA_TTABLE);
    lua_settop(L, 3);
    read_errors(L, c);
    c->answer = AMBIT_OK;
  } else if (status && (strcmp(status, "unable") == 0 || strcmp(status, "impossible") == 0)) {
    c->answer = AMBIT_UNABLE;
  } else if (!status || strcmp(status, "stopped") != 0) {
    return luaL_error(L, "core.reduce: `prove` must return \"proved\", \"unable\" or \"stopped\"");
  } else {
    snprintf(c->why, sizeof c->why, "%s", why ? why : "");
  }
  return 0;
}

/* (caller, tried) */
static int protected_tried(lua_State *L) {
  static const char *const outcome[] = { "accepted", "undone", "halved" };
  const caller *c = lua_touserdata(L, 1);
  const ambit_try *t = c->attempt;
  lua_pushstring(L, outcome[t->outcome]);
  lua_createtable(L, (int)t->ncandidate, 0);
  for (uint32_t i = 0; i < t->ncandidate; i++) {
    lua_pushinteger(L, (lua_Integer)t->candidate[i] + 1);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  if (t->error)
    push_doubles(L, c->q->noutput, t->error);
  else
    lua_pushnil(L);
  lua_call(L, 3, 0);
  return 0;
}

/* (caller, rankings) */
static int protected_rank(lua_State *L) {
  const caller *c = lua_touserdata(L, 1);
  push_doubles(L, c->q->ncandidate, c->rank);
  lua_setfield(L, 2, ambit_reduction_ranking_name(c->ranking));
  return 0;
}

/* f(caller, value at idx); an error is kept, and nothing is called from then on */
static bool call(caller *c, lua_CFunction f, int idx) {
  if (c->raised) return false;
  lua_pushcfunction(c->L, f);
  lua_pushlightuserdata(c->L, c);
  lua_pushvalue(c->L, idx);
  c->raised = lua_pcall(c->L, 2, 0, 0) != LUA_OK;
  if (c->raised) lua_replace(c->L, c->error);
  return !c->raised;
}

static ambit_status prove(void *user, uint32_t how, const uint8_t *cut, double *error) {
  caller *c = user;
  if (ambit_interrupt_pending()) return AMBIT_STOPPED;
  c->how = how, c->cut = cut, c->bound = error, c->answer = AMBIT_STOPPED;
  if (!call(c, protected_prove, c->prove)) return AMBIT_STOPPED;
  return c->answer;
}

static void tried(void *user, const ambit_try *t) {
  caller *c = user;
  c->attempt = t;
  if (c->tried) call(c, protected_tried, c->tried);
}

static void rank(void *user, uint32_t ranking, const double *value) {
  caller *c = user;
  c->ranking = ranking, c->rank = value;
  call(c, protected_rank, c->rankings);
}

typedef struct watcher {
  ambit_sink sink; /* first: what the solver sees */
  caller *caller;
} watcher;

/* after an error in a callback nothing goes on */
static int32_t progress(ambit_sink *sink, double done, const char *message) {
  const caller *c = ((watcher *)(void *)sink)->caller;
  return c->to->sink.progress(&c->to->sink, done, message) || c->raised;
}

/* -- the verb */

static void push_result(lua_State *L, const caller *c, const ambit_reduction_result *result, const uint8_t *cut) {
  lua_createtable(L, 0, 8);
  const char *why = result->status == AMBIT_STOPPED && c->why[0] ? c->why : result->reason;
  ambit_receiver_tell(L, c->to, result->status, result->code, why);
  push_indices(L, c->q->ncandidate, cut);
  lua_setfield(L, -2, "cut");
  lua_pushvalue(L, c->rankings);
  lua_setfield(L, -2, "rankings");
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_reduction_result, key, kind, 0, member)
  static const ambit_lua_field field[] = { ONE("cpu_seconds", AMBIT_LUA_NUMBER, cpu_seconds),
    ONE("cpu_seconds_rank", AMBIT_LUA_NUMBER, cpu_seconds_rank), ONE("proofs", AMBIT_LUA_COUNT, proofs),
    ONE("proofs_lowered", AMBIT_LUA_COUNT, lowered) };
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_reduction_result, field);
  ambit_lua_write(L, &fields, result);
}

/* reduce{solver, options, states, symbols, data, rates, outputs, output_expressions, bounds, candidates, effect,
** effect_candidate, effect_state, references, prove, tried} -> {status, reason, cut, rankings, ...}, report */
static int reduce(lua_State *L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 1);
  luaL_checkstack(L, STACK, "core.reduce");
  ambit_reduction_request q = request(L);
  ambit_receiver to = ambit_receiver_silent();
  caller c = { .L = L, .to = &to, .q = &q };
  watcher w = { { sizeof(ambit_sink), NULL, progress }, &c };
  c.prove = function(L, "prove");
  c.tried = function(L, "tried");
  lua_newtable(L);
  c.rankings = lua_gettop(L);
  lua_pushnil(L);
  c.error = lua_gettop(L);
  uint8_t *cut = lua_newuserdatauv(L, q.ncandidate + 1, 0);
  q.prove = prove, q.tried = tried, q.rank = rank, q.user = &c, q.sink = &w.sink;
  ambit_reduction_result result;
  ambit_report report = { 0 };
  ambit_failure f = { 0 };
  ambit_receiver_begin(L, &to);
  ambit_status status = ambit_reduction_run(&q, cut, &result, &report, &f);
  ambit_receiver_end(&to);
  if (c.raised) {
    lua_pushvalue(L, c.error);
    return lua_error(L);
  }
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_result(L, &c, &result, cut);
  ambit_lua_push_report(L, &report);
  return 2;
}

void ambit_lua_open_reduction(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "reduce", reduce }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
