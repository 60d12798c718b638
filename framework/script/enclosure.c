/* enclosure.c -- enclosures as Lua values: bounds, width, text rounded outward, certain comparisons. */
#include "script/core.h"
#include "verbs/sample/sampled_lua.h"
#include "num/decimal.h"
#include <string.h>

static const ambit_lua_enclosure *self(lua_State *L) {
  const ambit_lua_enclosure *x = luaL_testudata(L, 1, AMBIT_TYPE_ENCLOSURE);
  if (!x)
    ambit_lua_error(L, "expected an enclosure in front of the colon, as in x:width(), got %s", luaL_typename(L, 1));
  return x;
}

static int width(lua_State *L) { return lua_pushnumber(L, ambit_interval_width(self(L)->x)), 1; }
static int rad(lua_State *L) { return lua_pushnumber(L, ambit_interval_rad(self(L)->x)), 1; }
static int mag(lua_State *L) { return lua_pushnumber(L, ambit_interval_mag(self(L)->x)), 1; }
static int mig(lua_State *L) { return lua_pushnumber(L, ambit_interval_mig(self(L)->x)), 1; }
static int is_empty(lua_State *L) { return lua_pushboolean(L, ambit_interval_is_empty(self(L)->x)), 1; }
static int is_bounded(lua_State *L) { return lua_pushboolean(L, ambit_interval_is_bounded(self(L)->x)), 1; }

static int mid(lua_State *L) {
  const ambit_lua_enclosure *x = self(L);
  if (ambit_interval_is_empty(x->x)) ambit_lua_error(L, "mid: the enclosure is empty");
  lua_pushnumber(L, ambit_interval_mid(x->x));
  return 1;
}

/* x:contains(y): is every value of y inside? Proved: y's own enclosure is used. */
static int contains(lua_State *L) {
  ambit_interval x = self(L)->x, y = ambit_lua_to_enclosure(L, 2, "contains").x;
  lua_pushboolean(L, ambit_interval_is_empty(y) || (x.lo <= y.lo && y.hi <= x.hi));
  return 1;
}

static int hull(lua_State *L) {
  ambit_lua_enclosure r = *self(L);
  for (int i = 2; i <= lua_gettop(L); i++) {
    ambit_lua_enclosure y = ambit_lua_to_enclosure(L, i, "hull");
    r.x = ambit_interval_hull(r.x, y.x);
    r.flags |= y.flags;
  }
  ambit_lua_push_enclosure(L, r.x, r.flags);
  return 1;
}

static int intersect(lua_State *L) {
  ambit_lua_enclosure x = *self(L), y = ambit_lua_to_enclosure(L, 2, "intersect");
  ambit_lua_push_enclosure(L, ambit_interval_intersect(x.x, y.x), x.flags | y.flags);
  return 1;
}

/* text(x [, digits of the width]) */
static int text(lua_State *L) {
  const ambit_lua_enclosure *x = self(L);
  lua_Integer digits = lua_isnumber(L, 2) ? lua_tointeger(L, 2) : 3;
  char out[AMBIT_SAMPLED_MAX];
  if (digits < 1 || digits > 17) ambit_lua_error(L, "text: expected 1 to 17 digits");
  int length = x->flags & AMBIT_LUA_SAMPLED
                   ? ambit_lua_sampled_text((const ambit_lua_sampled *)(const void *)x, (int)digits, out)
                   : ambit_decimal_interval(out, x->x, (int)digits);
  lua_pushlstring(L, out, (size_t)length);
  if (!(x->flags & AMBIT_F_PARTIAL) || ambit_interval_is_empty(x->x)) return 1;
  lua_pushliteral(L, " (partial: undefined for part of the data)");
  lua_concat(L, 2);
  return 1;
}

static int to_string(lua_State *L) {
  lua_settop(L, 1);
  return text(L);
}

