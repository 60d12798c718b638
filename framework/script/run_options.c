/* run_options.c -- checked by framework/verbs/simulate/simulate.lua and split.lua; here they only change their form. */
#include "script/run_options.h"
#include "script/request.h"
#include "script/track.h"
#include <string.h>

static uint32_t count_of(lua_State *L, int idx, const char *key) {
  lua_getfield(L, idx, key);
  lua_Integer n = lua_tointeger(L, -1);
  lua_pop(L, 1);
  return n > 0 && n < UINT32_MAX ? (uint32_t)n : 0;
}

static bool flag_of(lua_State *L, int idx, const char *key) {
  lua_getfield(L, idx, key);
  bool on = lua_toboolean(L, -1);
  lua_pop(L, 1);
  return on;
}

static void read_cuts(lua_State *L, int idx, ambit_simulate_request *q) {
  size_t n;
  if (lua_getfield(L, idx, "unknown") == LUA_TNIL) {
    lua_pop(L, 1);
    return;
  }
  n = (size_t)luaL_len(L, -1);
  int list = lua_gettop(L);
  ambit_expr *unknown = ambit_lua_to_array(L, list, n);
  lua_getfield(L, idx, "name");
  const char **name = ambit_lua_texts(L, lua_gettop(L), &n);
  lua_getfield(L, idx, "parts");
  double *parts = ambit_lua_numbers(L, lua_gettop(L), &n);
  ambit_cut *cut = lua_newuserdatauv(L, (n + 1) * sizeof *cut, 0);
  for (size_t i = 0; i < n; i++) cut[i] = (ambit_cut) { unknown[i], name[i], (uint32_t)parts[i] };
  q->ncut = n;
  q->cut = cut;
}

uint32_t ambit_lua_run_options(lua_State *L, int idx, ambit_simulate_request *q) {
  if (lua_isnoneornil(L, idx)) return 0;
  q->threads = count_of(L, idx, "threads");
  q->pieces = count_of(L, idx, "pieces");
  bool dense = flag_of(L, idx, "dense"), last = flag_of(L, idx, "last");
  if (dense) q->wish |= AMBIT_WISH_DENSE;
  read_cuts(L, idx, q);
  return (dense ? AMBIT_TRACK_DENSE : 0) | (last ? AMBIT_TRACK_LAST : 0);
}
