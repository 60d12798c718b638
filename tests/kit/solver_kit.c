/* solver_kit.c -- runs a solver and watches every record. */
#include "kit/solver_kit.h"
#include "kit/solver_kit_problems.h"
#include "kit/solver_kit_values.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define MESSAGES 5
#define OPTIONS_MAX 64
#define SAMPLES 5 /* of the uncertain datum, and of times within a step */
#define RECORDS_MAX 100000u
#define WILD 0.1     /* how long before that end errors of a solver that proves nothing are no matter */
#define NEAR 1e-2    /* how close before the end of existence a solver must get */
#define BESIDE 0.01  /* of the hull's width that a set may stick out of it, ... */
#define ROUNDED 1e-9 /* ... and of its size */

typedef struct state {
  const solver_kit *kit;
  const kit_problem *p;
  const double *option;
  ambit_problem problem;
  size_t findings;
} state;

static void find(state *s, const char *format, ...) AMBIT_PRINTF(2, 3);
static void find(state *s, const char *format, ...) {
  char message[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  if (s->findings++ < MESSAGES) s->kit->finding(s->kit->user, s->p->name, message);
}

/* -- the sink */

typedef struct watcher {
  ambit_sink sink; /* first */
  state *s;
  uint32_t records, stop_after, stop_progress_after; /* 0: never */
  uint32_t calls;                                    /* of progress */
  size_t next;                                       /* time[] ahead */
  double t, done;
  bool stopped;
  size_t first_count, last_count; /* allocations at the first and the last record */
  double lo[KIT_STATES], hi[KIT_STATES];
  uint64_t digest;
} watcher;

static bool rigorous(const state *s) { return s->kit->plugin->needs_rigorous != 0; }

static void check_header(watcher *w, const ambit_record *r) {
  state *s = w->s;
  bool backwards = s->problem.time[s->problem.ntime - 1] < s->problem.time[0];
  if (r->size < sizeof *r || r->nx != s->problem.nx) find(s, "a record of size %u with %u states", r->size, r->nx);
  if (r->t_from != w->t) find(s, "a step from t = %a after one to %a", r->t_from, w->t);
  if (!(backwards ? r->t_to < r->t_from : r->t_to > r->t_from)) find(s, "a step from t = %a to %a", r->t_from, r->t_to);
  if ((r->rigorous != 0) != rigorous(s)) find(s, "a record that says rigorous = %u", r->rigorous);
  double ahead = w->next < s->problem.ntime ? s->problem.time[w->next] : s->problem.time[s->problem.ntime - 1];
  if (backwards ? r->t_to < ahead : r->t_to > ahead) find(s, "a step over the instant %a, to %a", ahead, r->t_to);
  if (r->t_to == ahead) w->next++;
}

static void check_bounds(watcher *w, const ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++) {
    bool good = r->lo[i] <= r->hi[i] && isfinite(r->lo[i]) && isfinite(r->hi[i]);
    if (r->tube_lo && r->tube_hi)
      good = good && r->tube_lo[i] <= r->tube_hi[i] && isfinite(r->tube_lo[i]) && isfinite(r->tube_hi[i]);
    if (!good) find(w->s, "bounds [%a, %a] of state %u at t = %g", r->lo[i], r->hi[i], i, r->t_to);
    if (!rigorous(w->s) && r->lo[i] != r->hi[i])
      find(w->s, "a solver that proves nothing gives [%a, %a]", r->lo[i], r->hi[i]);
  }
}

static void check_point(state *s, double t, double u, const double *lo, const double *hi, const char *what) {
  ambit_interval truth[KIT_STATES];
  /* an answer where there is no solution is found elsewhere; just before the end any error grows without bound */
  if (t >= s->p->ends - (rigorous(s) ? 0 : WILD)) return;
  s->p->truth(t, u, truth);
  for (uint32_t i = 0; i < s->problem.nx; i++) {
    double slack = rigorous(s) ? 0 : s->kit->tolerance * (1 + fabs(truth[i].hi));
    if (!(lo[i] <= truth[i].hi + slack && hi[i] >= truth[i].lo - slack))
      find(s, "%s at t = %a misses the solution for u = %a: [%a, %a], truth in [%a, %a]", what, t, u, lo[i], hi[i],
          truth[i].lo, truth[i].hi);
  }
}

