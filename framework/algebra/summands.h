/* summands.h -- a sum as the list of its summands c * body, each body once.
**
** The summands of e are what its maximal tree of ADD, SUB and NEG has for leaves. How often a leaf occurs is counted on
** the nodes, not on the paths, so that shared partial sums cost nothing (x + x, doubled a thousand times, has one
** summand). Equal bodies are collected where the sum of their coefficients is exact, and vanish only where the body is
** total: the sum of the list is e on the domain of e, and is defined nowhere else.
*/
#ifndef AMBIT_SUMMANDS_H
#define AMBIT_SUMMANDS_H
#include "graph/fold.h"

typedef struct ambit_summands {
  size_t n, capacity;
  ambit_term *term; /* [n] in the order in which they are first met, left to right */
} ambit_summands;

static inline bool ambit_op_is_sum(uint32_t op) { return op == AMBIT_OP_ADD || op == AMBIT_OP_SUB; }

/* The summands of e. INVALID: a summand occurs so often that its coefficient is no double. list: closed by the caller
** in every case. */
ambit_status ambit_summands_read(const ambit_graph *g, ambit_expr e, ambit_summands *list, ambit_failure *f);
void ambit_summands_close(ambit_summands *list);
/* The expression c * body that is a summand. */
ambit_expr ambit_summand_expression(ambit_graph *g, ambit_term t);
/* The sum e, once read as n summands old[0..n), with value[0..n) instead: along the tree of e where every summand is in
** it once, otherwise from left to right. AMBIT_NO_EXPR: out of memory. */
ambit_expr ambit_summands_replace(
    ambit_graph *g, ambit_expr e, size_t n, const ambit_expr *old, const ambit_expr *value);
#endif
