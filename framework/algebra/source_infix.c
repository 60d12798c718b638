/* source_infix.c -- the languages with usual operators: Lua, Modelica.
**
** Lua has not only the brackets of text but those too that keep the order of operations, so that the graph is rebuilt
** node by node; an operation on two numbers alone would be done by Lua, with rounding, so one of them is wrapped.
** Modelica is bracketed as text is: its unary sign stands only at the beginning of an expression or of a bracket, and
** the operands of ^ are primaries.
*/
#include "algebra/source.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Lua */

/* 1/b for a negative number b is a node that only the power makes: 1/b would take the sign out. */
static bool is_reciprocal_of_negative(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  return x->op == AMBIT_OP_DIV && x->a == AMBIT_ONE && ambit_is_exact(g, x->b) && ambit_at(g, x->b)->value.lo < 0;
}

static ambit_layout lua_layout(const ambit_writer *w, ambit_expr e) {
  if (is_reciprocal_of_negative(w->g, e))
    return (ambit_layout) { .tail = "^-1", .a = ambit_at(w->g, e)->b, .place_a = AMBIT_BINDS_ATOM, .wrap = true };
  ambit_layout l = ambit_layout_infix(w, e);
  uint32_t op = ambit_at(w->g, e)->op;
  if (op == AMBIT_OP_ADD || op == AMBIT_OP_SUB) l.place_b = AMBIT_BINDS_PRODUCT;
  if (op == AMBIT_OP_MUL) l.place_b = AMBIT_BINDS_POWER;
  if (op == AMBIT_OP_NEG) l.place_a = AMBIT_BINDS_POWER;
  l.wrap = ambit_is_exact(w->g, l.a) && (!l.two || ambit_is_exact(w->g, l.b));
  return l;
}

static bool is_literal(const ambit_node *x) {
  return x->op == AMBIT_LEAF_CONSTANT && x->text && strcmp(x->text, "pi") != 0;
}

static int lua_strength(const ambit_writer *w, ambit_expr e) {
  if (is_reciprocal_of_negative(w->g, e)) return AMBIT_BINDS_POWER;
  return is_literal(ambit_at(w->g, e)) ? AMBIT_BINDS_ATOM : ambit_style_text.strength(w, e); /* number "1/3" */
}

static bool lua_leaf(ambit_writer *w, ambit_expr e, bool wrap) {
  const ambit_node *x = ambit_at(w->g, e);
  char buffer[AMBIT_LEAF_MAX], lo[AMBIT_DECIMAL_MAX], hi[AMBIT_DECIMAL_MAX];
  bool number = x->op == AMBIT_LEAF_CONSTANT && !x->text, point = x->value.lo == x->value.hi;
  if (is_literal(x))
    return ambit_writer_put(w, "number \"") && ambit_writer_put(w, x->text) && ambit_writer_put(w, "\"");
  if (!number || (point && !wrap)) return ambit_writer_put(w, ambit_leaf_text(w->g, e, buffer));
  ambit_decimal_shortest(lo, x->value.lo);
  ambit_decimal_shortest(hi, x->value.hi);
  snprintf(buffer, sizeof buffer, point ? "number(%s)" : "number(interval(%s, %s))", lo, hi);
  return ambit_writer_put(w, buffer);
}

const ambit_style ambit_style_lua = { "(", ")", lua_strength, lua_layout, lua_leaf };

/* ---- Modelica */

static int modelica_strength(const ambit_writer *w, ambit_expr e) { return ambit_style_text.strength(w, e); }

static ambit_layout modelica_layout(const ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  if (ambit_op_is_function(x->op))
    return ambit_layout_form(&ambit_function_of(x->op)->modelica, x, AMBIT_BINDS_PRODUCT);
  ambit_layout l = ambit_layout_infix(w, e);
  int32_t n = (int32_t)x->b;
  if (x->op == AMBIT_OP_POWN && n < 0) snprintf(l.tail, sizeof l.tail, "^(%d)", (int)n);
  return l;
}

/* Integers of more than 31 bits are written as reals, and no number begins with a point. */
static bool modelica_leaf(ambit_writer *w, ambit_expr e, bool wrap) {
  const ambit_node *x = ambit_at(w->g, e);
  char buffer[AMBIT_LEAF_MAX];
  if (x->op == AMBIT_LEAF_TIME) return ambit_writer_put(w, "time");
  if (x->op != AMBIT_LEAF_CONSTANT) {
    if (!x->text) return ambit_style_text.leaf(w, e, wrap);
    return ambit_source_identifier(AMBIT_LANGUAGE_MODELICA, x->text, sizeof buffer, buffer)
               ? ambit_writer_put(w, buffer)
               : ambit_writer_put(w, x->text);
  }
  if (x->text && strspn(x->text, "0123456789.eE+-/") == strlen(x->text))
    return (*x->text != '.' || ambit_writer_put(w, "0")) && ambit_writer_put(w, x->text);
  if (x->text && strcmp(x->text, "pi") == 0) return ambit_writer_put(w, "pi");
  double middle = x->value.lo == x->value.hi ? x->value.lo : x->value.lo / 2 + x->value.hi / 2;
  ambit_decimal_shortest(buffer, middle);
  bool whole = strspn(buffer, "-0123456789") == strlen(buffer);
  return ambit_writer_put(w, buffer) && (!whole || fabs(middle) < 0x1p31 || ambit_writer_put(w, ".0"));
}

const ambit_style ambit_style_modelica = { "(", ")", modelica_strength, modelica_layout, modelica_leaf };
