/* run.c -- from step to step, into the sink; and what a run that could not go on has to say. */
#include "lohner.h"
#include "shared/deliver.h"
#include <ambit/code.h>
#include <stdio.h>

#define FORGET 0.9 /* per step: how fast a state's size is forgotten */
#define BENT 0.5   /* by how much slopes may vary, relative, where first order says something */

/* -- records */

static int32_t emit(lohner *s, ambit_sink *sink) {
  const field *f = &s->field;
  const flow *phi = &s->flow;
  ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = phi->t,
    .t_to = phi->t_next,
    .nx = f->nx,
    .rigorous = 1,
    .lo = s->set.lo,
    .hi = s->set.hi,
    .tube_lo = phi->tube_lo,
    .tube_hi = phi->tube_hi,
    .order = phi->p };
  extras_grant(f, &s->set, phi, &s->extras, &r);
  double done = (phi->t_next - f->problem.time[0]) / (field_end(f) - f->problem.time[0]);
  return shared_deliver(sink, &r, done);
}

/* -- steps */

/* Where slopes vary over the set by as much as they are, there is no first order, and only midpoints count. */
static int explodes(const field *f, const set *x, double varies, double *limit, uint32_t *worst) {
  ambit_explosion e = AMBIT_EXPLOSION_START;
  for (uint32_t i = 0; i < f->nx; i++) {
    double linear = fabs(x->centre[i]);
    for (uint32_t j = 0; j < f->nc && varies <= BENT; j++) linear += fabs(x->column[(size_t)i * f->nc + j]);
    ambit_explosion_note(&e, i, x->hi[i] - x->lo[i], linear, &limit[i]);
  }
  *worst = e.worst;
  return ambit_explodes(&e);
}

/* 0: some state is too wide, or no number */
static int is_good(const field *f, const set *x, const flow *phi, const double *limit, double *size, uint32_t *worst) {
  for (uint32_t i = 0; i < f->nx; i++) {
    size[i] = larger(FORGET * size[i], larger(fabs(x->lo[i]), fabs(x->hi[i])));
    *worst = i;
    if (f->options.width_max != 0 && !(x->hi[i] - x->lo[i] <= limit[i])) return 0;
    if (!(x->lo[i] > -INFINITY && x->hi[i] < INFINITY && phi->tube_lo[i] > -INFINITY && phi->tube_hi[i] < INFINITY &&
            phi->tube_lo[i] <= phi->tube_hi[i]))
      return 0;
  }
  return 1;
}

/* One step: every solution from the set x at t is in x at t + h, with the same xi. Names are those of
** docs/numerics/lohner.md, a step; what is proved there is computed in this order. */
static enum why advance(lohner *s) {
  const field *f = &s->field;
  set *x = &s->set;
  slopes *S = &s->slopes;
  flow *phi = &s->flow;
  control *c = &s->control;
  enum why why = control_find_step(f, x, c, S, phi); /* 1 to 5: h, series over it, and that solutions exist */
  if (why != WHY_NOTHING) return why;
  extras_take_step(f, x, phi, &s->extras);
  slopes_choose(f, x, &c->sizes, phi, S); /* S, piece by piece, and M near it */
  set_move(f, x, phi, S);                 /* (3): phi(m) + M v + (S - M) v */
  set_hull(f, x);
  if (!constraint_cut(f, x, &S->pieces, &s->constraint)) return WHY_APART; /* (6) */
  double *limit = c->sizes.limit;
  if (f->options.width_max == 0 && explodes(f, x, S->varies, limit, &s->blamed)) return WHY_WIDE;
  if (!is_good(f, x, phi, limit, c->sizes.size, &s->blamed)) return WHY_WIDE;
  c->next += (uint32_t)c->at_instant;
  return WHY_NOTHING;
}

static enum why integrate(lohner *s, ambit_sink *sink) {
  const field *f = &s->field;
  control *c = &s->control;
  if (lohner_start(s) != WHY_NOTHING) return WHY_APART;
  while (c->next < f->problem.ntime) {
    enum why why = advance(s);
    if (why != WHY_NOTHING) return why;
    if (emit(s, sink)) return WHY_STOPPED;
    int hopeless = pace_is_hopeless(&f->options, s->set.t, field_end(f), c->guess, s->slopes.wide, &c->pace);
    if (hopeless && c->next < f->problem.ntime) return WHY_SHORT_STEPS;
  }
  return WHY_NOTHING;
}

