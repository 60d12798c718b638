/* sample_system.c -- draws of initial values and parameters, each integrated by itself, on the threads of a pool. The
** tapes are built once; only the data change. Draw k takes the same random numbers whoever makes it. */
#include "graph/hull.h"
#include "graph/tape.h"
#include "host/pool.h"
#include "host/processors.h"
#include "model/context.h"
#include "model/pair.h"
#include "model/problem.h"
#include "model/sample.h"
#include "num/random.h"
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>

struct job;

/* What one thread needs to make draws. */
typedef struct drawer {
  struct job *job;
  ambit_problem problem; /* its data point at the arrays below, filled anew for each draw */
  ambit_context context;
  ambit_interval *u, *slot; /* [nu], slots of the initial tape */
  double *u_point;          /* [nu] */
  double *lo, *hi;          /* [nx + np] */
  ambit_interval *out;      /* [ntime * nx] hull of its draws */
} drawer;

typedef struct job {
  const ambit_simulate_request *q;
  const char *solver_name;
  ambit_arena *arena;
  const ambit_solver *solver;
  char arithmetic[AMBIT_NAME_MAX];
  ambit_problem problem;
  const ambit_tape *initial;
  ambit_lease *options; /* holds `option` */
  double *option;
  ambit_interval *range; /* [nu] */
  uint32_t ndrawer;
  drawer *drawer; /* [ndrawer] */
  uint64_t seed;
  size_t base, draws; /* of the items that the pool does; in all */
  pthread_mutex_t lock;
  /* guarded by the lock */
  ambit_sample_result *result;
  size_t first_failed; /* of the draws, whose reason is told */
  ambit_failure broken;
  size_t first_broken; /* of the draws that could not even be opened */
} job;

static void *room(const job *j, size_t n, size_t size) { return ambit_arena_alloc(j->arena, n * size); }

static ambit_status find_ranges(job *j, ambit_failure *f) {
  const ambit_problem *p = &j->problem;
  j->range = room(j, p->nu, sizeof *j->range);
  if (!j->range) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  for (uint32_t i = 0; i < p->nu; i++) {
    j->range[i] = (ambit_interval) { p->u_lo[i], p->u_hi[i] };
    if (!ambit_interval_is_bounded(j->range[i]))
      return ambit_fail(f, AMBIT_INVALID, "cannot draw from an unbounded range");
  }
  return AMBIT_OK;
}

/* The arrays of one draw take the place of the hulls. */
static bool make_room(job *j, drawer *d) {
  d->job = j;
  d->problem = j->problem;
  ambit_problem *p = &d->problem;
  size_t n = (size_t)p->nx + p->np, values = (size_t)p->ntime * p->nx;
  d->u = room(j, p->nu, sizeof *d->u);
  d->u_point = room(j, p->nu, sizeof *d->u_point);
  d->slot = room(j, j->initial->nslot, sizeof *d->slot);
  d->lo = room(j, n, sizeof *d->lo);
  d->hi = room(j, n, sizeof *d->hi);
  d->out = room(j, values, sizeof *d->out);
  if (!d->u || !d->slot || !d->u_point || !d->lo || !d->hi || !d->out) return false;
  for (size_t i = 0; i < values; i++) d->out[i] = AMBIT_EMPTY;
  p->u_lo = p->u_hi = d->u_point;
  p->x0_lo = d->lo;
  p->x0_hi = d->hi;
  p->p_lo = d->lo + p->nx;
  p->p_hi = d->hi + p->nx;
  return true;
}

