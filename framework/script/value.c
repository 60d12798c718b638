/* value.c -- Lua values as kernel values. A number is the exact double it is; text is the decimal it says. */
#include "script/core.h"
#include "num/decimal.h"
#include "num/interval.h"
#include <ctype.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

int ambit_lua_retire(lua_State *L) {
  lua_pushnil(L);
  lua_setmetatable(L, 1);
  return 0;
}

ambit_lua_expression *ambit_lua_push_expression(lua_State *L, ambit_expr e) {
  if (e == AMBIT_NO_EXPR) ambit_lua_error(L, "out of memory while building an expression");
  ambit_lua *core = AMBIT_LUA(L);
  ambit_lua_box *box = lua_newuserdatauv(L, sizeof *box, 0);
  *box = (ambit_lua_box) {
    .x = { .e = e, .dimension.state = AMBIT_DIMENSION_OPEN }, .next = core->boxes, .link = &core->boxes
  };
  if (box->next) box->next->link = &box->next;
  core->boxes = box;
  luaL_setmetatable(L, AMBIT_TYPE_EXPRESSION);
  return &box->x;
}

void ambit_lua_mark_boxes(ambit_holder *holder, ambit_graph *g) {
  const ambit_lua *core = (const ambit_lua *)(const void *)((const char *)holder - offsetof(ambit_lua, holder));
  for (const ambit_lua_box *box = core->boxes; box; box = box->next) ambit_graph_mark(g, 1, &box->x.e);
}

void ambit_lua_push_enclosure(lua_State *L, ambit_interval x, uint32_t flags) {
  ambit_lua_enclosure *y = lua_newuserdatauv(L, sizeof *y, 0);
  *y = (ambit_lua_enclosure) { .x = x, .flags = flags & AMBIT_F_PARTIAL };
  luaL_setmetatable(L, AMBIT_TYPE_ENCLOSURE);
}

void ambit_lua_push_expressions(lua_State *L, size_t n, const ambit_expr *e) {
  lua_createtable(L, (int)n, 0);
  for (size_t i = 0; i < n; i++) {
    ambit_lua_push_expression(L, e[i]);
    lua_rawseti(L, -2, (lua_Integer)i + 1);
  }
}

ambit_expr *ambit_lua_to_array(lua_State *L, int idx, size_t n) {
  idx = lua_absindex(L, idx);
  ambit_expr *e = lua_newuserdatauv(L, (n + 1) * sizeof *e, 0);
  for (size_t i = 0; i < n; i++) {
    lua_rawgeti(L, idx, (lua_Integer)i + 1);
    e[i] = ((ambit_lua_expression *)luaL_checkudata(L, -1, AMBIT_TYPE_EXPRESSION))->e;
    lua_pop(L, 1);
  }
  return e;
}

bool ambit_lua_is_constant(lua_State *L, const ambit_lua_expression *x) {
  return ambit_graph_node(AMBIT_LUA(L)->graph, x->e)->constant;
}

_Noreturn static void wrong(lua_State *L, const char *what, const char *message) {
  ambit_lua_error(L, "%s%s%s", what ? what : "", what ? ": " : "", message);
}

static const char *type_name(lua_State *L, int idx) {
  return luaL_getmetafield(L, idx, "__name") == LUA_TSTRING ? lua_tostring(L, -1) : luaL_typename(L, idx);
}

/* In a host's Lua state, once Lua has rounded a text, any number with a point may be what came of it, and any whole one
** if that wrapped around (text.c). */
void ambit_lua_check_number(lua_State *L, int idx, const char *what) {
  const char *where = AMBIT_LUA(L)->text_rounded;
  if (!where[0] || (lua_isinteger(L, idx) && !AMBIT_LUA(L)->text_wrapped)) return;
  char message[AMBIT_MESSAGE_MAX];
  snprintf(message, sizeof message,
      "%sLua calculated with a text there and rounded it, so that this number may not be what the scene says. "
      "Call ambit.text_arithmetic(true) before: texts then mean what they say; (false): rounding them is meant",
      where);
  wrong(L, what, message);
}

