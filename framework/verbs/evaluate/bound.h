/* bound.h -- expressions with the values of `at` put in, and the unknowns that are left. */
#ifndef AMBIT_BOUND_H
#define AMBIT_BOUND_H
#include <ambit/evaluate.h>

typedef struct ambit_bound {
  ambit_expr *expr; /* [nexpr] */
  size_t nunknown;
  ambit_expr *unknown; /* [nunknown] the inputs of the tape */
} ambit_bound;

/* All in the arena. INVALID: a symbol without a value (named). */
ambit_status ambit_bound_build(const ambit_evaluate_request *q, ambit_arena *arena, ambit_bound *b, ambit_failure *f);
#endif
