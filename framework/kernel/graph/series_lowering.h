/* series_lowering.h -- expressions in the opcodes that a SERIES tape may hold (ambit/tape.h). */
#ifndef AMBIT_SERIES_LOWERING_H
#define AMBIT_SERIES_LOWERING_H
#include <ambit/graph.h>

/* Will sealing write the node as a constant? */
bool ambit_tape_folds(const ambit_graph *g, ambit_expr e);

/* root [nroot]: the outputs, rewritten as the flags of sealing say, then the helpers that nodes of a SERIES tape need.
** The caller frees root. */
ambit_status ambit_series_lower(ambit_graph *g, size_t nout, const ambit_expr *out, uint32_t flags, ambit_expr **root,
    size_t *nroot, ambit_failure *f);
/* e[i] rewritten such that a / (1 + exp v) is bounded where exp v is too large for a double, and derivatives are, too;
** false: out of memory */
bool ambit_series_bound(ambit_graph *g, size_t n, ambit_expr *e);
/* AMBIT_FUNCTIONS below e[0..n) written in other operations, in place; false: out of memory. */
bool ambit_functions_write(ambit_graph *g, size_t n, ambit_expr *e);
/* The node whose slot is the `aux` of node e; AMBIT_NO_EXPR: e needs none, or out of memory. */
ambit_expr ambit_series_helper(ambit_graph *g, ambit_expr e);
#endif
