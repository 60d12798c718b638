/* solver_kit.c -- runs a solver on every problem, with and without extras, and stops it. */
#include "host/params.h"
#include "kit/conduct.h"
#include "kit/guarded.h"
#include "kit/solver_kit_inside.h"
#include "kit/solver_kit_random.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MESSAGES 5
#define OPTIONS_MAX 64
#define NEAR 1e-2 /* how close before the end of existence a solver must get */

void kit_find_solver(state *s, const char *format, ...) {
  char message[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  if (s->findings++ < MESSAGES) s->kit->finding(s->kit->user, s->p->name, message);
}

/* -- a run */

typedef struct outcome {
  ambit_status status;
  char reason[AMBIT_MESSAGE_MAX];
} outcome;

static void check_floating(state *s, unsigned before, const char *what) {
  s->counts->compared++;
  if (conduct_floating() != before) kit_find_solver(s, "%s changes the rounding mode", what);
}

static outcome run(state *s, watcher *w) {
  const solver_kit *kit = s->kit;
  outcome o = { .status = AMBIT_NOMEM };
  ambit_scope *scope = NULL;
  void *self = NULL;
  w->sink = (ambit_sink) { sizeof(ambit_sink), kit_emit, kit_progress };
  w->s = s, w->next = 1, w->t = s->problem.time[0];
  if (ambit_scope_open(&scope, NULL, NULL) != AMBIT_OK) return o;
  if (kit->service) scope->host.service = kit->service;
  unsigned floating = conduct_floating();
  o.status = kit->plugin->open(&scope->host, &s->problem, s->option, &self);
  check_floating(s, floating, "open");
  if (o.status == AMBIT_OK) {
    o.status = kit->plugin->run(self, &w->sink);
    check_floating(s, floating, "run");
    kit->plugin->close(self);
    check_floating(s, floating, "close");
  }
  snprintf(o.reason, sizeof o.reason, "%s", scope->failure.message);
  ambit_scope_close(scope);
  s->counts->runs++;
  return o;
}

static uint32_t wanted(const state *s) {
  const ambit_solver *plugin = s->kit->plugin;
  return plugin->want_for ? plugin->want_for(s->option) : plugin->want;
}

/* -- what is expected of the end */

/* A random system may be too much for a method: then it says so. */
static bool gave_up(state *s, const watcher *w, const outcome *o) {
  if (!s->p->random || o->status != AMBIT_UNABLE || !kit_is_rigorous(s)) return false;
  if (strlen(o->reason) < 10) kit_find_solver(s, "no reason why it ended at t = %g: `%s`", w->t, o->reason);
  return true;
}

static void check_complete(state *s, const watcher *w, const outcome *o) {
  if (gave_up(s, w, o)) return;
  s->counts->complete++;
  if (o->status != AMBIT_OK) kit_find_solver(s, "ended with status %d at t = %g: %s", o->status, w->t, o->reason);
  if (w->next != s->problem.ntime)
    kit_find_solver(s, "ended at t = %g and left out %zu instants", w->t, s->problem.ntime - w->next);
  if (o->status == AMBIT_OK && o->reason[0]) kit_find_solver(s, "a failure although it is done: %s", o->reason);
  bool correlated = kit_is_rigorous(s) && (wanted(s) & AMBIT_WANT_INITIAL);
  if (correlated && !(w->hi[0] - w->lo[0] <= s->p->widest))
    kit_find_solver(s, "%g wide at the end: a datum was taken for two", w->hi[0] - w->lo[0]);
}

/* A solver that proves nothing may step over the end without noticing. */
static void check_unable(state *s, const watcher *w, const outcome *o) {
  bool rigorous = kit_is_rigorous(s);
  if (o->status != AMBIT_UNABLE && (rigorous || o->status != AMBIT_OK))
    kit_find_solver(s, "no solution exists beyond t = %g, but the status is %d", s->p->ends, o->status);
  if (o->status != AMBIT_OK && strlen(o->reason) < 10) kit_find_solver(s, "no reason why it ended: `%s`", o->reason);
  if (w->t >= s->p->ends && rigorous) kit_find_solver(s, "an enclosure at t = %a, where no solution exists", w->t);
  if (!(w->t > s->p->ends - NEAR)) kit_find_solver(s, "gave up at t = %g already", w->t);
}

static void check_allocations(state *s, const watcher *w, const char *what) {
  if (s->kit->allocations) s->counts->compared++;
  if (w->records > 1 && w->last_count != w->first_count)
    kit_find_solver(s, "%zu allocations between the first and the last record%s", w->last_count - w->first_count, what);
}

static void check_run(state *s) {
  watcher w = { .s = s }, again = { .s = s };
  outcome o = run(s, &w);
  if (s->p->ends < INFINITY)
    check_unable(s, &w, &o);
  else
    check_complete(s, &w, &o);
  if (w.calls < w.records) kit_find_solver(s, "%u calls of progress in %u steps", w.calls, w.records);
  check_allocations(s, &w, "");
  run(s, &again);
  s->counts->compared++;
  if (again.digest != w.digest || again.records != w.records) kit_find_solver(s, "another result the second time");
}

/* with every extra: what records say besides is true */
static void check_extras(state *s) {
  watcher w = { .s = s };
  s->problem.extras = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET;
  outcome o = run(s, &w);
  if (s->p->ends == INFINITY) check_complete(s, &w, &o);
  s->problem.extras = 0;
  check_allocations(s, &w, " of a run with extras");
}

static void check_stops(state *s) {
  for (uint32_t after = 1; after <= 2; after++) {
    watcher by_record = { .stop_after = after }, by_progress = { .stop_progress_after = after };
    outcome o = run(s, &by_record);
    s->counts->stops++;
    if (gave_up(s, &by_record, &o)) return;
    if (o.status != AMBIT_STOPPED || by_record.records != after)
      kit_find_solver(s, "stopped at record %u: status %d after %u records", after, o.status, by_record.records);
    o = run(s, &by_progress);
    if (o.status != AMBIT_STOPPED) kit_find_solver(s, "stopped by progress: status %d", o.status);
  }
}

/* -- problems */

/* the arrays of a problem, each at the end of its memory */
static void guard(ambit_problem *p, bool open) {
  const double **array[] = { &p->time, &p->x0_lo, &p->x0_hi, &p->p_lo, &p->p_hi, &p->u_lo, &p->u_hi };
  const uint32_t size[] = { p->ntime, p->nx, p->nx, p->np, p->np, p->nu, p->nu };
  for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
    if (!*array[i] || size[i] == 0) continue;
    size_t bytes = size[i] * sizeof(double);
    if (open)
      *array[i] = guarded_open(*array[i], bytes);
    else
      guarded_close((void *)(uintptr_t)*array[i], bytes);
  }
}

