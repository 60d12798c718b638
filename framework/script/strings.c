/* strings.c -- methods of strings, a scene's and Ambit's own.
**
** Lua finds them in one place for all, `__index` of the metatable of strings. What stands there looks who asks: Ambit's
** modules get a copy of `string` from when Ambit was loaded, others what a scene or host has put there. For these
** getmetatable("") is a stand-in, which they read and write like the metatable itself; its `__index` is theirs only.
*/
#include "script/strings.h"
#include "script/core.h"
#include "script/embedded.h"
#include <stdbool.h>
#include <string.h>

enum { METATABLE = 1, METHODS = 2 }; /* upvalues of the stand-in's functions; METHODS: find_method */
enum { OWN = 1, OTHERS = 2 };        /* upvalues of find_method */

/* Is the function that asked for a method one of Ambit's modules? */
static bool is_own_caller(lua_State *L) {
  lua_Debug ar;
  if (!lua_getstack(L, 1, &ar) || !lua_getinfo(L, "S", &ar)) return false;
  return strncmp(ar.source, AMBIT_CHUNK_PREFIX, sizeof AMBIT_CHUNK_PREFIX - 1) == 0;
}

static int find_method(lua_State *L) {
  lua_settop(L, 2);
  if (is_own_caller(L)) {
    lua_rawget(L, lua_upvalueindex(OWN));
    return 1;
  }
  if (lua_isnil(L, lua_upvalueindex(OTHERS))) return luaL_error(L, "attempt to index a string value");
  if (lua_isfunction(L, lua_upvalueindex(OTHERS))) {
    lua_pushvalue(L, lua_upvalueindex(OTHERS));
    lua_insert(L, 1);
    lua_call(L, 2, 1);
  } else {
    lua_gettable(L, lua_upvalueindex(OTHERS));
  }
  return 1;
}

/* -- the stand-in */

static bool is_key(lua_State *L, int idx, const char *key) {
  return lua_type(L, idx) == LUA_TSTRING && strcmp(lua_tostring(L, idx), key) == 0;
}

static int read_entry(lua_State *L) {
  if (is_key(L, 2, "__index")) {
    lua_getupvalue(L, lua_upvalueindex(METHODS), OTHERS);
  } else if (is_key(L, 2, "__metatable")) {
    lua_pushnil(L);
  } else {
    lua_settop(L, 2);
    lua_rawget(L, lua_upvalueindex(METATABLE));
  }
  return 1;
}

static int write_entry(lua_State *L) {
  lua_settop(L, 3);
  if (is_key(L, 2, "__index"))
    lua_setupvalue(L, lua_upvalueindex(METHODS), OTHERS);
  else
    lua_rawset(L, lua_upvalueindex(METATABLE));
  return 0;
}

static int next_entry(lua_State *L) {
  lua_settop(L, 2);
  if (lua_next(L, 1)) return 2;
  lua_pushnil(L);
  return 1;
}

static int list_entries(lua_State *L) {
  lua_pushcfunction(L, next_entry);
  lua_newtable(L);
  for (lua_pushnil(L); lua_next(L, lua_upvalueindex(METATABLE));) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, -4);
  }
  lua_pushnil(L);
  lua_setfield(L, -2, "__metatable");
  lua_getupvalue(L, lua_upvalueindex(METHODS), OTHERS);
  lua_setfield(L, -2, "__index");
  return 2;
}

/* Pushes it; the metatable and find_method are on top of the stack. */
static void push_stand_in(lua_State *L) {
  static const luaL_Reg functions[] = { { "__index", read_entry }, { "__newindex", write_entry },
    { "__pairs", list_entries }, { NULL, NULL } };
  lua_newtable(L);
  lua_newtable(L);
  lua_pushvalue(L, -4);
  lua_pushvalue(L, -4);
  luaL_setfuncs(L, functions, 2);
  lua_setmetatable(L, -2);
}

void ambit_strings_keep(lua_State *L) {
  int own = lua_gettop(L);
  lua_pushliteral(L, "");
  if (lua_getmetatable(L, -1) && lua_getfield(L, -1, "__index") != LUA_TNIL) {
    lua_pushvalue(L, own);
    lua_insert(L, -2);
    lua_pushcclosure(L, find_method, 2);
    if (lua_getfield(L, -2, "__metatable") == LUA_TNIL) {
      lua_pop(L, 1);
      push_stand_in(L);
      lua_setfield(L, -3, "__metatable");
    } else {
      lua_pop(L, 1);
    }
    lua_setfield(L, -2, "__index");
  }
  lua_settop(L, own);
}
