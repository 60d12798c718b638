/* solver_kit_watch.c -- what is checked of each record. */
#include "kit/solver_kit_inside.h"
#include "kit/solver_kit_values.h"
#include "num/interval.h"
#include <math.h>
#include <string.h>

#define SAMPLES 5 /* of times within a step */
#define RECORDS_MAX 100000u
#define WILD 0.1     /* how long before that end errors of a solver that proves nothing are no matter */
#define BESIDE 0.01  /* of the hull's width that a set may stick out of it, ... */
#define ROUNDED 1e-9 /* ... and of its size */

bool kit_is_rigorous(const state *s) { return s->kit->plugin->needs_rigorous != 0; }

static void check_header(watcher *w, const ambit_record *r) {
  state *s = w->s;
  bool backwards = s->problem.time[s->problem.ntime - 1] < s->problem.time[0];
  if (r->size < sizeof *r || r->nx != s->problem.nx)
    kit_find_solver(s, "a record of size %u with %u states", r->size, r->nx);
  if (r->t_from != w->t) kit_find_solver(s, "a step from t = %a after one to %a", r->t_from, w->t);
  if (!(backwards ? r->t_to < r->t_from : r->t_to > r->t_from))
    kit_find_solver(s, "a step from t = %a to %a", r->t_from, r->t_to);
  if ((r->rigorous != 0) != kit_is_rigorous(s)) kit_find_solver(s, "a record that says rigorous = %u", r->rigorous);
  double ahead = w->next < s->problem.ntime ? s->problem.time[w->next] : s->problem.time[s->problem.ntime - 1];
  if (backwards ? r->t_to < ahead : r->t_to > ahead)
    kit_find_solver(s, "a step over the instant %a, to %a", ahead, r->t_to);
  if (r->t_to == ahead) w->next++;
}

static void check_bounds(watcher *w, const ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++) {
    bool good = r->lo[i] <= r->hi[i] && isfinite(r->lo[i]) && isfinite(r->hi[i]);
    if (r->tube_lo && r->tube_hi)
      good = good && r->tube_lo[i] <= r->tube_hi[i] && isfinite(r->tube_lo[i]) && isfinite(r->tube_hi[i]);
    if (!good) kit_find_solver(w->s, "bounds [%a, %a] of state %u at t = %g", r->lo[i], r->hi[i], i, r->t_to);
    if (!kit_is_rigorous(w->s) && r->lo[i] != r->hi[i])
      kit_find_solver(w->s, "a solver that proves nothing gives [%a, %a]", r->lo[i], r->hi[i]);
  }
}

static void check_point(state *s, double t, const double *u, const double *lo, const double *hi, const char *what) {
  ambit_interval truth[KIT_STATES];
  /* an answer where there is no solution is found elsewhere; just before the end any error grows without bound */
  if (t >= s->p->ends - (kit_is_rigorous(s) ? 0 : WILD)) return;
  kit_truth(s->p, t, u, truth);
  s->counts->compared += s->problem.nx;
  for (uint32_t i = 0; i < s->problem.nx; i++) {
    double slack = kit_is_rigorous(s) ? 0 : s->kit->tolerance * (1 + fabs(truth[i].hi));
    if (!(lo[i] <= truth[i].hi + slack && hi[i] >= truth[i].lo - slack))
      kit_find_solver(s, "%s at t = %a misses state %u of the solution for u = (%a, ...): [%a, %a], truth in [%a, %a]",
          what, t, i, u[0], lo[i], hi[i], truth[i].lo, truth[i].hi);
  }
}

/* sample k of the data; a solver that proves nothing follows their middle */
static bool sample(const state *s, size_t k, double u[KIT_DATA]) {
  memset(u, 0, KIT_DATA * sizeof *u);
  if (kit_is_rigorous(s)) return kit_sample(s->p, k, u);
  for (uint32_t j = 0; j < s->p->nu; j++) u[j] = 0.5 * s->p->u_lo[j] + 0.5 * s->p->u_hi[j];
  return k == 0;
}

static void check_samples(state *s, double t, const double *lo, const double *hi, const char *what) {
  double u[KIT_DATA];
  for (size_t k = 0; sample(s, k, u); k++) check_point(s, t, u, lo, hi, what);
}

static double instant(const ambit_record *r, int j) {
  return j < SAMPLES ? r->t_from + (double)j / SAMPLES * (r->t_to - r->t_from) : r->t_to;
}

static void check_truth(state *s, const ambit_record *r) {
  s->counts->enclosures++;
  check_samples(s, r->t_to, r->lo, r->hi, "the enclosure");
  if (!r->tube_lo || !r->tube_hi) return;
  s->counts->tubes++;
  for (int j = 0; j <= SAMPLES; j++) check_samples(s, instant(r, j), r->tube_lo, r->tube_hi, "the tube");
}

/* -- what records say besides */

static void check_meets(state *s, double t, uint32_t i, ambit_interval x, double lo, double hi, const char *what) {
  if (!(x.lo <= hi && x.hi >= lo))
    kit_find_solver(
        s, "%s of state %u at t = %a, [%a, %a], does not meet the bounds [%a, %a]", what, i, t, x.lo, x.hi, lo, hi);
}

