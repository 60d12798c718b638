/* store.h -- the graph's node store, seen by the files of this folder that make or fold nodes.
**
** ambit_store_make enters a node as it is, without any rule: the one way in for operations. Everything above it
** (fold.h) rewrites.
*/
#ifndef AMBIT_STORE_H
#define AMBIT_STORE_H
#include "graph/graph.h"
#include "graph/kink.h"

typedef struct ambit_stored {
  ambit_node node;
  uint32_t hash;
  uint32_t angles; /* sines and cosines among the factors, saturating: less than 2 rules out all angle sums */
} ambit_stored;

typedef struct ambit_marks ambit_marks; /* of walk.c */

struct ambit_graph {
  ambit_stored *stored;
  size_t count, capacity;
  uint32_t *table; /* open addressing, linear probing; AMBIT_NO_EXPR = free */
  size_t table_size;
  ambit_arena *arena; /* texts */
  ambit_marks *marks;
  ambit_expr pi, time; /* AMBIT_NO_EXPR until asked for */
  ambit_kinks kinks;
  ambit_graph_tally tally;
  double sealing; /* s of CPU time that sealing tapes has taken */
};

#define AMBIT_ZERO 0u /* node numbers fixed by ambit_graph_open */
#define AMBIT_ONE 1u

/* A hash-consed operation; no rule is applied. a, b < count. POWN: b is the exponent. AMBIT_NO_EXPR: out of memory. */
ambit_expr ambit_store_make(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b);

/* An operation of the same kind as node e on other operands, by the folding rules; it keeps e's writer. */
ambit_expr ambit_store_rebuild(ambit_graph *g, ambit_expr e, ambit_expr a, ambit_expr b);

static inline const ambit_node *ambit_at(const ambit_graph *g, ambit_expr e) { return &g->stored[e].node; }
static inline bool ambit_op_is_binary(uint32_t op) {
  return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB || op == AMBIT_OP_MUL || op == AMBIT_OP_DIV || op == AMBIT_OP_ATAN2 ||
         op == AMBIT_OP_MIN || op == AMBIT_OP_MAX;
}
static inline bool ambit_op_is_leaf(uint32_t op) { return op >= AMBIT_LEAF_CONSTANT; }
static inline bool ambit_is_exact(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  return x->op == AMBIT_LEAF_CONSTANT && x->value.lo == x->value.hi;
}
/* Defined everywhere and never 0. exp has the lower bound 0, which it does not take. */
static inline bool ambit_is_nonzero(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  return x->total && (x->range.lo > 0 || x->range.hi < 0 || x->op == AMBIT_OP_EXP);
}
#endif
