/* sample.c -- draws of expressions: blocks of lanes on the threads of a pool. */
#include <ambit/sample.h>
#include "verbs/sample/batch.h"
#include "graph/hull.h"
#include "graph/tape.h"
#include "host/pool.h"
#include "verbs/run/processors.h"
#include "verbs/evaluate/bound.h"
#include "verbs/run/context.h"
#include "verbs/sample/sample_inside.h"
#include "verbs/sample/sample_points.h"
#include "verbs/sample/sample_polish.h"
#include "verbs/run/tally.h"
#include "models/default.h"
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>

#define LANES 1024u
#define FINEST 0x1p-20 /* part of a range, at which the search ends */

/* What one thread needs. */
typedef struct drawer {
  ambit_context context;
  ambit_batch *batch;
  double *point;     /* [nunknown][LANES] */
  double *rlo, *rhi; /* [nexpr][LANES] */
  ambit_extremes extremes;
  size_t *defined; /* [nexpr] */
} drawer;

typedef struct job {
  const ambit_evaluate_request *q;
  const ambit_sample_plan *plan;
  const char *arithmetic;
  ambit_arena *arena;
  ambit_bound bound;
  ambit_interval *range; /* [nunknown] */
  const ambit_tape *tape;
  ambit_sample_points *points;
  uint32_t ndrawer;
  drawer *drawer;
  atomic_size_t done; /* draws */
} job;

static void *room(const job *j, size_t n, size_t size) { return ambit_arena_alloc(j->arena, (n + 1) * size); }

static ambit_status find_ranges(job *j, ambit_failure *f) {
  j->range = room(j, j->bound.nunknown, sizeof *j->range);
  if (!j->range) return ambit_no_memory(f);
  for (size_t i = 0; i < j->bound.nunknown; i++) {
    const ambit_node *node = ambit_graph_node(j->q->graph, j->bound.unknown[i]);
    j->range[i] = ambit_sample_range(node);
    ambit_status status = ambit_sample_check_range(j->q->graph, j->bound.unknown[i], f);
    if (status != AMBIT_OK) return status;
  }
  return AMBIT_OK;
}

static ambit_status open_drawer(job *j, drawer *d, ambit_failure *f) {
  size_t nu = j->bound.nunknown, results = j->q->nexpr * LANES;
  d->point = room(j, nu * LANES, sizeof *d->point);
  d->rlo = room(j, results, sizeof *d->rlo);
  d->rhi = room(j, results, sizeof *d->rhi);
  d->defined = room(j, j->q->nexpr, sizeof *d->defined);
  if (!d->point || !d->rlo || !d->rhi || !d->defined) return ambit_no_memory(f);
  if (!ambit_extremes_open(&d->extremes, j->arena, j->q->nexpr, nu)) return ambit_no_memory(f);
  ambit_status status =
      ambit_context_open(j->q->registry, j->arithmetic, j->q->noption, j->q->option, (uint32_t)nu, &d->context, f);
  if (status != AMBIT_OK) return status;
  return ambit_batch_open(j->tape, d->context.arithmetic, d->context.ctx, &d->batch, f);
}

static ambit_status open_drawers(job *j, ambit_failure *f) {
  uint32_t n = j->plan->threads;
  size_t blocks = (j->plan->draws - 1) / LANES + 1;
  ambit_status status = n ? AMBIT_OK : ambit_processors_threads(&n, f);
  if (status != AMBIT_OK) return status;
  if (n > blocks) n = (uint32_t)blocks;
  j->drawer = room(j, n, sizeof *j->drawer);
  if (!j->drawer) return ambit_no_memory(f);
  while (j->ndrawer < n && status == AMBIT_OK) status = open_drawer(j, &j->drawer[j->ndrawer++], f);
  return status;
}

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_evaluate_request *q = j->q;
  ambit_status status = ambit_bound_build(q, j->arena, &j->bound, f);
  if (status == AMBIT_OK) status = find_ranges(j, f);
  if (status != AMBIT_OK) return status;
  size_t nu = j->bound.nunknown;
  status = ambit_tape_seal(q->graph, j->arena, q->nexpr, j->bound.expr, nu, j->bound.unknown, 0, 0, &j->tape, f);
  if (status == AMBIT_OK) status = ambit_sample_open_points(q->registry, j->plan, nu, j->range, &j->points, f);
  return status == AMBIT_OK ? open_drawers(j, f) : status;
}

/* -- the draws */

