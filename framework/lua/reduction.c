/* reduction.c -- a solver that chooses what a model may leave out. */
#include "lua/core.h"

void ambit_lua_open_reduction(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
