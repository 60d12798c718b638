/* partial.h -- which results of an evaluation hold for a part of the data only, and which operation is to blame.
**
** A result is partial if an operation that it depends on left its domain, as the arithmetic saw it, or if a constant or
** a datum that it depends on is itself known for a part only. Sound since each operation's own flag is: one that is not
** raised proves that the operation is defined for all values of its operands' enclosures.
*/
#ifndef AMBIT_PARTIAL_H
#define AMBIT_PARTIAL_H
#include "graph/interpreter.h"
#include "graph/tape.h"
#include "verbs/evaluate/bound.h"

typedef struct ambit_partial {
  ambit_graph *graph;
  ambit_arena *arena;
  const ambit_bound *bound;
  const ambit_tape *tape;
  ambit_block *block; /* has run; its results are lost */
  size_t nexpr;
  bool left;   /* running it, some operation left its domain */
  bool folded; /* the tape holds constants in place of operations on constants */
} ambit_partial;

/* May one of the results be partial at all? Cheap. */
bool ambit_partial_possible(const ambit_partial *p);
/* partial [nexpr] := 1 or 0; blame := "sqrt(x - 1) of joint_spring `knee`" for the first that is, or "". */
ambit_status ambit_partial_find(
    const ambit_partial *p, uint8_t *partial, char blame[AMBIT_BLAME_MAX], ambit_failure *f);
#endif
