/* loops_lua.c -- closed loops as Lua values: constraints, the choice of independent speeds, multipliers, rank. */
#include "script/core.h"
#include "script/fields.h"
#include "script/interrupt.h"
#include "models/mechanism_lua.h"
#include "script/request.h"
#include "models/system_lua.h"
#include "mechanics/constrained.h"
#include "mechanics/rank.h"

/* Scratch memory that Lua frees. */
static ambit_arena *scratch(lua_State *L) { return ambit_lua_push_system(L)->arena; }

static void push_row(lua_State *L, const ambit_constraint *row) {
  lua_createtable(L, 0, 3);
  lua_pushstring(L, row->name);
  lua_setfield(L, -2, "name");
  lua_pushstring(L, row->loop);
  lua_setfield(L, -2, "loop");
  ambit_lua_push_expression(L, row->g);
  lua_setfield(L, -2, "residual");
}

/* constraints(mechanism) -> {{name, loop, residual}, ...}, {name of a row that is 0 = 0, ...} */
static int constraints(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  ambit_arena *arena = scratch(L);
  ambit_constraints c;
  if (ambit_constraints_build(m, arena, &c, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  size_t n = c.n + c.npure;
  lua_createtable(L, (int)n, 0);
  for (size_t k = 0; k < n; k++) {
    push_row(L, &c.row[k]);
    lua_rawseti(L, -2, (lua_Integer)k + 1);
  }
  lua_createtable(L, (int)c.ntrivial, 0);
  for (size_t k = 0; k < c.ntrivial; k++) {
    lua_pushstring(L, c.row[n + k].name);
    lua_rawseti(L, -2, (lua_Integer)k + 1);
  }
  return 2;
}

static int has_constraints(lua_State *L) {
  lua_pushboolean(L, ambit_constraints_exist(ambit_lua_to_mechanism(L, 1)));
  return 1;
}

/* -- the choice */

/* loops_refer(mechanism, {name}, {number}) */
static int loops_refer(lua_State *L) {
  ambit_failure f = { 0 };
  size_t n;
  const char **name = ambit_lua_texts(L, 2, &n);
  const double *value = ambit_lua_numbers(L, 3, &n);
  if (ambit_loops_refer(ambit_lua_to_mechanism(L, 1), n, name, value, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return 0;
}

/* loops_choose(mechanism, {name}) */
static int loops_choose(lua_State *L) {
  ambit_failure f = { 0 };
  size_t n;
  const char **name = ambit_lua_texts(L, 2, &n);
  if (ambit_loops_choose(ambit_lua_to_mechanism(L, 1), n, name, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return 0;
}

/* A speed goes by the name of its coordinate if it has one. */
static const char *motion_name(const ambit_constraints *c, uint32_t speed) {
  for (size_t j = 0; j < c->nq; j++)
    if (c->coordinate[j].q == c->speed[speed].coordinate) return c->coordinate[j].name;
  return c->speed[speed].name;
}

static void set_motions(lua_State *L, const char *key, const ambit_constraints *c, size_t n, const uint32_t *speed) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushstring(L, motion_name(c, speed[i]));
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  lua_setfield(L, -2, key);
}

static void set_rows(lua_State *L, const char *key, const ambit_constraints *c, size_t n, const uint32_t *row) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_pushstring(L, c->row[row[i]].name);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  lua_setfield(L, -2, key);
}

/* The fields independent, dependent, redundant of the table on top. */
static void set_partition(lua_State *L, const ambit_constraints *c, const ambit_partition *p) {
  set_motions(L, "independent", c, p->nu - p->rank, p->independent);
  set_motions(L, "dependent", c, p->rank, p->column);
  set_rows(L, "redundant", c, p->n - p->rank, p->redundant);
}

/* loops(mechanism) -> {independent, dependent, redundant, reference = {name = number}} */
static int loops(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_loops found;
  ambit_mechanism *m = ambit_lua_to_mechanism(L, 1);
  if (ambit_loops_build(m, scratch(L), &found, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  const ambit_constraints *c = &found.constraints;
  lua_createtable(L, 0, 4);
  set_partition(L, c, &found.partition);
  lua_createtable(L, 0, (int)c->nq);
  for (size_t j = 0; j < c->nq; j++) {
    lua_pushnumber(L, found.reference[j]);
    lua_setfield(L, -2, c->coordinate[j].name);
  }
  lua_setfield(L, -2, "reference");
  return 1;
}

/* -- what the states determine */

static ambit_constrained constrained_of(lua_State *L, ambit_arena *arena) {
  ambit_failure f = { 0 };
  ambit_constrained c;
  if (ambit_constrained_build(ambit_lua_to_mechanism(L, 1), arena, &c, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  return c;
}

/* multipliers(mechanism) -> {{name, multiplier}, ...} by rows; those of redundant rows are left out */
static int multipliers(lua_State *L) {
  ambit_constrained c = constrained_of(L, scratch(L));
  const ambit_partition *p = &c.loops.partition;
  lua_createtable(L, (int)p->rank, 0);
  for (size_t k = 0, n = 0; k < p->n; k++) {
    bool kept = false;
    for (size_t i = 0; i < p->rank; i++) kept = kept || p->row[i] == k;
    if (!kept) continue;
    lua_createtable(L, 0, 2);
    lua_pushstring(L, c.loops.constraints.row[k].name);
    lua_setfield(L, -2, "name");
    ambit_lua_push_expression(L, c.multiplier[k]);
    lua_setfield(L, -2, "multiplier");
    lua_rawseti(L, -2, (lua_Integer)++n);
  }
  return 1;
}

/* of_states(mechanism, {expression}) -> {expression}: dependent speeds, accelerations and multipliers replaced */
static int of_states(lua_State *L) {
  ambit_failure f = { 0 };
  ambit_arena *arena = scratch(L);
  size_t n = (size_t)luaL_len(L, 2);
  ambit_expr *e = ambit_lua_to_array(L, 2, n);
  ambit_constrained c = constrained_of(L, arena);
  if (ambit_constrained_express(&c, arena, n, e, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_expressions(L, n, e);
  return 1;
}

/* -- rank */

/* The elements of the rows, each once. */
static void set_loops(lua_State *L, const char *key, const ambit_constraints *c, size_t n, const uint32_t *row) {
  lua_Integer count = 0;
  lua_newtable(L);
  for (size_t i = 0; i < n; i++) {
    bool seen = false;
    for (size_t k = 0; k < i; k++) seen = seen || c->row[row[k]].part == c->row[row[i]].part;
    if (seen) continue;
    lua_pushstring(L, c->row[row[i]].loop);
    lua_rawseti(L, -2, ++count);
  }
  lua_setfield(L, -2, key);
}

static void push_rank(lua_State *L, const ambit_rank *r) {
  static const char *const status[] = { "proved", "undecided", "singular", "empty" };
  lua_createtable(L, 0, 7);
  lua_pushstring(L, status[r->outcome]);
  lua_setfield(L, -2, "status");
  set_partition(L, &r->loops.constraints, &r->partition);
  set_rows(L, "rows", &r->loops.constraints, r->nrow, r->row);
  set_loops(L, "loops", &r->loops.constraints, r->nrow, r->row);
  lua_pushinteger(L, (lua_Integer)r->boxes);
  lua_setfield(L, -2, "boxes");
}

/* rank(mechanism, {names, lo, hi, from, to, boxes}) -> {status, independent, dependent, redundant, rows, loops,
** boxes} */
static int rank(lua_State *L) {
#define LIST(key, kind, flags, member) AMBIT_LUA_LIST(ambit_rank_request, key, kind, flags, member, n)
#define ONE(key, kind, member) AMBIT_LUA_ONE(ambit_rank_request, key, kind, AMBIT_LUA_NEEDED, member)
  static const ambit_lua_field field[] = { LIST("names", AMBIT_LUA_TEXTS, AMBIT_LUA_NEEDED, name),
    LIST("lo", AMBIT_LUA_NUMBERS, AMBIT_LUA_NEEDED | AMBIT_LUA_SAME, lo),
    LIST("hi", AMBIT_LUA_NUMBERS, AMBIT_LUA_NEEDED | AMBIT_LUA_SAME, hi), ONE("from", AMBIT_LUA_NUMBER, time_lo),
    ONE("to", AMBIT_LUA_NUMBER, time_hi), ONE("boxes", AMBIT_LUA_SIZE, budget) };
#undef LIST
#undef ONE
  static const ambit_lua_fields fields = AMBIT_LUA_FIELDS(ambit_rank_request, field);
  ambit_failure f = { 0 };
  ambit_rank result;
  ambit_rank_request q = { .mechanism = ambit_lua_to_mechanism(L, 1) };
  ambit_lua_read(L, 2, "rank", &fields, &q);
  ambit_arena *arena = scratch(L);
  ambit_interrupt interrupt; /* many boxes take long: Ctrl-C in haste ends the process, once it raises at the end */
  ambit_interrupt_begin(&interrupt);
  ambit_status status = ambit_rank_certify(&q, arena, &result, &f);
  bool stopped = ambit_interrupt_pending();
  ambit_interrupt_end(&interrupt);
  if (stopped) ambit_lua_error(L, "rank: interrupted");
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  push_rank(L, &result);
  return 1;
}

void ambit_lua_open_loops(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "constraints", constraints }, { "has_constraints", has_constraints },
    { "loops_refer", loops_refer }, { "loops_choose", loops_choose }, { "loops", loops },
    { "multipliers", multipliers }, { "of_states", of_states }, { "rank", rank }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
