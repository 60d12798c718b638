/* system.h -- a first-order system x' = f(x, u, t) as expressions, whatever it came from. */
#ifndef AMBIT_SYSTEM_H
#define AMBIT_SYSTEM_H
#include "graph/graph.h"

typedef struct ambit_system {
  ambit_graph *graph;
  size_t nx;
  const char *const *name; /* [nx] "beta1", "beta1'" */
  const char *const *unit; /* [nx] */
  const ambit_expr *state; /* [nx] symbols */
  const ambit_expr *rate;  /* [nx] right-hand sides; their unknowns are the uncertain parameters */
} ambit_system;
#endif
