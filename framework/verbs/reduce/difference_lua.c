/* difference_lua.c -- u(x) - w(x - d), written so that it vanishes with d. */
#include "algebra/difference.h"
#include "script/core.h"

/* difference({u}, {w}, {leaf}, {delta} [, clamps]) -> {u(leaf) - w(leaf - delta)} */
static int difference(lua_State *L) {
  size_t n = (size_t)luaL_len(L, 1), nleaf = (size_t)luaL_len(L, 3);
  const ambit_expr *u = ambit_lua_to_array(L, 1, n), *w = ambit_lua_to_array(L, 2, n);
  const ambit_expr *leaf = ambit_lua_to_array(L, 3, nleaf), *delta = ambit_lua_to_array(L, 4, nleaf);
  ambit_expr *out = lua_newuserdatauv(L, (n + 1) * sizeof *out, 0);
  ambit_failure f = { 0 };
  if (ambit_graph_difference(AMBIT_LUA(L)->graph, n, u, w, nleaf, leaf, delta, lua_toboolean(L, 5), out, &f) !=
      AMBIT_OK)
    ambit_lua_raise(L, &f);
  ambit_lua_push_expressions(L, n, out);
  return 1;
}

void ambit_lua_open_difference(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "difference", difference }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
