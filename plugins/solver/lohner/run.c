/* run.c -- from step to step, into the sink; and what a run that could not go on has to say.
**
** The whole run is in upward mode; the sink is called in the mode that the run was called in.
*/
#include "lohner.h"

#define FORGET 0.9 /* per step: how fast a state's size is forgotten */

static int32_t emit(lohner *s, ambit_sink *sink, double t_from, ambit_rounding outside) {
  const ambit_problem *p = &s->problem;
  ambit_record r = { .size = sizeof r, .kind = AMBIT_REC_STEP, .t_from = t_from, .t_to = s->t, .nx = s->nx, .rigorous = 1,
    .lo = s->lo, .hi = s->hi, .tube_lo = s->tube_lo, .tube_hi = s->tube_hi, .order = s->options.order };
  double done = (s->t - p->time[0]) / (p->time[p->ntime - 1] - p->time[0]);
  ambit_rounding up = ambit_rounding_swap(outside);
  int32_t stop = sink->emit(sink, &r);
  if (!stop && sink->progress) stop = sink->progress(sink, done, NULL);
  ambit_rounding_restore(up);
  return stop;
}
