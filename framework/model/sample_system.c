/* sample_system.c -- the passes of a sample of a system: the draws, those that the lanes lost once more one by one, the
** search from the extremes, the estimate of the error. Results of blocks are put together by hulls, so neither the
** order nor the number of threads matters.
*/
#include "graph/tape.h"
#include "host/pool.h"
#include "host/processors.h"
#include "model/context.h"
#include "model/sample_error.h"
#include "model/sample_flow.h"
#include "model/sample_inside.h"
#include "model/sample_polish.h"
#include "model/tally.h"
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#define INSTANTS 8u    /* at which extremes are followed, at most */
#define FINEST 0x1p-10 /* part of a range, at which the search ends */

struct job;

/* What one thread needs. */
typedef struct drawer {
  struct job *job;
  ambit_flow_block block;
  double *point; /* [nu][AMBIT_FLOW_LANES] */
  size_t first;  /* draw of its lane 0 */
  double *value; /* of a search: [quantities][count], lane 0 at `column`; or NULL */
  size_t column, count;
  ambit_interval *hull; /* [ntime * nx] */
  ambit_extremes extremes;
} drawer;

/* A draw that the lanes lost. */
typedef struct lost_draw {
  size_t draw;
  double point[];
} lost_draw;

typedef struct job {
  const ambit_simulate_request *q;
  ambit_sample_plan plan; /* threads > 0 */
  ambit_arena *arena;
  ambit_flow *flow;
  const ambit_problem *problem;
  ambit_sample_points *points;
  ambit_pool *pool;
  uint32_t ninstant, *instant; /* followed ones; [ntime] number among them, or ninstant */
  drawer *drawer;              /* [threads] */
  const double *candidates;    /* of a search, [nu][count] */
  atomic_bool stopping;
  atomic_bool stiff; /* a block was */
  pthread_mutex_t lock;
  /* guarded by the lock */
  ambit_sample_result *result;
  size_t first_failed; /* of the draws, whose reason is told */
  lost_draw **lost;    /* [nlost] */
  size_t nlost, room_lost;
  ambit_failure broken;
} job;

static void *room(const job *j, size_t n, size_t size) { return ambit_arena_alloc(j->arena, (n + 1) * size); }

static ambit_status no_memory(ambit_failure *f) { return ambit_fail(f, AMBIT_NOMEM, "out of memory"); }

/* -- what is seen of a draw */

static void see(void *user, uint32_t k, size_t lane, const double *x, size_t stride) {
  drawer *d = user;
  const job *j = d->job;
  size_t nx = j->problem->nx, at = j->instant[k] * nx;
  ambit_interval *hull = d->hull + k * nx;
  const double *point = d->block.point + lane;
  for (size_t i = 0; i < nx; i++) {
    double value = x[i * stride];
    hull[i] = ambit_interval_hull(hull[i], (ambit_interval) { value, value });
    if (j->instant[k] == j->ninstant) continue;
    if (d->value)
      d->value[(at + i) * d->count + d->column + lane] = value;
    else
      ambit_extremes_see(&d->extremes, at + i, value, d->first + lane, point, d->block.n);
  }
}

static int32_t tell_progress(void *user) {
  job *j = user;
  pthread_mutex_lock(&j->lock);
  double done = (double)j->result->draws / (double)j->plan.draws;
  pthread_mutex_unlock(&j->lock);
  int32_t stop = ambit_sample_progress(j->plan.sink, done);
  if (stop) atomic_store(&j->stopping, true);
  return stop;
}

/* Between steps: on a thread of its own the caller can't ask. */
static int32_t pause(void *user) {
  drawer *d = user;
  if (d->job->plan.threads == 1) tell_progress(d->job);
  return atomic_load(&d->job->stopping);
}

/* -- preparations */

