/* fold_items.c -- looking into a tree of sums or products from its root, to a bounded depth.
**
** Sums are kept as they were written (the operands of each node in canonical order): flattening them would cost the
** sharing of partial sums. Rules that need two terms, such as x - x -> 0, look for the partner among the last few.
*/
#include "graph/fold.h"

typedef struct search {
  const ambit_graph *g;
  uint32_t op;
  size_t room, count;
  ambit_item *item;
} search;

static void collect(search *s, ambit_item at) {
  if (s->count == s->room) return;
  const ambit_node *x = ambit_at(s->g, at.e);
  bool sum = s->op == AMBIT_OP_ADD, deeper = at.depth < AMBIT_ITEM_DEPTH;
  bool pair = x->op == s->op || (sum && x->op == AMBIT_OP_SUB), minus = sum && x->op == AMBIT_OP_NEG;
  if (!deeper || !(pair || minus)) {
    s->item[s->count++] = at;
    return;
  }
  bool flips = x->op == AMBIT_OP_SUB;
  if (pair) collect(s, (ambit_item) { x->b, at.negative != flips, at.path | 1u << at.depth, at.depth + 1 });
  collect(s, (ambit_item) { x->a, at.negative != minus, at.path, at.depth + 1 });
}

size_t ambit_fold_items(const ambit_graph *g, uint32_t op, ambit_expr e, size_t room, ambit_item *item) {
  search s = { g, op, room, 0, item };
  collect(&s, (ambit_item) { .e = e });
  return s.count;
}

static ambit_expr rebuild(ambit_graph *g, uint32_t op, ambit_expr e, const ambit_item *item, uint32_t depth) {
  if (e == AMBIT_NO_EXPR || depth == item->depth) return op == AMBIT_OP_MUL ? AMBIT_ONE : AMBIT_ZERO;
  const ambit_node x = *ambit_at(g, e);
  bool right = item->path >> depth & 1u;
  ambit_expr rest = rebuild(g, op, right ? x.b : x.a, item, depth + 1);
  if (x.op == AMBIT_OP_NEG) return ambit_fold_negate(g, rest);
  ambit_expr a = right ? x.a : rest, b = right ? rest : x.b;
  return op == AMBIT_OP_MUL ? ambit_fold_multiply(g, a, b) : ambit_fold_join(g, a, b, x.op == AMBIT_OP_SUB);
}

ambit_expr ambit_fold_without(ambit_graph *g, uint32_t op, ambit_expr e, const ambit_item *item) {
  return rebuild(g, op, e, item, 0);
}
