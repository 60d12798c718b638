/* error.c -- failures as Lua errors that name the script's own line. */
#include "script/core.h"
#include "script/embedded.h"
#include <stdio.h>
#include <string.h>

/* Ambit's own chunks are named "=(ambit) ..."; the user's line is the nearest one that is neither those nor C. */
void ambit_lua_where(lua_State *L) {
  lua_Debug frame;
  for (int level = 0; lua_getstack(L, level, &frame); level++) {
    lua_getinfo(L, "Sl", &frame);
    bool own = strncmp(frame.source, AMBIT_CHUNK_PREFIX, sizeof AMBIT_CHUNK_PREFIX - 1) == 0;
    if (frame.currentline > 0 && !own) {
      lua_pushfstring(L, "%s:%d: ", frame.short_src, frame.currentline);
      return;
    }
  }
  lua_pushliteral(L, "");
}

_Noreturn static void raise(lua_State *L, const char *message) {
  ambit_lua_where(L);
  lua_pushstring(L, message);
  lua_concat(L, 2);
  lua_error(L);
  for (;;) {}
}

_Noreturn void ambit_lua_error(lua_State *L, const char *format, ...) {
  char message[AMBIT_MESSAGE_MAX];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  raise(L, message);
}

/* A scene that catches the error ends with exit code 1 all the same. */
static void note_broken(lua_State *L, const ambit_failure *f) {
  if (f->status != AMBIT_BROKEN) return;
  luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
  if (lua_getfield(L, -1, "ambit.session") == LUA_TTABLE) {
    lua_pushstring(L, f->code[0] ? f->code : ambit_code_of(f->status));
    lua_setfield(L, -2, "worst");
  }
  lua_pop(L, 2);
}

_Noreturn void ambit_lua_raise(lua_State *L, const ambit_failure *f) {
  char message[AMBIT_MESSAGE_MAX]; /* a copy: the failure may live in something that Lua frees */
  snprintf(message, sizeof message, "%s", f->message[0] ? f->message : ambit_status_name(f->status));
  note_broken(L, f);
  raise(L, message);
}
