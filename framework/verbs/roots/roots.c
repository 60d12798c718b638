/* roots.c -- chooses as many equations as there are unknowns, builds the problem, runs the solver behind a sink that
** watches it.
**
** With more equations than unknowns the solver gets nx of them, those that elimination with row pivoting finds most
** independent at the centre, and the others as further equations: each root of all is one of the chosen ones, and boxes
** where a further one cannot vanish hold none; but that a further one vanishes exactly is beyond enclosures.
*/
#include <ambit/roots.h>
#include "graph/interpreter.h"
#include "graph/tape.h"
#include "verbs/run/allocation.h"
#include "verbs/run/context.h"
#include "verbs/run/guard.h"
#include "verbs/roots/equations.h"
#include "verbs/run/pair.h"
#include "verbs/run/share.h"
#include "verbs/run/tally.h"
#include "models/default.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct job {
  const ambit_roots_request *q;
  ambit_arena *arena;
  ambit_ready ready;
  const ambit_root_finder *solver;
  char arithmetic[AMBIT_NAME_MAX];
  uint32_t seal;
  ambit_root_problem problem;
  ambit_context context;
  ambit_scope *scope;
  double *option;
  ambit_tally tally;
} job;

/* -- the request */

static ambit_status check_box(const ambit_roots_request *q, ambit_failure *f) {
  const ambit_equations *e = q->equations;
  if (e->nx == 0) return ambit_fail(f, AMBIT_INVALID, "there are no unknowns: `box` names none");
  for (size_t i = 0; i < e->nx; i++) {
    ambit_interval x = q->box[i];
    if (ambit_interval_is_empty(ambit_interval_of(x.lo, x.hi)))
      return ambit_fail(f, AMBIT_INVALID, "the box is empty: `%s` in [%g, %g]", e->name[i], x.lo, x.hi);
  }
  return AMBIT_OK;
}

/* equations that are to be solved, of those that are not 0 = 0 */
static size_t count_leading(const job *j) {
  size_t n = 0;
  if (!j->q->leading) return j->ready.ne;
  for (size_t i = 0; i < j->ready.ne; i++) n += j->ready.place[i] < j->q->leading;
  return n;
}

static bool is_implied(const job *j) { return j->q->leading && count_leading(j) == j->ready.nx; }

static ambit_status check_count(const job *j, ambit_failure *f) {
  size_t ne = count_leading(j), nx = j->ready.nx;
  if (ne >= nx) return AMBIT_OK;
  char list[256] = "";
  size_t used = 0;
  for (size_t i = 0; i < nx && used < sizeof list; i++)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s`%s`", i ? ", " : "", j->ready.name[i]);
  return ambit_fail(f, AMBIT_INVALID,
      "%zu equation%s cannot fix %zu unknowns (%s): take %zu of them out of `box` and give values in `at`", ne,
      ne == 1 ? "" : "s", nx, list, nx - ne);
}

/* -- which equations */

/* Row pivoting on J [ne x nx], destroyed: order[0 .. nx) are independent rows, if there are so many. */
static void order_rows(size_t ne, size_t nx, double *J, size_t *order) {
  for (size_t i = 0; i < ne; i++) order[i] = i;
  for (size_t k = 0, c = 0; k < nx && c < nx; c++) {
    size_t best = k;
    for (size_t i = k; i < ne; i++)
      if (fabs(J[order[i] * nx + c]) > fabs(J[order[best] * nx + c])) best = i;
    size_t row = order[best];
    if (fabs(J[row * nx + c]) < 1e-12) continue;
    order[best] = order[k];
    order[k++] = row;
    for (size_t i = k; i < ne; i++) {
      double factor = J[order[i] * nx + c] / J[row * nx + c];
      for (size_t j = c; j < nx; j++) J[order[i] * nx + j] -= factor * J[row * nx + j];
    }
  }
}

static double middle(ambit_interval x) { return fmin(fmax(ambit_interval_mid(x), -1e3), 1e3); }

