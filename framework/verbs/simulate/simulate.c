/* simulate.c -- checks the pair, builds the problem, runs the solver behind a sink that watches it: once, or once for
** each piece of a split.
*/
#include <ambit/simulate.h>
#include "graph/interpreter.h"
#include "graph/tape.h"
#include "verbs/run/processors.h"
#include "verbs/run/allocation.h"
#include "verbs/run/context.h"
#include "verbs/run/guard.h"
#include "verbs/run/pair.h"
#include "verbs/simulate/problem.h"
#include "verbs/run/share.h"
#include "verbs/split/split_plan.h"
#include "verbs/split/split.h"
#include "verbs/run/tally.h"
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

typedef struct job {
  const ambit_simulate_request *q;
  ambit_arena *arena;
  const ambit_solver *solver;
  char arithmetic[AMBIT_NAME_MAX];
  ambit_problem problem;
  const ambit_tape *initial; /* x(t0) and p over the unknowns, of a split */
  ambit_split_plan plan;
  const ambit_cut_band *band; /* of the problem's instants */
  bool splits;
  uint32_t threads, ncontext; /* threads of the run; contexts that are open */
  ambit_context *context;
  void **ctx; /* [ncontext] of the contexts */
  ambit_scope *scope;
  double *option;
  ambit_tally tally;
} job;

static bool is_split(const ambit_simulate_request *q) {
  bool cuts = q->pieces > 0 || q->band;
  for (size_t i = 0; i < q->ncut; i++) cuts = cuts || q->cut[i].parts > 0;
  return cuts;
}

static ambit_status count_threads(job *j, ambit_failure *f) {
  if (j->q->threads == 0) return ambit_processors_threads(&j->threads, f);
  j->threads = j->q->threads < AMBIT_THREADS_MAX ? j->q->threads : AMBIT_THREADS_MAX;
  return AMBIT_OK;
}

/* One for each thread that will compute: a context belongs to one thread at a time. */
static ambit_status open_contexts(job *j, uint32_t want, ambit_failure *f) {
  const ambit_simulate_request *q = j->q;
  const ambit_problem *p = &j->problem;
  uint32_t nvar = ambit_pair_variables(p, want), n = 1;
  if (j->splits)
    n = q->band || j->threads < j->plan.pieces.count ? j->threads : j->plan.pieces.count;
  else if (want & AMBIT_WANT_WORKERS)
    n = j->threads;
  j->context = ambit_arena_alloc(j->arena, n * sizeof *j->context);
  j->ctx = ambit_arena_alloc(j->arena, n * sizeof *j->ctx);
  if (!j->context || !j->ctx) return ambit_no_memory(f);
  for (; j->ncontext < n; j->ncontext++) {
    ambit_context *c = &j->context[j->ncontext];
    ambit_status status =
        ambit_context_open(q->registry, j->arithmetic, q->narithmetic_option, q->arithmetic_option, nvar, c, f);
    if (status != AMBIT_OK) return status;
    j->ctx[j->ncontext] = c->ctx;
  }
  j->problem.arithmetic = j->context->arithmetic;
  j->problem.actx = j->context->ctx;
  j->problem.nworker = j->splits ? 1 : j->threads;
  j->problem.worker = want & AMBIT_WANT_WORKERS ? j->ctx : NULL;
  return AMBIT_OK;
}

