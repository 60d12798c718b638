/* simulate.c -- checks the pair, builds the problem, runs the solver behind a sink that watches it.
**
** The kernel trusts no record blindly: a NaN or reversed bound, a gap in time or a run that claims to be complete
** without having reached the end makes the outcome `broken`, never `complete`.
*/
#include "model/simulate.h"
#include "graph/tape.h"
#include "model/allocation.h"
#include "model/context.h"
#include "model/pair.h"
#include "model/problem.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* -- the watching sink */

typedef struct guard {
  ambit_sink sink; /* first: what the solver sees */
  ambit_sink *outer;
  uint32_t nx, steps;
  double direction, reached; /* +1 or -1; end of the last step, s */
  bool stopped;
  char broken[160]; /* what was wrong with a record, or "" */
} guard;

static bool bounds_make_sense(uint32_t n, const double *lo, const double *hi) {
  for (uint32_t i = 0; i < n; i++)
    if (!(lo[i] <= hi[i])) return false;
  return true;
}

/* NULL: the step is sound in form */
static const char *find_fault(const guard *g, const ambit_record *r) {
  if (r->size < offsetof(ambit_record, ndense)) return "a record of the wrong size";
  if (r->kind != AMBIT_REC_STEP) return NULL;
  if (r->nx != g->nx || !r->lo || !r->hi) return "a step without an enclosure of every state";
  if (!bounds_make_sense(r->nx, r->lo, r->hi)) return "a step with an empty or NaN enclosure";
  if (r->tube_lo && r->tube_hi && !bounds_make_sense(r->nx, r->tube_lo, r->tube_hi))
    return "a step with an empty or NaN tube";
  if (!(g->direction * (r->t_from - g->reached) <= 0)) return "a step that leaves a gap in time";
  if (!(g->direction * (r->t_to - g->reached) >= 0) || !isfinite(r->t_to))
    return "a step against the direction of time";
  return NULL;
}

static int32_t pass(guard *g, int32_t stop) {
  g->stopped = g->stopped || stop;
  ambit_allocation_forbid(1); /* from the first record on */
  return stop;
}

static int32_t emit(ambit_sink *s, const ambit_record *given) {
  guard *g = (guard *)(void *)s;
  ambit_allocation_forbid(0);              /* what the receiver does is its own affair */
  ambit_record whole = { 0 }, *r = &whole; /* a solver may be older than this kernel, and its records shorter */
  memcpy(r, given, given->size < sizeof *r ? given->size : sizeof *r);
  const char *fault = find_fault(g, r);
  if (fault) {
    snprintf(g->broken, sizeof g->broken, "%s", fault);
    return pass(g, 1);
  }
  if (r->kind == AMBIT_REC_STEP) {
    g->steps++;
    g->reached = r->t_to;
  }
  return pass(g, g->outer && g->outer->emit ? g->outer->emit(g->outer, r) : 0);
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  guard *g = (guard *)(void *)s;
  if (!g->outer || !g->outer->progress) return 0;
  ambit_allocation_forbid(0);
  int32_t stop = g->outer->progress(g->outer, done, message);
  g->stopped = g->stopped || stop;
  if (g->steps) ambit_allocation_forbid(1);
  return stop;
}

static guard make_guard(const ambit_problem *p, ambit_sink *outer) {
  return (guard) {
    .sink = { sizeof(ambit_sink), emit, progress },
    .outer = outer,
    .nx = p->nx,
    .direction = p->time[p->ntime - 1] < p->time[0] ? -1 : 1,
    .reached = p->time[0],
  };
}

/* -- the run */

typedef struct job {
  const ambit_simulate_request *q;
  ambit_arena *arena;
  const ambit_solver *solver;
  char arithmetic[AMBIT_NAME_MAX];
  ambit_problem problem;
  ambit_context context;
  ambit_lease *lease;
  double *option;
} job;

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_simulate_request *q = j->q;
  ambit_status status = ambit_registry_solver(q->registry, q->solver, &j->solver, f);
  if (status == AMBIT_OK)
    status = ambit_pair_choose(q->registry, q->solver, j->solver, q->arithmetic, j->arithmetic, f);
  if (status == AMBIT_OK) status = ambit_context_lease(q->registry, &j->lease, f);
  if (status != AMBIT_OK) return status;
  if (j->solver->solves != AMBIT_SOLVES_FLOW)
    return ambit_fail(f, AMBIT_INVALID,
        "solver `%s` finds roots and does not advance in time; `simulate` needs one that does", q->solver);
  ambit_failure own = { 0 };
  j->option =
      ambit_context_options(j->lease, j->solver->param, "solver", q->solver, q->nsolver_option, q->solver_option, &own);
  if (!j->option) return ambit_fail(f, own.status, "%s", own.message);
  const ambit_arithmetic *arithmetic;
  status = ambit_registry_arithmetic(q->registry, j->arithmetic, &arithmetic, f);
  if (status != AMBIT_OK) return status;
  uint32_t want = ambit_pair_want(j->solver, j->option);
  const ambit_expr *unknown;
  ambit_problem_request request = { q->system, q->initial, q->ntime, q->time, want,
    arithmetic->set_text ? AMBIT_SEAL_KEEP : 0, &unknown };
  status = ambit_problem_build(&request, j->arena, &j->problem, f);
  if (status != AMBIT_OK) return status;
  j->problem.wish = q->wish;
  if (q->prepared) q->prepared(q->prepared_user, j->problem.nu, unknown);
  const ambit_problem *p = &j->problem;
  uint32_t nvar = want & AMBIT_WANT_INITIAL ? p->nu : p->nx + p->np;
  return ambit_context_open(
      q->registry, j->arithmetic, q->narithmetic_option, q->arithmetic_option, nvar, &j->context, f);
}

