/* sample.h -- the verb `sample`: Monte Carlo in ordinary floating point. It proves nothing: the hull of what was
** drawn is an estimate from inside, which a proved enclosure should contain up to rounding.
**
** Draws come from the box of the unknowns, which must be bounded: draw 0 is its midpoint, odd ones are random corners,
** even ones uniform over the inside. The same seed gives the same draws.
*/
#ifndef AMBIT_SAMPLE_H
#define AMBIT_SAMPLE_H
#include "model/evaluate.h"
#include "model/simulate.h"

/* Expressions, in the arithmetic of the request (NULL: "real"). out [nexpr]: hull of the finite values, empty if
** there was none; defined [nexpr] (may be NULL): how many draws gave one. */
ambit_status ambit_sample_expressions(const ambit_evaluate_request *q, size_t draws, uint64_t seed, ambit_interval *out,
    size_t *defined, ambit_report *report, ambit_failure *f);

typedef struct ambit_sample_result {
  ambit_status status;  /* OK, or STOPPED by the sink's progress() */
  size_t draws, failed; /* made; of these did not reach the end (their hulls count up to there) */
  char reason[1024];    /* of the first that failed, or "" */
  double cpu_seconds;
} ambit_sample_result;

/* A system: the request's solver (NULL: "gsl") integrates every draw to the request's times; its sink sees
** progress() only. out [ntime * nx]: hull of state i at time[k] at k*nx + i, empty if no draw reached it. */
ambit_status ambit_sample_system(const ambit_simulate_request *q, size_t draws, uint64_t seed, ambit_interval *out,
    ambit_sample_result *result, ambit_report *report, ambit_failure *f);
#endif