/* the equations in the order: chosen ones, then the others */
static ambit_status choose_rows(job *j, ambit_failure *f) {
  ambit_ready *r = &j->ready;
  const ambit_tape *slopes;
  if (r->ne == r->nx || is_implied(j)) return AMBIT_OK;
  ambit_status status = ambit_equations_differentiate(r, r->ne, r->equation, 0, r->nx, 0, &slopes, f);
  if (status != AMBIT_OK) return status;
  double *x = ambit_arena_alloc(j->arena, r->nx * sizeof *x);
  double *J = ambit_arena_alloc(j->arena, r->ne * r->nx * sizeof *J);
  size_t *order = ambit_arena_alloc(j->arena, r->ne * sizeof *order);
  ambit_interval *slot = ambit_arena_alloc(j->arena, (slopes->nslot + 1) * sizeof *slot);
  ambit_expr *chosen = ambit_arena_alloc(j->arena, r->ne * sizeof *chosen);
  if (!x || !J || !order || !slot || !chosen) return ambit_no_memory(f);
  for (size_t i = 0; i < r->nx; i++) x[i] = j->q->centre ? j->q->centre[i] : middle(j->q->box[i]);
  if (!ambit_equations_at(r, slopes, x, slot, J)) return AMBIT_OK; /* as they come */
  order_rows(r->ne, r->nx, J, order);
  for (size_t i = 0; i < r->ne; i++) chosen[i] = r->equation[order[i]];
  r->equation = chosen;
  return AMBIT_OK;
}

/* -- the problem */

static ambit_status copy_ranges(job *j, ambit_failure *f) {
  ambit_root_problem *p = &j->problem;
  double *lo = ambit_arena_alloc(j->arena, (p->nx + p->np + 1u) * sizeof *lo);
  double *hi = ambit_arena_alloc(j->arena, (p->nx + p->np + 1u) * sizeof *hi);
  if (!lo || !hi) return ambit_no_memory(f);
  for (uint32_t i = 0; i < p->nx + p->np; i++) {
    ambit_interval x = i < p->nx ? j->q->box[i] : j->ready.p[i - p->nx];
    lo[i] = x.lo, hi[i] = x.hi;
  }
  p->x_lo = lo, p->x_hi = hi;
  p->p_lo = lo + p->nx, p->p_hi = hi + p->nx;
  return AMBIT_OK;
}

static ambit_status build_problem(job *j, uint32_t want, ambit_failure *f) {
  const ambit_ready *r = &j->ready;
  ambit_root_problem *p = &j->problem;
  *p = (ambit_root_problem) {
    .size = sizeof *p, .nx = (uint32_t)r->nx, .np = (uint32_t)r->np, .implied = is_implied(j), .name = r->name
  };
  size_t further = r->ne - r->nx;
  ambit_status status = copy_ranges(j, f);
  if (status == AMBIT_OK) status = ambit_equations_seal(r, r->nx, r->equation, j->seal, &p->f, f);
  if (status == AMBIT_OK && (want & AMBIT_ROOT_WANT_JACOBIAN))
    status = ambit_equations_differentiate(r, r->nx, r->equation, 0, r->nx, j->seal, &p->jacobian, f);
  ambit_failure kink = { 0 }; /* of |p|: then there is none */
  if (status == AMBIT_OK && (want & AMBIT_ROOT_WANT_SLOPE) && r->np)
    ambit_equations_differentiate(r, r->nx, r->equation, r->nx, r->np, j->seal, &p->slope, &kink);
  if (status == AMBIT_OK && (want & AMBIT_ROOT_WANT_FURTHER) && further) {
    p->nfurther = (uint32_t)further;
    status = ambit_equations_seal(r, further, r->equation + r->nx, j->seal, &p->further, f);
  }
  ambit_share_note(p->f, "equations", p->nx, NULL);
  ambit_share_note(p->jacobian, "Jacobian", p->nx, NULL);
  return status;
}

