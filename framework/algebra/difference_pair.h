/* difference_pair.h -- pairs of expressions whose difference is wanted, seen by the files difference*.c.
**
** A pair (u, w) stands for u(x) - w(x - d). Planning a pair lists the links it is made of: pairs further down, which
** are solved first, and expressions that stand alone. Solving then writes the formula.
*/
#ifndef AMBIT_DIFFERENCE_PAIR_H
#define AMBIT_DIFFERENCE_PAIR_H
#include "graph/fold.h"

#define AMBIT_NO_PAIR UINT32_MAX

typedef enum { PAIR_NEW, PAIR_PLAIN, PAIR_RULE, PAIR_SUM, PAIR_PRODUCT, PAIR_SOLVED } ambit_pair_state;

/* One part of a pair. pair == AMBIT_NO_PAIR: only u (w is AMBIT_NO_EXPR) or only w (u is). In a sum u counts cu times
** and w cw times; they differ only if u == w. */
typedef struct ambit_pair_link {
  uint32_t pair;
  ambit_expr u, w;
  double cu, cw;
} ambit_pair_link;

typedef struct ambit_pair {
  ambit_expr u, w, result; /* result: once it is solved */
  ambit_pair_state state;
  size_t first, count; /* its links */
} ambit_pair;

typedef struct ambit_pairs {
  ambit_graph *g;
  bool clamps;         /* kinks: within what their operands can make of them */
  size_t nodes;        /* that the graph had at the start */
  ambit_expr *shifted; /* [nodes] of everything below u and w: the same at x - d */
  ambit_pair *pair;
  size_t npair, pair_capacity;
  ambit_pair_link *link;
  size_t nlink, link_capacity;
  uint32_t *table; /* open addressing: pairs by (u, w) */
  size_t table_size;
} ambit_pairs;

/* The pair (u, w), made if it is new; AMBIT_NO_PAIR: out of memory. */
uint32_t ambit_pairs_find(ambit_pairs *p, ambit_expr u, ambit_expr w);
bool ambit_pairs_link(ambit_pairs *p, ambit_pair_link link);

/* Lists the links of a pair. False: out of memory. */
bool ambit_pair_plan(ambit_pairs *p, uint32_t at);
/* The formula of a planned pair of which all linked pairs are solved. AMBIT_NO_EXPR: out of memory. */
ambit_expr ambit_pair_solve(ambit_pairs *p, const ambit_pair *pair);

static inline ambit_expr ambit_shifted(const ambit_pairs *p, ambit_expr e) { return p->shifted[e]; }
/* Does e change with d? */
static inline bool ambit_moves(const ambit_pairs *p, ambit_expr e) { return p->shifted[e] != e; }
#endif
