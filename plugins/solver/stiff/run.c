/* run.c -- from step to step, into the sink; and what a run that could not go on has to say. */
#include "stiff.h"
#include <ambit/code.h>
#include <string.h>

/* -- the hull of the set */

static AMBIT_WORKER void hull_up(stiff *s) {
  const carried *c = &s->carried;
  uint32_t n = s->n;
  for (uint32_t i = 0; i < s->nx; i++) {
    double norm[N_MAX], radius = s->end_error[i];
    bound_blocks(n, c->block, c->blocks, c->B + i * n, norm);
    for (uint32_t b = 0; b < c->blocks; b++) radius += norm[b] * c->w[b];
    double rest = radius;
    if (s->spread)
      for (uint32_t t = 1; t < s->terms.count; t++) radius += fabs(s->end_row[i * s->terms.count + t]);
    iv end = iv_of_dd(s->end[i]);
    s->lo[i] = -(end.low + radius);
    s->hi[i] = end.high + radius;
    s->set_middle[i] = iv_middle(end);
    s->set_rest[i] = rest + larger(end.high - s->set_middle[i], s->set_middle[i] + end.low);
    if (!s->spread) continue;
    double *terms = s->set_coefficient + i * s->terms.count;
    memcpy(terms, s->end_row + i * s->terms.count, s->terms.count * sizeof *terms);
    terms[0] = s->set_middle[i];
  }
}

static AMBIT_WORKER void start_up(stiff *s) { start_set(s); }

static void hull(stiff *s) {
  ambit_rounding nearest = ambit_round_up();
  hull_up(s);
  ambit_rounding_restore(nearest);
}

static void start(stiff *s) {
  ambit_rounding nearest = ambit_round_up();
  start_up(s);
  ambit_rounding_restore(nearest);
}

/* -- records */

static int32_t emit(const stiff *s, ambit_sink *sink, double t_from) {
  const ambit_problem *p = &s->problem;
  const ambit_set set = { sizeof set, p->nu, s->spread ? s->terms.count : 1, 0, s->about, s->scale,
    s->spread ? s->terms.exponent : s->exponent, s->spread ? s->set_coefficient : s->set_middle, s->set_rest };
  int dense = (p->extras & AMBIT_EXTRA_DENSE) && dense_is_good(s);
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
    .order = s->q.N,
    .ndense = dense ? s->q.N + 1 : 0,
    .dense_mid = dense ? s->dense_mid : NULL,
    .dense_rad = dense ? s->dense_rad : NULL,
    .set = p->extras & AMBIT_EXTRA_SET ? &set : NULL };
  double done = (s->t - p->time[0]) / (p->time[p->ntime - 1] - p->time[0]);
  int32_t stop = sink->emit(sink, &r);
  if (!stop && sink->progress) stop = sink->progress(sink, fmin(fmax(done, 0), 1), NULL);
  return stop;
}

/* -- steps */

/* The limit follows the middle of the enclosure: a state that is small at first may become large. */
static int is_good(stiff *s, uint32_t i) {
  s->limit[i] = fmax(s->limit[i], s->options.width_max * fmax(1, fabs(s->end[i].hi)));
  int narrow = s->options.width_max == 0 || s->hi[i] - s->lo[i] <= s->limit[i];
  return narrow && isfinite(s->lo[i]) && isfinite(s->hi[i]) && isfinite(s->tube_lo[i]) && isfinite(s->tube_hi[i]);
}

/* Where data have columns and no rows of terms, what they move cannot be told from errors: all counts as movement. */
static int explodes(stiff *s) {
  ambit_explosion e = AMBIT_EXPLOSION_START;
  int columns = !s->spread && s->problem.nu > 0;
  for (uint32_t i = 0; i < s->nx; i++) {
    double width = s->hi[i] - s->lo[i], linear = fabs(s->end[i].hi) + (columns ? 0.5 * width : 0);
    for (uint32_t t = 1; s->spread && t < s->terms.count; t++) linear += fabs(s->end_row[i * s->terms.count + t]);
    ambit_explosion_note(&e, i, width, linear, &s->limit[i]);
  }
  s->blamed = e.worst;
  return ambit_explodes(&e);
}

/* a length to begin with, from rates and speeds at the start; the first steps make it better */
static double first_length(const stiff *s) {
  const double *time = s->problem.time;
  double span = fabs(time[s->problem.ntime - 1] - time[0]), rate = s->first_rate;
  return rate > 0 ? fmin(span, 0.05 / rate) : span;
}

static enum why integrate(stiff *s, ambit_sink *sink) {
  start(s);
  s->t = s->problem.time[0];
  s->next = 1, s->level = 1, s->careful = 0, s->looked_ahead = 0, s->last_why = WHY_NOTHING;
  hull(s);
  for (uint32_t i = 0; i < s->nx; i++) s->limit[i] = s->options.width_max;
  s->guess = first_length(s);
  for (uint32_t i = 0; i < s->nx; i++) {
    s->q.x[i] = dd_long(s->end[i]);
    s->below[i] = dd_sub(s->end[i], dd_of(s->q.x[i])).hi;
  }
  while (s->next < s->problem.ntime) {
    double t_from = s->t;
    enum why why = step_make(s);
    if (why != WHY_NOTHING) return why;
    hull(s);
    if (s->options.width_max == 0 && explodes(s)) return WHY_WIDE;
    for (uint32_t i = 0; i < s->nx; i++) {
      s->blamed = i;
      if (!is_good(s, i)) return WHY_WIDE;
    }
    s->t = s->t_next;
    s->next += (uint32_t)s->at_instant;
    if (emit(s, sink, t_from)) return WHY_STOPPED;
  }
  return WHY_NOTHING;
}

/* -- reasons */

static const char *reason(enum why why) {
  switch (why) {
  case WHY_NEWTON: return "Newton's method for the collocation polynomial does not converge";
  case WHY_ROUGH: return "the collocation polynomial is too far off";
  case WHY_UNDEFINED: return "the right-hand side could not be bounded over the enclosure";
  case WHY_SPLIT: return "fast and slow directions cannot be told apart";
  case WHY_FRAME: return "the directions of errors change too fast";
  default: return "errors grow too fast";
  }
}

static double width(const stiff *s) {
  double most = 0;
  for (uint32_t i = 0; i < s->nx; i++) most = fmax(most, s->hi[i] - s->lo[i]);
  return most;
}

static ambit_status explain(const stiff *s, enum why why) {
  const ambit_host *h = s->host;
  switch (why) {
  case WHY_NOTHING: return AMBIT_OK;
  case WHY_STOPPED: return AMBIT_STOPPED;
  case WHY_WIDE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_WIDTH,
        "the enclosure of `%s` grew wider than %.4g in the step from t = %.9g s; split the initial set, or allow more "
        "by "
        "`width_max`",
        s->problem.name[s->blamed], s->limit[s->blamed], s->t);
  case WHY_FAST:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_RATES,
        "at t = %.9g s a step of %.3g s is too long for the rates of the equations: their product has no square among "
        "the numbers; end before it, or allow no longer steps by `step_max`",
        s->t, s->h.hi);
  default:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_STEP,
        "at t = %.9g s no step could be proved, the last try was %.3g s long, with an enclosure up to %.3g wide: %s; "
        "split the uncertain data, lower `step_min` or change `tolerance`",
        s->t, s->h.hi, width(s), reason(s->last_why));
  }
}

ambit_status stiff_run(void *self, ambit_sink *sink) {
  ambit_rounding outside = ambit_round_nearest();
  enum why why = integrate(self, sink);
  ambit_rounding_restore(outside);
  return explain(self, why);
}
