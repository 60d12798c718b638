/* loops.c -- closed loops as Lua values: constraints, multipliers, rank. */
#include "lua/core.h"

void ambit_lua_open_loops(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