static ambit_status open_drawers(job *j, uint32_t want, ambit_failure *f) {
  const ambit_simulate_request *q = j->q;
  uint32_t nvar = ambit_pair_variables(&j->problem, want), n = q->threads;
  ambit_status status = n ? AMBIT_OK : ambit_processors_threads(&n, f);
  if (status != AMBIT_OK) return status;
  if (n > j->draws) n = (uint32_t)j->draws;
  j->drawer = room(j, n, sizeof *j->drawer);
  if (!j->drawer) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  for (; j->ndrawer < n; j->ndrawer++) {
    drawer *d = &j->drawer[j->ndrawer];
    if (!make_room(j, d)) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
    status = ambit_context_open(
        q->registry, j->arithmetic, q->narithmetic_option, q->arithmetic_option, nvar, &d->context, f);
    if (status != AMBIT_OK) return status;
    d->problem.arithmetic = d->context.arithmetic;
    d->problem.actx = d->context.ctx;
    d->problem.nworker = 1;
    if (want & AMBIT_WANT_WORKERS) d->problem.worker = &d->problem.actx;
  }
  return AMBIT_OK;
}

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_simulate_request *q = j->q;
  ambit_status status = ambit_registry_solver(q->registry, j->solver_name, &j->solver, f);
  if (status == AMBIT_OK && j->solver->solves != AMBIT_SOLVES_FLOW)
    return ambit_fail(f, AMBIT_INVALID, "solver `%s` %s and does not advance in time; `sample` needs one that does",
        j->solver_name, j->solver->solves == AMBIT_SOLVES_ROOTS ? "finds roots" : "is for ambit.reduce");
  if (status == AMBIT_OK)
    status = ambit_pair_choose(q->registry, j->solver_name, j->solver, q->arithmetic, j->arithmetic, f);
  if (status == AMBIT_OK) status = ambit_context_lease(q->registry, &j->options, f);
  if (status != AMBIT_OK) return status;
  ambit_failure own = { 0 };
  j->option = ambit_context_options(
      j->options, j->solver->param, "solver", j->solver_name, q->nsolver_option, q->solver_option, &own);
  if (!j->option) return ambit_fail(f, own.status, "%s", own.message);
  uint32_t want = ambit_pair_want(j->solver, j->option);
  ambit_problem_request request = {
    .system = q->system, .initial = q->initial, .ntime = q->ntime, .time = q->time, .want = want | AMBIT_WANT_INITIAL
  };
  status = ambit_problem_build(&request, j->arena, &j->problem, f);
  if (status != AMBIT_OK) return status;
  j->initial = j->problem.initial;
  if (!(want & AMBIT_WANT_INITIAL)) j->problem.initial = NULL;
  status = find_ranges(j, f);
  return status == AMBIT_OK ? open_drawers(j, want, f) : status;
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

static void draw_data(drawer *d, size_t draw) {
  const job *j = d->job;
  uint32_t nu = j->problem.nu;
  ambit_random random = { j->seed };
  if (draw) ambit_random_skip(&random, (draw - 1) * (uint64_t)nu);
  ambit_random_draw(&random, draw, nu, j->range, d->u_point, 1);
  for (uint32_t i = 0; i < nu; i++) d->u[i] = (ambit_interval) { d->u_point[i], d->u_point[i] };
  ambit_hull(j->initial, d->u, d->slot);
  for (uint32_t i = 0; i < j->initial->nout; i++) {
    d->lo[i] = d->slot[j->initial->out[i]].lo;
    d->hi[i] = d->slot[j->initial->out[i]].hi;
  }
}

static void count(job *j, size_t draw, bool failed, ambit_status status, const ambit_lease *lease) {
  pthread_mutex_lock(&j->lock);
  j->result->draws++;
  j->result->failed += failed;
  if (failed && draw < j->first_failed) {
    const char *own = lease->failure.message;
    j->first_failed = draw;
    snprintf(j->result->reason, sizeof j->result->reason, "%s",
        own[0]               ? own
        : status == AMBIT_OK ? "the solver left a time out"
                             : ambit_status_name(status));
  }
  pthread_mutex_unlock(&j->lock);
}

static ambit_status give_up(job *j, size_t draw, ambit_status status, const ambit_lease *lease) {
  char who[96];
  snprintf(who, sizeof who, "solver `%s`", j->solver_name);
  pthread_mutex_lock(&j->lock);
  if (draw < j->first_broken) {
    j->first_broken = draw;
    ambit_failure_clear(&j->broken);
    ambit_context_failed(lease, status, who, &j->broken);
  }
  pthread_mutex_unlock(&j->lock);
  return status;
}

