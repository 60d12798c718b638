/* sample_draws.c -- one draw: the data's point, the start as its hull, a run of the solver into a collecting sink. */
#include "host/params.h"
#include "verbs/sample/sample_draws.h"
#include "graph/hull.h"
#include "verbs/run/context.h"
#include "verbs/run/pair.h"
#include "verbs/simulate/problem.h"
#include "verbs/run/tally.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* What one thread needs. */
typedef struct drawer {
  ambit_problem problem; /* its data point at the arrays below, filled anew for each draw */
  ambit_context context;
  ambit_interval *u, *slot; /* [nu], slots of the initial tape */
  double *u_point;          /* [nu] */
  double *lo, *hi;          /* [nx + np] */
  double *middle;           /* [nx] */
  ambit_work work;          /* of the scopes of its draws */
} drawer;

struct ambit_draws {
  const ambit_simulate_request *q;
  ambit_arena *arena;
  const char *solver_name;
  const ambit_solver *solver;
  char arithmetic[AMBIT_NAME_MAX];
  ambit_problem problem;
  const ambit_tape *initial;
  ambit_scope *options; /* holds `option` */
  double *option;
  uint32_t ndrawer;
  drawer *drawer; /* [ndrawer] */
};

void ambit_draws_work(const ambit_draws *draws, ambit_work *sum) {
  for (uint32_t i = 0; i < draws->ndrawer; i++) {
    ambit_work opened = ambit_scope_work(draws->drawer[i].context.scope);
    ambit_work_add(sum, &opened);
    ambit_work_add(sum, &draws->drawer[i].work);
  }
}

static void *room(const ambit_draws *d, size_t n, size_t size) { return ambit_arena_alloc(d->arena, (n + 1) * size); }

/* The arrays of one draw take the place of the hulls. */
static bool make_room(const ambit_draws *draws, drawer *d) {
  d->problem = draws->problem;
  ambit_problem *p = &d->problem;
  size_t n = (size_t)p->nx + p->np;
  d->u = room(draws, p->nu, sizeof *d->u);
  d->u_point = room(draws, p->nu, sizeof *d->u_point);
  d->slot = room(draws, draws->initial->nslot, sizeof *d->slot);
  d->lo = room(draws, n, sizeof *d->lo);
  d->hi = room(draws, n, sizeof *d->hi);
  d->middle = room(draws, p->nx, sizeof *d->middle);
  if (!d->u || !d->slot || !d->u_point || !d->lo || !d->hi || !d->middle) return false;
  p->u_lo = p->u_hi = d->u_point;
  p->x0_lo = d->lo;
  p->x0_hi = d->hi;
  p->p_lo = d->lo + p->nx;
  p->p_hi = d->hi + p->nx;
  return true;
}

static ambit_status open_drawers(ambit_draws *draws, uint32_t n, uint32_t want, ambit_failure *f) {
  const ambit_simulate_request *q = draws->q;
  uint32_t nvar = ambit_pair_variables(&draws->problem, want);
  draws->drawer = room(draws, n, sizeof *draws->drawer);
  if (!draws->drawer) return ambit_no_memory(f);
  for (; draws->ndrawer < n; draws->ndrawer++) {
    drawer *d = &draws->drawer[draws->ndrawer];
    if (!make_room(draws, d)) return ambit_no_memory(f);
    ambit_status status = ambit_context_open(
        q->registry, draws->arithmetic, q->narithmetic_option, q->arithmetic_option, nvar, &d->context, f);
    if (status != AMBIT_OK) return status;
    d->problem.arithmetic = d->context.arithmetic;
    d->problem.actx = d->context.ctx;
    d->problem.nworker = 1;
    if (want & AMBIT_WANT_WORKERS) d->problem.worker = &d->problem.actx;
  }
  return AMBIT_OK;
}

