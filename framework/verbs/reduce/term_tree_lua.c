/* term_tree_lua.c -- the equations of a system as nested sums of terms, as a Lua value. */
#include "graph/writer.h"
#include "algebra/term_tree.h"
#include "script/core.h"
#include <string.h>

#define TYPE "ambit.term_tree"
#define TEXT_MAX 100u /* of a term, in bytes; a longer one is shown shortened */

typedef struct held_tree {
  ambit_holder holder; /* of the expressions of `tree` */
  ambit_term_tree tree;
} held_tree;

static ambit_term_tree *check(lua_State *L) { return &((held_tree *)luaL_checkudata(L, 1, TYPE))->tree; }

static void mark(ambit_holder *holder, ambit_graph *g) {
  const ambit_term_tree *tree = &((const held_tree *)(const void *)holder)->tree;
  if (tree->rate) ambit_graph_mark(g, tree->nequation, tree->rate);
  if (tree->expanded) ambit_graph_mark(g, tree->nequation, tree->expanded);
  for (size_t k = 0; k < tree->nterm; k++) ambit_graph_mark(g, 1, &tree->term[k].e);
  for (size_t k = 0; k < tree->nsum; k++) ambit_graph_mark(g, 1, &tree->sum[k].node);
}

static int close(lua_State *L) {
  held_tree *held = luaL_checkudata(L, 1, TYPE);
  ambit_graph_release(&held->holder);
  ambit_term_tree_close(&held->tree);
  return ambit_lua_retire(L);
}

/* A number not below 0 and not above the greatest that fits. */
static uint32_t count_at(lua_State *L, int idx, const char *what) {
  lua_Integer n = luaL_optinteger(L, idx, 0);
  if (n < 0 || n > INT32_MAX) ambit_lua_error(L, "term_tree: %s must be 0 or a positive integer", what);
  return (uint32_t)n;
}

/* term_tree({rate} [, max_level [, expand_limit]]) -> tree */
static int term_tree(lua_State *L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  size_t n = (size_t)luaL_len(L, 1);
  uint32_t level = count_at(L, 2, "the greatest level"), limit = count_at(L, 3, "the limit of summands");
  const ambit_expr *rate = ambit_lua_to_array(L, 1, n);
  held_tree *held = lua_newuserdatauv(L, sizeof *held, 0);
  *held = (held_tree) { .holder = { .mark = mark } };
  luaL_setmetatable(L, TYPE);
  ambit_graph_hold(AMBIT_LUA(L)->graph, &held->holder);
  ambit_failure f = { 0 };
  if (ambit_term_tree_open(AMBIT_LUA(L)->graph, n, rate, level, limit, &held->tree, &f) != AMBIT_OK)
    ambit_lua_raise(L, &f);
  return 1;
}

static void push_text(lua_State *L, const ambit_graph *g, ambit_expr e) {
  char text[TEXT_MAX + 2];
  bool whole = ambit_writer_begin(g, e, sizeof text, text);
  size_t length = strlen(text), shown = length < TEXT_MAX ? length : TEXT_MAX;
  while (!whole && shown > 0 && ((unsigned char)text[shown - 1] & 0xc0) == 0x80) shown--; /* UTF-8 as a whole */
  if (!whole && shown > 0 && (unsigned char)text[shown - 1] >= 0xc0) shown--;
  lua_pushlstring(L, text, shown);
  if (whole) return;
  lua_pushstring(L, " ...");
  lua_concat(L, 2);
}

/* term_list(tree) -> { { equation, level, parent (0: none), expression, text }, ... } */
static int term_list(lua_State *L) {
  const ambit_term_tree *tree = check(L);
  lua_createtable(L, (int)tree->nterm, 0);
  for (size_t k = 0; k < tree->nterm; k++) {
    ambit_tree_term term = tree->term[k];
    lua_createtable(L, 0, 5);
    lua_pushinteger(L, (lua_Integer)term.equation + 1);
    lua_setfield(L, -2, "equation");
    lua_pushinteger(L, term.level);
    lua_setfield(L, -2, "level");
    lua_pushinteger(L, term.parent == AMBIT_NO_TERM ? 0 : (lua_Integer)term.parent + 1);
    lua_setfield(L, -2, "parent");
    ambit_lua_push_expression(L, term.e);
    lua_setfield(L, -2, "expression");
    push_text(L, AMBIT_LUA(L)->graph, term.e);
    lua_setfield(L, -2, "text");
    lua_rawseti(L, -2, (lua_Integer)k + 1);
  }
  return 1;
}

/* term_rewrite(tree, {index}, {expression}) -> {rate} */
static int term_rewrite(lua_State *L) {
  const ambit_term_tree *tree = check(L);
  luaL_checktype(L, 2, LUA_TTABLE);
  luaL_checktype(L, 3, LUA_TTABLE);
  size_t n = (size_t)luaL_len(L, 2);
  if ((size_t)luaL_len(L, 3) != n) ambit_lua_error(L, "term_rewrite: expected one expression for each term");
  const ambit_expr *by = ambit_lua_to_array(L, 3, n);
  uint32_t *index = lua_newuserdatauv(L, (n + 1) * sizeof *index, 0);
  for (size_t k = 0; k < n; k++) {
    lua_rawgeti(L, 2, (lua_Integer)k + 1);
    lua_Integer i = luaL_checkinteger(L, -1);
    if (i < 1 || (size_t)i > tree->nterm)
      ambit_lua_error(L, "term_rewrite: there is no term %lld: there are %zu", (long long)i, tree->nterm);
    index[k] = (uint32_t)(i - 1);
    lua_pop(L, 1);
  }
  ambit_expr *rate = lua_newuserdatauv(L, (tree->nequation + 1) * sizeof *rate, 0);
  ambit_failure f = { 0 };
  if (ambit_term_tree_rewrite(AMBIT_LUA(L)->graph, tree, n, index, by, rate, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_push_expressions(L, tree->nequation, rate);
  return 1;
}

void ambit_lua_open_term_tree(lua_State *L, ambit_lua *core) {
  static const luaL_Reg meta[] = { { "__gc", close }, { NULL, NULL } };
  static const luaL_Reg functions[] = { { "term_tree", term_tree }, { "term_list", term_list },
    { "term_rewrite", term_rewrite }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
  ambit_lua_new_type(L, core, TYPE, meta);
  lua_pop(L, 1);
}
