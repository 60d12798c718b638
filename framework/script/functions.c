/* functions.c -- sin, sqrt, pow ... and the operators, one function per opcode for every kind of value.
**
** With an enclosure among the operands (and no unknown) the result is an enclosure, by the kernel's interval functions
** (IEEE 1788 set-based); otherwise an expression, so that what a script writes stays exact, differentiable and
** correlated.
*/
#include "script/core.h"
#include "num/interval.h"
#include <ctype.h>
#include <string.h>

static const struct {
  const char *name; /* NULL: no opcode */
  int arity;
  const char *symbol;
} opcode[AMBIT_OP_END] = {
#define AMBIT_X(name, arity, symbol) [AMBIT_OP_##name] = { #name, arity, symbol },
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
#define AMBIT_X(name, arity, symbol) [AMBIT_OP_##name] = { #name, arity, #symbol },
      AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
};

static bool is_enclosure(lua_State *L, int idx) { return luaL_testudata(L, idx, AMBIT_TYPE_ENCLOSURE) != NULL; }

static bool is_unknown(lua_State *L, int idx) {
  const ambit_lua_expression *x = luaL_testudata(L, idx, AMBIT_TYPE_EXPRESSION);
  return x && !ambit_lua_is_constant(L, x);
}

static bool wants_enclosure(lua_State *L, int arity) {
  bool some = false;
  for (int i = 1; i <= arity; i++) {
    if (is_unknown(L, i)) return false;
    some = some || is_enclosure(L, i);
  }
  return some;
}

static int apply(lua_State *L, uint32_t op, int arity, const char *what) {
  if (wants_enclosure(L, arity)) {
    ambit_lua_enclosure a = ambit_lua_to_enclosure(L, 1, what), b = arity == 2 ? ambit_lua_to_enclosure(L, 2, what) : a;
    ambit_interval r;
    uint32_t flags = ambit_interval_op(op, &r, a.x, b.x);
    ambit_lua_push_enclosure(L, r, flags | a.flags | b.flags);
    return 1;
  }
  ambit_lua_expression a = ambit_lua_to_expression(L, 1, NULL, what);
  ambit_lua_expression b = arity == 2 ? ambit_lua_to_expression(L, 2, NULL, what) : a;
  ambit_dimension d = ambit_lua_dimension_op(L, op, a.dimension, b.dimension, opcode[op].symbol);
  ambit_lua_push_expression(L, ambit_graph_op(AMBIT_LUA(L)->graph, op, a.e, b.e))->dimension = d;
  return 1;
}

/* sin(x), atan2(y, x): upvalue 2 is the opcode */
static int function(lua_State *L) {
  uint32_t op = (uint32_t)lua_tointeger(L, AMBIT_LUA_OWN(1));
  return apply(L, op, opcode[op].arity, lua_tostring(L, AMBIT_LUA_OWN(2)));
}

/* min(a, b, ...), max(a, b, ...) */
static int fold(lua_State *L) {
  uint32_t op = (uint32_t)lua_tointeger(L, AMBIT_LUA_OWN(1));
  const char *what = lua_tostring(L, AMBIT_LUA_OWN(2));
  int n = lua_gettop(L);
  if (n == 1) {
    lua_pushvalue(L, 1);
    return apply(L, op, 2, what);
  }
  while (lua_gettop(L) > 1) {
    int rest = lua_gettop(L) - 2;
    apply(L, op, 2, what);
    lua_replace(L, 1);
    lua_remove(L, 2);
    lua_settop(L, rest + 1);
  }
  if (n == 0) apply(L, op, 2, what); /* says what is missing */
  return 1;
}

#define EXPONENT_MAX 1e9

/* Twice the exponent as an integer, if it is exactly one: a text is read as a decimal, so "2.00000000000000000001" is
** none. */
static bool half_integer_exponent(lua_State *L, int idx, int32_t *n) {
  double x;
  if (lua_type(L, idx) == LUA_TNUMBER) {
    ambit_lua_check_number(L, idx, "exponent");
    x = lua_tonumber(L, idx);
  } else if (!is_unknown(L, idx)) {
    ambit_lua_enclosure e = ambit_lua_to_enclosure(L, idx, "exponent");
    if (!ambit_interval_is_point(e.x)) return false;
    x = e.x.lo;
  } else {
    return false;
  }
  if (fabs(x) > EXPONENT_MAX && x == floor(x)) /* by logarithms it would be defined for positive numbers only */
    ambit_lua_error(
        L, "pow: a whole exponent is at most 1e9 in magnitude, got %.17g; for a > 0 write exp(b*log(a))", x);
  x *= 2;
  if (!(fabs(x) <= 2 * EXPONENT_MAX) || x != floor(x)) return false;
  *n = (int32_t)x;
  return true;
}

/* Twice the exponent is n: the dimension, where both sides are expressions. */
static ambit_dimension power_dimension(lua_State *L, int32_t n) {
  return ambit_dimension_power(ambit_lua_dimension(L, 1, "pow"), (int64_t)n * (AMBIT_POWER_ONE / 2));
}

