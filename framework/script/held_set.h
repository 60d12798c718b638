/* held_set.h -- the set at the end of a run, kept as the function of its unknowns that the solver gave (ambit_set), so
** that a run can be continued without losing what the states have in common.
*/
#ifndef AMBIT_LUA_HELD_SET_H
#define AMBIT_LUA_HELD_SET_H
#include "graph/collect.h"
#include <ambit/graph.h>
#include <ambit/solver.h>
#include <stdbool.h>

typedef struct ambit_held_set {
  ambit_holder holder; /* of `unknown` */
  size_t nu;
  ambit_expr *unknown; /* [nu] what the solver's unknowns are */
  ambit_set set;       /* nterm == 0: none is held */
  double *number;      /* about, scale, coefficient, rest */
  uint32_t *exponent;
  size_t room_number, room_exponent;
} ambit_held_set;

/* The unknowns of the sets to come, nodes of g; false: out of memory. */
bool ambit_held_set_begin(ambit_held_set *held, ambit_graph *g, size_t nu, const ambit_expr *unknown);
/* Takes over the set of a record, or holds none; false: out of memory. */
bool ambit_held_set_put(ambit_held_set *held, uint32_t nx, const ambit_set *set);
void ambit_held_set_clear(ambit_held_set *held);
/* What they hold, of one graph; each stays in its place among the graph's holders. */
void ambit_held_set_swap(ambit_held_set *a, ambit_held_set *b);
/* x[i] := state i as an expression of the same unknowns and of a fresh one for its rest; NO_EXPR: out of memory. */
void ambit_held_set_express(const ambit_held_set *held, ambit_graph *g, size_t nx, ambit_expr *x);
#endif
