/* run.c -- from step to step while there is one piece, then from instant to instant; and what a run that could not go
** on has to say. */
#include "flow.h"
#include "shared/deliver.h"
#include <ambit/code.h>
#include <stdio.h>

#define BLURRED 0.1     /* remainder, of the set's width, from which pieces must serve */
#define NEGLIGIBLE 1e-9 /* of the state's magnitude */

/* -- records; the sink's world is round-to-nearest */

static double done(const flow *f) {
  const double *time = f->problem.time;
  double share = (f->t - time[0]) / (time[f->problem.ntime - 1] - time[0]);
  return smaller(larger(share, 0), 1);
}

int32_t flow_ask(flow *f) { return shared_deliver(f->sink, NULL, done(f)); }

int32_t flow_emit(flow *f, double t_from, int dense) {
  ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = t_from,
    .t_to = f->t,
    .nx = f->nx,
    .rigorous = 1,
    .lo = f->lo,
    .hi = f->hi,
    .tube_lo = f->tube_lo,
    .tube_hi = f->tube_hi,
    .order = f->options.time_order };
  if (dense && f->dense) flow_describe(f, &r);
  if (dense && (f->problem.extras & AMBIT_EXTRA_SET)) r.set = flow_describe_set(f, &f->piece[0]);
  return shared_deliver(f->sink, &r, done(f));
}

static void clear_bounds(const flow *f, double *lo, double *hi) {
  for (uint32_t i = 0; i < f->nx; i++) lo[i] = INFINITY, hi[i] = -INFINITY;
}

/* the hull of all pieces; 0: too wide */
static int merge(flow *f) {
  clear_bounds(f, f->lo, f->hi), clear_bounds(f, f->tube_lo, f->tube_hi);
  for (uint32_t n = 0; n < f->npiece; n++)
    for (uint32_t i = 0; i < f->nx; i++) {
      const piece *p = &f->piece[n];
      f->lo[i] = smaller(f->lo[i], p->lo[i]), f->hi[i] = larger(f->hi[i], p->hi[i]);
      f->tube_lo[i] = smaller(f->tube_lo[i], p->tube_lo[i]), f->tube_hi[i] = larger(f->tube_hi[i], p->tube_hi[i]);
    }
  ambit_explosion e = AMBIT_EXPLOSION_START;
  for (uint32_t i = 0; i < f->nx; i++) {
    double width = f->hi[i] - f->lo[i], most = 0;
    f->piece[0].blamed = i, f->failed = 0;
    if (!(f->tube_lo[i] > -INFINITY && f->tube_hi[i] < INFINITY)) return 0;
    if (f->options.width_max > 0) {
      if (!(width <= f->limit[i])) return 0;
      continue;
    }
    for (uint32_t n = 0; n < f->npiece; n++)
      most = larger(most, polynomial_norm(&f->space, f->piece[n].x + i * f->space.size));
    ambit_explosion_note(&e, i, width, most, &f->limit[i]);
  }
  f->piece[0].blamed = e.worst;
  return !ambit_explodes(&e);
}

/* -- one piece */

/* is so much of the set remainder that pieces must do better? */
static int is_blurred(const flow *f, const piece *p) {
  const zonotope_shape *shape = &f->worker[0].shape;
  for (uint32_t i = 0; i < f->nx; i++) {
    double rest = 0;
    for (uint32_t n = 0; n < f->ns; n++) rest = larger(rest, zonotope_at(shape, p->zonotope, n).sum[i]);
    if (rest > BLURRED * (p->hi[i] - p->lo[i]) + NEGLIGIBLE * larger(fabs(p->lo[i]), fabs(p->hi[i]))) return 1;
  }
  return 0;
}

/* a piece that can't go on alone */
static enum why give_up_alone(flow *f, enum why why) {
  piece *p = &f->piece[0];
  p->why = why, f->failed = 0;
  if (f->put_off) return flow_go_back(f);
  if (why == WHY_DEFECT && flow_put_off(f)) return WHY_NOTHING;
  if (why != WHY_WIDE && flow_split(f, 0)) return WHY_NOTHING;
  if (p->tolerant || (why != WHY_DEFECT && why != WHY_NO_STEP)) return why;
  p->tolerant = 1;
  return WHY_NOTHING;
}