static ambit_status read_options(ambit_draws *d, const ambit_draws_request *request, ambit_failure *f) {
  const ambit_simulate_request *q = d->q;
  ambit_failure own = { 0 };
  ambit_status status = ambit_context_scope(q->registry, &d->options, f);
  if (status != AMBIT_OK) return status;
  size_t n = request->solver ? request->noption : q->nsolver_option;
  const ambit_option *option = request->solver ? request->option : q->solver_option;
  d->option = ambit_context_options(d->options, d->solver->param, "solver", d->solver_name, n, option, &own);
  return d->option ? AMBIT_OK : ambit_fail(f, own.status, "%s", own.message);
}

/* The unknowns are those of all parts of the system, whatever the solver wants: all users of a sample count them so. */
static ambit_status build(ambit_draws *d, uint32_t want, ambit_failure *f) {
  const ambit_simulate_request *q = d->q;
  ambit_problem_request request = { .system = q->system,
    .initial = q->initial,
    .ntime = q->ntime,
    .time = q->time,
    .want = want | AMBIT_WANT_INITIAL | AMBIT_WANT_INVARIANT,
    .final = q->final,
    .registry = q->registry };
  ambit_status status = ambit_problem_build(&request, d->arena, &d->problem, f);
  if (status != AMBIT_OK) return status;
  d->initial = d->problem.initial;
  if (!(want & AMBIT_WANT_INITIAL)) d->problem.initial = NULL;
  if (want & AMBIT_WANT_INVARIANT) return AMBIT_OK;
  d->problem.ninvariant = 0;
  d->problem.invariant = d->problem.invariant_jacobian = NULL;
  return AMBIT_OK;
}

static ambit_status prepare(ambit_draws *d, const ambit_draws_request *request, ambit_failure *f) {
  const ambit_simulate_request *q = d->q;
  ambit_status status = ambit_pair_offers(q->registry, d->solver_name, AMBIT_SOLVER, f);
  if (status == AMBIT_OK) status = ambit_registry_solver(q->registry, d->solver_name, &d->solver, f);
  if (status != AMBIT_OK) return status;
  ambit_method method = AMBIT_METHOD(d->solver_name, d->solver);
  status = ambit_pair_choose(q->registry, method, q->arithmetic, d->arithmetic, f);
  if (status == AMBIT_OK) status = read_options(d, request, f);
  if (status != AMBIT_OK) return status;
  uint32_t want = ambit_pair_want(method, d->option);
  status = build(d, want, f);
  return status == AMBIT_OK ? open_drawers(d, request->threads, want, f) : status;
}

ambit_status ambit_draws_open(const ambit_draws_request *request, ambit_draws **draws, ambit_failure *f) {
  *draws = NULL;
  ambit_arena *arena = ambit_arena_open();
  ambit_draws *d = arena ? ambit_arena_alloc(arena, sizeof *d) : NULL;
  if (!d) {
    ambit_arena_close(arena);
    return ambit_no_memory(f);
  }
  *d = (ambit_draws) {
    .q = request->q, .arena = arena, .solver_name = request->solver ? request->solver : request->q->solver
  };
  ambit_status status = prepare(d, request, f);
  if (status == AMBIT_OK)
    *draws = d;
  else
    ambit_draws_close(d);
  return status;
}

void ambit_draws_close(ambit_draws *d) {
  if (!d) return;
  for (uint32_t i = 0; i < d->ndrawer; i++) ambit_context_close(&d->drawer[i].context);
  ambit_scope_close(d->options);
  ambit_arena_close(d->arena);
}

const ambit_problem *ambit_draws_problem(const ambit_draws *d) { return &d->problem; }
const char *ambit_draws_arithmetic(const ambit_draws *d) { return d->arithmetic; }

/* Where in the flat options the number of that name is; shapes of several numbers come before it or not. */
static double *find_option(const ambit_draws *d, const char *name) {
  for (const ambit_param *p = d->solver->param; p && p->name; p++) {
    if (strcmp(p->name, name) != 0) continue;
    return d->option + ambit_params_doubles(d->solver->param) - ambit_params_doubles(p);
  }
  return NULL;
}

bool ambit_draws_tighten(ambit_draws *d, double by, double longest) {
  double *relative = find_option(d, "relative"), *absolute = find_option(d, "absolute");
  double *step_max = find_option(d, "step_max");
  if (!relative || !absolute) return false;
  *relative *= by;
  *absolute *= by;
  if (step_max) *step_max = fmin(*step_max, longest);
  return true;
}

