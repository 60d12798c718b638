/* expression.c -- expressions as Lua values: operators, text, derivative. */
#include "graph/name.h"
#include "script/core.h"
#include "script/embedded.h"
#include "num/decimal.h"
#include <string.h>

static ambit_lua_expression *self(lua_State *L) { return luaL_checkudata(L, 1, AMBIT_TYPE_EXPRESSION); }

/* __gc, not in the standard environment: it only takes the expression off the list. */
static int forget(lua_State *L) {
  ambit_lua_box *box = luaL_checkudata(L, 1, AMBIT_TYPE_EXPRESSION);
  if (box->link) {
    *box->link = box->next;
    if (box->next) box->next->link = box->link;
    box->link = NULL;
  }
  return ambit_lua_retire(L);
}

/* An expression that shares much can stand for a text of astronomical length. */
#define TEXT_MAX 10000u

static int text(lua_State *L) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  ambit_expr e = self(L)->e;
  char small[256];
  size_t length = ambit_graph_text(g, e, small, sizeof small);
  if (length < sizeof small) {
    lua_pushlstring(L, small, length);
    return 1;
  }
  size_t shown = length < TEXT_MAX ? length : TEXT_MAX;
  luaL_Buffer buffer;
  char *room = luaL_buffinitsize(L, &buffer, shown + 1);
  ambit_graph_text(g, e, room, shown + 1);
  luaL_pushresultsize(&buffer, shown);
  if (shown == length) return 1;
  lua_pushfstring(L, "%s ... (%f characters in all)", lua_tostring(L, -1), (lua_Number)length);
  return 1;
}

/* Is the running metamethod asked by a scene, and not by Ambit's own Lua, while a formula is written
** (models/formula.lua)? Then the comparison says nothing about what the expression will be. */
static bool in_formula(lua_State *L) {
  lua_Debug frame;
  for (int level = 1; lua_getstack(L, level, &frame); level++) {
    lua_getinfo(L, "S", &frame);
    if (strcmp(frame.source, AMBIT_CHUNK_PREFIX "formula.lua") == 0) return level > 1;
    if (level == 1 && strncmp(frame.source, AMBIT_CHUNK_PREFIX, sizeof AMBIT_CHUNK_PREFIX - 1) == 0) return false;
  }
  return false;
}

void ambit_lua_refuse_equality(lua_State *L) {
  if (!in_formula(L)) return;
  ambit_lua_error(L,
      "== and ~= do not compare the values of expressions, which have none while the formula is written: "
      "use ambit.abs, ambit.min and ambit.max, or one mode for each case (ambit.hybrid)");
}

static int equal(lua_State *L) {
  ambit_lua_refuse_equality(L);
  const ambit_lua_expression *a = luaL_testudata(L, 1, AMBIT_TYPE_EXPRESSION);
  const ambit_lua_expression *b = luaL_testudata(L, 2, AMBIT_TYPE_EXPRESSION);
  lua_pushboolean(L, a && b && a->e == b->e);
  return 1;
}

static int order(lua_State *L) {
  ambit_lua_error(
      L, "expressions have no order: compare enclosures (ambit.evaluate), or use ambit.min, ambit.max, ambit.abs");
}

/* derivative(e, x): x a variable, an unknown or ambit.time */
static int derivative(lua_State *L) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  ambit_lua_expression of = ambit_lua_to_expression(L, 1, NULL, "derivative"),
                       by = ambit_lua_to_expression(L, 2, NULL, "derivative");
  ambit_expr e = of.e, x = by.e;
  ambit_failure f = { 0 };
  if (ambit_graph_node(g, x)->op < AMBIT_LEAF_UNKNOWN)
    ambit_lua_error(L, "derivative: the second argument must be a single variable or unknown");
  ambit_expr d = ambit_graph_derivative(g, e, x, &f);
  if (d == AMBIT_NO_EXPR && f.status != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_expression(L, d)->dimension =
      ambit_lua_dimension_op(L, AMBIT_OP_DIV, of.dimension, by.dimension, "derivative");
  return 1;
}

/* rate_off_kinks(e, {symbol}, {rate}): de/dt along x' = rate, undefined where abs, min and max switch */
static int rate_off_kinks(lua_State *L) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  ambit_expr e = ambit_lua_to_expression(L, 1, NULL, "rate_off_kinks").e;
  size_t n = (size_t)luaL_len(L, 2);
  ambit_expr *leaf = ambit_lua_to_array(L, 2, n), *rate = ambit_lua_to_array(L, 3, n);
  ambit_failure f = { 0 };
  ambit_expr d = ambit_graph_rate_off_kinks(g, e, n, leaf, rate, &f);
  if (d == AMBIT_NO_EXPR) ambit_lua_raise(L, &f);
  ambit_lua_push_expression(L, d);
  return 1;
}

