/* run.c -- from step to step, into the sink; and what a run that could not go on has to say. */
#include "lohner.h"

#define FORGET 0.9 /* per step: how fast a state's size is forgotten */

/* -- records */

/* the sink's world is round-to-nearest */
static AMBIT_WORKER int32_t deliver(ambit_sink *sink, const ambit_record *r, double done) {
  ambit_rounding up = ambit_round_nearest();
  int32_t stop = sink->emit(sink, r);
  if (!stop && sink->progress) stop = sink->progress(sink, done, NULL);
  ambit_rounding_restore(up);
  return stop;
}

static int32_t emit(const lohner *s, ambit_sink *sink, double t_from) {
  const ambit_problem *p = &s->problem;
  const ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = t_from,
    .t_to = s->t,
    .nx = s->nx,
    .rigorous = 1,
    .lo = s->lo,
    .hi = s->hi,
    .tube_lo = s->tube_lo,
    .tube_hi = s->tube_hi,
    .order = s->options.order };
  double done = (s->t - p->time[0]) / (p->time[p->ntime - 1] - p->time[0]);
  return deliver(sink, &r, smaller(larger(done, 0), 1));
}

/* -- steps */

static int is_good(const lohner *s, uint32_t i) {
  return s->hi[i] - s->lo[i] <= s->limit[i] && s->lo[i] > -INFINITY && s->hi[i] < INFINITY &&
         s->tube_lo[i] > -INFINITY && s->tube_hi[i] < INFINITY && s->tube_lo[i] <= s->tube_hi[i];
}

static enum why advance(lohner *s) {
  enum why why = lohner_find_step(s);
  if (why != WHY_NOTHING) return why;
  lohner_tube(s);
  lohner_pieces(s);
  lohner_move(s);
  lohner_hull(s);
  for (uint32_t i = 0; i < s->nx; i++) {
    s->size[i] = larger(FORGET * s->size[i], larger(fabs(s->lo[i]), fabs(s->hi[i])));
    s->culprit = i;
    if (!is_good(s, i)) return WHY_WIDE;
  }
  s->t = s->t_next;
  s->next += (uint32_t)s->at_instant;
  return WHY_NOTHING;
}

static AMBIT_WORKER enum why integrate(lohner *s, ambit_sink *sink) {
  lohner_start(s);
  while (s->next < s->problem.ntime) {
    double t_from = s->t;
    enum why why = advance(s);
    if (why != WHY_NOTHING) return why;
    if (emit(s, sink, t_from)) return WHY_STOPPED;
  }
  return WHY_NOTHING;
}

/* -- reasons */

static double width(const lohner *s) {
  double most = 0;
  for (uint32_t i = 0; i < s->nx; i++) most = larger(most, s->radius[i]);
  return 2 * most;
}

static ambit_status explain(const lohner *s, enum why why) {
  const ambit_host *h = s->host;
  switch (why) {
  case WHY_NOTHING: return AMBIT_OK;
  case WHY_STOPPED: return AMBIT_STOPPED;
  case WHY_CENTRE:
    return h->fail(h, AMBIT_UNABLE,
        "at t = %.9g s the right-hand side is not defined, not smooth or too large at the midpoint of the enclosure; "
        "end before it",
        s->t);
  case WHY_BOX:
    return h->fail(h, AMBIT_UNABLE,
        "at t = %.9g s the enclosure, up to %.3g wide, reaches a point where the right-hand side is not defined, not "
        "smooth or too large; "
        "split the initial set, or end before it",
        s->t, width(s));
  case WHY_WIDE:
    return h->fail(h, AMBIT_UNABLE,
        "the enclosure of `%s` grew wider than %.4g in the step from t = %.9g s; split the initial set, raise "
        "`pieces`, "
        "or allow more by "
        "`width_max`",
        s->problem.name[s->culprit], s->limit[s->culprit], s->t);
  default:
    return h->fail(h, AMBIT_UNABLE,
        "at t = %.9g s no step of at least %.3g s could be proved, with an enclosure up to %.3g wide: a solution may "
        "escape or leave "
        "the domain of the right-hand side near here; if not, split the initial set, lower `step_min` or raise "
        "`tolerance`",
        s->t, s->options.step_min, width(s));
  }
}

ambit_status lohner_run(void *self, ambit_sink *sink) {
  ambit_rounding outside = ambit_round_up();
  enum why why = integrate(self, sink);
  ambit_rounding_restore(outside);
  return explain(self, why);
}
