/* text.c -- arithmetic on texts: "1" / "3" is a third, not the double next to it.
**
** Lua turns texts into numbers by metamethods of strings, which may be replaced. The command replaces them by Ambit's
** operators: what they make of texts are expressions. A host's Lua state keeps Lua's results (`require "ambit"` alone
** must not change a program); but where one is not exactly what the texts say, this is remembered, and from then on
** numbers of the host that may be such results are refused (value.c) until the host has said by text_arithmetic which
** arithmetic it means: those with a point, and whole ones too once one of them has wrapped around. Proof that nothing
** else is refused or let through: docs/soundness.md.
*/
#include "script/core.h"
#include "num/decimal.h"
#include "num/interval.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

static const char originals_key = 0; /* its address is the key of Lua's own metamethods in the Lua registry */

static const struct {
  const char *event;
  int lua_op, arity;
} operators[] = { { "__add", LUA_OPADD, 2 }, { "__sub", LUA_OPSUB, 2 }, { "__mul", LUA_OPMUL, 2 },
  { "__div", LUA_OPDIV, 2 }, { "__pow", LUA_OPPOW, 2 }, { "__unm", LUA_OPUNM, 1 }, { "__mod", LUA_OPMOD, 2 },
  { "__idiv", LUA_OPIDIV, 2 } };
#define OPERATORS (int)(sizeof operators / sizeof *operators)

static bool is_plain(lua_State *L, int idx) {
  return lua_type(L, idx) == LUA_TNUMBER || lua_type(L, idx) == LUA_TSTRING;
}

/* One operand is no number and no text: the operator is its own, as in Lua. */
static int by_the_other(lua_State *L, const char *event) {
  int idx = lua_type(L, 1) == LUA_TSTRING ? 2 : 1;
  if (!luaL_getmetafield(L, idx, event))
    ambit_lua_error(L, "attempt to perform arithmetic on a %s value", luaL_typename(L, idx));
  lua_insert(L, 1);
  lua_call(L, 2, 1);
  return 1;
}

/* -- Ambit's */

/* Number k of the operators; upvalue 2: that of expressions, or nil. Lua calls __unm with its operand twice. */
static int operate(lua_State *L) {
  int k = (int)lua_tointeger(L, AMBIT_LUA_OWN(1));
  lua_settop(L, 2);
  if (!is_plain(L, 1) || !is_plain(L, 2)) return by_the_other(L, operators[k].event);
  if (lua_isnil(L, AMBIT_LUA_OWN(2)))
    ambit_lua_error(L, "texts have no `%s`: it would be calculated with rounded numbers; say so by tonumber(...)",
        operators[k].lua_op == LUA_OPMOD ? "%" : "//");
  lua_settop(L, operators[k].arity);
  for (int i = 1; i <= operators[k].arity; i++) {
    *ambit_lua_push_expression(L, 0) = ambit_lua_to_expression(L, i, NULL, "arithmetic on text");
    lua_replace(L, i);
  }
  lua_pushvalue(L, AMBIT_LUA_OWN(2));
  lua_insert(L, 1);
  lua_call(L, operators[k].arity, 1);
  return 1;
}

/* -- Lua's, watched */

/* What the number or text says; entire if that is no plain number. */
static ambit_interval said(lua_State *L, int idx) {
  ambit_interval x;
  ambit_failure f = { 0 };
  if (lua_isinteger(L, idx)) {
    lua_Integer n = lua_tointeger(L, idx);
    bool exact = n >= -9007199254740992LL && n <= 9007199254740992LL;
    return exact ? (ambit_interval) { (double)n, (double)n } : AMBIT_ENTIRE;
  }
  if (lua_type(L, idx) == LUA_TNUMBER) return ambit_interval_of(lua_tonumber(L, idx), lua_tonumber(L, idx));
  return ambit_decimal_read(lua_tostring(L, idx), &x, NULL, &f) == AMBIT_OK ? x : AMBIT_ENTIRE;
}

static ambit_interval enclose(int lua_op, ambit_interval a, ambit_interval b) {
  switch (lua_op) {
  case LUA_OPADD: return ambit_interval_add(a, b);
  case LUA_OPSUB: return ambit_interval_sub(a, b);
  case LUA_OPMUL: return ambit_interval_mul(a, b);
  case LUA_OPDIV: return ambit_interval_div(a, b);
  case LUA_OPUNM: return ambit_interval_sub((ambit_interval) { 0, 0 }, a);
  default: return AMBIT_ENTIRE;
  }
}

