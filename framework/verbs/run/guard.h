/* guard.h -- the sink between a flow solver and the receiver of its records.
**
** The kernel trusts no record blindly: a NaN or reversed bound, a gap in time or a run that claims to be complete
** without having reached the end makes the outcome `broken`, never `complete`.
*/
#ifndef AMBIT_GUARD_H
#define AMBIT_GUARD_H
#include <ambit/status.h>
#include <ambit/solver.h>
#include <stdbool.h>

typedef struct ambit_guard {
  ambit_sink sink; /* first: what the solver sees */
  ambit_sink *outer;
  uint32_t nx, steps;
  double clock_error;
  double direction, reached, end; /* +1 or -1; end of the last step, where the run shall end, s */
  bool stopped;
  char broken[160];        /* what was wrong with a record, or "" */
  const char *broken_code; /* and its code */
} ambit_guard;

ambit_guard ambit_guard_make(const ambit_problem *p, ambit_sink *outer); /* outer may be NULL */

/* The outcome from what the solver said and what the guard saw; also in `why`, with code and message (none if all went
** well). own: the failure that the solver left. */
ambit_status ambit_guard_judge(
    const ambit_guard *g, ambit_status said, const char *solver, const ambit_failure *own, ambit_failure *why);
/* The same for one that could not go on: `fallback` if it left no message. */
ambit_status ambit_guard_explain(
    ambit_status said, const char *solver, const ambit_failure *own, const char *fallback, ambit_failure *why);
#endif
