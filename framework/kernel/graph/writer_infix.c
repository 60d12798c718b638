/* writer_infix.c -- usual operators, with as few brackets as the usual precedence allows: the text of messages, and
** what other languages with such operators have in common with it.
*/
#include "graph/writer.h"
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