/* -- one draw */

typedef struct collector {
  ambit_sink sink; /* first */
  const ambit_problem *p;
  const ambit_draws_one *one;
  double *middle;
  uint32_t next; /* instant that comes next */
} collector;

static bool collect(collector *c, uint32_t k, const double *lo, const double *hi) {
  for (uint32_t i = 0; i < c->p->nx; i++) {
    if (!(lo[i] <= hi[i]) || !isfinite(lo[i]) || !isfinite(hi[i])) return false;
    c->middle[i] = ambit_interval_mid((ambit_interval) { lo[i], hi[i] });
  }
  c->one->see(c->one->user, k, c->middle);
  return true;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  collector *c = (collector *)(void *)s;
  if (r->kind == AMBIT_REC_STEP && c->next < c->p->ntime && r->t_to == c->p->time[c->next] &&
      !collect(c, c->next++, r->lo, r->hi))
    return 1;
  return c->one->pause(c->one->user);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  (void)done, (void)message;
  const ambit_draws_one *one = ((collector *)(void *)s)->one;
  return one->pause(one->user);
}

static void place_data(const ambit_draws *draws, drawer *d, const ambit_draws_one *one) {
  for (uint32_t i = 0; i < draws->problem.nu; i++) {
    d->u_point[i] = one->point[i * one->stride];
    d->u[i] = (ambit_interval) { d->u_point[i], d->u_point[i] };
  }
  ambit_hull(draws->initial, d->u, d->slot);
  for (uint32_t i = 0; i < draws->initial->nout; i++) {
    d->lo[i] = d->slot[draws->initial->out[i]].lo;
    d->hi[i] = d->slot[draws->initial->out[i]].hi;
  }
}

static void tell_reason(const ambit_draws_one *one, bool reached, ambit_status status, const ambit_scope *scope) {
  const char *own = scope->failure.message;
  snprintf(one->reason, one->room, "%s",
      reached              ? ""
      : own[0]             ? own
      : status == AMBIT_OK ? "the solver left a time out"
                           : ambit_status_name(status));
}

static ambit_status integrate(
    const ambit_draws *draws, drawer *d, const ambit_draws_one *one, ambit_scope *scope, bool *reached) {
  collector c = { { sizeof(ambit_sink), emit, progress }, &d->problem, one, d->middle, 1 };
  void *self = NULL;
  *reached = false;
  collect(&c, 0, d->lo, d->hi);
  ambit_stage_enter("open", AMBIT_FRAME_SOLVER, draws->solver_name);
  ambit_status status = draws->solver->open(&scope->host, &d->problem, draws->option, &self);
  ambit_stage_leave();
  if (status == AMBIT_INVALID || status == AMBIT_NOMEM || status == AMBIT_BROKEN) {
    char who[96];
    ambit_failure own = { 0 };
    snprintf(who, sizeof who, "solver `%s`", draws->solver_name);
    ambit_context_failed(scope, status, who, &own);
    snprintf(one->reason, one->room, "%s", own.message);
    return status;
  }
  if (status == AMBIT_OK) {
    ambit_stage_enter("run", AMBIT_FRAME_SOLVER, draws->solver_name);
    status = draws->solver->run(self, &c.sink);
    ambit_stage_leave();
    draws->solver->close(self);
  }
  *reached = status == AMBIT_OK && c.next >= draws->problem.ntime;
  tell_reason(one, *reached, status, scope);
  return AMBIT_OK;
}

ambit_status ambit_draws_make(ambit_draws *draws, uint32_t worker, const ambit_draws_one *one, bool *reached) {
  drawer *d = &draws->drawer[worker];
  ambit_scope *scope;
  ambit_status status = ambit_context_scope(draws->q->registry, &scope, NULL);
  if (status != AMBIT_OK) return status;
  place_data(draws, d, one);
  status = integrate(draws, d, one, scope, reached);
  ambit_work work = ambit_scope_work(scope);
  ambit_work_add(&d->work, &work);
  ambit_scope_close(scope);
  return status;
}
