/* loops.h -- closed loops: where they are assembled, and which speeds are independent there. */
#ifndef AMBIT_LOOPS_H
#define AMBIT_LOOPS_H
#include "mechanics/constraints.h"
#include "mechanics/partition.h"

typedef struct ambit_loops {
  ambit_constraints constraints;
  ambit_partition partition;
  const double *reference; /* [nq] an assembled configuration, where pivots were chosen */
  size_t nfree;            /* independent speeds: numbers partition.independent[] */
} ambit_loops;

/* Where pivots are to be chosen: values of coordinates by name, and of "t" (else 0), replacing what was said before.
** And speeds, by the name of their coordinate or their own, that are to be independent. Names are checked when the
** loops are built. */
ambit_status ambit_loops_refer(
    ambit_mechanism *m, size_t n, const char *const *name, const double *value, ambit_failure *f);
ambit_status ambit_loops_choose(ambit_mechanism *m, size_t n, const char *const *name, ambit_failure *f);

/* INVALID: loops that cannot be closed from the reference, or are singular there; speeds that cannot be independent;
** the message names the loop. */
ambit_status ambit_loops_build(ambit_mechanism *m, ambit_arena *arena, ambit_loops *loops, ambit_failure *f);
#endif
