/* monotone.h -- tighter bounds where an expression is proved monotone in some of its unknowns. */
#ifndef AMBIT_MONOTONE_H
#define AMBIT_MONOTONE_H
#include <ambit/graph.h>
#include "verbs/run/context.h"

/* The expression over a box of unknowns, in an arithmetic that offers `gradient`. */
typedef struct ambit_monotone {
  ambit_graph *graph;
  const ambit_context *context; /* of nunknown variables */
  uint32_t seal;                /* flags of sealing */
  size_t nunknown;
  const ambit_expr *unknown; /* their values are the box */
  ambit_work *work;          /* what it does is added here */
} ambit_monotone;

/* *x, an enclosure of e over the box, is narrowed if derivatives of one sign allow it; never widened. */
ambit_status ambit_monotone_narrow(const ambit_monotone *m, ambit_expr e, ambit_interval *x, ambit_failure *f);
#endif
