/* sample_system.c -- draws of initial values and parameters, each integrated by itself. The tapes are built once;
** only the data change. */
#include "graph/tape.h"
#include "model/context.h"
#include "graph/hull.h"
#include "model/pair.h"
#include "model/problem.h"
#include "num/random.h"
#include "model/sample.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct job {
  const ambit_simulate_request *q;
  const char *solver_name;
  ambit_arena *arena;
  const ambit_solver *solver;
  char arithmetic[AMBIT_NAME_MAX];
  ambit_problem problem; /* its data point at the arrays below, filled anew for each draw */
  const ambit_tape *initial;
  ambit_context context;
  ambit_lease *options; /* holds `option` */
  double *option;
  ambit_interval *range, *u, *slot; /* [nu], [nu], slots of the initial tape */
  double *u_point;                  /* [nu] */
  double *lo, *hi;                  /* [nx + np] */
} job;

static void *room(const job *j, size_t n, size_t size) { return ambit_arena_alloc(j->arena, n * size); }

/* The arrays of one draw take the place of the hulls. */
static ambit_status make_room(job *j, ambit_failure *f) {
  ambit_problem *p = &j->problem;
  size_t n = (size_t)p->nx + p->np;
  j->range = room(j, p->nu, sizeof *j->range);
  j->u = room(j, p->nu, sizeof *j->u);
  j->u_point = room(j, p->nu, sizeof *j->u_point);
  j->slot = room(j, j->initial->nslot, sizeof *j->slot);
  j->lo = room(j, n, sizeof *j->lo);
  j->hi = room(j, n, sizeof *j->hi);
  if (!j->range || !j->u || !j->u_point || !j->slot || !j->lo || !j->hi)
    return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  for (uint32_t i = 0; i < p->nu; i++) {
    j->range[i] = (ambit_interval) { p->u_lo[i], p->u_hi[i] };
    if (!ambit_interval_is_bounded(j->range[i]))
      return ambit_fail(f, AMBIT_INVALID, "cannot draw from an unbounded range");
  }
  p->u_lo = p->u_hi = j->u_point;
  p->x0_lo = j->lo;
  p->x0_hi = j->hi;
  p->p_lo = j->lo + p->nx;
  p->p_hi = j->hi + p->nx;
  return AMBIT_OK;
}

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_simulate_request *q = j->q;
  ambit_status status = ambit_registry_solver(q->registry, j->solver_name, &j->solver, f);
  if (status == AMBIT_OK && j->solver->solves != AMBIT_SOLVES_FLOW)
    return ambit_fail(f, AMBIT_INVALID,
        "solver `%s` finds roots and does not advance in time; `sample` needs one that does", j->solver_name);
  if (status == AMBIT_OK)
    status = ambit_pair_choose(q->registry, j->solver_name, j->solver, q->arithmetic, j->arithmetic, f);
  if (status == AMBIT_OK) status = ambit_context_lease(q->registry, &j->options, f);
  if (status != AMBIT_OK) return status;
  ambit_failure own = { 0 };
  j->option = ambit_context_options(
      j->options, j->solver->param, "solver", j->solver_name, q->nsolver_option, q->solver_option, &own);
  if (!j->option) return ambit_fail(f, own.status, "%s", own.message);
  uint32_t want = ambit_pair_want(j->solver, j->option);
  ambit_problem_request request = { q->system, q->initial, q->ntime, q->time, want | AMBIT_WANT_INITIAL, 0, NULL };
  status = ambit_problem_build(&request, j->arena, &j->problem, f);
  if (status != AMBIT_OK) return status;
  j->initial = j->problem.initial;
  if (!(want & AMBIT_WANT_INITIAL)) j->problem.initial = NULL;
  status = make_room(j, f);
  if (status != AMBIT_OK) return status;
  const ambit_problem *p = &j->problem;
  uint32_t nvar = p->initial ? p->nu : p->nx + p->np;
  status =
      ambit_context_open(q->registry, j->arithmetic, q->narithmetic_option, q->arithmetic_option, nvar, &j->context, f);
  j->problem.arithmetic = j->context.arithmetic;
  j->problem.actx = j->context.ctx;
  return status;
}

/* -- one draw */

typedef struct collector {
  ambit_sink sink; /* first */
  const ambit_problem *p;
  ambit_interval *out;
  uint32_t next; /* instant that comes next */
} collector;

static void collect(collector *c, uint32_t k, const double *lo, const double *hi) {
  for (uint32_t i = 0; i < c->p->nx; i++) {
    ambit_interval *x = &c->out[(size_t)k * c->p->nx + i];
    double v = ambit_interval_mid((ambit_interval) { lo[i], hi[i] });
    *x = ambit_interval_hull(*x, (ambit_interval) { v, v });
  }
}

static bool all_finite(const ambit_record *r) {
  for (uint32_t i = 0; i < r->nx; i++)
    if (!(r->lo[i] <= r->hi[i]) || !isfinite(r->lo[i]) || !isfinite(r->hi[i])) return false;
  return true;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  collector *c = (collector *)(void *)s;
  if (r->kind != AMBIT_REC_STEP || c->next >= c->p->ntime || r->t_to != c->p->time[c->next]) return 0;
  if (!all_finite(r)) return 1;
  collect(c, c->next++, r->lo, r->hi);
  return 0;
}

