/* data.c -- uncertain data: around, between, interval.
**
** around(c, tol) for a numeric c is one fresh unknown over [c - tol, c + tol]. c and tol are known from both sides
** (verbs/evaluate/tight.h). The outer range takes the bounds that make it larger, so every value within the tolerance
** is inside; the inner range takes those that make it smaller, so every value inside is within the tolerance. What
** refutes, bounds from below or is sampled uses the inner range alone. For a general expression c the datum is c + |c|
** tol xi (absolute: c + tol xi) with a fresh xi in [-1, 1], which has the same image. between(lo, hi): one fresh
** unknown over the hull of its ends. varying(lo, hi): a function of time within that hull.
*/
#include "script/core.h"
#include "verbs/evaluate/tight.h"
#include "num/decimal.h"
#include "num/interval.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

typedef struct tolerance {
  ambit_interval size; /* >= 0 */
  bool relative;
  ambit_dimension dimension;
} tolerance;

/* 0.1 (a number: absolute), "0.1", "0.1%", "0.1 mm" */
static tolerance tolerance_of(lua_State *L, int idx) {
  tolerance t = { { 0, 0 }, false, { 0 } };
  ambit_failure f = { 0 };
  if (lua_type(L, idx) == LUA_TNUMBER) {
    ambit_lua_check_number(L, idx, "around");
    double x = lua_tonumber(L, idx);
    if (!(x >= 0) || isinf(x)) ambit_lua_error(L, "around: the tolerance must be a finite number, not negative");
    t.size = (ambit_interval) { x, x };
    return t;
  }
  if (lua_type(L, idx) != LUA_TSTRING)
    ambit_lua_error(L, "around: expected a tolerance such as 0.1, \"0.1\" or \"1%%\", got %s",
        lua_isnone(L, idx) ? "nothing" : luaL_typename(L, idx));
  const char *rest = "";
  if (ambit_decimal_tolerance(lua_tostring(L, idx), &t.size, &t.relative, &rest, &f) != AMBIT_OK)
    ambit_lua_raise(L, &f);
  while (isspace((unsigned char)*rest)) rest++;
  if (*rest && t.relative) ambit_lua_error(L, "around: a tolerance in %% takes no unit, got \"%s\"", rest);
  if (*rest) {
    lua_pushfstring(L, "1 %s", rest);
    t.dimension = ambit_lua_dimension(L, -1, "around");
    ambit_interval unit = ambit_lua_to_enclosure(L, -1, "around").x;
    lua_pop(L, 1);
    t.size = ambit_interval_mul(t.size, unit);
  }
  if (!ambit_interval_is_bounded(t.size)) ambit_lua_error(L, "around: the tolerance is not finite");
  return t;
}

/* The numbers that are at least the number in lo and at most the one in hi, whatever these are: of the sum of an end
** and a radius `inner` takes the bound that makes the range smaller. */
static ambit_interval between_all(ambit_interval lo, ambit_interval hi) { return ambit_interval_of(lo.hi, hi.lo); }

static ambit_expr around_number(lua_State *L, ambit_interval c, tolerance t, const char *name) {
  ambit_interval r = t.size;
  if (t.relative) r = ambit_interval_mul(r, (ambit_interval) { ambit_interval_mig(c), ambit_interval_mag(c) });
  ambit_interval lo = ambit_interval_sub(c, r), hi = ambit_interval_add(c, r);
  return ambit_lua_datum(L, name, (ambit_interval) { lo.lo, hi.hi }, between_all(lo, hi));
}

