/* mechanism_lua.h -- the mechanism behind a Lua value, for the files that ask it things. */
#ifndef AMBIT_LUA_MECHANISM_H
#define AMBIT_LUA_MECHANISM_H
#include <ambit/mechanism.h>
#include <lua.h>

/* Anything else at idx raises a Lua error. */
ambit_mechanism *ambit_lua_to_mechanism(lua_State *L, int idx);
#endif