/* The tapes, and what is cut. */
static ambit_status build(job *j, uint32_t want, uint32_t seal, ambit_failure *f) {
  const ambit_simulate_request *q = j->q;
  const ambit_expr *unknown;
  size_t ntime = q->ntime;
  const double *time = j->splits ? ambit_split_plan_instants(j->arena, q->time, &ntime) : q->time;
  if (!time) return ambit_no_memory(f);
  uint32_t all = j->splits ? want | AMBIT_WANT_INITIAL | AMBIT_WANT_RHS : want;
  ambit_problem_request request = { q->system, q->initial, ntime, time, all, seal, &unknown, q->nnarrow, q->narrow,
    q->range, q->final, q->registry };
  ambit_status status = ambit_problem_build(&request, j->arena, &j->problem, f);
  if (status != AMBIT_OK) return status;
  j->problem.extras = q->extras;
  const ambit_problem *p = &j->problem;
  ambit_share_note(p->rhs, "right-hand side", p->nx, p->name);
  if (p->implicit) ambit_share_note(p->implicit->tape, "implicit form", p->nx + p->implicit->na, NULL);
  ambit_share_note(p->jacobian, "Jacobian", p->nx, p->name);
  if (q->prepared) q->prepared(q->prepared_user, j->problem.nu, unknown);
  if (!j->splits) return AMBIT_OK;
  if (q->band) {
    j->band = ambit_split_plan_band(j->arena, q->band, p->nx, q->ntime, ntime);
    if (!j->band) return ambit_no_memory(f);
  }
  j->initial = j->problem.initial;
  if (!(want & AMBIT_WANT_INITIAL)) j->problem.initial = NULL;
  return ambit_split_plan_make(&j->problem, j->initial, unknown, q->ncut, q->cut, q->pieces, j->arena, &j->plan, f);
}

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_simulate_request *q = j->q;
  ambit_status status = ambit_pair_offers(q->registry, q->solver, AMBIT_SOLVER, f);
  if (status == AMBIT_OK) status = ambit_registry_solver(q->registry, q->solver, &j->solver, f);
  if (status != AMBIT_OK) return status;
  ambit_method method = AMBIT_METHOD(q->solver, j->solver);
  status = ambit_pair_choose(q->registry, method, q->arithmetic, j->arithmetic, f);
  if (status == AMBIT_OK) status = ambit_context_scope(q->registry, &j->scope, f);
  if (status != AMBIT_OK) return status;
  ambit_failure own = { 0 };
  j->option =
      ambit_context_options(j->scope, j->solver->param, "solver", q->solver, q->nsolver_option, q->solver_option, &own);
  if (!j->option) return ambit_fail(f, own.status, "%s", own.message);
  const ambit_arithmetic *arithmetic;
  status = ambit_registry_arithmetic(q->registry, j->arithmetic, &arithmetic, f);
  if (status != AMBIT_OK) return status;
  uint32_t want = ambit_pair_want(method, j->option);
  j->splits = is_split(q);
  uint32_t written = want & AMBIT_WANT_SERIES ? AMBIT_SEAL_WRITE_FUNCTIONS | AMBIT_SEAL_WRITE_PAIRS : 0;
  status = build(j, want, ambit_arithmetic_seal(arithmetic) | written, f);
  if (status == AMBIT_OK) status = count_threads(j, f);
  return status == AMBIT_OK ? open_contexts(j, want, f) : status;
}

/* -- the run */

static double wall_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Whatever the solver made of it: what a broken arithmetic gave is not believed. */
static void tell(const job *j, const ambit_failure *why, ambit_simulate_result *result) {
  ambit_failure f = { 0 };
  for (uint32_t i = 0; i < j->ncontext && f.status == AMBIT_OK; i++) ambit_context_sound(&j->context[i], &f);
  if (f.status != AMBIT_OK) why = &f;
  result->status = why->status;
  memcpy(result->reason, why->message, sizeof result->reason);
  memcpy(result->code, why->code, sizeof result->code);
}

static void finish(
    const job *j, const ambit_guard *g, ambit_status said, const ambit_failure *own, ambit_simulate_result *result) {
  result->t_reached = g->reached;
  result->steps = g->steps;
  ambit_failure why;
  ambit_guard_judge(g, said, j->q->solver, own, &why);
  tell(j, &why, result);
}

static ambit_status run_pieces(job *j, ambit_guard *g, ambit_simulate_result *result, ambit_failure *f) {
  ambit_split split = { .problem = &j->problem,
    .band = j->band,
    .initial = j->initial,
    .pieces = &j->plan.pieces,
    .unknown = j->plan.name,
    .registry = j->q->registry,
    .solver = j->solver,
    .solver_name = j->q->solver,
    .option = j->option,
    .ncontext = j->ncontext,
    .context = j->context,
    .sink = &g->sink };
  ambit_split_outcome outcome;
  double start = ambit_context_seconds(), wall = wall_seconds();
  ambit_meter_enter(AMBIT_FRAME_STAGE, "split");
  ambit_status status = ambit_split_run(&split, j->arena, &outcome, f);
  ambit_meter_leave();
  result->cpu_seconds = ambit_context_seconds() - start;
  result->wall_seconds = wall_seconds() - wall;
  result->threads = outcome.threads;
  result->pieces = outcome.pieces;
  ambit_work_add(&j->tally.work, &outcome.work);
  if (status == AMBIT_OK) finish(j, g, outcome.said, &outcome.why, result);
  return status;
}

