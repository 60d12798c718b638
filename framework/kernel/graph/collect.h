/* collect.h -- nodes that nothing holds any more are freed.
**
** A node lives as long as a holder names it or a node above it. Holders are the structures that keep expressions beyond
** one call: expressions of Lua, mechanisms, systems, sets at the end of runs. Everything else (C code at work) may keep
** expressions only between two collections, and a collection happens only where somebody asks for it who knows that no
** such code is running (script/core.c). Nodes do not move; the numbers of freed nodes are given to new ones, so a
** number must not be kept without being held. No result depends on collections: no order of expressions depends on
** numbers (order.c), and the order of leaves is that of their making, which symbols keep beyond their nodes.
*/
#ifndef AMBIT_COLLECT_H
#define AMBIT_COLLECT_H
#include <ambit/graph.h>

#define AMBIT_COLLECT_LEAST 16384u /* fewer nodes are not worth a collection: about 2 MB */

/* Embedded in the structure that holds; `mark` calls ambit_graph_mark for all expressions that it keeps. */
typedef struct ambit_holder {
  void (*mark)(struct ambit_holder *self, ambit_graph *g);
  struct ambit_holder *next, **link; /* link: what points to this one; NULL: holds nothing */
} ambit_holder;

void ambit_graph_hold(ambit_graph *g, ambit_holder *holder);
void ambit_graph_release(ambit_holder *holder);                       /* also one that was never given to a graph */
void ambit_graph_mark(ambit_graph *g, size_t n, const ambit_expr *e); /* AMBIT_NO_EXPR is passed over */

/* Have enough nodes been made since the last collection that another one pays? Then the work of all collections
** together is proportional to the nodes made. */
bool ambit_graph_is_due(const ambit_graph *g);
void ambit_graph_collect(ambit_graph *g);  /* out of memory: everything stays */
void ambit_graph_hasten(ambit_graph *g);   /* one is due now */
void ambit_graph_postpone(ambit_graph *g); /* one was due, but could not be done */
/* For tests: one is due whenever so many nodes have been made, and the numbers of freed nodes are never used again:
** whoever goes on using one is found, and aborts. */
void ambit_graph_collect_always(ambit_graph *g, uint64_t nodes);
uint32_t ambit_graph_living(const ambit_graph *g); /* nodes */
#endif
