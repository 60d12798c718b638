/* pivot.h -- can a pivot of the mass matrix be told from zero? */
#ifndef AMBIT_PIVOT_H
#define AMBIT_PIVOT_H
#include "graph/graph.h"

/* True if the enclosures of e at random points of its leaves all contain 0 (or say nothing): then e vanishes
** everywhere, but for an event of probability 0 or a matrix too ill-conditioned to be solved. Failures (memory) count
** as false.
*/
bool ambit_pivot_vanishes(ambit_graph *g, ambit_expr e);
#endif
