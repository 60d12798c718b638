/* implicit.h -- a system in implicit form, as a solver gets it. */
#ifndef AMBIT_MODEL_IMPLICIT_H
#define AMBIT_MODEL_IMPLICIT_H
#include <ambit/system.h>
#include <ambit/solver.h>

typedef struct ambit_implicit_request {
  ambit_graph *graph;
  const ambit_implicit_form *form; /* NULL: none, so that `e` has no equations */
  uint32_t nx, np, uses_time, seal;
  const ambit_expr *e;     /* [nx + na] F, R */
  const ambit_expr *input; /* [nx + np + uses_time] as of the right-hand side */
} ambit_implicit_request;

/* INVALID: not affine in the unknowns, stage by stage. */
ambit_status ambit_implicit_seal(
    const ambit_implicit_request *q, ambit_arena *arena, const ambit_implicit **implicit, ambit_failure *f);
#endif
