/* term_tree.c -- the equations of a system as nested sums of terms. */
#include "lua/core.h"

void ambit_lua_open_term_tree(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