/* An integer beyond 2^53 is a decimal too: no digit of it is lost. */
static ambit_expr number_expression(lua_State *L, int idx, const char *what) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  double x = lua_tonumber(L, idx);
  ambit_lua_check_number(L, idx, what);
  if (lua_isinteger(L, idx) && (lua_Number)(lua_Integer)x != (lua_Number)INFINITY) {
    lua_Integer n = lua_tointeger(L, idx);
    if (n > 9007199254740992LL || n < -9007199254740992LL) {
      char text[32];
      snprintf(text, sizeof text, LUA_INTEGER_FMT, (LUAI_UACINT)n);
      return ambit_graph_decimal(g, text, NULL);
    }
  }
  if (!isfinite(x)) wrong(L, what, isnan(x) ? "the number is NaN" : "the number is infinite");
  return ambit_graph_number(g, x);
}

static bool text_is_set(const char *text, const char *rest) {
  while (isspace((unsigned char)*text)) text++;
  const char *mark = strchr(text, '?');
  return *text == '[' || (mark && mark < rest);
}

ambit_expr ambit_lua_leaf(lua_State *L, uint32_t leaf, const char *name, ambit_interval outer, ambit_interval inner) {
  ambit_lua_where(L);
  size_t length;
  const char *where = lua_tolstring(L, -1, &length);
  const char *place = length > 2 ? lua_pushlstring(L, where, length - 2) : NULL; /* without ": " */
  ambit_graph *g = AMBIT_LUA(L)->graph;
  ambit_expr e = leaf == AMBIT_LEAF_VARYING ? ambit_graph_varying(g, name, place, outer, inner)
                                            : ambit_graph_datum(g, name, place, outer, inner);
  lua_pop(L, length > 2 ? 2 : 1);
  if (e == AMBIT_NO_EXPR) ambit_lua_error(L, "out of memory while building an expression");
  return e;
}

ambit_expr ambit_lua_datum(lua_State *L, const char *name, ambit_interval outer, ambit_interval inner) {
  return ambit_lua_leaf(L, AMBIT_LEAF_UNKNOWN, name, outer, inner);
}

/* A datum if it is given as one; in equations it is refused, since nobody said whether it varies. */
static ambit_expr plain_datum(lua_State *L, ambit_interval x, ambit_interval inner) {
  ambit_expr e = ambit_lua_datum(L, NULL, x, inner);
  ambit_graph_set_plain(AMBIT_LUA(L)->graph, e);
  return e;
}

/* A set literal is an uncertain datum: a fresh unknown, times its unit. */
static ambit_expr set_expression(
    lua_State *L, ambit_interval x, ambit_interval inner, const char *unit, const char *wanted, ambit_failure *f) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  if (ambit_interval_is_empty(x)) {
    ambit_fail(f, AMBIT_INVALID, "the interval is empty");
    return AMBIT_NO_EXPR;
  }
  if (!ambit_interval_is_bounded(x)) {
    ambit_fail(f, AMBIT_INVALID, "the interval is not bounded");
    return AMBIT_NO_EXPR;
  }
  ambit_expr e = ambit_interval_is_point(x) ? ambit_graph_number(g, x.lo) : plain_datum(L, x, inner), factor;
  if (!*unit) return e;
  char one[128];
  snprintf(one, sizeof one, "1 %s", unit);
  if (ambit_unit_quantity(g, one, wanted, &factor, f) != AMBIT_OK) return AMBIT_NO_EXPR;
  return ambit_graph_op(g, AMBIT_OP_MUL, e, factor);
}