/* Values into rlo: NaN where there is none. */
static void run_lanes(job *j, drawer *d, size_t lanes, const double *point) {
  ambit_batch_run(d->batch, lanes, point, point, NULL, d->rlo, d->rhi);
  for (size_t i = 0; i < j->q->nexpr * lanes; i++) {
    ambit_interval x = { d->rlo[i], d->rhi[i] };
    bool good = x.lo <= x.hi && ambit_interval_is_bounded(x);
    d->rlo[i] = !good ? NAN : x.lo == x.hi ? x.lo : ambit_interval_mid(x);
  }
}

static ambit_status make_block(void *user, uint32_t item, uint32_t worker) {
  (void)item; /* blocks are numbered by the points */
  job *j = user;
  drawer *d = &j->drawer[worker];
  size_t first, lanes;
  ambit_status status = ambit_sample_points_next(j->points, LANES, d->point, &first, &lanes);
  if (status != AMBIT_OK || !lanes) return status;
  run_lanes(j, d, lanes, d->point);
  for (size_t e = 0; e < j->q->nexpr; e++)
    for (size_t lane = 0; lane < lanes; lane++) {
      double value = d->rlo[e * lanes + lane];
      d->defined[e] += isnan(value) ? 0 : 1;
      ambit_extremes_see(&d->extremes, e, value, first + lane, d->point + lane, lanes);
    }
  atomic_fetch_add(&j->done, lanes);
  return AMBIT_OK;
}

static int32_t tell_progress(void *user) {
  job *j = user;
  return ambit_sample_progress(j->plan->sink, (double)atomic_load(&j->done) / (double)j->plan->draws);
}

static ambit_status run_draws(job *j, ambit_sample_result *result, ambit_failure *f) {
  size_t blocks = (j->plan->draws - 1) / LANES + 1;
  ambit_pool *pool;
  if (blocks > UINT32_MAX) return ambit_fail(f, AMBIT_INVALID, "%zu draws are too many", j->plan->draws);
  ambit_status status = ambit_pool_open(NULL, j->ndrawer, &pool);
  if (status == AMBIT_OK) status = ambit_pool_run(pool, (uint32_t)blocks, make_block, j, tell_progress);
  ambit_pool_close(pool);
  result->draws = atomic_load(&j->done);
  result->status = status == AMBIT_STOPPED ? status : AMBIT_OK;
  if (status == AMBIT_OK || status == AMBIT_STOPPED) return AMBIT_OK;
  return status == AMBIT_NOMEM ? ambit_no_memory(f) : ambit_fail(f, status, "sample: no further points");
}

/* -- the search, by the first drawer, whose extremes are those of all */

static ambit_status evaluate_points(void *user, size_t count, const double *point, double *value) {
  job *j = user;
  drawer *d = &j->drawer[0];
  for (size_t done = 0; done < count; done += LANES) {
    size_t lanes = count - done < LANES ? count - done : LANES;
    for (size_t i = 0; i < j->bound.nunknown; i++)
      for (size_t lane = 0; lane < lanes; lane++) d->point[i * lanes + lane] = point[i * count + done + lane];
    run_lanes(j, d, lanes, d->point);
    for (size_t e = 0; e < j->q->nexpr; e++)
      for (size_t lane = 0; lane < lanes; lane++) value[e * count + done + lane] = d->rlo[e * lanes + lane];
  }
  return tell_progress(j) ? AMBIT_STOPPED : AMBIT_OK;
}

static ambit_status polish(job *j, ambit_sample_result *result, ambit_failure *f) {
  if (!j->plan->polish || j->plan->draws < AMBIT_SAMPLE_FEWEST || result->status != AMBIT_OK) return AMBIT_OK;
  size_t most = j->plan->draws * 64 < 20000 ? j->plan->draws * 64 : 20000;
  ambit_polish q = { .range = j->range,
    .extremes = &j->drawer[0].extremes,
    .budget = j->plan->draws > most ? j->plan->draws : most,
    .finest = FINEST,
    .first = j->plan->draws,
    .evaluate = evaluate_points,
    .user = j };
  ambit_status status = ambit_polish_run(&q, j->arena, &result->polished);
  if (status == AMBIT_STOPPED) result->status = status;
  return status == AMBIT_NOMEM ? ambit_no_memory(f) : AMBIT_OK;
}

/* -- what is told */

/* How far a value that was seen can be off: the kernel's intervals at its point enclose the true one. */
static double error_of(const job *j, const ambit_extreme *x, size_t e, ambit_interval *in, ambit_interval *slot) {
  for (size_t i = 0; i < j->bound.nunknown; i++) {
    const ambit_node *datum = ambit_graph_node(j->q->graph, j->bound.unknown[i]);
    bool allowed = !ambit_interval_is_empty(datum->inner);
    in[i] = allowed ? (ambit_interval) { x->point[i], x->point[i] } : datum->value;
  }
  ambit_hull(j->tape, in, slot);
  ambit_interval true_value = slot[j->tape->out[e]];
  if (ambit_interval_is_empty(true_value)) return INFINITY;
  return fmax(fabs(x->value - true_value.lo), fabs(true_value.hi - x->value)) * (1 + 0x1p-50);
}