static AMBIT_WORKER enum why work(lohner *s, ambit_sink *sink) {
  enum why why = integrate(s, sink);
  int no_step = why == WHY_CENTRE || why == WHY_BOX || why == WHY_NO_STEP;
  int ended = why == WHY_NOTHING || why == WHY_APART || why == WHY_STOPPED;
  s->kink = no_step ? lohner_kink(&s->field, &s->flow, why != WHY_NO_STEP) : NULL;
  s->constraint.lost = !ended && constraint_loses_rank(&s->field, &s->set, &s->constraint);
  return why;
}

/* -- reasons */

static double width(const lohner *s) {
  double most = 0;
  for (uint32_t i = 0; i < s->field.nx; i++) most = larger(most, s->set.radius[i]);
  return 2 * most;
}

static void say_rank(const lohner *s, size_t room, char *text) {
  text[0] = '\0';
  if (s->constraint.lost)
    snprintf(text, room, " (the constraints may lose rank here: `%s`)",
        s->field.problem.invariant_name[s->constraint.blamed]);
}

/* Only solutions on which the invariants vanish are claimed, and there are none. */
static ambit_status explain_apart(const lohner *s) {
  const char *name = s->field.problem.invariant_name[s->constraint.blamed];
  const ambit_host *h = s->field.host;
  if (s->flow.t_next == s->field.problem.time[0])
    return h->fail_code(h, AMBIT_DOMAIN, AMBIT_CODE_DOMAIN_CONSTRAINT,
        "the initial set does not meet the constraint `%s`: no initial state of it can satisfy it; correct the initial "
        "values",
        name);
  return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_CONSTRAINT,
      "at t = %.9g s no state of the enclosure satisfies the constraint `%s`: no initial state does, or the equations "
      "of motion do not keep it",
      s->flow.t_next, name);
}

static ambit_status explain_kink(const lohner *s) {
  return s->field.host->fail_code(s->field.host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_KINK,
      "at t = %.9g s the enclosure, up to %.3g wide, comes to the kink of %s, where Taylor series end; end before it, "
      "or "
      "leave out `solver`, so that one that crosses kinks is taken",
      s->flow.t, width(s), s->kink);
}

static ambit_status explain(const lohner *s, enum why why) {
  const ambit_host *h = s->field.host;
  double t = s->flow.t;
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
        "at t = %.9g s the right-hand side could not be expanded at the midpoint of the enclosure%s; end before it", t,
        rank);
  case WHY_BOX:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDEFINED,
        "at t = %.9g s the right-hand side could not be bounded over the enclosure, which is up to %.3g wide%s; split "
        "the initial set, or end before it",
        t, width(s), rank);
  case WHY_WIDE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_WIDTH,
        "the enclosure of `%s` grew wider than %.4g in the step from t = %.9g s%s; split the initial set, raise "
        "`pieces`, or allow more by `width_max`",
        s->field.problem.name[s->blamed], s->control.sizes.limit[s->blamed], t, rank);
  case WHY_SHORT_STEPS:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_SHORT_STEPS,
        "at t = %.9g s steps over an enclosure up to %.3g wide, now of %.3g s, are so short that the end is out of "
        "reach%s; split the initial set, raise `tolerance`, or give a `step_min` to go on",
        s->set.t, width(s), s->control.guess, rank);
  default:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_STEP,
        "at t = %.9g s no step of at least %.3g s could be proved, with an enclosure up to %.3g wide%s; split the "
        "initial set, lower `step_min` or raise `tolerance`",
        t, control_least_step(&s->field, t), width(s), rank);
  }
}

ambit_status lohner_run(void *self, ambit_sink *sink) {
  ambit_rounding outside = ambit_round_up();
  enum why why = work(self, sink);
  ambit_rounding_restore(outside);
  return explain(self, why);
}
