/* units_lua.c -- dimensions of expressions in Lua: checked at every operation, given to what has a declared unit. */
#include "script/core.h"

/* How an operation is written: "+", "max", "around". */
static void fail_pair(lua_State *L, ambit_dimension a, ambit_dimension b, const char *what) {
  char first[AMBIT_DIMENSION_TEXT_MAX], second[AMBIT_DIMENSION_TEXT_MAX];
  ambit_dimension_name(a.power, first);
  ambit_dimension_name(b.power, second);
  ambit_lua_error(L, "%s: the dimensions differ: %s and %s", what, first, second);
}

ambit_dimension ambit_lua_dimension_op(
    lua_State *L, uint32_t op, ambit_dimension a, ambit_dimension b, const char *what) {
  ambit_dimension out;
  char name[AMBIT_DIMENSION_TEXT_MAX];
  if (ambit_dimension_op(op, a, b, &out)) return out;
  if (!ambit_dimension_agree(a, b)) fail_pair(L, a, b, what);
  ambit_dimension_name(a.power, name);
  ambit_lua_error(L, "%s: expected a number or angle (rad), got %s", what, name);
}

/* unit_of(value [, soft]) -> "m/s" and "a speed (m/s)"; nothing: no unit is known. soft: also one not insisted on */
static int unit_of(lua_State *L) {
  ambit_dimension d = ambit_lua_dimension(L, 1, NULL);
  char text[AMBIT_DIMENSION_TEXT_MAX];
  bool soft = lua_toboolean(L, 2) && d.state == AMBIT_DIMENSION_SOFT;
  if (d.state != AMBIT_DIMENSION_KNOWN && !soft) return 0;
  ambit_dimension_text(d.power, text);
  lua_pushstring(L, text);
  ambit_dimension_name(d.power, text);
  lua_pushstring(L, text);
  return 2;
}

/* in_unit(expression, unit [, how]) -> the same expression, whose value is in that unit; unit nil: in an unknown one.
** how: nil: made of states or coordinates; "given": only if the expression is; true: of states, and the unit is not
** insisted on */
static int in_unit(lua_State *L) {
  const ambit_lua_expression *from = luaL_checkudata(L, 1, AMBIT_TYPE_EXPRESSION);
  ambit_unit unit;
  ambit_failure f = { 0 };
  bool has_unit = !lua_isnoneornil(L, 2), of_state = lua_type(L, 3) == LUA_TSTRING ? from->dimension.of_state : true;
  if (has_unit && ambit_unit_read(luaL_checkstring(L, 2), &unit, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  ambit_lua_expression *x = ambit_lua_push_expression(L, from->e);
  if (!has_unit) return 1;
  x->dimension = ambit_dimension_known(unit.power);
  x->dimension.of_state = of_state;
  if (lua_isboolean(L, 3) && lua_toboolean(L, 3)) x->dimension.state = AMBIT_DIMENSION_SOFT;
  return 1;
}

/* units() -> {{name, prefix = does it take SI prefixes}, ...}, {{name, power of ten}, ...}: all that texts may use */
static int units(lua_State *L) {
  bool takes;
  int decimal;
  const char *name;
  lua_newtable(L);
  for (size_t k = 0; (name = ambit_unit_name(k, &takes)) != NULL; k++) {
    lua_createtable(L, 0, 2);
    lua_pushstring(L, name);
    lua_setfield(L, -2, "name");
    lua_pushboolean(L, takes);
    lua_setfield(L, -2, "prefix");
    lua_rawseti(L, -2, (lua_Integer)k + 1);
  }
  lua_newtable(L);
  for (size_t k = 0; (name = ambit_unit_prefix(k, &decimal)) != NULL; k++) {
    lua_createtable(L, 0, 2);
    lua_pushstring(L, name);
    lua_setfield(L, -2, "name");
    lua_pushinteger(L, decimal);
    lua_setfield(L, -2, "decimal");
    lua_rawseti(L, -2, (lua_Integer)k + 1);
  }
  return 2;
}

void ambit_lua_open_units(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "unit_of", unit_of }, { "in_unit", in_unit }, { "units", units },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