static ambit_status text_expression(
    lua_State *L, const char *text, const char *wanted, ambit_lua_expression *out, ambit_failure *f) {
  ambit_interval x, inner;
  const char *rest = "";
  ambit_unit unit = { 0 };
  char dimension[AMBIT_DIMENSION_TEXT_MAX];
  if (ambit_decimal_read_set(text, &x, &inner, &rest, f) != AMBIT_OK) return f->status;
  while (isspace((unsigned char)*rest)) rest++;
  if (*rest && ambit_unit_read(rest, &unit, f) != AMBIT_OK) return f->status;
  if (!wanted) ambit_dimension_text(unit.power, dimension);
  if (*rest) out->dimension = ambit_dimension_known(unit.power);
  if (text_is_set(text, rest)) {
    out->e = set_expression(L, x, inner, rest, wanted ? wanted : dimension, f);
    return out->e == AMBIT_NO_EXPR ? ambit_no_memory(f) : AMBIT_OK;
  }
  if (!ambit_interval_is_bounded(x) && isinf(x.lo) && isinf(x.hi))
    return ambit_fail(f, AMBIT_INVALID, "\"%s\" is not finite", text);
  return ambit_unit_quantity(AMBIT_LUA(L)->graph, text, wanted ? wanted : dimension, &out->e, f);
}

static void check_dimension(lua_State *L, const ambit_lua_expression *x, const char *wanted, const char *what) {
  ambit_unit unit;
  ambit_failure f = { 0 };
  char have[AMBIT_DIMENSION_TEXT_MAX], name[AMBIT_DIMENSION_TEXT_MAX], message[3 * AMBIT_DIMENSION_TEXT_MAX];
  if (!wanted || x->dimension.state != AMBIT_DIMENSION_KNOWN) return;
  if (ambit_unit_read(wanted, &unit, &f) != AMBIT_OK) ambit_lua_raise(L, &f);
  if (ambit_dimension_agree(x->dimension, ambit_dimension_known(unit.power))) return;
  ambit_dimension_name(unit.power, name);
  ambit_dimension_name(x->dimension.power, have);
  snprintf(message, sizeof message, "expected %s, got %s", name, have);
  wrong(L, what, message);
}

static ambit_expr enclosure_expression(lua_State *L, const ambit_lua_enclosure *y, const char *what) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  if (ambit_interval_is_empty(y->x)) wrong(L, what, "the enclosure is empty");
  if (!ambit_interval_is_bounded(y->x)) wrong(L, what, "the enclosure is not bounded");
  bool partial = (y->flags & AMBIT_F_PARTIAL) != 0;
  if (ambit_interval_is_point(y->x) && !partial) return ambit_graph_number(g, y->x.lo);
  ambit_interval x = y->x; /* a point would be a constant, which everything shares: its neighbours make it a datum */
  if (ambit_interval_is_point(x)) x = (ambit_interval) { nextafter(x.lo, -INFINITY), nextafter(x.hi, INFINITY) };
  ambit_expr e = plain_datum(L, x, y->declared ? y->inner : AMBIT_EMPTY);
  if (partial && e != AMBIT_NO_EXPR) ambit_graph_mark_partial(g, e);
  return e;
}

/* C would end the text at a zero byte, and read what is in front of it. */
static const char *whole_text(lua_State *L, int idx, const char *what) {
  size_t length;
  const char *text = lua_tolstring(L, idx, &length);
  if (strlen(text) != length) wrong(L, what, "the text holds a zero byte");
  return text;
}

ambit_lua_expression ambit_lua_to_expression(lua_State *L, int idx, const char *wanted, const char *what) {
  ambit_lua_expression out = { 0 };
  ambit_failure f = { 0 };
  const void *user;
  char message[160];
  switch (lua_type(L, idx)) {
  case LUA_TNUMBER: out.e = number_expression(L, idx, what); return out;
  case LUA_TSTRING:
    if (text_expression(L, whole_text(L, idx, what), wanted, &out, &f) != AMBIT_OK) wrong(L, what, f.message);
    return out;
  case LUA_TUSERDATA:
    if ((user = luaL_testudata(L, idx, AMBIT_TYPE_EXPRESSION)) != NULL) {
      out = *(const ambit_lua_expression *)user;
      check_dimension(L, &out, wanted, what);
      return out;
    }
    if ((user = luaL_testudata(L, idx, AMBIT_TYPE_ENCLOSURE)) != NULL) {
      out.e = enclosure_expression(L, user, what);
      return out;
    }
    break;
  default: break;
  }
  snprintf(message, sizeof message, "expected a number, text, expression or enclosure, got %s",
      lua_isnone(L, idx) ? "nothing" : type_name(L, idx));
  wrong(L, what, message);
}

