/* hostile.c -- a Lua module that does what a careless host program does: hostile(mode, flush) sets the rounding mode
** ("nearest", "upward", "downward", "zero") and, where there is such a thing, flush-to-zero and denormals-are-zero.
** "closing" closes every file but the three that all have, "forking" leaves a process behind that keeps them open. */
#include <fenv.h>
#include <lauxlib.h>
#include <unistd.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#define FLUSH_TO_ZERO 0x8000u
#define DENORMALS_ARE_ZERO 0x0040u

static int hostile(lua_State *L) {
  static const char *const name[] = { "nearest", "upward", "downward", "zero", "closing", "forking", NULL };
  static const int mode[] = { FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO };
  int chosen = luaL_checkoption(L, 1, NULL, name);
  if (chosen < 4) fesetround(mode[chosen]);
  for (int file = 3; chosen == 4 && file < 256; file++) close(file);
  if (chosen == 5 && fork() == 0) {
    sleep(20);
    _exit(0);
  }
#if defined(__SSE2__)
  if (lua_toboolean(L, 2)) _mm_setcsr(_mm_getcsr() | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
#endif
  return 0;
}

__attribute__((visibility("default"))) int luaopen_hostile(lua_State *L); /* found by its name */

int luaopen_hostile(lua_State *L) {
  lua_pushcfunction(L, hostile);
  return 1;
}
