/* main.c -- the command `ambit`: a Lua state with the module preloaded; what the words on the command line mean is
** scripts/command. */
#include "lua/core.h"
#include "lua/interrupt.h"
#include <fenv.h>
#include <lualib.h>
#include <stdio.h>
#include <stdlib.h>

#define EXIT_INTERRUPTED 130
#define STACK_BYTES ((size_t)1 << 20)

static int add_traceback(lua_State *L) {
  const char *message = lua_tostring(L, 1);
  luaL_traceback(L, L, message ? message : luaL_tolstring(L, 1, NULL), 1);
  return 1;
}

/* Chains of elements are nested calls (framework/mechanism/pull.c bounds how many). Under a limit of memory the stack
** must have its room before the heap has taken all; a page that was touched stays.
*/
__attribute__((noinline)) static void reserve_stack(void) {
  volatile char room[STACK_BYTES];
  for (size_t i = 0; i < sizeof room; i += 4096) room[i] = 0;
}

/* Protected: everything that may raise. Leaves the exit code. */
static int command(lua_State *L) {
  char **argument = lua_touserdata(L, 1);
  luaL_openlibs(L);
  luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
  lua_pushcfunction(L, luaopen_ambit);
  lua_setfield(L, -2, "ambit");
  lua_pop(L, 1);
  lua_getglobal(L, "require");
  lua_pushliteral(L, "ambit");
  lua_call(L, 1, 0);
  lua_getglobal(L, "require");
  lua_pushliteral(L, "ambit.command.main");
  lua_call(L, 1, 1);
  lua_newtable(L);
  for (lua_Integer i = 0; argument[i]; i++) {
    lua_pushstring(L, argument[i]);
    lua_rawseti(L, -2, i);
  }
  lua_call(L, 1, 1);
  return 1;
}

int main(int argc, char **argv) {
  fesetenv(FE_DFL_ENV); /* a library that was loaded before may have set flush-to-zero */
  reserve_stack();
  lua_State *L = luaL_newstate();
  if (!L || argc < 1) {
    fprintf(stderr, "ambit: out of memory\n");
    return EXIT_FAILURE;
  }
  ambit_interrupt_watch(L);
  lua_pushcfunction(L, add_traceback);
  lua_pushcfunction(L, command);
  lua_pushlightuserdata(L, argv);
  int code = EXIT_FAILURE;
  if (lua_pcall(L, 1, 1, 1) == LUA_OK)
    code = (int)lua_tointeger(L, -1);
  else
    fprintf(stderr, "ambit: %s\n", lua_tostring(L, -1));
  lua_close(L);
  if (fflush(stdout) != 0 || ferror(stdout)) { /* the last flush, or one before it */
    fprintf(stderr, "ambit: not everything could be written to standard output\n");
    if (code == EXIT_SUCCESS) code = EXIT_FAILURE;
  }
  return ambit_interrupt_seen() ? EXIT_INTERRUPTED : code;
}
