/* sample_system.c -- a sample of a system: preparations, the draws (sample_system_draws.c), the search from the
** extremes (sample_system_search.c), the estimate of the error, what is told.
*/
#include "graph/tape.h"
#include "verbs/run/processors.h"
#include "verbs/run/context.h"
#include "verbs/sample/sample_error.h"
#include "verbs/sample/sample_job.h"
#include "verbs/run/tally.h"
#include "models/default.h"
#include <math.h>
#include <stdlib.h>

#define INSTANTS 8u /* at which extremes are followed, at most */

static void *room(const ambit_sample_job *j, size_t n, size_t size) {
  return ambit_arena_alloc(j->arena, (n + 1) * size);
}

/* -- preparations */

/* As many instants as the search can afford, equidistant ones, always the last. */
static bool choose_instants(ambit_sample_job *j) {
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

static bool open_drawer(ambit_sample_job *j, ambit_sample_drawer *d) {
  const ambit_problem *p = j->problem;
  size_t values = (size_t)p->ntime * p->nx;
  d->job = j;
  d->point = room(j, (size_t)p->nu * AMBIT_FLOW_LANES, sizeof *d->point);
  d->hull = room(j, values, sizeof *d->hull);
  if (!d->point || !d->hull) return false;
  for (size_t i = 0; i < values; i++) d->hull[i] = AMBIT_EMPTY;
  return ambit_extremes_open(&d->extremes, j->arena, (size_t)j->ninstant * p->nx, p->nu);
}

static ambit_status prepare(ambit_sample_job *j, ambit_failure *f) {
  ambit_status status = j->plan.threads ? AMBIT_OK : ambit_processors_threads(&j->plan.threads, f);
  if (status != AMBIT_OK) return status;
  if (j->plan.threads > j->plan.draws) j->plan.threads = (uint32_t)j->plan.draws;
  status = ambit_flow_open(j->q, &j->plan, &j->flow, f);
  if (status != AMBIT_OK) return status;
  j->problem = ambit_flow_problem(j->flow);
  j->drawer = room(j, j->plan.threads, sizeof *j->drawer);
  if (!j->drawer || !choose_instants(j)) return ambit_no_memory(f);
  for (uint32_t i = 0; i < j->plan.threads; i++)
    if (!open_drawer(j, &j->drawer[i])) return ambit_no_memory(f);
  if (ambit_pool_open(NULL, j->plan.threads, &j->pool) != AMBIT_OK) return ambit_no_memory(f);
  return ambit_sample_open_points(j->q->registry, &j->plan, j->problem->nu, ambit_flow_range(j->flow), &j->points, f);
}

/* -- the error, at the midpoint and the extremes */

static ambit_status estimate_error(ambit_sample_job *j, const ambit_interval *hull, double *error, ambit_failure *f) {
  const ambit_problem *p = j->problem;
  for (size_t i = 0; i < (size_t)p->ntime * p->nx; i++) error[i] = NAN;
  if (j->result->status != AMBIT_OK || ambit_flow_is_vague(j->flow)) return AMBIT_OK;
  const ambit_sample_error q = { .flow = j->flow,
    .draws = j->plan.draws,
    .extremes = &j->drawer[0].extremes,
    .hull = hull,
    .pause = ambit_sample_pause,
    .user = j };
  ambit_status status = ambit_sample_estimate_error(&q, j->arena, error);
  if (status == AMBIT_STOPPED) j->result->status = status;
  return status == AMBIT_NOMEM ? ambit_no_memory(f) : AMBIT_OK;
}

/* -- what is told */

static void gather(const ambit_sample_job *j, ambit_interval *hull) {
  size_t n = (size_t)j->problem->ntime * j->problem->nx;
  for (size_t i = 0; i < n; i++) hull[i] = AMBIT_EMPTY;
  for (uint32_t k = 0; k < j->plan.threads; k++)
    for (size_t i = 0; i < n; i++) hull[i] = ambit_interval_hull(hull[i], j->drawer[k].hull[i]);
}

static void tell_result(const ambit_sample_job *j, ambit_sample_result *result) {
  bool alone = ambit_flow_is_one_by_one(j->flow);
  ambit_sample_tell_points(j->points, result);
  result->threads = j->plan.threads;
  if (alone) result->one_by_one = result->draws;
  snprintf(result->method, sizeof result->method, "%s",
      j->q->solver ? j->q->solver
      : !alone     ? "Runge-Kutta of order 8 in lanes"
                   : AMBIT_DEFAULT_DRAWS ", the system being stiff");
}

static void fill_report(
    const ambit_sample_job *j, double built, const ambit_sample_result *result, ambit_report *report) {
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
      : ambit_flow_is_one_by_one(j->flow) ? AMBIT_DEFAULT_DRAWS
                                          : "lanes");
  report->graph_nodes = ambit_graph_made(j->q->system->graph);
  report->work = ambit_flow_work(j->flow);
  ambit_report_count(report, p->rhs);
}

static ambit_status make(ambit_sample_job *j, ambit_interval *hull, double *error, ambit_failure *f) {
  ambit_status status = ambit_sample_make_draws(j, f);
  if (status == AMBIT_OK) status = ambit_sample_search(j);
  if (status == AMBIT_NOMEM && !f->message[0]) return ambit_no_memory(f);
  if (status == AMBIT_STOPPED) j->result->status = status;
  if (status != AMBIT_OK && status != AMBIT_STOPPED) return status;
  gather(j, hull);
  if (j->result->draws && j->result->off == j->result->draws)
    return ambit_fail(f, AMBIT_INVALID, "none of %zu draws can start: %s", j->result->draws, j->result->reason);
  return error ? estimate_error(j, hull, error, f) : AMBIT_OK;
}

static void close_job(ambit_sample_job *j) {
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
  ambit_sample_job j = { .q = q,
    .plan = *plan,
    .arena = ambit_arena_open(),
    .result = result,
    .first_failed = SIZE_MAX,
    .caller = pthread_self() };
  if (!j.arena) return ambit_no_memory(f);
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