static int32_t ignore_progress(ambit_sink *s, double done, const char *message) {
  (void)s, (void)done, (void)message;
  return 0;
}

static void draw_data(job *j, ambit_random *random, size_t draw) {
  ambit_random_draw(random, draw, j->problem.nu, j->range, j->u_point, 1);
  for (uint32_t i = 0; i < j->problem.nu; i++) j->u[i] = (ambit_interval) { j->u_point[i], j->u_point[i] };
  ambit_hull(j->initial, j->u, j->slot);
  for (uint32_t i = 0; i < j->initial->nout; i++) {
    j->lo[i] = j->slot[j->initial->out[i]].lo;
    j->hi[i] = j->slot[j->initial->out[i]].hi;
  }
}

static void count_failure(const ambit_lease *lease, ambit_status status, ambit_sample_result *result) {
  if (result->failed++) return;
  const char *own = lease->failure.message;
  snprintf(result->reason, sizeof result->reason, "%s",
      own[0]               ? own
      : status == AMBIT_OK ? "the solver left a time out"
                           : ambit_status_name(status));
}

static ambit_status integrate(job *j, ambit_interval *out, ambit_sample_result *result, ambit_failure *f) {
  collector c = { { sizeof(ambit_sink), emit, ignore_progress }, &j->problem, out, 1 };
  ambit_lease *lease = NULL;
  void *self = NULL;
  ambit_status status = ambit_context_lease(j->q->registry, &lease, f);
  if (status != AMBIT_OK) return status;
  collect(&c, 0, j->lo, j->hi);
  status = j->solver->open(&lease->host, &j->problem, j->option, &self);
  if (status == AMBIT_INVALID || status == AMBIT_NOMEM || status == AMBIT_BROKEN) {
    char who[96];
    snprintf(who, sizeof who, "solver `%s`", j->solver_name);
    ambit_context_failed(lease, status, who, f);
    ambit_lease_close(lease);
    return status;
  }
  if (status == AMBIT_OK) {
    status = j->solver->run(self, &c.sink);
    j->solver->close(self);
  }
  result->draws++;
  if (status != AMBIT_OK || c.next < j->problem.ntime) count_failure(lease, status, result);
  ambit_lease_close(lease);
  return AMBIT_OK;
}

static ambit_status run_draws(
    job *j, size_t draws, uint64_t seed, ambit_interval *out, ambit_sample_result *result, ambit_failure *f) {
  ambit_random random = { seed };
  ambit_sink *sink = j->q->sink;
  for (size_t k = 0; k < draws; k++) {
    draw_data(j, &random, k);
    ambit_status status = integrate(j, out, result, f);
    if (status != AMBIT_OK) return status;
    if (!sink || !sink->progress) continue;
    if (sink->progress(sink, (double)(k + 1) / (double)draws, "sampling")) {
      result->status = AMBIT_STOPPED;
      break;
    }
  }
  return AMBIT_OK;
}

static void fill_report(const job *j, double built, const ambit_sample_result *result, ambit_report *report) {
  const ambit_tape *rhs = j->problem.rhs;
  *report = (ambit_report) { .expressions = j->problem.nx,
    .states = j->problem.nx,
    .parameters = j->problem.np,
    .unknowns = j->problem.nu,
    .seconds_build = built,
    .seconds_run = result->cpu_seconds };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
  snprintf(report->solver, sizeof report->solver, "%.31s", j->solver_name);
  report->graph_nodes = ambit_graph_count(j->q->system->graph);
  if (!rhs) return;
  report->tape_slots = rhs->nslot;
  report->tape_constants = rhs->nconst;
  report->tape_instructions = rhs->ninstr;
  report->tape_runs = rhs->nrun;
}

ambit_status ambit_sample_system(const ambit_simulate_request *q, size_t draws, uint64_t seed, ambit_interval *out,
    ambit_sample_result *result, ambit_report *report, ambit_failure *f) {
  *result = (ambit_sample_result) { 0 };
  if (draws == 0) return ambit_fail(f, AMBIT_INVALID, "sample needs at least one draw");
  job j = { .q = q, .solver_name = q->solver ? q->solver : "gsl", .arena = ambit_arena_open() };
  if (!j.arena) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  for (size_t i = 0; i < q->ntime * q->system->nx; i++) out[i] = AMBIT_EMPTY;
  double start = ambit_context_seconds();
  ambit_status status = prepare(&j, f);
  double built = ambit_context_seconds();
  if (status == AMBIT_OK) status = run_draws(&j, draws, seed, out, result, f);
  result->cpu_seconds = ambit_context_seconds() - built;
  if (status == AMBIT_OK && report) fill_report(&j, built - start, result, report);
  ambit_context_close(&j.context);
  ambit_lease_close(j.options);
  ambit_arena_close(j.arena);
  return status;
}
