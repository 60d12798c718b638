/* run.c -- from step to step, and what a run that could not go on has to say.
**
** A step is: rows of the flow over the set (series.c), a length (pace.c), what every operation fails by over that
** length (defect.c), how far solutions can be from the rows (zono_prove), and the set at the end (zono_finish). Where
** the proof fails the step is made shorter with the same rows.
*/
#include "jump.h"
#include "kink.h"
#include "proof.h"
#include "vary.h"
#include <ambit/code.h>
#include <stdio.h>

#define GRID 20        /* bits of a step's length that count */
#define SLIVER 0x1p-10 /* of the step before: one between two instants that are next to each other */
#define GROW 3.0       /* longest step, in multiples of the last one */
#define TOO_FAR 1e6    /* steps to the end, at the present pace, that are too many ... */
#define SHRUNK 0.0625  /* if steps are so much shorter than they have been, or ... */
#define NEVER 1.7e10   /* steps, even if they shrink no more */
#define CREEP_FOR 30   /* steps in a row */

static int fails(zono *z, enum why why) {
  z->why = why;
  return 0;
}

/* -- one step */

/* the instant ahead: a listed one, or one of a jump */
static double ahead(const zono *z) {
  double time = z->problem.time[z->next];
  return fmin(time, jump_next(z)) < time ? jump_next(z) : time;
}

/* about t + h, with so few bits that differences of such instants are doubles; not beyond the goal */
static double on_grid(double t, double h, double goal) {
  double end = t + h, grid = ldexp(1, ilogb(h) - GRID), near = rint(end / grid) * grid;
  return h != 0 && fabs(end) < 0x1p50 * grid && fabs(near - t) < fabs(goal - t) ? near : end;
}

/* z->t_next, h and h_error for a length */
static void set_end(zono *z, double h) {
  double goal = ahead(z);
  int at_goal = !(fabs(h) < fabs(goal - z->t) * (1 - 0x1p-40));
  z->t_next = at_goal ? goal : on_grid(z->t, h, goal);
  z->h = z->t_next - z->t;
  /* a difference is rounded by half of that, if at all; bounds over [0, h] hold for it, too */
  z->h_error = two_sum(z->t_next, -z->t).lo != 0 ? 0x1p-52 * fabs(z->h) : 0;
  if (!(z->problem.jump_error > 0)) return;
  /* both ends may be so much off: a little longer, and back */
  z->h += 2 * z->problem.jump_error;
  z->h_error += 4 * z->problem.jump_error * (1 + 1e-9) + 0x1p-52 * fabs(z->h);
}

static double longest(const zono *z) {
  double left = ahead(z) - z->t, most = fabs(left);
  if (z->guess > 0 && GROW * z->guess < most) most = GROW * z->guess;
  most = fmin(most, fmin(z->options.step_max, z->vary_most));
  /* the last two steps before an instant are of like length: no sliver is left */
  if (most < fabs(left) && most > 0.6 * fabs(left)) most = 0.5 * fabs(left);
  return left < 0 ? -most : most;
}

static double least_step(const zono *z) {
  const double *time = z->problem.time;
  return ambit_least_step(z->options.step_min, z->t, time[0], time[z->problem.ntime - 1]);
}

/* 1: proved for some length, set in z */
static int prove_some(zono *z, double h) {
  enum why why;
  for (;;) {
    set_end(z, h);
    z->why = WHY_NOTHING, z->detail = NULL;
    ambit_work_try(z->shape.counted);
    if (zono_defects(z) && zono_prove(z)) {
      if (vary_fits(z)) return 1;
      z->why = WHY_GROWTH;
    }
    why = z->why == WHY_NOTHING ? WHY_GROWTH : z->why;
    if (fabs(h) * 0.5 < least_step(z) || z->t + 0.5 * h == z->t) return fails(z, why == WHY_GROWTH ? WHY_STEP : why);
    h *= 0.5;
  }
}

static int step(zono *z) {
  zono_choose_order(z);
  if (!zono_series(z)) return 0;
  double h = zono_choose_step(z, longest(z));
  if (!(fabs(h) >= least_step(z) || fabs(h) == fabs(longest(z))) || z->t + h == z->t) return fails(z, WHY_STEP);
  return prove_some(z, h);
}

/* -- records */

static int32_t emit(zono *z, ambit_record *r) {
  double span = z->problem.time[z->problem.ntime - 1] - z->problem.time[0];
  if (z->problem.extras & AMBIT_EXTRA_SET) r->set = zono_describe_set(z);
  int32_t stop = z->sink->emit(z->sink, r);
  if (!stop && z->sink->progress) stop = z->sink->progress(z->sink, (z->t - z->problem.time[0]) / span, NULL);
  return stop;
}

