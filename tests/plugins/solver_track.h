/* solver_track.h -- every record of a run, kept, and judged by solutions in 300-bit arithmetic. */
#ifndef AMBIT_SOLVER_TRACK_H
#define AMBIT_SOLVER_TRACK_H
#include "kit/reference_models.h"
#include "kit/solution_oracle.h"
#include "graph/tape.h"
#include "verbs/simulate/problem.h"
#include <ambit/simulate.h>
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define TRACK_RECORDS 4096
#define TRACK_UNKNOWNS 8

typedef struct track_record {
  double from, to, lo[MODEL_STATES], hi[MODEL_STATES], tube_lo[MODEL_STATES], tube_hi[MODEL_STATES];
} track_record;

typedef struct track {
  ambit_sink sink; /* first */
  size_t nx, count;
  track_record *record;
  ambit_simulate_result result;
} track;

static inline int32_t track_emit(ambit_sink *sink, const ambit_record *r) {
  track *k = (track *)(void *)sink;
  if (k->count == TRACK_RECORDS) return 1;
  track_record *at = &k->record[k->count++];
  size_t bytes = r->nx * sizeof(double);
  at->from = r->t_from, at->to = r->t_to, k->nx = r->nx;
  memcpy(at->lo, r->lo, bytes), memcpy(at->hi, r->hi, bytes);
  memcpy(at->tube_lo, r->tube_lo, bytes), memcpy(at->tube_hi, r->tube_hi, bytes);
  return 0;
}

static inline track track_run(
    const model *m, size_t ntime, const double *time, size_t noption, const ambit_option *option) {
  track k = { .sink = { sizeof(ambit_sink), track_emit, NULL } };
  ambit_failure f = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  k.record = malloc(TRACK_RECORDS * sizeof *k.record);
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "lohner",
    .nsolver_option = noption,
    .solver_option = option,
    .initial = m->initial,
    .ntime = ntime,
    .time = time,
    .sink = &k.sink };
  if (!k.record || ambit_simulate(&q, &k.result, NULL, &f) != AMBIT_OK) fail_msg("%s%s", m->failure.message, f.message);
  ambit_registry_close(registry);
  return k;
}

static inline void track_close(track *k) { free(k->record); }

/* the record that ends at t */
static inline const track_record *track_at(const track *k, double t) {
  for (size_t i = 0; i < k->count; i++)
    if (k->record[i].to == t) return &k->record[i];
  fail_msg("no record ends at t = %a; %s", t, k->result.reason);
  return NULL;
}

static inline double track_widest(const track *k, const track_record *r) {
  double most = 0;
  for (size_t i = 0; i < k->nx; i++) most = fmax(most, r->hi[i] - r->lo[i]);
  return most;
}

/* misses of the solution that starts from the oracle's states, in enclosures and in tubes, looked at in the middle of
** every step */
static inline size_t track_follow(const track *k, solution_oracle *o, int show) {
  size_t misses = 0;
  for (size_t n = 0; n < k->count; n++) {
    const track_record *r = &k->record[n];
    solution_advance(o, 0.5 * (r->from + r->to));
    for (uint32_t i = 0; i < k->nx; i++) {
      if (solution_within(o, i, r->tube_lo[i], r->tube_hi[i])) continue;
      if (show && !misses)
        print_error("tube of state %u in [%g, %g]: [%.17g, %.17g]\n", i, r->from, r->to, r->tube_lo[i], r->tube_hi[i]);
      misses++;
    }
    solution_advance(o, r->to);
    for (uint32_t i = 0; i < k->nx; i++) {
      if (solution_within(o, i, r->lo[i], r->hi[i]) && solution_within(o, i, r->tube_lo[i], r->tube_hi[i])) continue;
      if (show && !misses) print_error("state %u at t = %g: [%.17g, %.17g]\n", i, r->to, r->lo[i], r->hi[i]);
      misses++;
    }
  }
  return misses;
}

static inline size_t track_misses(const track *k, solution_oracle *o, const double *u, int show) {
  solution_start(o, u);
  return track_follow(k, o, show);
}

/* `samples` solutions: corners of the data's box first, then random ones */
static inline size_t track_check(
    const track *k, const model *m, size_t ntime, const double *time, int samples, int show) {
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_problem p;
  solution_oracle o;
  uint64_t random = 77;
  size_t misses = 0;
  const ambit_problem_request q = { .system = &m->system,
    .initial = m->initial,
    .ntime = ntime,
    .time = time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL,
    .seal = AMBIT_SEAL_KEEP };
  if (ambit_problem_build(&q, arena, &p, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_true(p.nu <= TRACK_UNKNOWNS);
  solution_open(&o, &p);
  for (int n = 0; n < samples; n++) {
    double u[TRACK_UNKNOWNS];
    for (uint32_t i = 0; i < p.nu; i++)
      u[i] = n == 0           ? 0.5 * (p.u_lo[i] + p.u_hi[i])
             : n <= 1 << p.nu ? (n - 1) >> i & 1 ? p.u_hi[i] : p.u_lo[i]
                              : oracle_uniform(&random, p.u_lo[i], p.u_hi[i]);
    misses += track_misses(k, &o, u, show);
  }
  solution_close(&o);
  ambit_arena_close(arena);
  return misses;
}
#endif