static void check_truth(state *s, const ambit_record *r) {
  const kit_problem *p = s->p;
  for (int k = 0; k <= SAMPLES; k++) {
    double share = (double)k / SAMPLES, u = p->u_lo + share * (p->u_hi - p->u_lo);
    if (!rigorous(s)) u = 0.5 * (p->u_lo + p->u_hi);
    check_point(s, r->t_to, u, r->lo, r->hi, "the enclosure");
    for (int j = 0; j <= SAMPLES && r->tube_lo && r->tube_hi; j++) {
      double t = r->t_from + (double)j / SAMPLES * (r->t_to - r->t_from);
      check_point(s, t, u, r->tube_lo, r->tube_hi, "the tube");
    }
  }
}

/* -- what records say on a wish */

static void check_meets(state *s, double t, uint32_t i, ambit_interval x, double lo, double hi, const char *what) {
  if (!(x.lo <= hi && x.hi >= lo))
    find(s, "%s of state %u at t = %a, [%a, %a], does not meet the bounds [%a, %a]", what, i, t, x.lo, x.hi, lo, hi);
}

static void check_dense(watcher *w, const ambit_record *r) {
  state *s = w->s;
  const kit_problem *p = s->p;
  const char *fault = kit_dense_fault(r);
  if (fault) find(s, "the dense enclosure to t = %a: %s", r->t_to, fault);
  if (fault || !r->dense_mid) return;
  double lo[KIT_STATES], hi[KIT_STATES];
  for (int j = 0; j <= SAMPLES; j++) {
    double t = j < SAMPLES ? r->t_from + (double)j / SAMPLES * (r->t_to - r->t_from) : r->t_to;
    ambit_interval since = ambit_interval_sub((ambit_interval) { t, t }, (ambit_interval) { r->t_from, r->t_from });
    for (uint32_t i = 0; i < r->nx; i++) {
      ambit_interval x = kit_dense_value(r, i, since);
      lo[i] = x.lo, hi[i] = x.hi;
      if (j == 0 && w->records > 1) check_meets(s, t, i, x, w->lo[i], w->hi[i], "the dense enclosure");
      if (j == SAMPLES) check_meets(s, t, i, x, r->lo[i], r->hi[i], "the dense enclosure");
    }
    for (int k = 0; k <= SAMPLES; k++)
      check_point(s, t, p->u_lo + (double)k / SAMPLES * (p->u_hi - p->u_lo), lo, hi, "the dense enclosure");
  }
}

/* A state is in the set and within the bounds; where invariants have cut the bounds, the set may be larger. */
static void check_hull(state *s, const ambit_record *r, uint32_t i, ambit_interval x) {
  double slack = BESIDE * (r->hi[i] - r->lo[i]) + ROUNDED * fmax(fabs(r->lo[i]), fabs(r->hi[i]));
  check_meets(s, r->t_to, i, x, r->lo[i], r->hi[i], "the set");
  if (s->problem.ninvariant == 0 && !(x.lo >= r->lo[i] - slack && x.hi <= r->hi[i] + slack))
    find(s, "the set of state %u at t = %a, [%a, %a], sticks out of [%a, %a]", i, r->t_to, x.lo, x.hi, r->lo[i],
        r->hi[i]);
}

static void check_set(state *s, const ambit_record *r) {
  const kit_problem *p = s->p;
  const char *fault = kit_set_fault(r, s->problem.nu);
  if (fault) find(s, "the set at t = %a: %s", r->t_to, fault);
  double lo[KIT_STATES], hi[KIT_STATES];
  for (int k = 0; k <= SAMPLES && r->set && !fault; k++) {
    double u = p->u_lo + (double)k / SAMPLES * (p->u_hi - p->u_lo);
    for (uint32_t i = 0; i < r->nx; i++) {
      ambit_interval x = kit_set_value(r->set, i, &u); /* at most one unknown */
      lo[i] = x.lo, hi[i] = x.hi;
      check_hull(s, r, i, x);
    }
    check_point(s, r->t_to, u, lo, hi, "the set");
  }
}