/* As many instants as the search can afford, equidistant ones, always the last. */
static bool choose_instants(job *j) {
  const ambit_problem *p = j->problem;
  size_t each = (size_t)p->nx * AMBIT_SIDES * (2 * (size_t)p->nu + 1) * 2, most = j->plan.draws / (each + 1);
  uint32_t later = p->ntime - 1;
  j->ninstant = most < 1 ? 1 : most < INSTANTS ? (uint32_t)most : INSTANTS;
  if (j->ninstant > later) j->ninstant = later;
  j->instant = room(j, p->ntime, sizeof *j->instant);
  if (!j->instant) return false;
  for (uint32_t k = 0; k < p->ntime; k++) j->instant[k] = j->ninstant;
  for (uint32_t m = 0; m < j->ninstant; m++) j->instant[(uint32_t)((uint64_t)later * (m + 1) / j->ninstant)] = m;
  return true;
}

static bool open_drawer(job *j, drawer *d) {
  const ambit_problem *p = j->problem;
  size_t values = (size_t)p->ntime * p->nx;
  d->job = j;
  d->point = room(j, (size_t)p->nu * AMBIT_FLOW_LANES, sizeof *d->point);
  d->hull = room(j, values, sizeof *d->hull);
  if (!d->point || !d->hull) return false;
  for (size_t i = 0; i < values; i++) d->hull[i] = AMBIT_EMPTY;
  return ambit_extremes_open(&d->extremes, j->arena, (size_t)j->ninstant * p->nx, p->nu);
}

static ambit_status prepare(job *j, ambit_failure *f) {
  ambit_status status = j->plan.threads ? AMBIT_OK : ambit_processors_threads(&j->plan.threads, f);
  if (status != AMBIT_OK) return status;
  if (j->plan.threads > j->plan.draws) j->plan.threads = (uint32_t)j->plan.draws;
  status = ambit_flow_open(j->q, &j->plan, &j->flow, f);
  if (status != AMBIT_OK) return status;
  j->problem = ambit_flow_problem(j->flow);
  j->drawer = room(j, j->plan.threads, sizeof *j->drawer);
  if (!j->drawer || !choose_instants(j)) return no_memory(f);
  for (uint32_t i = 0; i < j->plan.threads; i++)
    if (!open_drawer(j, &j->drawer[i])) return no_memory(f);
  if (ambit_pool_open(NULL, j->plan.threads, &j->pool) != AMBIT_OK) return no_memory(f);
  return ambit_sample_open_points(j->q->registry, &j->plan, j->problem->nu, ambit_flow_range(j->flow), &j->points, f);
}

/* -- a block of draws */

static void begin_block(drawer *d, size_t n, bool alone) {
  d->block.n = n;
  d->block.point = d->point;
  d->block.alone = alone;
  d->block.see = see;
  d->block.pause = pause;
  d->block.user = d;
}

/* [lock held] */
static ambit_status keep_lost(job *j, const drawer *d, size_t lane) {
  size_t nu = j->problem->nu;
  if (j->nlost == j->room_lost) {
    size_t most = j->room_lost ? 2 * j->room_lost : 64;
    lost_draw **grown = realloc(j->lost, most * sizeof *grown);
    if (!grown) return AMBIT_NOMEM;
    j->lost = grown, j->room_lost = most;
  }
  lost_draw *lost = malloc(sizeof *lost + nu * sizeof *lost->point);
  if (!lost) return AMBIT_NOMEM;
  lost->draw = d->first + lane;
  for (size_t i = 0; i < nu; i++) lost->point[i] = d->point[i * d->block.n + lane];
  j->lost[j->nlost++] = lost;
  return AMBIT_OK;
}