static void check_dense(watcher *w, const ambit_record *r) {
  state *s = w->s;
  const char *fault = kit_dense_fault(r);
  if (fault) kit_find_solver(s, "the dense enclosure to t = %a: %s", r->t_to, fault);
  if (fault || !r->dense_mid) return;
  double lo[KIT_STATES], hi[KIT_STATES];
  s->counts->dense++;
  for (int j = 0; j <= SAMPLES; j++) {
    double t = instant(r, j);
    ambit_interval since = ambit_interval_sub((ambit_interval) { t, t }, (ambit_interval) { r->t_from, r->t_from });
    for (uint32_t i = 0; i < r->nx; i++) {
      ambit_interval x = kit_dense_value(r, i, since);
      lo[i] = x.lo, hi[i] = x.hi;
      if (j == 0 && w->records > 1) check_meets(s, t, i, x, w->lo[i], w->hi[i], "the dense enclosure");
      if (j == SAMPLES) check_meets(s, t, i, x, r->lo[i], r->hi[i], "the dense enclosure");
    }
    check_samples(s, t, lo, hi, "the dense enclosure");
  }
}

/* A state is in the set and within the bounds; where invariants have cut the bounds, the set may be larger. */
static void check_hull(state *s, const ambit_record *r, uint32_t i, ambit_interval x) {
  double slack = BESIDE * (r->hi[i] - r->lo[i]) + ROUNDED * fmax(fabs(r->lo[i]), fabs(r->hi[i]));
  check_meets(s, r->t_to, i, x, r->lo[i], r->hi[i], "the set");
  if (s->problem.ninvariant == 0 && !(x.lo >= r->lo[i] - slack && x.hi <= r->hi[i] + slack))
    kit_find_solver(s, "the set of state %u at t = %a, [%a, %a], sticks out of [%a, %a]", i, r->t_to, x.lo, x.hi,
        r->lo[i], r->hi[i]);
}

static void check_set(state *s, const ambit_record *r) {
  const char *fault = kit_set_fault(r, s->problem.nu);
  if (fault) kit_find_solver(s, "the set at t = %a: %s", r->t_to, fault);
  if (fault || !r->set) return;
  double lo[KIT_STATES], hi[KIT_STATES], u[KIT_DATA], theirs[KIT_DATA] = { 0 };
  s->counts->sets++;
  for (size_t k = 0; sample(s, k, u); k++) {
    for (uint32_t j = 0; j < s->problem.nu; j++) theirs[j] = u[s->datum[j]];
    for (uint32_t i = 0; i < r->nx; i++) {
      ambit_interval x = kit_set_value(r->set, i, theirs);
      lo[i] = x.lo, hi[i] = x.hi;
      check_hull(s, r, i, x);
    }
    check_point(s, r->t_to, u, lo, hi, "the set");
  }
}

static void check_gifts(watcher *w, const ambit_record *r) {
  state *s = w->s;
  uint32_t extras = s->problem.extras, missing = extras & s->kit->gives;
  if ((!(extras & AMBIT_EXTRA_DENSE) && r->dense_mid) || (!(extras & AMBIT_EXTRA_SET) && r->set))
    kit_find_solver(s, "a dense enclosure or a set that nobody asked for");
  if (((missing & AMBIT_EXTRA_DENSE) && !r->dense_mid) || ((missing & AMBIT_EXTRA_SET) && !r->set))
    kit_find_solver(s, "no dense enclosure, or no set, in the step to t = %a", r->t_to);
  check_dense(w, r);
  check_set(s, r);
}

static uint64_t mix(uint64_t digest, const void *bytes, size_t n) {
  for (size_t i = 0; i < n; i++) digest = (digest ^ ((const unsigned char *)bytes)[i]) * 0x100000001b3u;
  return digest;
}

int32_t kit_emit(ambit_sink *sink, const ambit_record *r) {
  watcher *w = (watcher *)(void *)sink;
  w->last_count = w->s->kit->allocations ? w->s->kit->allocations() : 0;
  if (w->records++ == 0) w->first_count = w->last_count;
  if (w->stopped) kit_find_solver(w->s, "a record after the sink asked to stop");
  if (r->kind == AMBIT_REC_STEP) {
    check_header(w, r);
    check_bounds(w, r);
    check_truth(w->s, r);
    if (kit_is_rigorous(w->s)) check_gifts(w, r);
    w->t = r->t_to;
    size_t bytes = w->s->problem.nx * sizeof(double);
    memcpy(w->lo, r->lo, bytes), memcpy(w->hi, r->hi, bytes);
    w->digest = mix(mix(mix(w->digest, &r->t_to, sizeof r->t_to), r->lo, bytes), r->hi, bytes);
  }
  w->stopped = w->records == w->stop_after || w->records >= RECORDS_MAX;
  return w->stopped;
}

int32_t kit_progress(ambit_sink *sink, double done, const char *message) {
  watcher *w = (watcher *)(void *)sink;
  (void)message;
  w->s->counts->compared++;
  if (!(done >= w->done && done <= 1)) kit_find_solver(w->s, "progress %g after %g", done, w->done);
  if (w->stopped) kit_find_solver(w->s, "progress after the sink asked to stop");
  w->done = done;
  w->stopped = ++w->calls == w->stop_progress_after;
  return w->stopped;
}
