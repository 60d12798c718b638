/* reduction_lua.c -- the solver that chooses what a model may leave out; proofs are Lua functions.
**
** A callback runs in protected mode, inside the solver: an error in it is kept, the solver is told to stop, and the
** error is raised again once everything is closed. Ctrl-C stops as any verb.
*/
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

/* -- fields of the table at 1 */

static bool field(lua_State *L, const char *key, int type) {
  int got = lua_getfield(L, 1, key);
  if (got != type && got != LUA_TNIL)
    ambit_lua_error(L, "core.reduce: `%s` must be a %s, not a %s", key, lua_typename(L, type), luaL_typename(L, -1));
  return got == type;
}

/* the list in a field: its place on the stack; absent: an empty one */
static int list(lua_State *L, const char *key, size_t *n) {
  if (!field(L, key, LUA_TTABLE)) {
    lua_pop(L, 1);
    lua_newtable(L);
  }
  *n = (size_t)luaL_len(L, -1);
  return lua_gettop(L);
}

static void check_length(lua_State *L, const char *key, size_t n, size_t expected) {
  if (n != expected) ambit_lua_error(L, "core.reduce: `%s` has %d entries, not %d", key, (int)n, (int)expected);
}

static const char **texts(lua_State *L, const char *key, size_t *n) { return ambit_lua_texts(L, list(L, key, n), n); }

static const ambit_expr *expressions(lua_State *L, const char *key, size_t expected) {
  size_t n;
  int at = list(L, key, &n);
  if (expected != SIZE_MAX) check_length(L, key, n, expected);
  return ambit_lua_to_array(L, at, n);
}

/* indices from 1 -> from 0; 0 and what is no index become UINT32_MAX, which the kernel refuses */
static const uint32_t *indices(lua_State *L, const char *key, size_t expected) {
  size_t n;
  const double *x = ambit_lua_numbers(L, list(L, key, &n), &n);
  check_length(L, key, n, expected);
  uint32_t *index = lua_newuserdatauv(L, (n + 1) * sizeof *index, 0);
  for (size_t i = 0; i < n; i++) index[i] = x[i] >= 1 && x[i] < UINT32_MAX ? (uint32_t)x[i] - 1 : UINT32_MAX;
  return index;
}

static double *subnumbers(lua_State *L, int idx, const char *key, size_t *n) {
  if (lua_getfield(L, idx, key) != LUA_TTABLE) ambit_lua_error(L, "core.reduce: a reference needs the list `%s`", key);
  return ambit_lua_numbers(L, lua_gettop(L), n);
}

/* {scenario =, t =, x =, data =} at idx; data: one value each, or one row for each time */
static ambit_reduction_reference reference(lua_State *L, int idx, size_t nx, size_t ndata) {
  ambit_reduction_reference r = { 0 };
  size_t n, given;
  lua_getfield(L, idx, "scenario");
  r.scenario = (uint32_t)luaL_optinteger(L, -1, 1);
  r.time = subnumbers(L, idx, "t", &r.ntime);
  r.x = subnumbers(L, idx, "x", &n);
  check_length(L, "x", n, r.ntime * nx);
  const double *data = subnumbers(L, idx, "data", &given);
  if (given != ndata) check_length(L, "data", given, r.ntime * ndata);
  double *rows = lua_newuserdatauv(L, (r.ntime * ndata + 1) * sizeof *rows, 0);
  for (size_t i = 0; i < r.ntime * ndata; i++) rows[i] = data[i % given];
  r.data = rows;
  return r;
}

/* Arrays of each reference are kept in one table, so that the stack does not grow with their number. */
static const ambit_reduction_reference *references(lua_State *L, size_t nx, size_t ndata, size_t *n) {
  int at = list(L, "references", n);
  ambit_reduction_reference *r = lua_newuserdatauv(L, (*n + 1) * sizeof *r, 0);
  lua_newtable(L);
  int keep = lua_gettop(L);
  for (size_t i = 0; i < *n; i++) {
    lua_rawgeti(L, at, (lua_Integer)i + 1);
    luaL_checktype(L, -1, LUA_TTABLE);
    r[i] = reference(L, lua_gettop(L), nx, ndata);
    while (lua_gettop(L) > keep) luaL_ref(L, keep);
  }
  return r;
}

static ambit_reduction_request request(lua_State *L) {
  ambit_reduction_request q = { .graph = AMBIT_LUA(L)->graph, .registry = AMBIT_LUA(L)->registry };
  size_t n;
  q.solver = field(L, "solver", LUA_TSTRING) ? lua_tostring(L, -1) : AMBIT_DEFAULT_STRATEGY;
  q.solver_option = ambit_lua_options(L, list(L, "options", &n), &q.nsolver_option);
  q.state = texts(L, "states", &q.nx);
  q.symbol = expressions(L, "symbols", q.nx);
  q.rate = expressions(L, "rates", q.nx);
  int data = list(L, "data", &q.ndata);
  q.data = ambit_lua_to_array(L, data, q.ndata);
  q.output = texts(L, "outputs", &q.noutput);
  q.output_expression = expressions(L, "output_expressions", q.noutput);
  q.bound = ambit_lua_numbers(L, list(L, "bounds", &n), &n);
  check_length(L, "bounds", n, q.noutput);
  q.candidate = texts(L, "candidates", &q.ncandidate);
  int effect = list(L, "effect", &q.neffect);
  q.effect = ambit_lua_to_array(L, effect, q.neffect);
  q.effect_candidate = indices(L, "effect_candidate", q.neffect);
  q.effect_state = indices(L, "effect_state", q.neffect);
  q.reference = references(L, q.nx, q.ndata, &q.nreference);
  return q;
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
  ambit_lua_set_number(L, "cpu_seconds", result->cpu_seconds);
  ambit_lua_set_number(L, "cpu_seconds_rank", result->cpu_seconds_rank);
  ambit_lua_set_count(L, "proofs", result->proofs);
  ambit_lua_set_count(L, "proofs_lowered", result->lowered);
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
  if (!field(L, "prove", LUA_TFUNCTION)) ambit_lua_error(L, "core.reduce: `prove` is missing");
  c.prove = lua_gettop(L);
  c.tried = field(L, "tried", LUA_TFUNCTION) ? lua_gettop(L) : 0;
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
