/* profile.c -- where the time of a scene goes, and the work that it took, counted. */
#include "lua/core.h"

void ambit_lua_open_profile(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