/* The whole number of an operand. False: Lua reads another one than the text says, since hexadecimal digits wrap. */
static bool read_whole(lua_State *L, int idx, lua_Integer *n) {
  *n = lua_tointeger(L, idx); /* 0 if it is none: then the result is none either */
  if (lua_type(L, idx) != LUA_TSTRING) return true;
  const char *text = lua_tostring(L, idx);
  while (isspace((unsigned char)*text)) text++;
  if (*text == '-' || *text == '+') text++;
  if (text[0] != '0' || (text[1] != 'x' && text[1] != 'X')) return true;
  text += 2;
  while (*text == '0') text++;
  size_t digits = strspn(text, "0123456789abcdefABCDEF");
  return digits < 16 || (digits == 16 && *text < '8');
}

/* Of whole numbers: Lua calculates modulo 2^64. */
static bool wraps(lua_State *L, int lua_op) {
  lua_Integer a, b, result;
  if (!read_whole(L, 1, &a) || !read_whole(L, 2, &b)) return true;
  switch (lua_op) {
  case LUA_OPADD: return __builtin_add_overflow(a, b, &result);
  case LUA_OPSUB: return __builtin_sub_overflow(a, b, &result);
  case LUA_OPMUL: return __builtin_mul_overflow(a, b, &result);
  case LUA_OPUNM: return __builtin_sub_overflow(0, a, &result);
  case LUA_OPIDIV: return a == LUA_MININTEGER && b == -1;
  default: return false;
  }
}

/* As Lua does; upvalue 2: Lua's own metamethod. */
static int observe(lua_State *L) {
  int k = (int)lua_tointeger(L, AMBIT_LUA_OWN(1));
  lua_settop(L, 2);
  bool plain = is_plain(L, 1) && is_plain(L, 2);
  ambit_interval exact = plain ? enclose(operators[k].lua_op, said(L, 1), said(L, 2)) : AMBIT_EMPTY;
  bool wrapped = plain && wraps(L, operators[k].lua_op);
  lua_pushvalue(L, AMBIT_LUA_OWN(2));
  lua_insert(L, 1);
  lua_call(L, 2, 1);
  if (!plain) return 1;
  bool whole = lua_isinteger(L, -1);
  double x = lua_tonumber(L, -1);
  if (whole ? !wrapped : exact.lo == x && exact.hi == x) return 1;
  ambit_lua *core = AMBIT_LUA(L);
  core->text_wrapped = core->text_wrapped || whole;
  if (!core->text_rounded[0]) {
    ambit_lua_where(L);
    snprintf(core->text_rounded, sizeof core->text_rounded, "%s", lua_tostring(L, -1));
    lua_pop(L, 1);
  }
  return 1;
}

/* -- whose it is */

static bool push_string_metatable(lua_State *L) {
  lua_pushliteral(L, "");
  bool some = lua_getmetatable(L, -1);
  if (some) lua_remove(L, -2);
  return some;
}

/* Lua's own metamethods of strings, kept the first time; pushed. */
static void push_originals(lua_State *L, int metatable) {
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &originals_key) == LUA_TTABLE) return;
  lua_pop(L, 1);
  lua_createtable(L, 0, OPERATORS);
  for (int k = 0; k < OPERATORS; k++) {
    lua_getfield(L, metatable, operators[k].event);
    lua_setfield(L, -2, operators[k].event);
  }
  lua_pushvalue(L, -1);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &originals_key);
}

/* text_arithmetic("ambit", "watched" or "lua") -> what it was */
static int text_arithmetic(lua_State *L) {
  static const char *const modes[] = { "ambit", "watched", "lua", NULL };
  ambit_lua *core = AMBIT_LUA(L);
  const char *before = core->text_mode;
  int mode = luaL_checkoption(L, 1, NULL, modes);
  lua_settop(L, 0);
  if (!push_string_metatable(L)) return 0;
  push_originals(L, 1);
  luaL_getmetatable(L, AMBIT_TYPE_EXPRESSION);
  for (int k = 0; k < OPERATORS; k++) {
    lua_pushinteger(L, k);
    lua_getfield(L, mode == 0 ? 3 : 2, operators[k].event);
    if (mode == 2 || (mode == 1 && lua_isnil(L, -1)))
      lua_remove(L, -2);
    else
      ambit_lua_push_function(L, core, mode == 0 ? operate : observe, 2);
    lua_setfield(L, 1, operators[k].event);
  }
  core->text_rounded[0] = '\0';
  core->text_wrapped = false;
  core->text_mode = modes[mode];
  lua_pushstring(L, before ? before : "lua");
  return 1;
}

/* check_number(number, what): was it perhaps rounded? */
static int check_number(lua_State *L) {
  ambit_lua_check_number(L, 1, luaL_optstring(L, 2, NULL));
  return 0;
}

void ambit_lua_open_text(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "text_arithmetic", text_arithmetic }, { "check_number", check_number },
    { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