static ambit_status find_solver(job *j, ambit_failure *f) {
  const ambit_roots_request *q = j->q;
  ambit_status status = ambit_pair_offers(q->registry, q->solver, AMBIT_ROOT_FINDER, f);
  if (status == AMBIT_OK) status = ambit_registry_root_finder(q->registry, q->solver, &j->solver, f);
  if (status != AMBIT_OK) return status;
  status = ambit_pair_choose(q->registry, AMBIT_METHOD(q->solver, j->solver), q->arithmetic, j->arithmetic, f);
  if (status == AMBIT_OK) status = ambit_context_scope(q->registry, &j->scope, f);
  if (status != AMBIT_OK) return status;
  ambit_failure own = { 0 };
  j->option =
      ambit_context_options(j->scope, j->solver->param, "solver", q->solver, q->nsolver_option, q->solver_option, &own);
  if (!j->option) return ambit_fail(f, own.status, "%s", own.message);
  const ambit_arithmetic *arithmetic;
  status = ambit_registry_arithmetic(q->registry, j->arithmetic, &arithmetic, f);
  if (status == AMBIT_OK) j->seal = ambit_arithmetic_seal(arithmetic);
  return status;
}

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_roots_request *q = j->q;
  ambit_status status = check_box(q, f);
  if (status == AMBIT_OK) status = ambit_equations_prepare(q->equations, j->arena, &j->ready, f);
  if (status == AMBIT_OK) status = check_count(j, f);
  if (status == AMBIT_OK) status = find_solver(j, f);
  if (status == AMBIT_OK) status = choose_rows(j, f);
  if (status == AMBIT_OK) status = build_problem(j, ambit_pair_want(AMBIT_METHOD(q->solver, j->solver), j->option), f);
  if (status != AMBIT_OK) return status;
  return ambit_context_open(q->registry, j->arithmetic, q->narithmetic_option, q->arithmetic_option,
      j->problem.nx + j->problem.np, &j->context, f);
}

/* -- the watching sink */

typedef struct guard {
  ambit_sink sink; /* first: what the solver sees */
  ambit_sink *outer;
  ambit_roots_result *result;
  uint32_t nx;
  bool stopped;
  const char *broken, *broken_code;
} guard;

static const char *find_fault(const guard *g, const ambit_record *r, const char **code) {
  *code = AMBIT_CODE_BROKEN_RECORD;
  if (r->size < sizeof *r) return "a record of the wrong size";
  if (r->kind != AMBIT_REC_ROOT) return NULL;
  if (r->nx != g->nx || !r->lo || !r->hi) return "a root without an enclosure of every unknown";
  for (uint32_t i = 0; i < r->nx; i++) {
    if (r->lo[i] <= r->hi[i]) continue;
    *code = AMBIT_CODE_BROKEN_BOUNDS;
    return "a root with an empty or NaN enclosure";
  }
  return r->event > AMBIT_ROOT_PARTLY ? "a root of an unknown kind" : NULL;
}

static int32_t pass(guard *g, const ambit_record *r) {
  g->broken = find_fault(g, r, &g->broken_code);
  if (g->broken) return 1;
  if (r->kind == AMBIT_REC_SEARCHED) g->result->boxes = r->ncoef;
  if (r->kind != AMBIT_REC_ROOT) return 0;
  ambit_roots_result *to = g->result;
  uint32_t *const count[] = { &to->undecided, &to->proved, &to->partly };
  *count[r->event] += 1;
  if (!g->outer || !g->outer->emit) return 0;
  ambit_meter_enter(AMBIT_FRAME_STAGE, "records");
  int32_t stop = g->outer->emit(g->outer, r);
  ambit_meter_leave();
  return stop;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  guard *g = (guard *)(void *)s;
  ambit_allocation_forbid(0); /* what the receiver does is its own affair */
  int32_t stop = pass(g, r);
  g->stopped = g->stopped || stop;
  ambit_allocation_forbid(1); /* from the first record on */
  return stop;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  guard *g = (guard *)(void *)s;
  if (!g->outer || !g->outer->progress) return 0;
  ambit_allocation_forbid(0);
  int32_t stop = g->outer->progress(g->outer, done, message);
  g->stopped = g->stopped || stop;
  if (g->result->proved + g->result->partly + g->result->undecided) ambit_allocation_forbid(1);
  return stop;
}

/* -- the run */