/* A draw of the lanes that is lost counts later; nobody is lost for good before it was tried one by one. */
static ambit_status count_block(job *j, const drawer *d, ambit_status status) {
  pthread_mutex_lock(&j->lock);
  if (status != AMBIT_OK) ambit_fail(&j->broken, status, "%s", d->block.reason);
  for (size_t lane = 0; lane < d->block.n && status == AMBIT_OK && !d->block.stopped; lane++) {
    ambit_fate fate = d->block.fate[lane];
    if (fate == AMBIT_FATE_LOST) status = keep_lost(j, d, lane);
    if (fate == AMBIT_FATE_LOST) continue;
    j->result->draws++;
    j->result->failed += fate != AMBIT_FATE_REACHED;
    j->result->off += fate == AMBIT_FATE_OFF;
    if (fate == AMBIT_FATE_REACHED || d->first + lane >= j->first_failed) continue;
    j->first_failed = d->first + lane;
    snprintf(j->result->reason, sizeof j->result->reason, "%s", d->block.reason);
  }
  pthread_mutex_unlock(&j->lock);
  return status;
}

static size_t lanes_of_block(const job *j) { return ambit_flow_is_one_by_one(j->flow) ? 1 : AMBIT_FLOW_LANES; }

static ambit_status make_block(void *user, uint32_t item, uint32_t worker) {
  (void)item; /* blocks are numbered by the points */
  job *j = user;
  drawer *d = &j->drawer[worker];
  size_t n;
  ambit_status status = ambit_sample_points_next(j->points, lanes_of_block(j), d->point, &d->first, &n);
  if (status != AMBIT_OK || n == 0) return status;
  begin_block(d, n, false);
  status = ambit_flow_make(j->flow, worker, &d->block);
  if (d->block.stiff) atomic_store(&j->stiff, true);
  return count_block(j, d, status);
}

static ambit_status make_lost(void *user, uint32_t item, uint32_t worker) {
  job *j = user;
  drawer *d = &j->drawer[worker];
  memcpy(d->point, j->lost[item]->point, j->problem->nu * sizeof *d->point);
  d->first = j->lost[item]->draw;
  begin_block(d, 1, true);
  return count_block(j, d, ambit_flow_make(j->flow, worker, &d->block));
}

/* Items in runs of the pool, which counts them with 32 bits. */
static ambit_status run_pool(job *j, size_t items, ambit_pool_job each) {
  if (items > UINT32_MAX) return AMBIT_INVALID;
  ambit_status status = ambit_pool_run(j->pool, (uint32_t)items, each, j, tell_progress);
  return status == AMBIT_OK && atomic_load(&j->stopping) ? AMBIT_STOPPED : status;
}

static ambit_status tell_broken(const job *j, ambit_status status, ambit_failure *f) {
  if (status == AMBIT_OK || status == AMBIT_STOPPED) return status;
  if (status == AMBIT_NOMEM && !j->broken.message[0]) return no_memory(f);
  return ambit_fail(f, status, "%s", j->broken.message[0] ? j->broken.message : "sample: too many draws");
}

/* -- the passes */

/* The first block shows whether the lanes are for this system; if not, everything goes one by one from the start. */
static ambit_status try_first(job *j, ambit_failure *f) {
  ambit_status status = make_block(j, 0, 0);
  if (status != AMBIT_OK || !atomic_load(&j->stiff)) return tell_broken(j, status, f);
  for (size_t i = 0; i < j->nlost; i++) free(j->lost[i]);
  j->nlost = 0;
  *j->result = (ambit_sample_result) { 0 };
  j->first_failed = SIZE_MAX;
  status = ambit_flow_use_gsl(j->flow, true, true, f);
  if (status != AMBIT_OK) return status;
  ambit_sample_points_close(j->points);
  j->points = NULL;
  return ambit_sample_open_points(j->q->registry, &j->plan, j->problem->nu, ambit_flow_range(j->flow), &j->points, f);
}

static ambit_status draw_all(job *j, ambit_failure *f) {
  ambit_status status = ambit_flow_is_one_by_one(j->flow) ? AMBIT_OK : try_first(j, f);
  size_t blocks = (j->plan.draws - 1) / lanes_of_block(j) + 1;
  if (status == AMBIT_OK) status = tell_broken(j, run_pool(j, blocks, make_block), f);
  return status;
}

