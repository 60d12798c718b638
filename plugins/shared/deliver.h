/* deliver.h -- a record into the sink from code that rounds upward: the sink's world is round-to-nearest. */
#ifndef SHARED_DELIVER_H
#define SHARED_DELIVER_H
#include <ambit/rounding.h>
#include <ambit/solver.h>

/* r: NULL if there is only progress to tell. share: of the run that is done, cut to [0, 1]. Nonzero: stop. */
static AMBIT_WORKER int32_t shared_deliver(ambit_sink *sink, const ambit_record *r, double share) {
  ambit_rounding before = ambit_round_nearest();
  int32_t stop = r ? sink->emit(sink, r) : 0;
  if (!stop && sink->progress) stop = sink->progress(sink, share < 0 ? 0 : share > 1 ? 1 : share, NULL);
  ambit_rounding_restore(before);
  return stop;
}
#endif
