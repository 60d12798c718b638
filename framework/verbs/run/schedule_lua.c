/* schedule_lua.c -- the samples of a run as a Lua value: which ones are before an instant. */
#include "models/system_lua.h"
#include "verbs/run/schedule.h"
#include <string.h>

typedef struct lua_schedule {
  ambit_arena *arena;
  ambit_schedule own;
} lua_schedule;

/* schedule(system, start, end [, final]): final: the true end, an expression */
static int schedule(lua_State *L) {
  const ambit_lua_system *system = ambit_lua_check_outline(L, 1);
  double start = luaL_checknumber(L, 2), end = luaL_checknumber(L, 3);
  bool has_final = !lua_isnoneornil(L, 4);
  ambit_expr final = has_final ? ambit_lua_to_expression(L, 4, NULL, "schedule: final").e : AMBIT_NO_EXPR;
  ambit_failure f = { 0 };
  lua_schedule *s = lua_newuserdatauv(L, sizeof *s, 1);
  memset(s, 0, sizeof *s);
  luaL_setmetatable(L, AMBIT_TYPE_SCHEDULE);
  lua_pushvalue(L, 1); /* lives as long */
  lua_setiuservalue(L, -2, 1);
  s->arena = ambit_arena_open();
  if (!s->arena) ambit_lua_error(L, "out of memory");
  ambit_status status = ambit_schedule_build(
      &system->system, AMBIT_LUA(L)->registry, start, end, has_final ? &final : NULL, s->arena, &s->own, &f);
  if (status != AMBIT_OK) ambit_lua_raise(L, &f);
  return 1;
}

/* schedule_around(schedule, t) -> the doubles of the last sample before t and of the next one, or nil */
static int schedule_around(lua_State *L) {
  const lua_schedule *s = luaL_checkudata(L, 1, AMBIT_TYPE_SCHEDULE);
  ambit_expr t = ambit_lua_to_expression(L, 2, NULL, "schedule_around: t").e;
  uint32_t n = 0;
  ambit_failure f = { 0 };
  if (ambit_schedule_before(&s->own, t, &n, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  lua_settop(L, 1);
  if (n > 0) lua_pushnumber(L, s->own.time[n - 1]);
  if (n == 0) lua_pushnil(L);
  if (n < s->own.n) lua_pushnumber(L, s->own.time[n]);
  if (n == s->own.n) lua_pushnil(L);
  return 2;
}

static int close(lua_State *L) {
  lua_schedule *s = luaL_checkudata(L, 1, AMBIT_TYPE_SCHEDULE);
  ambit_arena_close(s->arena);
  s->arena = NULL;
  return ambit_lua_retire(L);
}

void ambit_lua_open_schedule(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "schedule", schedule }, { "schedule_around", schedule_around },
    { NULL, NULL } };
  static const luaL_Reg meta[] = { { "__gc", close }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
  ambit_lua_new_type(L, core, AMBIT_TYPE_SCHEDULE, meta);
  lua_pop(L, 1);
}