static ambit_status draw_lost(job *j, ambit_failure *f) {
  if (j->nlost == 0) return AMBIT_OK;
  ambit_failure own = { 0 };
  ambit_status status = ambit_flow_use_gsl(j->flow, false, atomic_load(&j->stiff), &own);
  j->result->one_by_one = j->nlost;
  if (status == AMBIT_OK) return tell_broken(j, run_pool(j, j->nlost, make_lost), f);
  j->result->draws += j->nlost;
  j->result->failed += j->nlost;
  if (!j->result->reason[0])
    snprintf(
        j->result->reason, sizeof j->result->reason, "the solution escapes or has no rate, and %.900s", own.message);
  return AMBIT_OK;
}

static void gather_extremes(job *j) {
  for (uint32_t k = 1; k < j->plan.threads; k++) ambit_extremes_merge(&j->drawer[0].extremes, &j->drawer[k].extremes);
}

/* -- the search */

static size_t candidates_of_block(const job *j) { return ambit_flow_is_one_by_one(j->flow) ? 1 : AMBIT_FLOW_LANES; }

static ambit_status make_candidates(void *user, uint32_t item, uint32_t worker) {
  job *j = user;
  drawer *d = &j->drawer[worker];
  size_t most = candidates_of_block(j), first = item * most;
  size_t n = d->count - first < most ? d->count - first : most;
  for (size_t i = 0; i < j->problem->nu; i++)
    memcpy(d->point + i * n, j->candidates + i * d->count + first, n * sizeof *d->point);
  d->column = first;
  begin_block(d, n, false);
  ambit_status status = ambit_flow_make(j->flow, worker, &d->block);
  return status == AMBIT_OK && d->block.stopped ? AMBIT_STOPPED : status;
}

static ambit_status evaluate(void *user, size_t count, const double *point, double *value) {
  job *j = user;
  for (size_t i = 0; i < (size_t)j->ninstant * j->problem->nx * count; i++) value[i] = NAN;
  j->candidates = point;
  for (uint32_t k = 0; k < j->plan.threads; k++) j->drawer[k].value = value, j->drawer[k].count = count;
  ambit_status status = run_pool(j, (count - 1) / candidates_of_block(j) + 1, make_candidates);
  for (uint32_t k = 0; k < j->plan.threads; k++) j->drawer[k].value = NULL;
  return status;
}

static ambit_status polish(job *j, ambit_failure *f) {
  if (!j->plan.polish || j->plan.draws < AMBIT_SAMPLE_FEWEST) return AMBIT_OK;
  const ambit_polish q = { .range = ambit_flow_range(j->flow),
    .extremes = &j->drawer[0].extremes,
    .budget = j->plan.draws,
    .finest = FINEST,
    .first = j->plan.draws,
    .evaluate = evaluate,
    .user = j };
  ambit_status status = ambit_polish_run(&q, j->arena, &j->result->polished);
  return status == AMBIT_NOMEM ? no_memory(f) : status == AMBIT_STOPPED ? status : AMBIT_OK;
}

/* -- the error, at the midpoint and the extremes */

static ambit_status estimate_error(job *j, const ambit_interval *hull, double *error, ambit_failure *f) {
  const ambit_problem *p = j->problem;
  for (size_t i = 0; i < (size_t)p->ntime * p->nx; i++) error[i] = NAN;
  if (j->result->status != AMBIT_OK) return AMBIT_OK;
  const ambit_sample_error q = { .flow = j->flow,
    .draws = j->plan.draws,
    .extremes = &j->drawer[0].extremes,
    .hull = hull };
  ambit_status status = ambit_sample_estimate_error(&q, j->arena, error);
  return status == AMBIT_NOMEM ? no_memory(f) : AMBIT_OK;
}

/* -- what is told */

static void gather(const job *j, ambit_interval *hull) {
  size_t n = (size_t)j->problem->ntime * j->problem->nx;
  for (size_t i = 0; i < n; i++) hull[i] = AMBIT_EMPTY;
  for (uint32_t k = 0; k < j->plan.threads; k++)
    for (size_t i = 0; i < n; i++) hull[i] = ambit_interval_hull(hull[i], j->drawer[k].hull[i]);
}

