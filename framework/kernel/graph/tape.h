/* tape.h -- sealing: from expressions to a straight-line program of just the nodes that the outputs reach. */
#ifndef AMBIT_TAPE_BUILD_H
#define AMBIT_TAPE_BUILD_H
#include <ambit/graph.h>
#include <ambit/tape.h>

/* Flags of sealing besides AMBIT_TAPE_SERIES. KEEP: do not fold inexact constants (for arithmetics of higher
** precision). WRITE_FUNCTIONS, WRITE_PAIRS: write AMBIT_FUNCTIONS of one operand, of two, in other operations. */
#define AMBIT_SEAL_KEEP 0x10000u
#define AMBIT_SEAL_WRITE_FUNCTIONS 0x20000u
#define AMBIT_SEAL_WRITE_PAIRS 0x40000u

/* Inputs are leaves, in this order; a reached leaf that is not among them, or among them twice, is INVALID and named.
** The tape lives in the arena and needs the graph no longer. The first ntime_varying inputs count as functions of time
** for `degree` (TIME itself: degree 1). */
ambit_status ambit_tape_seal(ambit_graph *g, ambit_arena *arena, size_t nout, const ambit_expr *out, size_t nin,
    const ambit_expr *in, size_t nvarying, uint32_t flags, const ambit_tape **tape, ambit_failure *f);
#endif