/* exponent_flags: of the set that the exponent is, of one point */
static int integer_power(lua_State *L, int32_t n, ambit_dimension d, uint32_t exponent_flags) {
  if (is_enclosure(L, 1)) {
    ambit_lua_enclosure a = ambit_lua_to_enclosure(L, 1, "pow");
    ambit_interval r;
    uint32_t flags = ambit_interval_pown(&r, a.x, n);
    ambit_lua_push_enclosure(L, r, flags | a.flags | exponent_flags);
  } else {
    ambit_expr a = ambit_lua_to_expression(L, 1, NULL, "pow").e;
    ambit_lua_push_expression(L, ambit_graph_pown(AMBIT_LUA(L)->graph, a, n))->dimension = d;
  }
  return 1;
}

/* a^b with an exponent that is no half integer: of a length only if the exponent is a known number such as "1/3". */
static ambit_dimension general_power_dimension(lua_State *L, ambit_dimension base) {
  if (!ambit_dimension_is_number(base) && is_unknown(L, 2))
    ambit_lua_error(L, "pow: a quantity with a unit takes no uncertain or variable exponent");
  if (is_unknown(L, 2))
    return base.state == AMBIT_DIMENSION_SOFT ? (ambit_dimension) { .state = AMBIT_DIMENSION_OPEN } : base;
  ambit_interval sixtieths = ambit_interval_mul(
      ambit_lua_to_enclosure(L, 2, "exponent").x, (ambit_interval) { AMBIT_POWER_ONE, AMBIT_POWER_ONE });
  double near = nearbyint(sixtieths.lo);
  bool whole = fabs(near) < 1e6 && sixtieths.lo <= near && near <= sixtieths.hi;
  return whole ? ambit_dimension_power(base, (int64_t)near) : (ambit_dimension) { .state = AMBIT_DIMENSION_OPEN };
}

/* a^b: integer b for every a, half integers as powers of the square root, a >= 0; otherwise POW, a > 0 */
static int power(lua_State *L) {
  int32_t n;
  lua_settop(L, 2);
  ambit_dimension exponent = ambit_lua_dimension(L, 2, "pow");
  if (!ambit_dimension_is_number(exponent)) ambit_lua_dimension_op(L, AMBIT_OP_EXP, exponent, exponent, "exponent");
  if (half_integer_exponent(L, 2, &n)) {
    uint32_t flags = is_enclosure(L, 2) ? ambit_lua_to_enclosure(L, 2, "exponent").flags : 0;
    ambit_dimension d = power_dimension(L, n);
    if (n % 2 == 0) return integer_power(L, n / 2, d, flags);
    lua_settop(L, 1);
    apply(L, AMBIT_OP_SQRT, 1, "pow");
    lua_replace(L, 1);
    return integer_power(L, n, d, flags);
  }
  if (wants_enclosure(L, 2)) {
    ambit_lua_enclosure a = ambit_lua_to_enclosure(L, 1, "pow"), b = ambit_lua_to_enclosure(L, 2, "pow");
    ambit_interval r;
    uint32_t flags = ambit_interval_op(AMBIT_OP_POW, &r, a.x, b.x);
    ambit_lua_push_enclosure(L, r, flags | a.flags | b.flags);
    return 1;
  }
  ambit_lua_expression base = ambit_lua_to_expression(L, 1, NULL, "pow");
  ambit_expr b = ambit_lua_to_expression(L, 2, NULL, "pow").e;
  ambit_dimension d = general_power_dimension(L, base.dimension);
  ambit_lua_push_expression(L, ambit_graph_op(AMBIT_LUA(L)->graph, AMBIT_OP_POW, base.e, b))->dimension = d;
  return 1;
}

static void push_function(lua_State *L, ambit_lua *core, lua_CFunction f, uint32_t op, const char *name) {
  lua_pushinteger(L, op);
  lua_pushstring(L, name);
  ambit_lua_push_function(L, core, f, 2);
}

void ambit_lua_open_functions(lua_State *L, ambit_lua *core) {
  for (uint32_t op = 0; op < AMBIT_OP_COUNT; op++) {
    char name[8];
    size_t length = strlen(opcode[op].name);
    for (size_t i = 0; i <= length; i++) name[i] = (char)tolower((unsigned char)opcode[op].name[i]);
    if (op == AMBIT_OP_POWN) continue;
    push_function(L, core, op == AMBIT_OP_MIN || op == AMBIT_OP_MAX ? fold : function, op, name);
    lua_setfield(L, -2, name);
  }
  lua_newtable(L); /* described_functions -> {"log1p", ...} */
  for (uint32_t op = AMBIT_OP_FUNCTIONS; op < AMBIT_OP_END; op++) {
    lua_pushstring(L, opcode[op].symbol);
    lua_rawseti(L, -2, (lua_Integer)(op - AMBIT_OP_FUNCTIONS) + 1);
    push_function(L, core, function, op, opcode[op].symbol);
    lua_setfield(L, -3, opcode[op].symbol);
  }
  lua_setfield(L, -2, "described_functions");
  push_function(L, core, power, AMBIT_OP_POWN, "pow");
  lua_setfield(L, -2, "pow");
}