static void tell_result(const job *j, ambit_sample_result *result) {
  bool alone = ambit_flow_is_one_by_one(j->flow);
  ambit_sample_tell_points(j->points, result);
  result->threads = j->plan.threads;
  if (alone) result->one_by_one = result->draws;
  snprintf(result->method, sizeof result->method, "%s",
      j->q->solver ? j->q->solver
      : !alone     ? "Runge-Kutta of order 8 in lanes"
                   : "gsl, the system being stiff");
}

static void fill_report(const job *j, double built, const ambit_sample_result *result, ambit_report *report) {
  const ambit_problem *p = j->problem;
  *report = (ambit_report) { .expressions = p->nx,
    .states = p->nx,
    .parameters = p->np,
    .unknowns = p->nu,
    .seconds_build = built,
    .seconds_run = result->cpu_seconds };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", ambit_flow_arithmetic(j->flow));
  snprintf(report->solver, sizeof report->solver, "%.31s",
      j->q->solver                        ? j->q->solver
      : ambit_flow_is_one_by_one(j->flow) ? "gsl"
                                          : "lanes");
  report->graph_nodes = ambit_graph_count(j->q->system->graph);
  report->work = ambit_flow_work(j->flow);
  ambit_report_count(report, p->rhs);
}

static ambit_status make(job *j, ambit_interval *hull, double *error, ambit_failure *f) {
  ambit_status status = draw_all(j, f);
  if (status == AMBIT_OK) status = draw_lost(j, f);
  gather_extremes(j);
  if (status == AMBIT_OK) status = polish(j, f);
  if (status == AMBIT_STOPPED) j->result->status = status;
  if (status != AMBIT_OK && status != AMBIT_STOPPED) return status;
  gather(j, hull);
  if (j->result->draws && j->result->off == j->result->draws)
    return ambit_fail(f, AMBIT_INVALID, "none of %zu draws can start: %s", j->result->draws, j->result->reason);
  return error ? estimate_error(j, hull, error, f) : AMBIT_OK;
}

static void close_job(job *j) {
  for (size_t i = 0; i < j->nlost; i++) free(j->lost[i]);
  free(j->lost);
  ambit_pool_close(j->pool);
  ambit_sample_points_close(j->points);
  ambit_flow_close(j->flow);
  pthread_mutex_destroy(&j->lock);
  ambit_arena_close(j->arena);
}

ambit_status ambit_sample_system(const ambit_simulate_request *q, const ambit_sample_plan *plan, ambit_interval *hull,
    double *error, ambit_sample_result *result, ambit_report *report, ambit_failure *f) {
  *result = (ambit_sample_result) { 0 };
  if (plan->draws == 0) return ambit_fail(f, AMBIT_INVALID, "sample needs at least one draw");
  job j = { .q = q, .plan = *plan, .arena = ambit_arena_open(), .result = result, .first_failed = SIZE_MAX };
  if (!j.arena) return no_memory(f);
  pthread_mutex_init(&j.lock, NULL);
  double start = ambit_context_seconds(), wall = ambit_sample_wall();
  ambit_meter_enter(AMBIT_FRAME_STAGE, "graph");
  ambit_status status = prepare(&j, f);
  ambit_meter_leave();
  double built = ambit_context_seconds();
  ambit_meter_enter(AMBIT_FRAME_STAGE, "run");
  if (status == AMBIT_OK) status = make(&j, hull, error, f);
  ambit_meter_leave();
  result->cpu_seconds = ambit_context_seconds() - built;
  result->wall_seconds = ambit_sample_wall() - wall;
  if (status == AMBIT_OK) tell_result(&j, result);
  if (status == AMBIT_OK && report) fill_report(&j, built - start, result, report);
  close_job(&j);
  return status;
}