static int simplify(lua_State *L) {
  ambit_lua_expression x = ambit_lua_to_expression(L, 1, NULL, "simplify");
  int fits = 1;
  lua_Integer limit = lua_isnoneornil(L, 2) ? 1000 : lua_tointegerx(L, 2, &fits);
  if (!fits || limit < 1) ambit_lua_error(L, "simplify: expected a positive integer, the most terms to expand into");
  x.e = ambit_graph_simplify(AMBIT_LUA(L)->graph, x.e, (size_t)limit);
  ambit_lua_push_expression(L, x.e)->dimension = x.dimension;
  return 1;
}

/* expression(value [, unit [, what]]) */
static int expression(lua_State *L) {
  const char *unit = luaL_optstring(L, 2, NULL), *what = luaL_optstring(L, 3, NULL);
  *ambit_lua_push_expression(L, 0) = ambit_lua_to_expression(L, 1, unit, what);
  return 1;
}

/* symbol(name, unit): the variable of that name */
static int symbol(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_lua_push_expression(L, ambit_graph_symbol(core->graph, luaL_checkstring(L, 1), luaL_optstring(L, 2, "1")));
  return 1;
}

static int time_symbol(lua_State *L) {
  ambit_lua_push_expression(L, ambit_graph_time(AMBIT_LUA(L)->graph));
  return 1;
}

static int pi(lua_State *L) {
  ambit_lua_push_expression(L, ambit_graph_pi(AMBIT_LUA(L)->graph))->dimension.state = AMBIT_DIMENSION_SOFT;
  return 1;
}

static int is_constant(lua_State *L) {
  lua_pushboolean(L, ambit_lua_is_constant(L, self(L)));
  return 1;
}

static const char *kind_of(uint32_t op) {
  switch (op) {
  case AMBIT_LEAF_UNKNOWN: return "unknown";
  case AMBIT_LEAF_VARYING: return "varying";
  case AMBIT_LEAF_TIME: return "time";
  default: return "symbol";
  }
}