static ambit_status tell(const job *j, ambit_interval *hull, double *error, size_t *defined, ambit_failure *f) {
  ambit_interval *in = room(j, j->bound.nunknown, sizeof *in), *slot = room(j, j->tape->nslot, sizeof *slot);
  if (!in || !slot) return ambit_no_memory(f);
  for (size_t e = 0; e < j->q->nexpr; e++) {
    const ambit_extreme *x = &j->drawer[0].extremes.at[e * AMBIT_SIDES];
    hull[e] = x->seen ? (ambit_interval) { x[AMBIT_LEAST].value, x[AMBIT_GREATEST].value } : AMBIT_EMPTY;
    if (error) error[e] = 0;
    for (int side = 0; side < AMBIT_SIDES && error && x->seen; side++)
      error[e] = fmax(error[e], error_of(j, &x[side], e, in, slot));
    if (defined) defined[e] = 0;
    for (uint32_t k = 0; k < j->ndrawer && defined; k++) defined[e] += j->drawer[k].defined[e];
  }
  return AMBIT_OK;
}

static void fill_report(const job *j, double built, ambit_sample_result *result, ambit_report *report) {
  ambit_sample_tell_points(j->points, result);
  result->threads = j->ndrawer;
  if (!report) return;
  *report = (ambit_report) { .expressions = (uint32_t)j->q->nexpr, .unknowns = (uint32_t)j->bound.nunknown };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
  report->graph_nodes = ambit_graph_made(j->q->graph);
  ambit_report_count(report, j->tape);
  report->seconds_build = built;
  for (uint32_t k = 0; k < j->ndrawer; k++) {
    ambit_work opened = ambit_scope_work(j->drawer[k].context.scope);
    ambit_work_add(&report->work, &opened);
    ambit_work_add(&report->work, ambit_batch_work(j->drawer[k].batch));
  }
  report->seconds_run = result->cpu_seconds;
}

static ambit_status draw(job *j, ambit_sample_result *result, ambit_failure *f) {
  ambit_status status = run_draws(j, result, f);
  for (uint32_t k = 1; k < j->ndrawer; k++) ambit_extremes_merge(&j->drawer[0].extremes, &j->drawer[k].extremes);
  if (status == AMBIT_OK) status = polish(j, result, f);
  for (uint32_t k = 0; k < j->ndrawer && status == AMBIT_OK; k++)
    status = ambit_context_sound(&j->drawer[k].context, f);
  return status;
}

static void close_job(job *j) {
  for (uint32_t k = 0; k < j->ndrawer; k++) {
    ambit_batch_close(j->drawer[k].batch);
    ambit_context_close(&j->drawer[k].context);
  }
  ambit_sample_points_close(j->points);
  ambit_arena_close(j->arena);
}

ambit_status ambit_sample_expressions(const ambit_evaluate_request *q, const ambit_sample_plan *plan,
    ambit_interval *hull, double *error, size_t *defined, ambit_sample_result *result, ambit_report *report,
    ambit_failure *f) {
  *result = (ambit_sample_result) { 0 };
  if (plan->draws == 0) return ambit_fail(f, AMBIT_INVALID, "sample needs at least one draw");
  job j = { .q = q,
    .plan = plan,
    .arithmetic = q->arithmetic ? q->arithmetic : AMBIT_DEFAULT_POINTS,
    .arena = ambit_arena_open() };
  if (!j.arena) return ambit_no_memory(f);
  double start = ambit_context_seconds(), wall = ambit_sample_wall();
  ambit_meter_enter(AMBIT_FRAME_STAGE, "graph");
  ambit_status status = prepare(&j, f);
  ambit_meter_leave();
  double built = ambit_context_seconds();
  ambit_stage_enter("run", AMBIT_FRAME_ARITHMETIC, j.arithmetic);
  if (status == AMBIT_OK) status = draw(&j, result, f);
  ambit_stage_leave();
  if (status == AMBIT_OK) status = tell(&j, hull, error, defined, f);
  result->cpu_seconds = ambit_context_seconds() - built;
  result->wall_seconds = ambit_sample_wall() - wall;
  if (status == AMBIT_OK) fill_report(&j, built - start, result, report);
  close_job(&j);
  return status;
}
