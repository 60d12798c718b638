/* embedded.c -- the Lua half of Ambit becomes loadable as ambit.*, in an environment of its own.
**
** A scene may redefine globals and what libraries hold (`type = 3`, `table.concat = nil`). Ambit's own modules see a
** copy from when Ambit was loaded; _G in it is the true one. So do methods of strings (strings.c). Modules are made
** once and get each other, whatever a scene makes of package.loaded.
*/
#include "script/embedded.h"
#include "script/core.h"
#include "script/strings.h"
#include "num/environment.h"
#include <stdbool.h>
#include <string.h>

static const char environment_key = 0; /* its address is the key in the Lua registry */

/* Pushes a copy of the table at idx. */
static void push_copy(lua_State *L, int idx) {
  idx = lua_absindex(L, idx);
  lua_newtable(L);
  for (lua_pushnil(L); lua_next(L, idx);) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, -4);
  }
}

/* -- numbers as text */

/* A library function that writes numbers, upvalue 1, with a decimal point and rounded to nearest, whatever locale and
** mode the scene or host has set: what Ambit writes is read again, as a literal, CSV or source. */
static int call_in_environment(lua_State *L) {
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  ambit_environment old = ambit_environment_enter();
  int status = lua_pcall(L, lua_gettop(L) - 1, LUA_MULTRET, 0);
  ambit_environment_leave(old);
  return status == LUA_OK ? lua_gettop(L) : lua_error(L);
}

/* In the table on top of the stack. */
static void write_plainly(lua_State *L, const char *name) {
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, call_in_environment, 1);
  lua_setfield(L, -2, name);
}

/* -- modules */

static int require_own(lua_State *L);

/* Pushes the environment; the first time that is the globals, and copies of the libraries in them. */
static void push_environment(lua_State *L) {
  static const char *const libraries[] = { "coroutine", "debug", "io", "math", "os", "string", "table", "utf8" };
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &environment_key) == LUA_TTABLE) return;
  lua_pop(L, 1);
  lua_pushglobaltable(L);
  push_copy(L, -1);
  lua_remove(L, -2);
  for (size_t i = 0; i < sizeof libraries / sizeof *libraries; i++) {
    if (lua_getfield(L, -1, libraries[i]) == LUA_TTABLE) {
      push_copy(L, -1);
      lua_setfield(L, -3, libraries[i]);
    }
    lua_pop(L, 1);
  }
  lua_getfield(L, -1, "require");
  lua_pushcclosure(L, require_own, 1);
  lua_setfield(L, -2, "require");
  write_plainly(L, "tostring");
  lua_getfield(L, -1, "string");
  write_plainly(L, "format");
  ambit_strings_keep(L);
  lua_pop(L, 1);
  lua_pushvalue(L, -1);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &environment_key);
}

static const ambit_embedded *find_file(const char *name) {
  for (const ambit_embedded *file = ambit_embedded_files; file->name; file++)
    if (strcmp(file->name, name) == 0) return file;
  return NULL;
}

/* Pushes the module called `name`, which is one of Ambit's own: made once in a Lua state, so that a scene that clears
** package.loaded (to read its own modules anew) does not get a second session, which would know nothing of what the
** first could not prove. */
static void push_module(lua_State *L, const char *name) {
  const ambit_embedded *file = find_file(name);
  luaL_getsubtable(L, LUA_REGISTRYINDEX, "ambit.modules");
  if (lua_getfield(L, -1, name) == LUA_TNIL) {
    lua_pop(L, 1);
    if (!file) {
      lua_pushcfunction(L, luaopen_ambit_core);
    } else {
      if (luaL_loadbufferx(L, file->text, file->size, file->chunk, "t") != LUA_OK) lua_error(L);
      push_environment(L);
      if (!lua_setupvalue(L, -2, 1)) lua_pop(L, 1); /* _ENV; a file without globals has none */
    }
    lua_pushstring(L, name);
    lua_call(L, 1, 1);
    lua_pushvalue(L, -1);
    lua_setfield(L, -3, name);
  }
  lua_remove(L, -2);
}

static bool is_own(const char *name) { return strcmp(name, "ambit.core") == 0 || find_file(name); }

/* in package.preload: what a scene's `require` calls */
static int load_module(lua_State *L) {
  push_module(L, luaL_checkstring(L, 1));
  return 1;
}

/* `require` of Ambit's modules: they get each other whatever stands in package.loaded and package.preload. */
static int require_own(lua_State *L) {
  const char *name = luaL_checkstring(L, 1);
  if (!is_own(name)) {
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
  }
  push_module(L, name);
  luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
  lua_pushvalue(L, -2);
  lua_setfield(L, -2, name);
  lua_pop(L, 1);
  return 1;
}

/* `require "ambit"`: the embedded files become loadable, then init.lua makes the module. */
int luaopen_ambit(lua_State *L) {
  luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
  for (const ambit_embedded *file = ambit_embedded_files; file->name; file++) {
    lua_pushcfunction(L, load_module);
    lua_setfield(L, -2, file->name);
  }
  lua_pushcfunction(L, load_module);
  lua_setfield(L, -2, "ambit.core");
  lua_pop(L, 1);
  push_environment(L);
  lua_getfield(L, -1, "require");
  lua_pushliteral(L, "ambit.init");
  lua_call(L, 1, 1);
  return 1;
}
