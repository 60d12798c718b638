/* print.c -- expressions as text with as few brackets as the usual precedence allows, without recursion.
**
** Work is a stack of pieces still to be written. Printing stops when the room is used up; the full length is found by
** a pass over the nodes, since a graph with much sharing can stand for a text of astronomical length.
*/
#include "base/vector.h"
#include "graph/store.h"
#include "graph/walk.h"
#include "num/decimal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Binding strength of an expression, and what an operand's place demands. */
enum { SUM = 1, SIGN = 2, PRODUCT = 3, POWER = 4, ATOM = 5 };
#define ADDEND 0 /* right of a plus: anything but a sign */

static const char *const symbol_of[AMBIT_OP_COUNT] = {
#define AMBIT_X(name, arity, symbol) symbol,
  AMBIT_OPS(AMBIT_X)
#undef AMBIT_X
};

static int strength(const ambit_node *x) {
  switch (x->op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB: return SUM;
  case AMBIT_OP_NEG: return SIGN;
  case AMBIT_OP_MUL:
  case AMBIT_OP_DIV: return PRODUCT;
  case AMBIT_OP_SQR:
  case AMBIT_OP_POWN: return POWER;
  case AMBIT_LEAF_CONSTANT:
    if (x->text) return strchr(x->text, '/') ? PRODUCT : ATOM;
    return x->value.lo == x->value.hi && x->value.lo < 0 ? SIGN : ATOM;
  default: return ATOM;
  }
}

#define LEAF_MAX (3 * AMBIT_DECIMAL_MAX)

/* The text of a leaf; `buffer` holds it if it has to be made. */
static const char *leaf_text(const ambit_node *x, ambit_expr e, char buffer[LEAF_MAX]) {
  if (x->text) return x->text;
  if (x->op == AMBIT_LEAF_UNKNOWN)
    snprintf(buffer, LEAF_MAX, "unknown%u", e);
  else if (x->value.lo == x->value.hi)
    ambit_decimal_shortest(buffer, x->value.lo);
  else
    ambit_decimal_interval(buffer, x->value, 3);
  return buffer;
}

/* A node is written as head, a, middle, b, tail; b only if it has two operands. */
typedef struct layout {
  char head[16], middle[16], tail[24];
  int place_a, place_b; /* what the operand has to bind as strongly as */
  bool two;
} layout;

static layout layout_of(const ambit_node *x) {
  layout l = { "", "", "", SUM, SUM, ambit_op_is_binary(x->op) };
  const char *symbol = symbol_of[x->op];
  switch (x->op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
    snprintf(l.middle, sizeof l.middle, " %s ", symbol);
    l.place_b = x->op == AMBIT_OP_SUB ? PRODUCT : ADDEND;
    break;
  case AMBIT_OP_NEG: snprintf(l.head, sizeof l.head, "-"), l.place_a = PRODUCT; break;
  case AMBIT_OP_MUL:
  case AMBIT_OP_DIV:
    snprintf(l.middle, sizeof l.middle, "%s", symbol);
    l.place_a = SIGN, l.place_b = x->op == AMBIT_OP_DIV ? POWER : PRODUCT;
    break;
  case AMBIT_OP_SQR: snprintf(l.tail, sizeof l.tail, "^2"), l.place_a = ATOM; break;
  case AMBIT_OP_POWN: snprintf(l.tail, sizeof l.tail, "^%d", (int)(int32_t)x->b), l.place_a = ATOM; break;
  default:
    snprintf(l.head, sizeof l.head, "%s(", symbol);
    snprintf(l.middle, sizeof l.middle, ", ");
    snprintf(l.tail, sizeof l.tail, ")");
  }
  return l;
}

static size_t plus(size_t a, size_t b) { return a < SIZE_MAX - b ? a + b : SIZE_MAX; }

static bool needs_bracket(const ambit_node *x, int place) {
  int s = strength(x);
  return place == ADDEND ? s == SIGN : s < place;
}

static size_t operand_length(const ambit_graph *g, ambit_expr e, size_t length, int place) {
  return needs_bracket(ambit_at(g, e), place) ? plus(length, 2) : length;
}

static size_t full_length(const ambit_graph *g, ambit_expr e) {
  ambit_walk walk;
  if (!ambit_walk_open(g, 1, &e, NULL, &walk)) return 0;
  size_t *length = malloc(walk.count * sizeof *length), total = 0;
  char buffer[LEAF_MAX];
  for (size_t i = 0; i < walk.count && length; i++) {
    const ambit_node *x = ambit_at(g, walk.node[i]);
    if (ambit_op_is_leaf(x->op)) {
      total = length[i] = strlen(leaf_text(x, walk.node[i], buffer));
      continue;
    }
    layout l = layout_of(x);
    total = plus(strlen(l.head) + strlen(l.tail), operand_length(g, x->a, length[walk.a[i]], l.place_a));
    if (l.two) total = plus(plus(total, strlen(l.middle)), operand_length(g, x->b, length[walk.b[i]], l.place_b));
    length[i] = total;
  }
  free(length);
  ambit_walk_close(&walk);
  return total;
}

/* What is left to write: operand e in a place (stage 0), or the rest of node e from its middle (1) or tail (2). */
typedef struct piece {
  ambit_expr e;
  int place, stage;
} piece;

#define CLOSE_BRACKET 3

typedef struct printer {
  const ambit_graph *g;
  char *out;
  size_t room, used; /* used < room */
  piece *stack;
  size_t depth, capacity;
} printer;

static void put(printer *p, const char *text) {
  size_t n = strlen(text), space = p->room - 1 - p->used;
  if (n > space) n = space;
  memcpy(p->out + p->used, text, n);
  p->used += n;
}

static bool later(printer *p, ambit_expr e, int place, int stage) {
  piece *stack = ambit_vector_reserve(p->stack, &p->capacity, p->depth + 1, sizeof *stack);
  if (!stack) return false;
  p->stack = stack;
  stack[p->depth++] = (piece) { e, place, stage };
  return true;
}

static bool put_operand(printer *p, piece now) {
  const ambit_node *x = ambit_at(p->g, now.e);
  char buffer[LEAF_MAX];
  bool bracket = needs_bracket(x, now.place);
  if (bracket) put(p, "(");
  if (bracket && !later(p, now.e, 0, CLOSE_BRACKET)) return false;
  if (ambit_op_is_leaf(x->op)) {
    put(p, leaf_text(x, now.e, buffer));
    return true;
  }
  layout l = layout_of(x);
  put(p, l.head);
  return later(p, now.e, 0, l.two ? 1 : 2) && later(p, x->a, l.place_a, 0);
}

static bool put_piece(printer *p, piece now) {
  if (now.stage == 0) return put_operand(p, now);
  if (now.stage == CLOSE_BRACKET) {
    put(p, ")");
    return true;
  }
  const ambit_node *x = ambit_at(p->g, now.e);
  layout l = layout_of(x);
  put(p, now.stage == 1 ? l.middle : l.tail);
  return now.stage == 2 || (later(p, now.e, 0, 2) && later(p, x->b, l.place_b, 0));
}

size_t ambit_graph_text(const ambit_graph *g, ambit_expr e, char *out, size_t room) {
  if (room > 0) {
    printer p = { .g = g, .out = out, .room = room };
    bool going = later(&p, e, SUM, 0);
    while (going && p.depth > 0 && p.used < room - 1) going = put_piece(&p, p.stack[--p.depth]);
    out[p.used] = '\0';
    free(p.stack);
  }
  return full_length(g, e);
}
