/* reduction_build.h -- from expressions and references to what a solver of reductions reads. */
#ifndef AMBIT_MODEL_REDUCTION_BUILD_H
#define AMBIT_MODEL_REDUCTION_BUILD_H
#include "verbs/reduce/reduction.h"

/* Everything but prove, rank, tried and user, in the arena. INVALID: f says what is wrong with the request. */
ambit_status ambit_reduction_build(
    const ambit_reduction_request *q, uint32_t want, ambit_arena *arena, ambit_reduction *r, ambit_failure *f);
#endif
