/* process.c -- what Lua's own libraries do not say: loaded libraries, CPU time, terminals, where the script stands. */
#include "script/core.h"
#include "script/interrupt.h"
#include "script/leave.h"
#include "script/limit.h"
#include "num/decimal.h"
#include <link.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#ifndef AMBIT_VERSION
#error "AMBIT_VERSION comes from the build"
#endif

typedef struct collection {
  size_t count, room;
  const char **name; /* NULL: only count */
} collection;

static int collect(struct dl_phdr_info *info, size_t size, void *user) {
  collection *c = user;
  (void)size;
  if (!info->dlpi_name || !info->dlpi_name[0]) return 0;
  if (c->count < c->room) c->name[c->count] = info->dlpi_name;
  c->count++;
  return 0;
}

/* libraries() -> {file, ...}: every shared object in this process, as the dynamic loader lists them */
static int libraries(lua_State *L) {
  collection c = { 0 };
  dl_iterate_phdr(collect, &c);
  c.name = lua_newuserdatauv(L, (c.count + 1) * sizeof *c.name, 0);
  c.room = c.count;
  c.count = 0;
  dl_iterate_phdr(collect, &c);
  lua_createtable(L, (int)c.room, 0);
  for (size_t i = 0; i < c.count && i < c.room; i++) {
    lua_pushstring(L, c.name[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

/* deadline(t) -> the last one: runs that begin from now on are stopped when cpu() is t; nil: never */
static int deadline(lua_State *L) {
  double last = AMBIT_LUA(L)->deadline;
  AMBIT_LUA(L)->deadline = luaL_optnumber(L, 1, 0);
  if (!(last > 0)) return 0;
  lua_pushnumber(L, last);
  return 1;
}

/* cpu() -> s of CPU time of this process */
static int cpu(lua_State *L) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  lua_pushnumber(L, (double)t.tv_sec + 1e-9 * (double)t.tv_nsec);
  return 1;
}

/* terminal("stdin" | "stdout" | "stderr") */
static int terminal(lua_State *L) {
  static const char *const name[] = { "stdin", "stdout", "stderr", NULL };
  lua_pushboolean(L, isatty(luaL_checkoption(L, 1, NULL, name)));
  return 1;
}

/* where() -> "scene.lua:12: " or "" */
static int where(lua_State *L) {
  ambit_lua_where(L);
  return 1;
}

/* fail(message): a Lua error at the script's own line */
static int fail(lua_State *L) { ambit_lua_error(L, "%s", luaL_checkstring(L, 1)); }

/* codes() -> {{code, meaning, advice}, ...}: of <ambit/code.h> */
static int codes(lua_State *L) {
  size_t n;
  const ambit_code *table = ambit_code_table(&n);
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    lua_createtable(L, 0, 3);
    lua_pushstring(L, table[i].code);
    lua_setfield(L, -2, "code");
    lua_pushstring(L, table[i].meaning);
    lua_setfield(L, -2, "meaning");
    lua_pushstring(L, table[i].advice);
    lua_setfield(L, -2, "advice");
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 1;
}

/* progress(on) */
static int progress(lua_State *L) {
  AMBIT_LUA(L)->progress = lua_toboolean(L, 1);
  return 0;
}

static void print_note(void *user, const char *line) {
  (void)user;
  fprintf(stderr, "note: %s\n", line);
}

/* notes(on): what plugins have to say goes to stderr, or nowhere */
static int notes(lua_State *L) {
  ambit_registry_set_note(AMBIT_LUA(L)->registry, lua_toboolean(L, 1) ? print_note : NULL, NULL);
  return 0;
}

/* interrupted() -> was there a signal, or was a limit reached?, the exit code that it gives, the code; the sentence if
** it was a limit */
static int interrupted(lua_State *L) {
  const char *code = AMBIT_CODE_STOPPED_REQUEST, *sentence;
  bool limit = ambit_limit_reached(&code, &sentence);
  lua_pushboolean(L, ambit_interrupt_seen());
  lua_pushinteger(L, ambit_interrupt_code());
  lua_pushstring(L, code);
  if (limit) lua_pushstring(L, sentence);
  return 3 + limit;
}

/* limit("time" | "memory" | "output", most, "10 s") -> nil, or what stands in the way */
static int limit(lua_State *L) {
  static const char *const name[] = { "time", "memory", "output", NULL };
  ambit_limit which = (ambit_limit)luaL_checkoption(L, 1, NULL, name);
  lua_pushstring(L, ambit_limit_begin(L, which, luaL_checknumber(L, 2), luaL_checkstring(L, 3)));
  return 1;
}

/* blame_memory(): an allocation has failed */
static int blame_memory(lua_State *L) {
  (void)L;
  ambit_limit_blame_memory();
  return 0;
}

/* leave(code): ends the process as the command does */
static int leave(lua_State *L) {
  int code = ambit_leave((int)luaL_checkinteger(L, 1)), signal = ambit_interrupt_code();
  exit(signal ? signal : code);
}

/* leave_with(code): the exit code of the process, although the command has returned another one */
static int leave_with(lua_State *L) {
  ambit_leave_with((int)luaL_checkinteger(L, 1));
  return 0;
}

/* flush() -> whether all that was printed could be written */
static int flush(lua_State *L) {
  lua_pushboolean(L, ambit_leave_flush());
  return 1;
}

/* literal(x) -> the shortest text that reads back as x */
static int literal(lua_State *L) {
  char text[AMBIT_DECIMAL_MAX];
  lua_pushlstring(L, text, (size_t)ambit_decimal_shortest(text, luaL_checknumber(L, 1)));
  return 1;
}

/* settle(): at the start of the next function of the core, all that nothing holds is freed */
static int settle(lua_State *L) {
  ambit_graph_hasten(AMBIT_LUA(L)->graph);
  return 0;
}

/* heap() -> bytes in use, Lua's among them (nil: nobody counts them), nodes of the graph */
static int heap(lua_State *L) {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  struct mallinfo2 m = mallinfo2();
  if (m.uordblks + m.hblkhd > 0) /* sanitizers have a heap of their own */
    lua_pushinteger(L, (lua_Integer)m.uordblks + (lua_Integer)m.hblkhd);
  else
    lua_pushnil(L);
#else
  lua_pushnil(L);
#endif
  lua_pushinteger(L, ambit_graph_living(AMBIT_LUA(L)->graph));
  return 2;
}

void ambit_lua_open_process(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "libraries", libraries }, { "cpu", cpu }, { "deadline", deadline },
    { "terminal", terminal }, { "where", where }, { "fail", fail }, { "progress", progress }, { "notes", notes },
    { "interrupted", interrupted }, { "literal", literal }, { "codes", codes }, { "leave", leave },
    { "leave_with", leave_with }, { "flush", flush }, { "limit", limit }, { "blame_memory", blame_memory },
    { "settle", settle }, { "heap", heap }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
  lua_pushliteral(L, AMBIT_VERSION);
  lua_setfield(L, -2, "version");
}
