/* system.h -- a first-order system x' = f(x, u, t) as expressions, whatever it came from.
**
** Invariants come from closed loops and unit quaternions. Who starts the system promises that they vanish at the start
** (an initial set may be wider: then what is proved holds for the part of it on which they vanish).
*/
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
  size_t ninvariant;
  const ambit_expr *invariant; /* [ninvariant] g(x, t), zero along every solution that starts with g = 0; see below */
  const char *const *invariant_name; /* [ninvariant] "close: row 1", for messages */
} ambit_system;
#endif