static ambit_status run_whole(job *j, ambit_guard *g, ambit_simulate_result *result, ambit_failure *f) {
  void *self = NULL;
  double begun = ambit_context_seconds();
  ambit_stage_enter("open", AMBIT_FRAME_SOLVER, j->q->solver);
  ambit_status status = j->solver->open(&j->scope->host, &j->problem, j->option, &self);
  ambit_stage_leave();
  j->tally.open = ambit_context_seconds() - begun;
  if (status == AMBIT_UNABLE || status == AMBIT_DOMAIN) {
    ambit_failure why;
    ambit_guard_explain(status, j->q->solver, &j->scope->failure, "could not start and gave no reason", &why);
    tell(j, &why, result);
    return AMBIT_OK;
  }
  if (status != AMBIT_OK) {
    char who[96];
    snprintf(who, sizeof who, "solver `%s`", j->q->solver);
    return ambit_context_failed(j->scope, status, who, f);
  }
  ambit_tally_run(&j->tally, j->scope, j->ncontext, j->context);
  double start = ambit_context_seconds(), wall = wall_seconds();
  ambit_stage_enter("run", AMBIT_FRAME_SOLVER, j->q->solver);
  ambit_status said = j->solver->run(self, &g->sink);
  ambit_stage_leave();
  ambit_allocation_forbid(0);
  result->cpu_seconds = ambit_context_seconds() - start;
  result->wall_seconds = wall_seconds() - wall;
  ambit_tally_ran(&j->tally, j->scope, j->ncontext, j->context);
  begun = ambit_context_seconds();
  j->solver->close(self);
  j->tally.close = ambit_context_seconds() - begun;
  finish(j, g, said, &j->scope->failure, result);
  return AMBIT_OK;
}

static ambit_status run(job *j, ambit_simulate_result *result, ambit_failure *f) {
  ambit_guard g = ambit_guard_make(&j->problem, j->q->sink);
  result->t_reached = g.reached;
  result->rigorous = j->solver->needs_rigorous && j->problem.arithmetic->rigorous;
  result->threads = j->splits || j->problem.worker ? j->ncontext : 1;
  result->pieces = j->splits ? j->plan.pieces.count : 1;
  return j->splits ? run_pieces(j, &g, result, f) : run_whole(j, &g, result, f);
}

/* -- the report */

static void fill_report(const job *j, const ambit_simulate_result *result, ambit_report *report) {
  *report = (ambit_report) { .expressions = (uint32_t)j->q->system->nx };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
  snprintf(report->solver, sizeof report->solver, "%.31s", j->q->solver);
  report->graph_nodes = ambit_graph_made(j->q->system->graph);
  ambit_report_count(report, j->problem.rhs);
  ambit_report_count(report, j->problem.implicit ? j->problem.implicit->tape : NULL);
  ambit_report_count(report, j->problem.jacobian);
  ambit_report_count(report, j->problem.slope);
  ambit_report_count(report, j->problem.invariant);
  ambit_report_count(report, j->problem.invariant_jacobian);
  report->states = j->problem.nx;
  report->parameters = j->problem.np;
  report->unknowns = j->problem.nu;
  report->steps = result->steps;
  report->seconds_run = result->cpu_seconds;
  ambit_tally_report(&j->tally, j->arena, j->scope, j->ncontext, j->context, report);
}

/* A solver that cannot work with these equations: a run without a step. */
static ambit_status end_at_start(const job *j, ambit_simulate_result *result, ambit_report *report, ambit_failure *f) {
  result->t_reached = j->q->time[0];
  result->rigorous = j->solver->needs_rigorous != 0;
  result->threads = result->pieces = 1;
  tell(j, f, result);
  if (report) {
    *report = (ambit_report) { .expressions = (uint32_t)j->q->system->nx, .states = (uint32_t)j->q->system->nx };
    snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
    snprintf(report->solver, sizeof report->solver, "%.31s", j->q->solver);
  }
  ambit_failure_clear(f);
  return AMBIT_OK;
}

ambit_status ambit_simulate(
    const ambit_simulate_request *q, ambit_simulate_result *result, ambit_report *report, ambit_failure *f) {
  job j = { .q = q, .arena = ambit_arena_open() };
  *result = (ambit_simulate_result) { 0 };
  if (!j.arena) return ambit_no_memory(f);
  j.tally = ambit_tally_begin(q->system->graph);
  ambit_status status = prepare(&j, f);
  ambit_tally_built(&j.tally);
  if (status == AMBIT_UNABLE) {
    status = end_at_start(&j, result, report, f);
  } else {
    if (status == AMBIT_OK) status = run(&j, result, f);
    if (status == AMBIT_OK && report) fill_report(&j, result, report);
  }
  for (uint32_t i = 0; i < j.ncontext; i++) ambit_context_close(&j.context[i]);
  ambit_scope_close(j.scope);
  ambit_arena_close(j.arena);
  return status;
}
