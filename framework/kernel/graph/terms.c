/* terms.c -- what an expression consists of: its additive terms, its leaves, the number of its operations. */
#include "base/vector.h"
#include "graph/store.h"
#include "graph/walk.h"
#include <stdlib.h>

typedef struct signed_expr {
  ambit_expr e;
  bool negative;
} signed_expr;

static bool is_sum(uint32_t op) { return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_NEG; }
static bool stops_at_term(const ambit_graph *g, ambit_expr e) { return !is_sum(ambit_at(g, e)->op); }

/* How many there are: shared sums can make them exponentially many, so they are counted without being listed. */
static size_t count_terms(const ambit_graph *g, ambit_expr e) {
  ambit_walk walk;
  if (!ambit_walk_open(g, 1, &e, stops_at_term, &walk)) return 0;
  size_t *count = malloc(walk.count * sizeof *count), total = 0;
  for (size_t i = 0; i < walk.count && count; i++) {
    uint32_t op = ambit_at(g, walk.node[i])->op;
    size_t a = count[walk.a[i]], b = count[walk.b[i]];
    if (!is_sum(op))
      count[i] = 1;
    else if (op == AMBIT_OP_NEG)
      count[i] = a;
    else
      count[i] = a < SIZE_MAX - b ? a + b : SIZE_MAX;
    total = count[i];
  }
  free(count);
  ambit_walk_close(&walk);
  return total;
}

size_t ambit_graph_terms(const ambit_graph *g, ambit_expr e, size_t room, ambit_expr *term, bool *negative) {
  signed_expr *stack = NULL;
  size_t capacity = 0, depth = 0, written = 0;
  signed_expr now = { e, false };
  while (written < room) {
    const ambit_node *x = ambit_at(g, now.e);
    if (is_sum(x->op)) {
      if (x->op != AMBIT_OP_NEG) {
        signed_expr *grown = ambit_vector_reserve(stack, &capacity, depth + 1, sizeof *grown);
        if (!grown) break;
        stack = grown;
        stack[depth++] = (signed_expr) { x->b, now.negative != (x->op == AMBIT_OP_SUB) };
      }
      now = (signed_expr) { x->a, now.negative != (x->op == AMBIT_OP_NEG) };
      continue;
    }
    term[written] = now.e;
    negative[written++] = now.negative;
    if (depth == 0) break;
    now = stack[--depth];
  }
  free(stack);
  return count_terms(g, e);
}

typedef struct born {
  uint64_t birth;
  ambit_expr leaf;
} born;

static int by_birth(const void *p, const void *q) {
  const born *a = p, *b = q;
  return a->birth < b->birth ? -1 : a->birth > b->birth;
}

size_t ambit_graph_leaves(const ambit_graph *g, size_t ne, const ambit_expr *e, size_t room, ambit_expr *leaf) {
  ambit_walk walk;
  if (!ambit_walk_open(g, ne, e, NULL, &walk)) return 0;
  born *all = malloc((walk.count + 1) * sizeof *all);
  size_t n = 0;
  for (size_t i = 0; i < walk.count && all; i++) {
    const ambit_stored *x = &g->stored[walk.node[i]];
    if (ambit_op_is_leaf(x->node.op) && x->node.op != AMBIT_LEAF_CONSTANT) all[n++] = (born) { x->birth, walk.node[i] };
  }
  if (n > 0) qsort(all, n, sizeof *all, by_birth);
  for (size_t i = 0; i < n && i < room; i++) leaf[i] = all[i].leaf;
  free(all);
  ambit_walk_close(&walk);
  return n;
}

size_t ambit_graph_size(const ambit_graph *g, size_t ne, const ambit_expr *e) {
  ambit_walk walk;
  if (!ambit_walk_open(g, ne, e, NULL, &walk)) return 0;
  size_t n = 0;
  for (size_t i = 0; i < walk.count; i++) n += !ambit_op_is_leaf(ambit_at(g, walk.node[i])->op);
  ambit_walk_close(&walk);
  return n;
}
