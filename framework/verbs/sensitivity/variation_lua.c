/* variation_lua.c -- systems with their variational equations as Lua values. */
#include "script/core.h"
#include "script/request.h"
#include "models/system_lua.h"
#include <ambit/variation.h>
#include <string.h>

/* The unit of a datum as it was written, or NULL: not known. */
static const char *datum_unit(lua_State *L, ambit_arena *arena, int idx, lua_Integer i) {
  char text[AMBIT_DIMENSION_TEXT_MAX];
  lua_rawgeti(L, idx, i);
  const ambit_lua_expression *x = luaL_checkudata(L, -1, AMBIT_TYPE_EXPRESSION);
  lua_pop(L, 1); /* the table keeps it */
  if (x->dimension.state != AMBIT_DIMENSION_KNOWN) return NULL;
  ambit_dimension_text(x->dimension.power, text);
  const char *unit = ambit_arena_text(arena, text);
  if (!unit) ambit_lua_error(L, "out of memory");
  return unit;
}

/* {name}, {number of the state, or 0}, {datum} at 3..5 */
static ambit_variation_by *quantities(lua_State *L, const ambit_system *s, ambit_arena *arena, size_t *n) {
  const char **name = ambit_lua_texts(L, 3, n);
  const double *state = ambit_lua_numbers(L, 4, n);
  const ambit_expr *datum = ambit_lua_to_array(L, 5, *n);
  ambit_variation_by *by = ambit_arena_alloc(arena, (*n + 1) * sizeof *by);
  if (!by) ambit_lua_error(L, "out of memory");
  for (size_t j = 0; j < *n; j++) {
    bool is_state = state[j] >= 1 && state[j] <= (double)s->nx;
    by[j] = (ambit_variation_by) {
      .name = ambit_arena_text(arena, name[j]), .datum = datum[j], .initial_of = AMBIT_VARIATION_ZERO
    };
    if (is_state) by[j].initial_of = (uint32_t)state[j] - 1;
    by[j].unit = is_state ? s->unit[by[j].initial_of] : datum_unit(L, arena, 5, (lua_Integer)j + 1);
  }
  return by;
}

/* variation(system, {initial}, {name}, {number of the state whose initial value it is, or 0}, {datum}) -> system,
** {initial}, {number of the state d x_i/d q_j by rows, or 0: identically zero} */
static int variation(lua_State *L) {
  const ambit_system *s = &ambit_lua_check_outline(L, 1)->system;
  ambit_variation_request q = { .system = s, .initial = ambit_lua_to_array(L, 2, s->nx) };
  ambit_lua_system *out = ambit_lua_push_system(L);
  int at = lua_gettop(L);
  q.by = quantities(L, s, out->arena, &q.nby);
  ambit_variation *v = ambit_arena_alloc(out->arena, sizeof *v);
  if (!v) ambit_lua_error(L, "out of memory");
  ambit_failure f = { 0 };
  if (ambit_variation_build(&q, out->arena, v, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  out->system = v->system;
  lua_pushvalue(L, 1); /* formulas for right-hand sides may be made of it later */
  lua_setiuservalue(L, at, 1);
  lua_pushvalue(L, at);
  ambit_lua_push_expressions(L, v->system.nx, v->initial);
  lua_createtable(L, (int)(s->nx * q.nby), 0);
  for (size_t i = 0; i < s->nx * q.nby; i++) {
    lua_pushinteger(L, v->place[i] == AMBIT_VARIATION_ZERO ? 0 : (lua_Integer)v->place[i] + 1);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
  return 3;
}

void ambit_lua_open_variation(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "variation", variation }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
