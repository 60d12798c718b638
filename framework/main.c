/* main.c -- the command `ambit`: a Lua state with the module preloaded; what the words on the command line mean is
** scripts/command. */
#include "script/core.h"
#include "script/interrupt.h"
#include "script/leave.h"
#include "script/limit.h"
#include <fenv.h>
#include <lualib.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#define STACK_BYTES ((size_t)1 << 20) /* that are touched at the start where memory is limited */
#define STACK_LEAST (4 * STACK_BYTES) /* that there must be */
#define STACK_USUAL ((size_t)8 * STACK_BYTES)

static int add_traceback(lua_State *L) {
  const char *message = lua_tostring(L, 1);
  luaL_traceback(L, L, message ? message : luaL_tolstring(L, 1, NULL), 1);
  return 1;
}

/* Touches pages of the stack: they stay. */
__attribute__((noinline)) static void touch_stack(void) {
  volatile char room[STACK_BYTES];
  for (size_t i = 0; i < sizeof room; i += 4096) room[i] = 0;
}

/* Chains of elements are nested calls (framework/mechanics/pull.c bounds how many). Under a limit of memory the stack
** must have its room before the heap has taken all.
*/
static void reserve_stack(void) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) touch_stack();
}

/* Raises a low limit as far as it may be raised. False: too low. */
static bool has_stack(size_t *bytes) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return true;
  if (limit.rlim_cur < STACK_USUAL && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = limit.rlim_max < STACK_USUAL ? limit.rlim_max : STACK_USUAL;
    setrlimit(RLIMIT_STACK, &limit);
    getrlimit(RLIMIT_STACK, &limit);
  }
  *bytes = (size_t)limit.rlim_cur;
  return limit.rlim_cur >= STACK_LEAST;
}

/* What the process needs before anything else; false: a sentence has been said. */
static bool prepare(void) {
  size_t stack = 0;
  fesetenv(FE_DFL_ENV);     /* a library that was loaded before may have set flush-to-zero */
  signal(SIGXFSZ, SIG_IGN); /* a file that may grow no more is then an error of write() */
  if (!ambit_leave_reserve_files()) return false;
  if (!has_stack(&stack)) {
    fprintf(stderr, "ambit: the stack may hold only %zu kB; allow at least %zu kB (ulimit -s)\n", stack >> 10,
        STACK_LEAST >> 10);
    return false;
  }
  reserve_stack();
  return ambit_leave_guard();
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
  if (!prepare()) return EXIT_FAILURE;
  lua_State *L = luaL_newstate();
  if (!L || argc < 1) {
    fprintf(stderr, "ambit: out of memory\n");
    return ambit_leave(EXIT_FAILURE);
  }
  ambit_interrupt_watch(L);
  lua_pushcfunction(L, add_traceback);
  lua_pushcfunction(L, command);
  lua_pushlightuserdata(L, argv);
  int code = EXIT_FAILURE;
  if (lua_pcall(L, 1, 1, 1) != LUA_OK) {
    if (!ambit_limit_reached(NULL, NULL)) fprintf(stderr, "ambit: %s\n", lua_tostring(L, -1));
  } else if (lua_isinteger(L, -1)) { /* nothing else is an exit code, least of all 0 */
    code = (int)lua_tointeger(L, -1);
  }
  ambit_interrupt_watch(NULL);
  lua_close(L);
  code = ambit_leave(code);
  return ambit_interrupt_seen() ? ambit_interrupt_code() : code;
}