/* scale is the tolerance rounded up, so that not all of [-1, 1] is allowed where that was inexact. */
static ambit_expr around_general(lua_State *L, ambit_expr c, tolerance t, const char *name) {
  ambit_graph *g = AMBIT_LUA(L)->graph;
  ambit_interval range = ambit_graph_node(g, c)->range, scale = { t.size.hi, t.size.hi };
  double part = ambit_interval_div((ambit_interval) { t.size.lo, t.size.lo }, scale).lo;
  ambit_expr xi = ambit_lua_datum(L, name, (ambit_interval) { -1, 1 }, (ambit_interval) { -part, part });
  ambit_expr factor = ambit_graph_number(g, t.size.hi);
  if (factor == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  ambit_expr d = ambit_graph_op(g, AMBIT_OP_MUL, factor, xi);
  if (t.relative && d != AMBIT_NO_EXPR) { /* |c| is c or -c where the sign is known: smooth */
    bool known = range.lo >= 0 || range.hi <= 0;
    ambit_expr size = known ? c : ambit_graph_op(g, AMBIT_OP_ABS, c, c); /* xi is symmetric: the sign does not matter */
    d = size == AMBIT_NO_EXPR ? size : ambit_graph_op(g, AMBIT_OP_MUL, size, d);
  }
  return d == AMBIT_NO_EXPR ? d : ambit_graph_op(g, AMBIT_OP_ADD, c, d);
}

/* The name at idx, or NULL */
static const char *name_of(lua_State *L, int idx, const char *what) {
  if (lua_isnoneornil(L, idx)) return NULL;
  size_t length = 0;
  const char *name = lua_type(L, idx) == LUA_TSTRING ? lua_tolstring(L, idx, &length) : NULL;
  if (!length || strlen(name) != length)
    ambit_lua_error(L, "%s: expected a name for the datum such as \"upper length\", got %s", what,
        name ? "an empty text or a zero byte" : luaL_typename(L, idx));
  return name;
}

/* A constant expression that no number is the value of: "around: the value". */
static void refuse_undefined(lua_State *L, ambit_interval x, const char *what) {
  if (!ambit_interval_is_empty(x)) return;
  ambit_lua_error(
      L, "%s is no number: it is not defined, such as the root of a negative number or a quotient by 0", what);
}

/* around(c, tolerance [, name]) */
static int around(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_lua_expression c = ambit_lua_to_expression(L, 1, NULL, "around");
  tolerance t = tolerance_of(L, 2);
  const char *name = name_of(L, 3, "around");
  if (t.dimension.state == AMBIT_DIMENSION_KNOWN) /* a bare tolerance is in the unit of the value */
    c.dimension = ambit_lua_dimension_op(L, AMBIT_OP_ADD, c.dimension, t.dimension, "around");
  if (t.size.hi > 0) {
    if (ambit_lua_is_constant(L, &c)) {
      ambit_interval x = ambit_tight(core->graph, core->registry, c.e);
      refuse_undefined(L, x, "around: the value");
      if (!ambit_interval_is_bounded(x)) ambit_lua_error(L, "around: the value is not bounded");
      c.e = around_number(L, x, t, name);
    } else {
      c.e = around_general(L, c.e, t, name);
    }
  }
  *ambit_lua_push_expression(L, c.e) = c;
  return 1;
}

/* tight(constant expression) -> the number that it is, to a few units in the last place */
static int tight(lua_State *L) {
  ambit_lua *core = AMBIT_LUA(L);
  ambit_lua_expression c = ambit_lua_to_expression(L, 1, NULL, "tight");
  ambit_lua_push_enclosure(L, ambit_tight(core->graph, core->registry, c.e), 0);
  return 1;
}

/* The tight enclosure of an end, "varying: the lower end". */
static ambit_interval end_of(lua_State *L, ambit_expr e, const char *verb, const char *which) {
  ambit_lua *core = AMBIT_LUA(L);
  char what[64];
  snprintf(what, sizeof what, "%s: the %s end", verb, which);
  ambit_interval x = ambit_tight(core->graph, core->registry, e);
  refuse_undefined(L, x, what);
  return x;
}

/* A leaf over the hull of the ends at 1 and 2, of the name at 3; the same end twice is that number. */
static int uncertain(lua_State *L, uint32_t leaf, const char *verb) {
  ambit_lua_expression lo = ambit_lua_to_expression(L, 1, NULL, verb), hi = ambit_lua_to_expression(L, 2, NULL, verb);
  const char *name = name_of(L, 3, verb);
  if (!ambit_lua_is_constant(L, &lo) || !ambit_lua_is_constant(L, &hi))
    ambit_lua_error(L, "%s: the ends must be known numbers, not uncertain themselves", verb);
  lo.dimension = ambit_lua_dimension_op(L, AMBIT_OP_ADD, lo.dimension, hi.dimension, verb);
  ambit_interval a = end_of(L, lo.e, verb, "lower"), b = end_of(L, hi.e, verb, "upper");
  if (a.lo > b.hi) ambit_lua_error(L, "%s: the interval is reversed: %g is greater than %g", verb, a.lo, b.hi);
  ambit_interval range = { a.lo, b.hi };
  if (!ambit_interval_is_bounded(range)) ambit_lua_error(L, "%s: the ends must be finite", verb);
  ambit_interval inner = between_all(a, b);
  if (lo.e != hi.e && range.lo == range.hi && !(inner.lo <= inner.hi))
    ambit_lua_error(
        L, "%s: no number is known to lie between the ends, both are %g but for a rounding", verb, range.lo);
  if (lo.e != hi.e) lo.e = ambit_lua_leaf(L, leaf, name, range, inner);
  *ambit_lua_push_expression(L, lo.e) = lo;
  return 1;
}

/* between(lo, hi [, name]) */
static int between(lua_State *L) { return uncertain(L, AMBIT_LEAF_UNKNOWN, "between"); }

/* varying(lo, hi [, name]): a function of time, always between the ends */
static int varying(lua_State *L) { return uncertain(L, AMBIT_LEAF_VARYING, "varying"); }

/* interval(lo, hi): numbers (infinite ones too), texts, enclosures; interval(x): a literal, a number, an enclosure */
static int interval(lua_State *L) {
  ambit_lua_enclosure x, y;
  if (lua_gettop(L) < 1) ambit_lua_error(L, "interval: expected bounds or a literal such as \"[0.1, 0.2]\"");
  bool unbounded[2] = { false, false };
  ambit_lua_enclosure end[2];
  for (int i = 0; i < 2; i++) {
    double v = lua_type(L, i + 1) == LUA_TNUMBER ? lua_tonumber(L, i + 1) : 0;
    unbounded[i] = isinf(v);
    if (unbounded[i])
      end[i] = (ambit_lua_enclosure) { .x = { v, v } };
    else if (i == 0 || !lua_isnoneornil(L, 2))
      end[i] = ambit_lua_to_enclosure(L, i + 1, "interval");
    else
      end[i] = end[0];
  }
  x = end[0];
  y = end[1];
  ambit_lua_dimension_op(
      L, AMBIT_OP_ADD, ambit_lua_dimension(L, 1, "interval"), ambit_lua_dimension(L, 2, "interval"), "interval");
  if (ambit_interval_is_empty(x.x) && lua_isnoneornil(L, 2)) {
    ambit_lua_push_enclosure(L, AMBIT_EMPTY, x.flags);
    return 1;
  }
  ambit_interval r = { x.x.lo, y.x.hi };
  if (ambit_interval_is_empty(x.x) || ambit_interval_is_empty(y.x)) ambit_lua_error(L, "interval: a bound is empty");
  if (r.lo > r.hi) ambit_lua_error(L, "interval: the bounds are reversed: %g is greater than %g", r.lo, r.hi);
  if (r.lo == r.hi && isinf(r.lo)) ambit_lua_error(L, "interval: the interval is empty: it holds no real number");
  bool whole = lua_isnoneornil(L, 2); /* a set itself, no two ends */
  ambit_lua_push_enclosure(L, r, x.flags | y.flags);
  ambit_lua_enclosure *made = lua_touserdata(L, -1);
  made->declared = !whole || x.declared;
  made->inner = whole ? x.inner : between_all(x.x, y.x);
  return 1;
}

void ambit_lua_open_data(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "around", around }, { "between", between }, { "varying", varying },
    { "interval", interval }, { "tight", tight }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