static void check_gifts(watcher *w, const ambit_record *r) {
  state *s = w->s;
  uint32_t wish = s->problem.wish, missing = wish & s->kit->gives;
  if ((!(wish & AMBIT_WISH_DENSE) && r->dense_mid) || (!(wish & AMBIT_WISH_SET) && r->set))
    find(s, "a dense enclosure or a set that nobody wished for");
  if (((missing & AMBIT_WISH_DENSE) && !r->dense_mid) || ((missing & AMBIT_WISH_SET) && !r->set))
    find(s, "no dense enclosure, or no set, in the step to t = %a", r->t_to);
  check_dense(w, r);
  check_set(s, r);
}

static uint64_t mix(uint64_t digest, const void *bytes, size_t n) {
  for (size_t i = 0; i < n; i++) digest = (digest ^ ((const unsigned char *)bytes)[i]) * 0x100000001b3u;
  return digest;
}

static int32_t emit(ambit_sink *sink, const ambit_record *r) {
  watcher *w = (watcher *)(void *)sink;
  w->last_count = w->s->kit->allocations ? w->s->kit->allocations() : 0;
  if (w->records++ == 0) w->first_count = w->last_count;
  if (w->stopped) find(w->s, "a record after the sink asked to stop");
  if (r->kind == AMBIT_REC_STEP) {
    check_header(w, r);
    check_bounds(w, r);
    check_truth(w->s, r);
    if (rigorous(w->s)) check_gifts(w, r);
    w->t = r->t_to;
    size_t bytes = w->s->problem.nx * sizeof(double);
    memcpy(w->lo, r->lo, bytes), memcpy(w->hi, r->hi, bytes);
    w->digest = mix(mix(mix(w->digest, &r->t_to, sizeof r->t_to), r->lo, bytes), r->hi, bytes);
  }
  w->stopped = w->records == w->stop_after || w->records >= RECORDS_MAX;
  return w->stopped;
}

static int32_t progress(ambit_sink *sink, double done, const char *message) {
  watcher *w = (watcher *)(void *)sink;
  (void)message;
  if (!(done >= w->done && done <= 1)) find(w->s, "progress %g after %g", done, w->done);
  if (w->stopped) find(w->s, "progress after the sink asked to stop");
  w->done = done;
  w->stopped = ++w->calls == w->stop_progress_after;
  return w->stopped;
}

/* -- a run */

typedef struct outcome {
  ambit_status status;
  char reason[AMBIT_MESSAGE_MAX];
} outcome;

static outcome run(state *s, watcher *w) {
  const solver_kit *kit = s->kit;
  outcome o = { .status = AMBIT_NOMEM };
  ambit_lease *lease = NULL;
  void *self = NULL;
  w->sink = (ambit_sink) { sizeof(ambit_sink), emit, progress };
  w->s = s, w->next = 1, w->t = s->problem.time[0];
  if (ambit_lease_open(&lease, NULL, NULL) != AMBIT_OK) return o;
  if (kit->service) lease->host.service = kit->service;
  o.status = kit->plugin->open(&lease->host, &s->problem, s->option, &self);
  if (o.status == AMBIT_OK) {
    o.status = kit->plugin->run(self, &w->sink);
    kit->plugin->close(self);
  }
  snprintf(o.reason, sizeof o.reason, "%s", lease->failure.message);
  ambit_lease_close(lease);
  return o;
}

static uint32_t wanted(const state *s) {
  const ambit_solver *plugin = s->kit->plugin;
  return plugin->want_for ? plugin->want_for(s->option) : plugin->want;
}

