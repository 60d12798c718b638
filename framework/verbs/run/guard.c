/* guard.c -- watches records, and judges a run by what it saw. */
#include "verbs/run/guard.h"
#include "base/meter.h"
#include "verbs/run/allocation.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool bounds_make_sense(uint32_t n, const double *lo, const double *hi) {
  for (uint32_t i = 0; i < n; i++)
    if (!(lo[i] <= hi[i])) return false;
  return true;
}

/* Radii are not negative, and nothing is NaN; infinite is allowed: it claims nothing. */
static bool balls_make_sense(size_t n, const double *mid, const double *rad) {
  for (size_t i = 0; i < n; i++)
    if (isnan(mid[i]) || !(rad[i] >= 0)) return false;
  return true;
}

static bool numbers_make_sense(size_t n, const double *x) {
  for (size_t i = 0; i < n; i++)
    if (isnan(x[i])) return false;
  return true;
}

static bool dense_makes_sense(const ambit_record *r) {
  if (!r->dense_mid || !r->dense_rad) return true;
  size_t columns = r->dense_column ? (size_t)r->nx * r->ncolumn * r->ncoef_column : 0;
  return balls_make_sense((size_t)r->nx * r->ndense, r->dense_mid, r->dense_rad) &&
         (!columns || numbers_make_sense(columns, r->dense_column));
}

static bool set_makes_sense(const ambit_record *r) {
  const ambit_set *s = r->set;
  if (!s) return true;
  for (uint32_t i = 0; i < r->nx; i++)
    if (!(s->rest[i] >= 0)) return false;
  for (uint32_t j = 0; j < s->nu; j++)
    if (isnan(s->about[j]) || !(s->scale[j] > 0)) return false;
  return numbers_make_sense((size_t)r->nx * s->nterm, s->coefficient);
}

/* The states at the end of a step are among those of the whole step. */
static bool end_meets_tube(const ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++)
    if (r->lo[i] > r->tube_hi[i] || r->hi[i] < r->tube_lo[i]) return false;
  return true;
}

/* NULL: the step is sound in form */
static const char *find_fault(const ambit_guard *g, const ambit_record *r, const char **code) {
  *code = AMBIT_CODE_BROKEN_RECORD;
  if (r->size < offsetof(ambit_record, ndense)) return "a record of the wrong size";
  if (r->kind != AMBIT_REC_STEP) return NULL;
  if (r->nx != g->nx || !r->lo || !r->hi) return "a step without an enclosure of every state";
  *code = AMBIT_CODE_BROKEN_BOUNDS;
  if (!bounds_make_sense(r->nx, r->lo, r->hi)) return "a step with an empty or NaN enclosure";
  if (r->tube_lo && r->tube_hi && !bounds_make_sense(r->nx, r->tube_lo, r->tube_hi))
    return "a step with an empty or NaN tube";
  if (r->tube_lo && r->tube_hi && !end_meets_tube(r)) return "a step whose end lies outside its own tube";
  if (!dense_makes_sense(r)) return "a dense enclosure with a NaN or a negative radius";
  if (!set_makes_sense(r)) return "a set with a NaN or a negative radius";
  *code = AMBIT_CODE_BROKEN_TIME;
  if (!(g->direction * (r->t_from - g->reached) <= 0)) return "a step that leaves a gap in time";
  if (!(g->direction * (r->t_to - g->reached) >= 0) || !isfinite(r->t_to))
    return "a step against the direction of time";
  return NULL;
}

static int32_t pass(ambit_guard *g, int32_t stop) {
  g->stopped = g->stopped || stop;
  ambit_allocation_forbid(1); /* from the first record on */
  return stop;
}

static int32_t emit(ambit_sink *s, const ambit_record *given) {
  ambit_guard *g = (ambit_guard *)(void *)s;
  ambit_allocation_forbid(0);              /* what the receiver does is its own affair */
  ambit_record whole = { 0 }, *r = &whole; /* a solver may be older than this kernel, and its records shorter */
  memcpy(r, given, given->size < sizeof *r ? given->size : sizeof *r);
  r->clock_error = g->clock_error;
  const char *code, *fault = find_fault(g, r, &code);
  if (fault) {
    snprintf(g->broken, sizeof g->broken, "%s", fault);
    g->broken_code = code;
    return pass(g, 1);
  }
  if (r->kind == AMBIT_REC_STEP) {
    g->steps++;
    g->reached = r->t_to;
  }
  if (!g->outer || !g->outer->emit) return pass(g, 0);
  ambit_meter_enter(AMBIT_FRAME_STAGE, "records");
  int32_t stop = g->outer->emit(g->outer, r);
  ambit_meter_leave();
  return pass(g, stop);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  ambit_guard *g = (ambit_guard *)(void *)s;
  if (!g->outer || !g->outer->progress) return 0;
  ambit_allocation_forbid(0);
  int32_t stop = g->outer->progress(g->outer, done, message);
  g->stopped = g->stopped || stop;
  if (g->steps) ambit_allocation_forbid(1);
  return stop;
}

ambit_guard ambit_guard_make(const ambit_problem *p, ambit_sink *outer) {
  return (ambit_guard) {
    .sink = { sizeof(ambit_sink), emit, progress },
    .outer = outer,
    .nx = p->nx,
    .clock_error = p->jump_error,
    .direction = p->time[p->ntime - 1] < p->time[0] ? -1 : 1,
    .reached = p->time[0],
    .end = p->time[p->ntime - 1],
  };
}

static ambit_status known(ambit_status said) { return said >= AMBIT_OK && said <= AMBIT_BROKEN ? said : AMBIT_BROKEN; }

ambit_status ambit_guard_explain(
    ambit_status said, const char *solver, const ambit_failure *own, const char *fallback, ambit_failure *why) {
  ambit_failure_clear(why);
  if (own->message[0]) return ambit_fail_code(why, known(said), own->code, "%s", own->message);
  return ambit_fail(why, known(said), "solver `%s` %s", solver, fallback);
}

ambit_status ambit_guard_judge(
    const ambit_guard *g, ambit_status said, const char *solver, const ambit_failure *own, ambit_failure *why) {
  ambit_failure_clear(why);
  if (g->broken[0])
    return ambit_fail_code(why, AMBIT_BROKEN, g->broken_code, "solver `%s` is broken: it gave %s", solver, g->broken);
  if (g->stopped && g->reached != g->end)
    return ambit_fail_code(
        why, AMBIT_STOPPED, AMBIT_CODE_STOPPED_REQUEST, "stopped on request at t = %.9g s", g->reached);
  if (said == AMBIT_OK && g->reached != g->end)
    return ambit_fail_code(why, AMBIT_BROKEN, AMBIT_CODE_BROKEN_TIME,
        "solver `%s` is broken: it says it is done at t = %.9g s, before the end", solver, g->reached);
  if (said == AMBIT_OK || (said == AMBIT_STOPPED && g->reached == g->end)) return AMBIT_OK;
  return ambit_guard_explain(said, solver, own,
      said == AMBIT_STOPPED ? "stopped without being asked to" : "could not go on and gave no reason", why);
}