/* leaves({e, ...}) -> {{expression, kind, name, unit, lo, hi, inner_lo, inner_hi, number}, ...}: what the expressions
** depend on. Data: inner_lo > inner_hi: no value is known to be allowed; unit: where it was made. */
static int leaves(lua_State *L) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  size_t n = (size_t)luaL_len(L, 1);
  ambit_expr *e = ambit_lua_to_array(L, 1, n);
  size_t count = ambit_graph_leaves(g, n, e, 0, NULL);
  ambit_expr *leaf = lua_newuserdatauv(L, (count + 1) * sizeof *leaf, 0);
  ambit_graph_leaves(g, n, e, count, leaf);
  lua_createtable(L, (int)count, 0);
  for (size_t i = 0; i < count; i++) {
    const ambit_node *node = ambit_graph_node(g, leaf[i]);
    ambit_interval range = ambit_leaf_is_uncertain(node->op) ? node->value : node->range;
    lua_createtable(L, 0, 9);
    lua_pushinteger(L, (lua_Integer)ambit_graph_birth(g, leaf[i]));
    lua_setfield(L, -2, "number");
    lua_pushstring(L, node->text);
    lua_setfield(L, -2, "name");
    lua_pushstring(L, node->unit);
    lua_setfield(L, -2, "unit");
    lua_pushstring(L, kind_of(node->op));
    lua_setfield(L, -2, "kind");
    lua_pushnumber(L, range.lo);
    lua_setfield(L, -2, "lo");
    lua_pushnumber(L, range.hi);
    lua_setfield(L, -2, "hi");
    lua_pushnumber(L, node->inner.lo);
    lua_setfield(L, -2, "inner_lo");
    lua_pushnumber(L, node->inner.hi);
    lua_setfield(L, -2, "inner_hi");
    ambit_lua_push_expression(L, leaf[i]);
    lua_setfield(L, -2, "expression");
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

/* substitute({e, ...}, {leaf, ...}, {value, ...}) -> {e, ...}: each leaf replaced by its value */
static int substitute(lua_State *L) {
  size_t n = (size_t)luaL_len(L, 1), count = (size_t)luaL_len(L, 2);
  ambit_expr *e = ambit_lua_to_array(L, 1, n), *leaf = ambit_lua_to_array(L, 2, count);
  ambit_expr *value = ambit_lua_to_array(L, 3, count);
  ambit_failure f = { 0 };
  if (ambit_graph_substitute(AMBIT_LUA(L)->graph, n, e, count, leaf, value, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_expressions(L, n, e);
  return 1;
}

/* name_data({e, ...}, {label, ...} or label): data below e that have no name yet are called after it */
static int name_data(lua_State *L) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  size_t n = (size_t)luaL_len(L, 1);
  const ambit_expr *e = ambit_lua_to_array(L, 1, n);
  for (size_t i = 0; i < n; i++) {
    if (lua_type(L, 2) == LUA_TTABLE)
      lua_rawgeti(L, 2, (lua_Integer)i + 1);
    else
      lua_pushvalue(L, 2);
    if (!ambit_graph_name_data(g, e[i], luaL_checkstring(L, -1))) ambit_lua_error(L, "out of memory");
    lua_pop(L, 1);
  }
  return 0;
}

/* The first plain interval among the leaves; AMBIT_NO_EXPR: none, or only data are there and not always. */
static ambit_expr find_plain(const ambit_graph *g, size_t n, const ambit_expr *leaf, bool always) {
  ambit_expr found = AMBIT_NO_EXPR;
  for (size_t i = n; i-- > 0;) {
    const ambit_node *node = ambit_graph_node(g, leaf[i]);
    if (node->plain) found = leaf[i];
    always = always || node->op != AMBIT_LEAF_UNKNOWN;
  }
  return always ? found : AMBIT_NO_EXPR;
}

/* refuse_plain({e, ...}, what, always): an error where a formula holds a plain interval: nobody said whether it is one
** constant or varies. not always: data without variables are no formula, but one datum. */
static int refuse_plain(lua_State *L) {
  const ambit_graph *g = AMBIT_LUA(L)->graph;
  size_t n = (size_t)luaL_len(L, 1);
  bool always = lua_toboolean(L, 3);
  const ambit_expr *e = ambit_lua_to_array(L, 1, n);
  for (size_t i = 0; i < n; i++) {
    if (ambit_graph_node(g, e[i])->constant) continue;
    size_t count = ambit_graph_leaves(g, 1, &e[i], 0, NULL);
    ambit_expr *leaf = lua_newuserdatauv(L, (count + 1) * sizeof *leaf, 0);
    ambit_graph_leaves(g, 1, &e[i], count, leaf);
    ambit_expr plain = find_plain(g, count, leaf, always);
    lua_pop(L, 1);
    if (plain == AMBIT_NO_EXPR) continue;
    char range[3 * AMBIT_DECIMAL_MAX];
    const ambit_node *node = ambit_graph_node(g, plain);
    ambit_decimal_interval(range, node->value, 3);
    ambit_lua_error(L,
        "%s: the plain interval %s%s%s%s does not say whether it is one unknown constant or varies along a run: write "
        "ambit.between(lo, hi) for one unknown constant, ambit.varying(lo, hi) for what varies within bounds",
        luaL_checkstring(L, 2), range, node->unit ? " (" : "", node->unit ? node->unit : "", node->unit ? ")" : "");
  }
  return 0;
}

/* leaf_names({leaf, ...}) -> {name, ...}, told apart */
static int leaf_names(lua_State *L) {
  const ambit_graph *g = AMBIT_LUA(L)->graph;
  size_t n = (size_t)luaL_len(L, 1);
  const ambit_expr *leaf = ambit_lua_to_array(L, 1, n);
  const char **name = lua_newuserdatauv(L, (n + 1) * sizeof *name, 0);
  lua_createtable(L, (int)n, 0);
  ambit_arena *arena = ambit_arena_open();
  bool good = arena && ambit_graph_leaf_names(g, arena, n, leaf, name);
  for (size_t i = 0; good && i < n; i++) {
    lua_pushstring(L, name[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  ambit_arena_close(arena);
  if (!good) ambit_lua_error(L, "out of memory");
  return 1;
}

static int nodes(lua_State *L) {
  lua_pushinteger(L, (lua_Integer)ambit_graph_made(AMBIT_LUA(L)->graph));
  return 1;
}

void ambit_lua_open_expression(lua_State *L, ambit_lua *core) {
  static const luaL_Reg meta[] = { { "__tostring", text }, { "__eq", equal }, { "__lt", order }, { "__le", order },
    { NULL, NULL } };
  static const luaL_Reg functions[] = { { "derivative", derivative }, { "rate_off_kinks", rate_off_kinks },
    { "simplify", simplify }, { "expression", expression }, { "symbol", symbol }, { "time", time_symbol }, { "pi", pi },
    { "is_constant", is_constant }, { "leaves", leaves }, { "name_data", name_data }, { "leaf_names", leaf_names },
    { "refuse_plain", refuse_plain }, { "nodes", nodes }, { "substitute", substitute }, { NULL, NULL } };
  static const char *const operators[][2] = { { "__add", "add" }, { "__sub", "sub" }, { "__mul", "mul" },
    { "__div", "div" }, { "__unm", "neg" }, { "__pow", "pow" } };
  ambit_lua_set_functions(L, core, functions);
  ambit_lua_new_type(L, core, AMBIT_TYPE_EXPRESSION, meta);
  lua_pushcfunction(L, forget);
  lua_setfield(L, -2, "__gc");
  for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
    lua_getfield(L, -2, operators[i][1]);
    lua_setfield(L, -2, operators[i][0]);
  }
  lua_pop(L, 1);
}