static void judge(const job *j, const guard *g, ambit_status said, ambit_roots_result *result) {
  const ambit_failure *own = &j->scope->failure;
  const char *fault = g->broken, *name = j->q->solver;
  ambit_failure why = { 0 };
  ambit_context_sound(&j->context, &why);
  if (!fault && said == AMBIT_OK && result->undecided) fault = "undecided boxes and says that all is decided";
  if (why.status != AMBIT_OK)
    ; /* what a broken arithmetic gave is not believed */
  else if (fault)
    ambit_fail_code(&why, AMBIT_BROKEN, g->broken ? g->broken_code : AMBIT_CODE_BROKEN_RECORD,
        "solver `%s` is broken: it gave %s", name, fault);
  else if (g->stopped)
    ambit_fail_code(&why, AMBIT_STOPPED, AMBIT_CODE_STOPPED_REQUEST, "stopped on request; roots may be missing");
  else if (said != AMBIT_OK)
    ambit_guard_explain(said == AMBIT_UNABLE ? said : AMBIT_BROKEN, name, own, "gave up without a reason", &why);
  result->status = why.status;
  memcpy(result->reason, why.message, sizeof result->reason);
  memcpy(result->code, why.code, sizeof result->code);
}

static ambit_status run(job *j, ambit_roots_result *result, ambit_failure *f) {
  void *self = NULL;
  guard g = { { sizeof(ambit_sink), emit, progress }, j->q->sink, result, j->problem.nx, false, NULL, NULL };
  j->problem.arithmetic = j->context.arithmetic;
  j->problem.actx = j->context.ctx;
  result->rigorous = j->solver->needs_rigorous && j->context.arithmetic->rigorous;
  result->further = is_implied(j) ? 0 : j->problem.nfurther;
  double begun = ambit_context_seconds();
  ambit_stage_enter("open", AMBIT_FRAME_SOLVER, j->q->solver);
  ambit_status status = j->solver->open(&j->scope->host, &j->problem, j->option, &self);
  ambit_stage_leave();
  j->tally.open = ambit_context_seconds() - begun;
  if (status != AMBIT_OK) {
    char who[96];
    snprintf(who, sizeof who, "solver `%s`", j->q->solver);
    return ambit_context_failed(j->scope, status, who, f);
  }
  ambit_tally_run(&j->tally, j->scope, 1, &j->context);
  double start = ambit_context_seconds();
  ambit_stage_enter("run", AMBIT_FRAME_SOLVER, j->q->solver);
  ambit_status said = j->solver->run(self, &g.sink);
  ambit_stage_leave();
  ambit_allocation_forbid(0);
  result->cpu_seconds = ambit_context_seconds() - start;
  ambit_tally_ran(&j->tally, j->scope, 1, &j->context);
  begun = ambit_context_seconds();
  j->solver->close(self);
  j->tally.close = ambit_context_seconds() - begun;
  judge(j, &g, said, result);
  return AMBIT_OK;
}

static void fill_report(const job *j, const ambit_roots_result *result, ambit_report *report) {
  const ambit_root_problem *p = &j->problem;
  *report = (ambit_report) { .expressions = (uint32_t)j->q->equations->ne };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
  snprintf(report->solver, sizeof report->solver, "%.31s", j->q->solver);
  report->graph_nodes = ambit_graph_made(j->q->equations->graph);
  ambit_report_count(report, p->f);
  ambit_report_count(report, p->jacobian);
  ambit_report_count(report, p->slope);
  ambit_report_count(report, p->further);
  report->states = p->nx;
  report->parameters = report->unknowns = p->np;
  report->steps = result->boxes;
  report->seconds_run = result->cpu_seconds;
  ambit_tally_report(&j->tally, j->arena, j->scope, 1, &j->context, report);
}

ambit_status ambit_roots(
    const ambit_roots_request *q, ambit_roots_result *result, ambit_report *report, ambit_failure *f) {
  job j = { .q = q, .arena = ambit_arena_open() };
  *result = (ambit_roots_result) { 0 };
  if (!j.arena) return ambit_no_memory(f);
  j.tally = ambit_tally_begin(q->equations->graph);
  ambit_status status = prepare(&j, f);
  ambit_tally_built(&j.tally);
  if (status == AMBIT_OK) status = run(&j, result, f);
  if (status == AMBIT_OK && report) fill_report(&j, result, report);
  ambit_context_close(&j.context);
  ambit_scope_close(j.scope);
  ambit_arena_close(j.arena);
  return status;
}