static int is_wide(zono *z) {
  ambit_explosion e = AMBIT_EXPLOSION_START;
  for (uint32_t i = 0; i < z->nx; i++) {
    double width = z->hi[i] - z->lo[i], most = z->options.width_max;
    const double *row = z->P + (size_t)i * z->shape.stride;
    z->blamed = i;
    if (most > 0 ? !(width <= z->limit[i]) : !(width < INFINITY)) return 1;
    if (most == 0 && !z->nvarying) ambit_explosion_note(&e, i, width, row_total(&z->shape, row), &z->limit[i]);
  }
  z->blamed = e.worst;
  return z->options.width_max == 0 && !z->nvarying && ambit_explodes(&e);
}

static int advance(zono *z) {
  ambit_record r = { .size = sizeof r, .kind = AMBIT_REC_STEP, .t_from = z->t, .nx = z->nx, .rigorous = 1 };
  if (!step(z)) return 0;
  zono_tube(z);
  if (z->problem.extras & AMBIT_EXTRA_DENSE) zono_describe_dense(z, &r);
  pace_budget(z, fabs(z->h));
  parts_choose(z);
  zono_finish(z);
  zono_hull(z);
  if (is_wide(z)) return fails(z, WHY_WIDE);
  int is_sliver = z->t_next == ahead(z) && fabs(z->h) < SLIVER * z->guess; /* tells nothing about the next one */
  z->guess = is_sliver ? z->guess : fabs(z->h), z->t = z->t_next;
  kinks_note(z);
  z->next += z->t == z->problem.time[z->next];
  r.t_to = z->t, r.order = z->K;
  r.lo = z->lo, r.hi = z->hi, r.tube_lo = z->tube_lo, r.tube_hi = z->tube_hi;
  if (emit(z, &r)) return fails(z, WHY_STOPPED);
  z->proof->cut = z->t != jump_next(z) && z->t != z->problem.time[z->next - 1];
  return jump_all(z);
}

static void work(zono *z) {
  uint32_t slow = 0;
  double most = 0;
  zono_start(z);
  vary_start(z);
  if (!jump_all(z)) return;
  zono_hull(z);
  for (uint32_t i = 0; i < z->nx; i++)
    z->limit[i] = z->options.width_max * fmax(1, fmax(fabs(z->lo[i]), fabs(z->hi[i])));
  while (z->next < z->problem.ntime && advance(z)) {
    double left = fabs(z->problem.time[z->problem.ntime - 1] - z->t);
    most = fmax(most, z->guess);
    slow = left > (z->guess < SHRUNK * most ? TOO_FAR : NEVER) * z->guess ? slow + 1 : 0;
    if (slow > CREEP_FOR) {
      z->why = WHY_SHORT_STEPS;
      return;
    }
  }
}

/* -- reasons */

static ambit_status explain(const zono *z) {
  const ambit_host *h = z->host;
  double width = 0;
  char from[600];
  for (uint32_t i = 0; i < z->nx; i++) width = fmax(width, z->hi[i] - z->lo[i]);
  origin_text(z, from, sizeof from);
  switch (z->why) {
  case WHY_NOTHING: return AMBIT_OK;
  case WHY_STOPPED: return AMBIT_STOPPED;
  case WHY_KINK:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_KINK,
        "at t = %.9g s the enclosure, up to %.3g wide, comes to the kink of %s, which this solver cannot cross here; "
        "narrow the data, or end before it",
        z->t, width, z->detail ? z->detail : "an element's law");
  case WHY_UNDEFINED:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDEFINED,
        "at t = %.9g s the equations could not be bounded over the enclosure, which is up to %.3g wide; narrow the "
        "data, or end before it",
        z->t, width);
  case WHY_PIVOT:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDEFINED,
        "at t = %.9g s the equations for the accelerations could not be solved over the enclosure, which is up to %.3g "
        "wide (unknown %u); narrow the data, or end before it",
        z->t, width, z->blamed + 1);
  case WHY_WIDE:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_WIDTH,
        "the enclosure of `%s` grew wider than allowed in the step from t = %.9g s%s; narrow the data, or allow more "
        "by "
        "`width_max`",
        z->problem.name[z->blamed], z->t, from);
  case WHY_SHORT_STEPS:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_SHORT_STEPS,
        "at t = %.9g s steps over an enclosure up to %.3g wide%s, now of %.3g s, are so short that the end is out of "
        "reach; narrow the data, or end before it",
        z->t, width, from, z->guess);
  default:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_STEP,
        "at t = %.9g s no step of at least %.3g s could be proved, with an enclosure up to %.3g wide%s; narrow the "
        "data, "
        "lower `step_min`, or end before it",
        z->t, least_step(z), width, from);
  }
}

ambit_status zono_run(void *self, ambit_sink *sink) {
  zono *z = self;
  z->sink = sink;
  work(z);
  return explain(z);
}