static void check_complete(state *s, const watcher *w, const outcome *o) {
  if (o->status != AMBIT_OK) find(s, "ended with status %d at t = %g: %s", o->status, w->t, o->reason);
  if (w->next != s->problem.ntime)
    find(s, "ended at t = %g and left out %zu instants", w->t, s->problem.ntime - w->next);
  if (o->status == AMBIT_OK && o->reason[0]) find(s, "a failure although it is done: %s", o->reason);
  bool correlated = rigorous(s) && (wanted(s) & AMBIT_WANT_INITIAL);
  if (correlated && !(w->hi[0] - w->lo[0] <= s->p->widest))
    find(s, "%g wide at the end: a datum was taken for two", w->hi[0] - w->lo[0]);
}

/* A solver that proves nothing may step over the end without noticing. */
static void check_unable(state *s, const watcher *w, const outcome *o) {
  if (o->status != AMBIT_UNABLE && (rigorous(s) || o->status != AMBIT_OK))
    find(s, "no solution exists beyond t = %g, but the status is %d", s->p->ends, o->status);
  if (o->status != AMBIT_OK && strlen(o->reason) < 10) find(s, "no reason why it ended: `%s`", o->reason);
  if (w->t >= s->p->ends && rigorous(s)) find(s, "an enclosure at t = %a, where no solution exists", w->t);
  if (!(w->t > s->p->ends - NEAR)) find(s, "gave up at t = %g already", w->t);
}

static void check_run(state *s) {
  watcher w = { .s = s }, again = { .s = s };
  outcome o = run(s, &w);
  if (s->p->ends < INFINITY)
    check_unable(s, &w, &o);
  else
    check_complete(s, &w, &o);
  if (w.calls < w.records) find(s, "%u calls of progress in %u steps", w.calls, w.records);
  if (w.records > 1 && w.last_count != w.first_count)
    find(s, "%zu allocations between the first and the last record", w.last_count - w.first_count);
  run(s, &again);
  if (again.digest != w.digest || again.records != w.records) find(s, "another result the second time");
}

/* with every wish: what records say besides is true */
static void check_wishes(state *s) {
  watcher w = { .s = s };
  s->problem.wish = AMBIT_WISH_DENSE | AMBIT_WISH_SET;
  run(s, &w);
  s->problem.wish = 0;
  if (w.records > 1 && w.last_count != w.first_count)
    find(s, "%zu allocations between the first and the last record of a run with wishes", w.last_count - w.first_count);
}

static void check_stops(state *s) {
  for (uint32_t after = 1; after <= 2; after++) {
    watcher by_record = { .stop_after = after }, by_progress = { .stop_progress_after = after };
    outcome o = run(s, &by_record);
    if (o.status != AMBIT_STOPPED || by_record.records != after)
      find(s, "stopped at record %u: status %d after %u records", after, o.status, by_record.records);
    o = run(s, &by_progress);
    if (o.status != AMBIT_STOPPED) find(s, "stopped by progress: status %d", o.status);
  }
}

static void run_problem(state *s) {
  kit_model m;
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  kit_model_open(&m, s->p);
  const ambit_problem_request q = {
    .system = &m.system, .initial = m.initial, .ntime = s->p->ntime, .time = s->p->time, .want = wanted(s)
  };
  if (!arena || ambit_problem_build(&q, arena, &s->problem, &f) != AMBIT_OK)
    find(s, "cannot be built: %s", f.message);
  else {
    s->problem.arithmetic = s->kit->arithmetic;
    s->problem.actx = s->kit->actx;
    check_run(s);
    check_wishes(s);
    check_stops(s);
  }
  kit_model_close(&m);
  ambit_arena_close(arena);
}

size_t solver_kit_run(const solver_kit *kit) {
  double option[OPTIONS_MAX];
  ambit_failure f = { 0 };
  size_t findings = 0;
  if (ambit_params_doubles(kit->plugin->param) > OPTIONS_MAX ||
      ambit_params_resolve(kit->plugin->param, kit->name, kit->noption, kit->option, option, &f) != AMBIT_OK) {
    kit->finding(kit->user, "options", f.message);
    return 1;
  }
  for (size_t i = 0; i < kit_problem_count; i++) {
    state s = { .kit = kit, .p = &kit_problems[i], .option = option };
    run_problem(&s);
    findings += s.findings;
  }
  return findings;
}
