/* sample_error.h -- how far the values of a sample of a system are off: an estimate.
**
** The middle of the data and the draws that gave the extremes are integrated once more, and then with a hundredth of
** the tolerances and steps no longer than a 128th of the whole time: with tolerances alone, both runs would
** take the same long steps over a short pulse, or where all is below `absolute`. What that changes is nearly the error
** of the first values, if the method still gains from shorter steps; ten times that is told, since the error of other
** draws may be larger. Where lanes lost draws, values of `gsl` count too, in all that was said.
*/
#ifndef AMBIT_SAMPLE_ERROR_H
#define AMBIT_SAMPLE_ERROR_H
#include "verbs/sample/sample_extremes.h"
#include "verbs/sample/sample_flow.h"

typedef struct ambit_sample_error {
  ambit_flow *flow;               /* its tolerances are tighter afterwards */
  size_t draws;                   /* of the sample: no more than these are made again, one by one a tenth of them */
  const ambit_extremes *extremes; /* the last ones count first */
  const ambit_interval *hull;     /* [ntime * nx] of the sample */
  int32_t (*pause)(void *user);   /* nonzero: stop */
  void *user;
} ambit_sample_error;

/* The part of a hull that its error leaves, rounded inward; if it leaves nothing, the middle, and *error becomes how
** far it may be from all that was drawn. An error that is not known leaves all. */
ambit_interval ambit_sample_sure(ambit_interval hull, double *error);
/* error [ntime * nx]: of state i at time[k] at k * nx + i; NaN where nothing is known. OK, NOMEM, or STOPPED by
** `pause`: then it is NaN. */
ambit_status ambit_sample_estimate_error(const ambit_sample_error *q, ambit_arena *arena, double *error);
#endif
