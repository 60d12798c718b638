/* source_infix.c -- the languages with usual operators: text, Lua, Modelica.
**
** Text has as few brackets as the usual precedence allows. Lua has those too that keep the order of operations, so that
** the graph is rebuilt node by node; an operation on two numbers alone would be done by Lua, with rounding, so one of
** them is wrapped. Modelica is bracketed as text is: its unary sign stands only at the beginning of an expression or of
** a bracket, and the operands of ^ are primaries.
*/
#include "graph/source_style.h"
#include <stdio.h>
#include <string.h>

static const char *const symbol_of[AMBIT_OP_END] = {
#define AMBIT_X(name, arity, symbol) [AMBIT_OP_##name] = symbol,
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
#define AMBIT_X(name, arity, symbol) [AMBIT_OP_##name] = #symbol,
      AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
};

const char *ambit_op_symbol(uint32_t op) { return op < AMBIT_OP_END && symbol_of[op] ? symbol_of[op] : ""; }

/* Does a product, as it is written, begin with a sign? */
static bool begins_with_sign(const ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  while (x->op == AMBIT_OP_MUL || x->op == AMBIT_OP_DIV) {
    e = x->a;
    x = ambit_at(w->g, e);
    if (ambit_writer_name(w, e)) return false;
  }
  return w->style->strength(w, e) == AMBIT_BINDS_SIGN;
}

int ambit_writer_strength(const ambit_writer *w, ambit_expr e) {
  switch (ambit_at(w->g, e)->op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB: return AMBIT_BINDS_SUM;
  case AMBIT_OP_NEG: return AMBIT_BINDS_SIGN;
  case AMBIT_OP_MUL:
  case AMBIT_OP_DIV: return begins_with_sign(w, e) ? AMBIT_BINDS_SIGN : AMBIT_BINDS_PRODUCT;
  case AMBIT_OP_SQR:
  case AMBIT_OP_POWN: return AMBIT_BINDS_POWER;
  default: return AMBIT_BINDS_ATOM;
  }
}

static int strength(const ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  if (x->op != AMBIT_LEAF_CONSTANT) return ambit_writer_strength(w, e);
  if (x->text) return strchr(x->text, '/') ? AMBIT_BINDS_PRODUCT : AMBIT_BINDS_ATOM;
  return x->value.lo == x->value.hi && x->value.lo < 0 ? AMBIT_BINDS_SIGN : AMBIT_BINDS_ATOM;
}

ambit_layout ambit_layout_infix(const ambit_writer *w, ambit_expr e) {
  const ambit_node *x = ambit_at(w->g, e);
  ambit_layout l = {
    .a = x->a, .b = x->b, .place_a = AMBIT_BINDS_SUM, .place_b = AMBIT_BINDS_SUM, .two = ambit_op_is_binary(x->op)
  };
  const char *symbol = ambit_op_symbol(x->op);
  switch (x->op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
    snprintf(l.middle, sizeof l.middle, " %s ", symbol);
    l.place_b = x->op == AMBIT_OP_SUB ? AMBIT_BINDS_PRODUCT : AMBIT_BINDS_ADDEND;
    break;
  case AMBIT_OP_NEG: snprintf(l.head, sizeof l.head, "-"), l.place_a = AMBIT_BINDS_PRODUCT; break;
  case AMBIT_OP_MUL:
  case AMBIT_OP_DIV:
    snprintf(l.middle, sizeof l.middle, "%s", symbol);
    l.place_a = AMBIT_BINDS_SIGN, l.place_b = x->op == AMBIT_OP_DIV ? AMBIT_BINDS_POWER : AMBIT_BINDS_PRODUCT;
    break;
  case AMBIT_OP_SQR: snprintf(l.tail, sizeof l.tail, "^2"), l.place_a = AMBIT_BINDS_ATOM; break;
  case AMBIT_OP_POWN: snprintf(l.tail, sizeof l.tail, "^%d", (int)(int32_t)x->b), l.place_a = AMBIT_BINDS_ATOM; break;
  default:
    snprintf(l.head, sizeof l.head, "%s(", symbol);
    snprintf(l.middle, sizeof l.middle, ", ");
    snprintf(l.tail, sizeof l.tail, ")");
  }
  return l;
}

ambit_layout ambit_layout_form(const ambit_function_form *form, const ambit_node *x, int place) {
  ambit_layout l = { .a = x->a, .b = x->b, .place_a = form->tight ? AMBIT_BINDS_ATOM : place, .place_b = place };
  l.two = form->middle != NULL;
  snprintf(l.head, sizeof l.head, "%s", form->head);
  if (l.two) snprintf(l.middle, sizeof l.middle, "%s", form->middle);
  snprintf(l.tail, sizeof l.tail, "%s", form->tail);
  return l;
}

const char *ambit_leaf_text(const ambit_graph *g, ambit_expr e, char buffer[AMBIT_LEAF_MAX]) {
  const ambit_node *x = ambit_at(g, e);
  if (x->text) return x->text;
  if (x->value.lo == x->value.hi)
    ambit_decimal_shortest(buffer, x->value.lo);
  else
    ambit_decimal_interval(buffer, x->value, 3);
  return buffer;
}

static bool text_leaf(ambit_writer *w, ambit_expr e, bool wrap) {
  char buffer[AMBIT_LEAF_MAX];
  (void)wrap;
  return ambit_writer_put(w, ambit_leaf_text(w->g, e, buffer));
}

const ambit_style ambit_style_text = { "(", ")", strength, ambit_layout_infix, text_leaf };

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
  return is_literal(ambit_at(w->g, e)) ? AMBIT_BINDS_ATOM : strength(w, e); /* number "1/3" */
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
    if (!x->text) return text_leaf(w, e, wrap);
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

const ambit_style ambit_style_modelica = { "(", ")", strength, modelica_layout, modelica_leaf };
