/* store.h -- the graph's node store, seen by the files of this folder that make or fold nodes.
**
** ambit_store_make enters a node as it is, without any rule: the one way in for operations. Everything above it
** (fold.h) rewrites.
*/
#ifndef AMBIT_STORE_H
#define AMBIT_STORE_H
#include "graph/collect.h"
#include <ambit/graph.h>
#include "graph/kink.h"
#include "graph/symbols.h"
#include "num/function.h"
#include <stdlib.h>

typedef struct ambit_stored {
  ambit_node node;
  uint32_t hash;
  uint32_t angles; /* sines and cosines among the factors, saturating: less than 2 rules out all angle sums */
  uint32_t height; /* operations on the longest way down to a leaf */
  uint32_t mark;   /* collect.c: the collection that last reached the node */
  uint64_t birth;  /* leaf: its place in the order of leaves, see order.c */
} ambit_stored;

typedef struct ambit_marks ambit_marks; /* of walk.c */

struct ambit_graph {
  ambit_stored *stored;
  size_t count, capacity; /* node numbers in use or in the list of unused ones */
  ambit_expr unused;      /* first number of that list, the next one in its node.a; AMBIT_NO_EXPR ends */
  uint32_t *table;        /* open addressing, linear probing; AMBIT_NO_EXPR = free */
  size_t table_size;
  ambit_marks *marks;
  ambit_symbols symbols;
  ambit_expr pi, time;   /* AMBIT_NO_EXPR until asked for */
  uint64_t made, births; /* nodes, leaves ever made */
  bool has_functions;    /* was one of AMBIT_FUNCTIONS ever made? */
  const char *maker;     /* who writes formulas, see kink.h, or NULL */
  ambit_graph_tally tally;
  double sealing; /* s of CPU time that sealing tapes has taken */
  /* collect.c */
  ambit_holder *holders;
  uint32_t living, collection; /* nodes; number of the newest collection */
  size_t due;                  /* so many living nodes are worth a collection */
  uint64_t collected_at;       /* `made` at the newest collection */
  uint64_t forced;             /* collect once so many nodes have been made, and never use a number again; 0: not so */
  bool mark_failed;
  ambit_expr *to_mark;
  size_t to_mark_count, to_mark_capacity;
};

#define AMBIT_ZERO 0u /* node numbers fixed by ambit_graph_open */
#define AMBIT_ONE 1u

/* A hash-consed operation; no rule is applied. a, b < count. POWN: b is the exponent. AMBIT_NO_EXPR: out of memory. */
ambit_expr ambit_store_make(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b);

/* The order of expressions, which depends on what they say and on the order in which their leaves were made, never on
** node numbers: negative, 0 (the same node) or positive. */
int ambit_store_order(const ambit_graph *g, ambit_expr a, ambit_expr b);

void ambit_store_clear(ambit_stored *x); /* frees the texts of a node: it is none any more */
void ambit_store_tidy(ambit_graph *g);   /* after nodes have been cleared: the table, and memory that is not needed */

/* An operation of the same kind as node e on other operands, by the folding rules; it keeps e's writer. */
ambit_expr ambit_store_rebuild(ambit_graph *g, ambit_expr e, ambit_expr a, ambit_expr b);

static inline const ambit_node *ambit_at(const ambit_graph *g, ambit_expr e) { return &g->stored[e].node; }
/* Where tests collect always: nobody may come with the number of a freed node. */
static inline void ambit_store_expect(const ambit_graph *g, ambit_expr e) {
  if (g->forced && ambit_at(g, e)->op == AMBIT_LEAF_NONE) abort();
}
static inline bool ambit_op_is_binary(uint32_t op) { return ambit_op_arity(op) == 2; }
static inline bool ambit_op_is_leaf(uint32_t op) { return op >= AMBIT_LEAF_CONSTANT; }
static inline bool ambit_is_exact(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  return x->op == AMBIT_LEAF_CONSTANT && x->value.lo == x->value.hi;
}
/* Defined everywhere and never 0. exp and its like have the lower bound 0, which they do not
** take. */
static inline bool ambit_is_nonzero(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  bool positive = x->op == AMBIT_OP_EXP || (ambit_op_is_function(x->op) && ambit_function_of(x->op)->positive);
  return x->total && (x->range.lo > 0 || x->range.hi < 0 || positive);
}
#endif