static bool all_guarded(const ambit_problem *p) {
  return p->time && p->x0_lo && p->x0_hi && (!p->np || (p->p_lo && p->p_hi)) && (!p->nu || (p->u_lo && p->u_hi));
}

static void match_data(state *s, const kit_model *m, const ambit_expr *unknown) {
  for (uint32_t j = 0; j < s->problem.nu; j++)
    for (uint32_t k = 0; k < m->ndatum; k++)
      if (unknown[j] == m->datum[k]) s->datum[j] = k;
}

static void run_all(state *s) {
  guard(&s->problem, true);
  if (all_guarded(&s->problem)) {
    check_run(s);
    check_extras(s);
    check_stops(s);
  } else
    kit_find_solver(s, "out of memory");
  guard(&s->problem, false);
}

static size_t run_problem(
    const solver_kit *kit, solver_kit_counts *counts, const kit_problem *p, const double *option) {
  kit_model m;
  ambit_failure f = { 0 };
  const ambit_expr *unknown = NULL;
  state s = { .kit = kit, .p = p, .option = option, .counts = counts };
  ambit_arena *arena = ambit_arena_open();
  kit_model_open(&m, p);
  const ambit_problem_request q = { .system = &m.system,
    .initial = m.initial,
    .ntime = p->ntime,
    .time = p->time,
    .want = wanted(&s),
    .unknown = &unknown };
  if (!arena || ambit_problem_build(&q, arena, &s.problem, &f) != AMBIT_OK || s.problem.nu > KIT_DATA)
    kit_find_solver(&s, "cannot be built: %s", f.message);
  else {
    match_data(&s, &m, unknown);
    s.problem.arithmetic = kit->arithmetic;
    s.problem.actx = kit->actx;
    run_all(&s);
  }
  kit_model_close(&m);
  ambit_arena_close(arena);
  return s.findings;
}

static size_t resolve(const solver_kit *kit, double option[OPTIONS_MAX]) {
  ambit_failure f = { 0 };
  if (ambit_params_doubles(kit->plugin->param) <= OPTIONS_MAX &&
      ambit_params_resolve(kit->plugin->param, kit->name, kit->noption, kit->option, option, &f) == AMBIT_OK)
    return 0;
  kit->finding(kit->user, "options", f.message[0] ? f.message : "too many");
  return 1;
}

size_t solver_kit_run(const solver_kit *kit, solver_kit_counts *counts) {
  double option[OPTIONS_MAX];
  solver_kit_counts own = { 0 };
  size_t findings = resolve(kit, option);
  if (findings) return findings;
  for (size_t i = 0; i < kit_problem_count; i++)
    findings += run_problem(kit, counts ? counts : &own, &kit_problems[i], option);
  return findings;
}

size_t solver_kit_run_random(const solver_kit *kit, size_t systems, solver_kit_counts *counts) {
  double option[OPTIONS_MAX];
  kit_random_system *r = malloc(sizeof *r);
  size_t findings = r ? resolve(kit, option) : 1, before = counts->complete;
  for (size_t i = 0; r && findings == 0 && i < systems; i++) {
    kit_random_make(r, kit->seed, i);
    findings += run_problem(kit, counts, &r->problem, option);
  }
  free(r);
  /* two runs of each may be complete: without and with settings */
  if (findings || 2 * (counts->complete - before) >= systems) return findings;
  kit->finding(kit->user, "random systems", "it gives up on three quarters of them");
  return 1;
}