ambit_dimension ambit_lua_dimension(lua_State *L, int idx, const char *what) {
  const ambit_lua_expression *x = luaL_testudata(L, idx, AMBIT_TYPE_EXPRESSION);
  ambit_interval value;
  ambit_unit unit;
  ambit_failure f = { 0 };
  const char *rest;
  if (x) return x->dimension;
  if (lua_type(L, idx) != LUA_TSTRING) return (ambit_dimension) { 0 };
  ambit_status status = ambit_decimal_read(whole_text(L, idx, what), &value, &rest, &f);
  if (status == AMBIT_OK) status = ambit_unit_read(rest, &unit, &f);
  if (status != AMBIT_OK) wrong(L, what, f.message);
  while (isspace((unsigned char)*rest)) rest++;
  return *rest ? ambit_dimension_known(unit.power) : (ambit_dimension) { 0 };
}

/* How many SI units one `unit` is. */
static ambit_interval unit_factor(lua_State *L, const char *unit, const char *what) {
  ambit_lua_expression one = { 0 };
  ambit_failure f = { 0 };
  char text[128];
  snprintf(text, sizeof text, "1 %s", unit);
  if (text_expression(L, text, NULL, &one, &f) != AMBIT_OK) wrong(L, what, f.message);
  return ambit_graph_node(AMBIT_LUA(L)->graph, one.e)->range;
}

/* What is surely in the set times the factor, which is positive and lies in `factor`. */
static ambit_interval scaled_inner(ambit_interval inner, ambit_interval factor) {
  if (ambit_interval_is_empty(inner)) return inner;
  ambit_interval lo = { inner.lo, inner.lo }, hi = { inner.hi, inner.hi };
  double least = isinf(inner.lo) ? inner.lo : ambit_interval_mul(lo, factor).hi;
  double most = isinf(inner.hi) ? inner.hi : ambit_interval_mul(hi, factor).lo;
  return ambit_interval_of(least, most);
}

ambit_lua_enclosure ambit_lua_to_enclosure(lua_State *L, int idx, const char *what) {
  const void *user = luaL_testudata(L, idx, AMBIT_TYPE_ENCLOSURE);
  if (user) return *(const ambit_lua_enclosure *)user;
  if (lua_type(L, idx) == LUA_TSTRING) { /* sets and infinite bounds are welcome here */
    ambit_interval x, inner;
    ambit_failure f = { 0 };
    const char *rest;
    if (ambit_decimal_read_set(whole_text(L, idx, what), &x, &inner, &rest, &f) != AMBIT_OK) wrong(L, what, f.message);
    while (isspace((unsigned char)*rest)) rest++;
    if (*rest) {
      ambit_interval factor = unit_factor(L, rest, what);
      x = ambit_interval_mul(x, factor);
      inner = scaled_inner(inner, factor);
    }
    return (ambit_lua_enclosure) { .x = x, .declared = true, .inner = inner };
  }
  if (lua_type(L, idx) == LUA_TNUMBER && isnan(lua_tonumber(L, idx))) wrong(L, what, "the number is NaN");
  ambit_lua_expression e = ambit_lua_to_expression(L, idx, NULL, what);
  const ambit_node *node = ambit_graph_node(AMBIT_LUA(L)->graph, e.e);
  if (!node->constant)
    wrong(L, what, "this expression holds unknowns or variables; ask ambit.evaluate for its enclosure");
  return (ambit_lua_enclosure) { .x = node->range, .flags = node->total ? 0 : AMBIT_F_PARTIAL };
}