/* a == b: the same set */
static int equal(lua_State *L) {
  const ambit_lua_enclosure *a = luaL_testudata(L, 1, AMBIT_TYPE_ENCLOSURE),
                            *b = luaL_testudata(L, 2, AMBIT_TYPE_ENCLOSURE);
  if (!a || !b) ambit_lua_refuse_equality(L); /* an enclosure and an expression */
  lua_pushboolean(L, a && b && a->x.lo == b->x.lo && a->x.hi == b->x.hi);
  return 1;
}

/* a < b: certainly, for every value of a and every value of b */
static int less(lua_State *L) {
  ambit_interval a = ambit_lua_to_enclosure(L, 1, "<").x, b = ambit_lua_to_enclosure(L, 2, "<").x;
  lua_pushboolean(L, ambit_interval_is_empty(a) || ambit_interval_is_empty(b) || a.hi < b.lo);
  return 1;
}

static int less_equal(lua_State *L) {
  ambit_interval a = ambit_lua_to_enclosure(L, 1, "<=").x, b = ambit_lua_to_enclosure(L, 2, "<=").x;
  lua_pushboolean(L, ambit_interval_is_empty(a) || ambit_interval_is_empty(b) || a.hi <= b.lo);
  return 1;
}

/* x.lo, x.hi, x.partial, x.error (nil unless it was sampled); everything else is a method (own value 1) */
static int get_field(lua_State *L) {
  const ambit_lua_enclosure *x = self(L);
  const char *key = luaL_checkstring(L, 2);
  if (strcmp(key, "lo") == 0) return lua_pushnumber(L, x->x.lo), 1;
  if (strcmp(key, "hi") == 0) return lua_pushnumber(L, x->x.hi), 1;
  if (strcmp(key, "partial") == 0) return lua_pushboolean(L, (x->flags & AMBIT_F_PARTIAL) != 0), 1;
  if (strcmp(key, "error") == 0) {
    if (!(x->flags & AMBIT_LUA_SAMPLED)) return 0;
    return lua_pushnumber(L, ((const ambit_lua_sampled *)(const void *)x)->error), 1;
  }
  lua_pushvalue(L, 2);
  if (lua_rawget(L, AMBIT_LUA_OWN(1)) != LUA_TNIL) return 1;
  ambit_lua_error(L,
      "an enclosure has no `%s` (it has lo, hi, partial, width(), mid(), rad(), mag(), mig(), contains(x), "
      "hull(x), intersect(x), text(digits), is_empty(), is_bounded())",
      key);
}

/* enclosure(lo, hi): for results; no check but canonical form */
static int enclosure(lua_State *L) {
  ambit_lua_push_enclosure(L, ambit_interval_of(luaL_checknumber(L, 1), luaL_checknumber(L, 2)), 0);
  return 1;
}

void ambit_lua_open_enclosure(lua_State *L, ambit_lua *core) {
  static const luaL_Reg meta[] = { { "__tostring", to_string }, { "__eq", equal }, { "__lt", less },
    { "__le", less_equal }, { NULL, NULL } };
  static const luaL_Reg methods[] = { { "width", width }, { "mid", mid }, { "rad", rad }, { "mag", mag },
    { "mig", mig }, { "contains", contains }, { "hull", hull }, { "intersect", intersect }, { "text", text },
    { "is_empty", is_empty }, { "is_bounded", is_bounded }, { NULL, NULL } };
  static const luaL_Reg functions[] = { { "enclosure", enclosure }, { NULL, NULL } };
  static const char *const operators[][2] = { { "__add", "add" }, { "__sub", "sub" }, { "__mul", "mul" },
    { "__div", "div" }, { "__unm", "neg" }, { "__pow", "pow" } };
  ambit_lua_set_functions(L, core, functions);
  ambit_lua_new_type(L, core, AMBIT_TYPE_ENCLOSURE, meta);
  for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
    lua_getfield(L, -2, operators[i][1]);
    lua_setfield(L, -2, operators[i][0]);
  }
  lua_newtable(L);
  ambit_lua_set_functions(L, core, methods);
  ambit_lua_push_function(L, core, get_field, 1);
  lua_setfield(L, -2, "__index");
  lua_pop(L, 1);
}
