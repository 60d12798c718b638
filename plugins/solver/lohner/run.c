/* run.c -- from step to step, into the sink; and what a run that could not go on has to say. */
#include "lohner.h"
#include "shared/deliver.h"
#include <ambit/code.h>
#include <stdio.h>

#define FORGET 0.9 /* per step: how fast a state's size is forgotten */
#define BENT 0.5   /* by how much slopes may vary, relative, where first order says something */

/* -- records */

static int32_t emit(lohner *s, ambit_sink *sink, double t_from) {
  const ambit_problem *p = &s->problem;
  ambit_record r = { .size = sizeof r,
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
  lohner_grant(s, &r);
  double done = (s->t - p->time[0]) / (p->time[p->ntime - 1] - p->time[0]);
  return shared_deliver(sink, &r, done);
}

/* -- steps */

static int is_good(const lohner *s, uint32_t i) {
  int narrow = s->options.width_max == 0 || s->hi[i] - s->lo[i] <= s->limit[i];
  return narrow && s->lo[i] > -INFINITY && s->hi[i] < INFINITY && s->tube_lo[i] > -INFINITY &&
         s->tube_hi[i] < INFINITY && s->tube_lo[i] <= s->tube_hi[i];
}

/* Where slopes vary over the set by as much as they are, there is no first order, and only midpoints count. */
static int explodes(lohner *s) {
  ambit_explosion e = AMBIT_EXPLOSION_START;
  for (uint32_t i = 0; i < s->nx; i++) {
    double linear = fabs(s->centre[i]);
    for (uint32_t j = 0; j < s->nc && s->varies <= BENT; j++) linear += fabs(s->column[(size_t)i * s->nc + j]);
    ambit_explosion_note(&e, i, s->hi[i] - s->lo[i], linear, &s->limit[i]);
  }
  s->blamed = e.worst;
  return ambit_explodes(&e);
}

static enum why advance(lohner *s) {
  enum why why = lohner_find_step(s);
  if (why != WHY_NOTHING) return why;
  lohner_dense(s);
  lohner_pieces(s);
  lohner_move(s);
  lohner_hull(s);
  if (lohner_contract(s, s->t_next, s->pieces) != WHY_NOTHING) return WHY_APART;
  if (s->options.width_max == 0 && explodes(s)) return WHY_WIDE;
  for (uint32_t i = 0; i < s->nx; i++) {
    s->size[i] = larger(FORGET * s->size[i], larger(fabs(s->lo[i]), fabs(s->hi[i])));
    s->blamed = i;
    if (!is_good(s, i)) return WHY_WIDE;
  }
  s->t = s->t_next;
  s->next += (uint32_t)s->at_instant;
  return WHY_NOTHING;
}

static enum why integrate(lohner *s, ambit_sink *sink) {
  if (lohner_start(s) != WHY_NOTHING) return WHY_APART;
  while (s->next < s->problem.ntime) {
    double t_from = s->t;
    enum why why = advance(s);
    if (why != WHY_NOTHING) return why;
    if (emit(s, sink, t_from)) return WHY_STOPPED;
    if (lohner_steps_shrink(s) && s->next < s->problem.ntime) return WHY_SHORT_STEPS;
  }
  return WHY_NOTHING;
}

static AMBIT_WORKER enum why work(lohner *s, ambit_sink *sink) {
  enum why why = integrate(s, sink);
  s->kink = why == WHY_CENTRE || why == WHY_BOX || why == WHY_NO_STEP ? lohner_kink(s, why != WHY_NO_STEP) : NULL;
  s->constraint.lost = why != WHY_NOTHING && why != WHY_APART && why != WHY_STOPPED && lohner_loses_rank(s);
  return why;
}

/* -- reasons */

static double width(const lohner *s) {
  double most = 0;
  for (uint32_t i = 0; i < s->nx; i++) most = larger(most, s->radius[i]);
  return 2 * most;
}

static void say_rank(const lohner *s, size_t room, char *text) {
  text[0] = '\0';
  if (s->constraint.lost)
    snprintf(
        text, room, " (the constraints may lose rank here: `%s`)", s->problem.invariant_name[s->constraint.blamed]);
}

/* Only solutions on which the invariants vanish are claimed, and there are none. */
static ambit_status explain_apart(const lohner *s) {
  const char *name = s->problem.invariant_name[s->constraint.blamed];
  if (s->t == s->problem.time[0] && s->t_next == s->t)
    return s->host->fail_code(s->host, AMBIT_DOMAIN, AMBIT_CODE_DOMAIN_CONSTRAINT,
        "the initial set does not meet the constraint `%s`: no initial state of it can satisfy it; correct the initial "
        "values",
        name);
  return s->host->fail_code(s->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_CONSTRAINT,
      "at t = %.9g s no state of the enclosure satisfies the constraint `%s`: no initial state does, or the equations "
      "of motion do not keep it",
      s->t_next, name);
}

static ambit_status explain_kink(const lohner *s) {
  return s->host->fail_code(s->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_KINK,
      "at t = %.9g s the enclosure, up to %.3g wide, comes to the kink of %s, where Taylor series end; end before it, "
      "or "
      "leave out `solver`, so that one that crosses kinks is taken",
      s->t, width(s), s->kink);
}

static ambit_status explain(const lohner *s, enum why why) {
  const ambit_host *h = s->host;
  char rank[160];
  switch (why) {
  case WHY_NOTHING: return AMBIT_OK;
  case WHY_STOPPED: return AMBIT_STOPPED;
  case WHY_APART: return explain_apart(s);
  default: say_rank(s, sizeof rank, rank);
  }
  if (s->kink) return explain_kink(s);
  switch (why) {
  case WHY_CENTRE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDEFINED,
        "at t = %.9g s the right-hand side could not be expanded at the midpoint of the enclosure%s; end before it",
        s->t, rank);
  case WHY_BOX:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDEFINED,
        "at t = %.9g s the right-hand side could not be bounded over the enclosure, which is up to %.3g wide%s; split "
        "the initial set, or end before it",
        s->t, width(s), rank);
  case WHY_WIDE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_WIDTH,
        "the enclosure of `%s` grew wider than %.4g in the step from t = %.9g s%s; split the initial set, raise "
        "`pieces`, or allow more by `width_max`",
        s->problem.name[s->blamed], s->limit[s->blamed], s->t, rank);
  case WHY_SHORT_STEPS:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_SHORT_STEPS,
        "at t = %.9g s steps over an enclosure up to %.3g wide, now of %.3g s, are so short that the end is out of "
        "reach%s; split the initial set, raise `tolerance`, or give a `step_min` to go on",
        s->t, width(s), s->guess, rank);
  default:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_STEP,
        "at t = %.9g s no step of at least %.3g s could be proved, with an enclosure up to %.3g wide%s; split the "
        "initial set, lower `step_min` or raise `tolerance`",
        s->t, lohner_least_step(s), width(s), rank);
  }
}

ambit_status lohner_run(void *self, ambit_sink *sink) {
  ambit_rounding outside = ambit_round_up();
  enum why why = work(self, sink);
  ambit_rounding_restore(outside);
  return explain(self, why);
}
