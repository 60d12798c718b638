/* roots.c -- verified roots of expressions as Lua values. */
#include "lua/core.h"

void ambit_lua_open_roots(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