static void explain(const job *j, ambit_status status, const char *fallback, ambit_simulate_result *result) {
  result->status = status >= AMBIT_OK && status <= AMBIT_BROKEN ? status : AMBIT_BROKEN;
  const char *own = j->lease->failure.message;
  if (own[0])
    snprintf(result->reason, sizeof result->reason, "%s", own);
  else
    snprintf(result->reason, sizeof result->reason, "solver `%s` %s", j->q->solver, fallback);
}

/* The outcome from what the solver says and what the guard saw. */
static void judge(const job *j, const guard *g, ambit_status said, ambit_simulate_result *result) {
  double end = j->problem.time[j->problem.ntime - 1];
  result->t_reached = g->reached;
  result->steps = g->steps;
  if (g->broken[0]) {
    result->status = AMBIT_BROKEN;
    snprintf(result->reason, sizeof result->reason, "solver `%s` is broken: it gave %s", j->q->solver, g->broken);
  } else if (g->stopped && g->reached != end) {
    result->status = AMBIT_STOPPED;
    snprintf(result->reason, sizeof result->reason, "stopped on request at t = %.9g s", g->reached);
  } else if (said == AMBIT_OK && g->reached != end) {
    result->status = AMBIT_BROKEN;
    snprintf(result->reason, sizeof result->reason,
        "solver `%s` is broken: it says it is done at t = %.9g s, before the end", j->q->solver, g->reached);
  } else if (said != AMBIT_OK && !(said == AMBIT_STOPPED && g->reached == end)) {
    explain(j, said, said == AMBIT_STOPPED ? "stopped without being asked to" : "could not go on and gave no reason",
        result);
  }
}

static ambit_status run(job *j, ambit_simulate_result *result, ambit_failure *f) {
  void *self = NULL;
  guard g = make_guard(&j->problem, j->q->sink);
  j->problem.arithmetic = j->context.arithmetic;
  j->problem.actx = j->context.ctx;
  result->t_reached = g.reached;
  result->rigorous = j->solver->needs_rigorous && j->context.arithmetic->rigorous;
  ambit_status status = j->solver->open(&j->lease->host, &j->problem, j->option, &self);
  if (status == AMBIT_UNABLE || status == AMBIT_DOMAIN) {
    explain(j, status, "could not start and gave no reason", result);
    return AMBIT_OK;
  }
  if (status != AMBIT_OK) {
    char who[96];
    snprintf(who, sizeof who, "solver `%s`", j->q->solver);
    return ambit_context_failed(j->lease, status, who, f);
  }
  double start = ambit_context_seconds();
  ambit_status said = j->solver->run(self, &g.sink);
  ambit_allocation_forbid(0);
  result->cpu_seconds = ambit_context_seconds() - start;
  j->solver->close(self);
  judge(j, &g, said, result);
  return AMBIT_OK;
}

/* -- the report */

static void fill_report(const job *j, double built, const ambit_simulate_result *result, ambit_report *report) {
  *report = (ambit_report) { .expressions = (uint32_t)j->q->system->nx, .seconds_build = built };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
  snprintf(report->solver, sizeof report->solver, "%.31s", j->q->solver);
  report->graph_nodes = ambit_graph_count(j->q->system->graph);
  ambit_report_count(report, j->problem.rhs);
  ambit_report_count(report, j->problem.jacobian);
  ambit_report_count(report, j->problem.invariant);
  ambit_report_count(report, j->problem.invariant_jacobian);
  report->states = j->problem.nx;
  report->parameters = j->problem.np;
  report->unknowns = j->problem.nu;
  report->steps = result->steps;
  report->seconds_run = result->cpu_seconds;
}

ambit_status ambit_simulate(
    const ambit_simulate_request *q, ambit_simulate_result *result, ambit_report *report, ambit_failure *f) {
  job j = { .q = q, .arena = ambit_arena_open() };
  *result = (ambit_simulate_result) { 0 };
  if (!j.arena) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  double start = ambit_context_seconds();
  ambit_status status = prepare(&j, f);
  double built = ambit_context_seconds() - start;
  if (status == AMBIT_OK) status = run(&j, result, f);
  if (status == AMBIT_OK && report) fill_report(&j, built, result, report);
  ambit_context_close(&j.context);
  ambit_lease_close(j.lease);
  ambit_arena_close(j.arena);
  return status;
}
