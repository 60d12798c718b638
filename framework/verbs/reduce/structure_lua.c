/* structure_lua.c -- what expressions are made of, for model reduction: how many operations, which of them have
** kinks. */
#include "graph/kink.h"
#include "graph/walk.h"
#include "script/core.h"

static const char *kink_name(uint32_t op) { return op == AMBIT_OP_ABS ? "abs" : op == AMBIT_OP_MIN ? "min" : "max"; }

/* operations({e, ...}) -> how many distinct operations they take */
static int operations(lua_State *L) {
  size_t n = (size_t)luaL_len(L, 1);
  const ambit_expr *e = ambit_lua_to_array(L, 1, n);
  lua_pushinteger(L, (lua_Integer)ambit_graph_size(AMBIT_LUA(L)->graph, n, e));
  return 1;
}

/* kinks({e, ...}) -> { { op = "abs" | "min" | "max", node = e, a = e, b = e } }, operands before what they are in */
static int kinks(lua_State *L) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  size_t n = (size_t)luaL_len(L, 1), found = 0;
  const ambit_expr *e = ambit_lua_to_array(L, 1, n);
  ambit_expr *node = lua_newuserdatauv(L, (ambit_graph_size(g, n, e) + 1) * sizeof *node, 0);
  ambit_walk walk; /* its memory is not Lua's: nothing may raise while it is open */
  if (!ambit_walk_open(g, n, e, NULL, &walk)) ambit_lua_error(L, "out of memory");
  for (size_t i = 0; i < walk.count; i++)
    if (ambit_op_has_kink(ambit_graph_node(g, walk.node[i])->op)) node[found++] = walk.node[i];
  ambit_walk_close(&walk);
  lua_createtable(L, (int)found, 0);
  for (size_t i = 0; i < found; i++) {
    ambit_node at = *ambit_graph_node(g, node[i]);
    lua_createtable(L, 0, 4);
    lua_pushstring(L, kink_name(at.op));
    lua_setfield(L, -2, "op");
    ambit_lua_push_expression(L, node[i]);
    lua_setfield(L, -2, "node");
    ambit_lua_push_expression(L, at.a);
    lua_setfield(L, -2, "a");
    ambit_lua_push_expression(L, at.b);
    lua_setfield(L, -2, "b");
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

/* answers() -> {nodes, asked, shared, folded} of the whole graph: how operations were answered */
static int answers(lua_State *L) {
  const ambit_graph *g = AMBIT_LUA(L)->graph;
  ambit_graph_tally tally = ambit_graph_answers(g);
  const struct {
    const char *name;
    uint64_t count;
  } field[] = { { "nodes", ambit_graph_made(g) }, { "asked", tally.asked }, { "shared", tally.shared },
    { "folded", tally.folded } };
  lua_createtable(L, 0, 4);
  for (size_t i = 0; i < sizeof field / sizeof *field; i++) {
    lua_pushinteger(L, (lua_Integer)field[i].count);
    lua_setfield(L, -2, field[i].name);
  }
  return 1;
}

void ambit_lua_open_structure(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "operations", operations }, { "kinks", kinks }, { "answers", answers },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
