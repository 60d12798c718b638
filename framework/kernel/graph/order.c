/* order.c -- the canonical order of expressions.
**
** Two expressions are compared by their heights, then by what they are, then by their operands, the first that
** differ. Equal operands are equal nodes, so a comparison goes down one path only. Leaves are in the order in which
** they were made (constants with a value of their own by that value). Nothing depends on node numbers: a node that was
** collected and is made again comes to stand where it would have stood.
*/
#include "graph/store.h"
#include <string.h>

static int by_double(double x, double y) { return x < y ? -1 : x > y; }
static int by_word(uint64_t x, uint64_t y) { return x < y ? -1 : x > y; }

/* Points, then literals, then enclosures of numbers that nobody spelt. */
static uint32_t kind_of(const ambit_node *x) {
  if (x->op != AMBIT_LEAF_CONSTANT) return 3;
  return x->text ? 1 : x->value.lo == x->value.hi ? 0 : 2;
}

static int compare_leaves(const ambit_stored *p, const ambit_stored *q) {
  const ambit_node *x = &p->node, *y = &q->node;
  uint32_t k = kind_of(x), l = kind_of(y);
  if (k != l) return by_word(k, l);
  if (k >= 2) return by_word(p->birth, q->birth);
  int lower = by_double(x->value.lo, y->value.lo), upper = by_double(x->value.hi, y->value.hi);
  return lower ? lower : upper ? upper : k == 1 ? strcmp(x->text, y->text) : 0;
}

int ambit_store_order(const ambit_graph *g, ambit_expr a, ambit_expr b) {
  while (a != b) {
    const ambit_stored *p = &g->stored[a], *q = &g->stored[b];
    const ambit_node *x = &p->node, *y = &q->node;
    if (p->height != q->height) return by_word(p->height, q->height);
    if (ambit_op_is_leaf(x->op)) return compare_leaves(p, q);
    if (x->op != y->op) return by_word(x->op, y->op);
    if (x->a == y->a && x->op == AMBIT_OP_POWN) return (int32_t)x->b < (int32_t)y->b ? -1 : 1;
    bool first = x->a != y->a;
    a = first ? x->a : x->b;
    b = first ? y->a : y->b;
  }
  return 0;
}
