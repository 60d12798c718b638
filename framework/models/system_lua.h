/* system_lua.h -- first-order systems as Lua values. */
#ifndef AMBIT_LUA_SYSTEM_H
#define AMBIT_LUA_SYSTEM_H
#include "script/core.h"
#include <ambit/system.h>

typedef struct ambit_lua_system {
  ambit_holder holder; /* of the expressions of `system` */
  ambit_arena *arena;  /* holds what `system` points to */
  /* user value 1: what its implicit form is written from, which has to live as long: a mechanism or another system */
  ambit_system system;
} ambit_lua_system;

ambit_lua_system *ambit_lua_push_system(lua_State *L); /* empty, with its arena */
ambit_lua_system *ambit_lua_check_system(lua_State *L, int idx);
/* The same, maybe without its right-hand sides (ambit_system_rates). */
ambit_lua_system *ambit_lua_check_outline(lua_State *L, int idx);
#endif
