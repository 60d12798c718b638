/* approximate.h -- a tape in ordinary doubles, for estimates that prove nothing. */
#ifndef AMBIT_APPROXIMATE_H
#define AMBIT_APPROXIMATE_H
#include <ambit/tape.h>

/* slot[nslot] := values for the inputs in[nin]; NaN where an operation is not defined. */
void ambit_approximate(const ambit_tape *t, const double *in, double *slot);
#endif
