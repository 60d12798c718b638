/* source.c -- equations as source text of other languages. */
#include "lua/core.h"

void ambit_lua_open_source(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