/* The first split is put off as long as the remainder stays a small part of the set: where the flow contracts it does
** so to the end, and pieces would gain nothing. If it does not, all is done again in pieces from there. */
static enum why go_alone(flow *f) {
  worker *w = &f->worker[0];
  piece *p = &f->piece[0];
  enum why why = WHY_NOTHING;
  while (why == WHY_NOTHING && f->next < f->problem.ntime && f->npiece == 1) {
    clear_bounds(f, p->tube_lo, p->tube_hi);
    why = flow_step(w, p, f->problem.time[f->next]);
    if (why == WHY_NOTHING) {
      flow_hull(w, p);
      why = !merge(f) ? WHY_WIDE : f->put_off && is_blurred(f, p) ? WHY_DEFECT : WHY_NOTHING;
    }
    if (why != WHY_NOTHING) {
      why = give_up_alone(f, why);
      continue;
    }
    double t_from = f->t;
    f->t = p->t;
    f->next += f->t == f->problem.time[f->next];
    if (flow_emit(f, t_from, 1)) return WHY_STOPPED;
  }
  return why;
}

/* -- many */

/* As far apart as `outputs` says, but not so close that they would cut steps short, unless somebody wants to know where
** the states are within steps: many pieces have no dense enclosure, so short tubes must serve. */
static void choose_instant(flow *f) {
  const ambit_problem *p = &f->problem;
  double span = p->time[p->ntime - 1] - p->time[0], grid = span / f->options.outputs, goal = p->time[f->next];
  for (uint32_t n = 0; n < f->npiece && !(p->extras & AMBIT_EXTRA_DENSE); n++)
    if (f->piece[n].guess > 0.5 * fabs(grid)) grid = grid > 0 ? 2 * f->piece[n].guess : -2 * f->piece[n].guess;
  f->t_to = f->t + grid;
  if (f->t_to == f->t || fabs(goal - f->t) < 1.5 * fabs(grid)) f->t_to = goal;
}

static enum why go_together(flow *f) {
  while (f->next < f->problem.ntime) {
    double t_from = f->t;
    choose_instant(f);
    enum why why = flow_advance_pieces(f);
    if (why != WHY_NOTHING) return why;
    f->t = f->t_to;
    if (!merge(f)) return WHY_WIDE;
    f->next += f->t == f->problem.time[f->next];
    if (flow_emit(f, t_from, 0)) return WHY_STOPPED;
  }
  return WHY_NOTHING;
}

static AMBIT_WORKER enum why work(flow *f) {
  flow_start(f);
  enum why why = go_alone(f);
  return why == WHY_NOTHING ? go_together(f) : why;
}

/* -- reasons */

static ambit_status explain(const flow *f, enum why why) {
  const ambit_host *h = f->host;
  const piece *p = &f->piece[f->failed];
  char pieces[80] = "";
  double width = 0;
  for (uint32_t n = 0; n < f->ns; n++)
    for (uint32_t i = 0; i < f->nx; i++) width = larger(width, 2 * p->rad[(size_t)n * (f->nx + f->np) + i]);
  if (f->npiece > 1) snprintf(pieces, sizeof pieces, " (in one of %u pieces)", f->npiece);
  if (why == WHY_NOTHING) return AMBIT_OK;
  if (why == WHY_STOPPED) return AMBIT_STOPPED;
  if (p->kink)
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_KINK,
        "at t = %.9g s the set, up to %.3g wide%s, comes to the kink of %s, where Taylor series end; end before it, or "
        "leave out `solver`, so that one that crosses kinks is taken",
        p->t, width, pieces, p->kink);
  switch (why) {
  case WHY_KINK:
  case WHY_SERIES:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDEFINED,
        "at t = %.9g s the right-hand side could not be bounded over the set%s; narrow the initial set, raise `order`, "
        "or end before it",
        p->t, pieces);
  case WHY_WIDE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_WIDTH,
        "the enclosure of `%s` grew wider than %.4g at t = %.9g s%s; narrow the initial set, raise `order` or "
        "`pieces_max`, or allow more by `width_max`",
        f->problem.name[p->blamed], f->limit[p->blamed], p->t, pieces);
  default:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_STEP,
        "at t = %.9g s no step of at least %.3g s could be proved, with a box up to %.3g wide%s; raise `pieces_max` "
        "(%u now) or `order`, or lower `step_min`",
        p->t, flow_least_step(f, p->t), width, pieces, f->options.pieces_max);
  }
}

ambit_status flow_run(void *self, ambit_sink *sink) {
  flow *f = self;
  f->sink = sink, f->stop = 0;
  ambit_rounding outside = ambit_round_up();
  enum why why = work(f);
  ambit_rounding_restore(outside);
  return explain(f, why);
}