static ambit_status integrate(drawer *d, size_t draw, ambit_lease *lease) {
  job *j = d->job;
  collector c = { { sizeof(ambit_sink), emit, ignore_progress }, &d->problem, d->out, 1 };
  void *self = NULL;
  collect(&c, 0, d->lo, d->hi);
  ambit_status status = j->solver->open(&lease->host, &d->problem, j->option, &self);
  if (status == AMBIT_INVALID || status == AMBIT_NOMEM || status == AMBIT_BROKEN)
    return give_up(j, draw, status, lease);
  if (status == AMBIT_OK) {
    status = j->solver->run(self, &c.sink);
    j->solver->close(self);
  }
  count(j, draw, status != AMBIT_OK || c.next < j->problem.ntime, status, lease);
  return AMBIT_OK;
}

static ambit_status make_draw(void *user, uint32_t item, uint32_t worker) {
  job *j = user;
  size_t draw = j->base + item;
  ambit_lease *lease;
  ambit_status status = ambit_context_lease(j->q->registry, &lease, NULL);
  if (status != AMBIT_OK) return status;
  draw_data(&j->drawer[worker], draw);
  status = integrate(&j->drawer[worker], draw, lease);
  ambit_lease_close(lease);
  return status;
}

static int32_t tell_progress(void *user) {
  job *j = user;
  ambit_sink *sink = j->q->sink;
  if (!sink || !sink->progress) return 0;
  pthread_mutex_lock(&j->lock);
  double done = (double)j->result->draws / (double)j->draws;
  pthread_mutex_unlock(&j->lock);
  return sink->progress(sink, done, "sampling");
}

static ambit_status run_draws(job *j, ambit_failure *f) {
  const size_t most = (size_t)1 << 30; /* items of one run of a pool */
  ambit_pool *pool;
  ambit_status status = ambit_pool_open(NULL, j->ndrawer, &pool);
  if (status != AMBIT_OK) return ambit_fail(f, status, "out of memory");
  for (j->base = 0; status == AMBIT_OK && j->base < j->draws; j->base += most) {
    size_t left = j->draws - j->base;
    status = ambit_pool_run(pool, (uint32_t)(left < most ? left : most), make_draw, j, tell_progress);
  }
  ambit_pool_close(pool);
  if (status == AMBIT_STOPPED) j->result->status = status;
  if (status == AMBIT_OK || status == AMBIT_STOPPED) return AMBIT_OK;
  return ambit_fail(f, status, "%s", j->broken.message[0] ? j->broken.message : "out of memory");
}

static void gather(const job *j, ambit_interval *out) {
  size_t n = (size_t)j->problem.ntime * j->problem.nx;
  for (uint32_t k = 0; k < j->ndrawer; k++)
    for (size_t i = 0; i < n; i++) out[i] = ambit_interval_hull(out[i], j->drawer[k].out[i]);
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
  job j = { .q = q,
    .solver_name = q->solver ? q->solver : "gsl",
    .arena = ambit_arena_open(),
    .seed = seed,
    .draws = draws,
    .result = result,
    .first_failed = SIZE_MAX,
    .first_broken = SIZE_MAX };
  if (!j.arena) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  pthread_mutex_init(&j.lock, NULL);
  for (size_t i = 0; i < q->ntime * q->system->nx; i++) out[i] = AMBIT_EMPTY;
  double start = ambit_context_seconds();
  ambit_status status = prepare(&j, f);
  double built = ambit_context_seconds();
  if (status == AMBIT_OK) status = run_draws(&j, f);
  result->cpu_seconds = ambit_context_seconds() - built;
  if (status == AMBIT_OK) gather(&j, out);
  if (status == AMBIT_OK && report) fill_report(&j, built - start, result, report);
  for (uint32_t i = 0; i < j.ndrawer; i++) ambit_context_close(&j.drawer[i].context);
  ambit_lease_close(j.options);
  pthread_mutex_destroy(&j.lock);
  ambit_arena_close(j.arena);
  return status;
}
