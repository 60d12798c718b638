/* invariant.h -- linear invariants of a tape's outputs, exact. */
#ifndef STIFF_INVARIANT_H
#define STIFF_INVARIANT_H
#include <ambit/tape.h>

#define INVARIANT_LARGEST 1e6 /* of integers: products of two are exact */

/* How many integer w [at most nx x nx] with sum_i w_i out_i = 0 were found; rows [nx x (nslot + nx)] is scratch. */
uint32_t invariant_find(const ambit_tape *t, uint32_t nx, double *rows, double *w);
#endif
