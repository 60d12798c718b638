/* reduction.c -- runs a strategy, and believes no cut that was not proved. */
#include "verbs/reduce/reduction.h"
#include "verbs/run/context.h"
#include "verbs/run/guard.h"
#include "verbs/run/pair.h"
#include "verbs/reduce/reduction_build.h"
#include "verbs/run/tally.h"
#include "models/default.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CLAIMED 2 /* of a proof: said to be accepted */

typedef struct job {
  const ambit_reduction_request *q;
  ambit_reduction_result *result;
  ambit_arena *arena;
  const ambit_strategy *solver;
  char arithmetic[AMBIT_NAME_MAX];
  ambit_context context;
  ambit_scope *scope;
  double *option;
  ambit_reduction reduction;
  uint8_t *cut;          /* [ncandidate] accepted */
  uint8_t *tried;        /* [ncandidate] of the last full proof: 0, 1 or CLAIMED */
  double *error, *spare; /* [noutput] of the last full proof; of others */
  bool within;           /* was every error of the last full proof within its bound? */
  double outside;        /* s of CPU in callbacks */
  const char *broken;
  ambit_tally tally;
} job;

static const char *const ranking_name[AMBIT_RANK_COUNT] = { [AMBIT_RANK_RESIDUAL] = "residual",
  [AMBIT_RANK_ONE_STEP] = "one_step",
  [AMBIT_RANK_LOWERED] = "lowered_order",
  [AMBIT_RANK_EXACT] = "exact",
  [AMBIT_RANK_ADJOINT] = "adjoint" };

const char *ambit_reduction_ranking_name(uint32_t ranking) {
  return ranking < AMBIT_RANK_COUNT ? ranking_name[ranking] : "unknown";
}

/* -- the solver */

static ambit_status find_solver(job *j, ambit_failure *f) {
  const ambit_reduction_request *q = j->q;
  ambit_status status = ambit_pair_offers(q->registry, q->solver, AMBIT_STRATEGY, f);
  if (status == AMBIT_OK) status = ambit_registry_strategy(q->registry, q->solver, &j->solver, f);
  if (status != AMBIT_OK) return status;
  status = ambit_pair_choose(q->registry, AMBIT_METHOD(q->solver, j->solver), AMBIT_DEFAULT_POINTS, j->arithmetic, f);
  if (status == AMBIT_OK) status = ambit_context_scope(q->registry, &j->scope, f);
  if (status != AMBIT_OK) return status;
  ambit_failure own = { 0 };
  j->option =
      ambit_context_options(j->scope, j->solver->param, "solver", q->solver, q->nsolver_option, q->solver_option, &own);
  return j->option ? AMBIT_OK : ambit_fail(f, own.status, "%s", own.message);
}

/* -- callbacks: between the solver and the caller */

static bool is_within(const job *j, const double *error) {
  for (size_t o = 0; o < j->q->noutput; o++)
    if (!(error[o] >= 0 && error[o] <= j->q->bound[o])) return false;
  return true;
}

static ambit_status prove(void *user, uint32_t how, const uint8_t *cut, double *error) {
  job *j = user;
  bool full = how == AMBIT_PROVE_FULL;
  double begun = ambit_context_seconds(), *to = full ? j->error : j->spare;
  for (size_t o = 0; o < j->q->noutput; o++) to[o] = INFINITY;
  if (full) {
    for (size_t k = 0; k < j->q->ncandidate; k++) j->tried[k] = cut[k] != 0;
    j->within = false;
  }
  *(full ? &j->result->proofs : &j->result->lowered) += 1;
  ambit_meter_enter(AMBIT_FRAME_STAGE, "proof");
  ambit_status status = j->q->prove(j->q->user, how, cut, to);
  ambit_meter_leave();
  if (full && status == AMBIT_OK) j->within = is_within(j, to);
  if (error) memcpy(error, to, j->q->noutput * sizeof *error);
  j->outside += ambit_context_seconds() - begun;
  return status;
}

static void rank(void *user, uint32_t ranking, const double *value) {
  job *j = user;
  if (ranking >= AMBIT_RANK_COUNT || !value)
    j->broken = "a ranking that does not exist";
  else if (j->q->rank)
    j->q->rank(j->q->user, ranking, value);
}

/* what the last full proof was about: the accepted ones and these, each of them once */
static bool is_proved(job *j, const ambit_try *t) {
  for (uint32_t i = 0; i < t->ncandidate; i++) {
    if (j->tried[t->candidate[i]] != 1) return false;
    j->tried[t->candidate[i]] = CLAIMED;
  }
  size_t before = 0, after = 0;
  for (size_t k = 0; k < j->q->ncandidate; k++) {
    if (j->cut[k] && !j->tried[k]) return false;
    before += j->cut[k] != 0;
    after += j->tried[k] != 0;
  }
  return j->within && after == before + t->ncandidate;
}

static const char *find_fault(job *j, const ambit_try *t) {
  if (t->size < sizeof *t || t->outcome > AMBIT_TRY_HALVED) return "a decision of an unknown kind";
  if (t->ncandidate == 0 || !t->candidate) return "a decision about nothing";
  for (uint32_t i = 0; i < t->ncandidate; i++) {
    if (t->candidate[i] >= j->q->ncandidate) return "a decision about a candidate that does not exist";
    if (j->cut[t->candidate[i]]) return "a decision about a candidate that was accepted before";
  }
  if (t->outcome == AMBIT_TRY_ACCEPTED && !is_proved(j, t)) return "a cut as accepted that was not proved last";
  return NULL;
}

static void tried(void *user, const ambit_try *t) {
  job *j = user;
  if (j->broken) return;
  j->broken = find_fault(j, t);
  if (j->broken) return;
  ambit_try told = *t;
  if (t->outcome == AMBIT_TRY_ACCEPTED) {
    for (uint32_t i = 0; i < t->ncandidate; i++) j->cut[t->candidate[i]] = 1;
    told.error = j->error; /* what was proved, whatever the solver says */
  }
  double begun = ambit_context_seconds();
  if (j->q->tried) j->q->tried(j->q->user, &told);
  j->outside += ambit_context_seconds() - begun;
}

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  (void)s, (void)r;
  return 0;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  (void)s, (void)done, (void)message;
  return 0;
}

/* -- the run */

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_reduction_request *q = j->q;
  ambit_status status = find_solver(j, f);
  if (status == AMBIT_OK)
    status = ambit_reduction_build(
        q, ambit_pair_want(AMBIT_METHOD(q->solver, j->solver), j->option), j->arena, &j->reduction, f);
  if (status != AMBIT_OK) return status;
  j->tried = ambit_arena_alloc(j->arena, q->ncandidate + 1);
  j->error = ambit_arena_alloc(j->arena, 2 * q->noutput * sizeof *j->error);
  if (!j->tried || !j->error) return ambit_no_memory(f);
  j->spare = j->error + q->noutput;
  ambit_reduction *r = &j->reduction;
  r->prove = prove, r->rank = rank, r->tried = tried, r->user = j;
  status = ambit_context_open(q->registry, j->arithmetic, 0, NULL, 0, &j->context, f);
  r->nx = (uint32_t)q->nx, r->arithmetic = j->context.arithmetic, r->actx = j->context.ctx;
  return status;
}

static void judge(const job *j, ambit_status said, ambit_reduction_result *result) {
  const char *name = j->q->solver;
  bool known = said == AMBIT_OK || said == AMBIT_STOPPED || said == AMBIT_UNABLE;
  ambit_failure why = { 0 };
  ambit_context_sound(&j->context, &why);
  if (why.status != AMBIT_OK)
    ; /* what a broken arithmetic gave is not believed */
  else if (j->broken)
    ambit_fail_code(&why, AMBIT_BROKEN, AMBIT_CODE_BROKEN_RECORD, "solver `%s` is broken: it gave %s", name, j->broken);
  else if (said == AMBIT_STOPPED && !j->scope->failure.message[0])
    ambit_fail_code(
        &why, AMBIT_STOPPED, AMBIT_CODE_STOPPED_REQUEST, "stopped on request; what was accepted until then is proved");
  else if (said != AMBIT_OK)
    ambit_guard_explain(known ? said : AMBIT_BROKEN, name, &j->scope->failure, "gave up without a reason", &why);
  result->status = why.status;
  memcpy(result->reason, why.message, sizeof result->reason);
  memcpy(result->code, why.code, sizeof result->code);
}

static ambit_status run(job *j, ambit_failure *f) {
  void *self = NULL;
  ambit_sink silent = { sizeof silent, emit, progress };
  double begun = ambit_context_seconds();
  ambit_stage_enter("open", AMBIT_FRAME_SOLVER, j->q->solver);
  ambit_status status = j->solver->open(&j->scope->host, &j->reduction, j->option, &self);
  ambit_stage_leave();
  j->tally.open = ambit_context_seconds() - begun;
  if (status != AMBIT_OK) {
    char who[96];
    snprintf(who, sizeof who, "solver `%s`", j->q->solver);
    return ambit_context_failed(j->scope, status, who, f);
  }
  ambit_stage_enter("run", AMBIT_FRAME_SOLVER, j->q->solver);
  ambit_status said = j->solver->run(self, j->q->sink ? j->q->sink : &silent);
  ambit_stage_leave();
  j->solver->close(self);
  judge(j, said, j->result);
  return AMBIT_OK;
}

static void fill_report(const job *j, ambit_report *report) {
  const ambit_reduction *r = &j->reduction;
  *report = (ambit_report) { .expressions = (uint32_t)(j->q->neffect + j->q->nx + j->q->noutput),
    .states = (uint32_t)j->q->nx,
    .parameters = (uint32_t)j->q->ndata,
    .seconds_run = j->result->cpu_seconds - j->tally.built };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
  snprintf(report->solver, sizeof report->solver, "%.31s", j->q->solver);
  report->graph_nodes = ambit_graph_made(j->q->graph);
  const ambit_tape *const tape[] = { r->effect, r->jacobian, r->output_jacobian, r->rates, r->output_value };
  for (size_t i = 0; i < sizeof tape / sizeof *tape; i++) ambit_report_count(report, tape[i]);
  ambit_tally_report(&j->tally, j->arena, j->scope, 1, &j->context, report);
}

ambit_status ambit_reduction_run(const ambit_reduction_request *q, uint8_t *cut, ambit_reduction_result *result,
    ambit_report *report, ambit_failure *f) {
  *result = (ambit_reduction_result) { 0 };
  if (q->ncandidate) memset(cut, 0, q->ncandidate);
  job j = { .q = q, .result = result, .cut = cut, .arena = ambit_arena_open() };
  if (!j.arena) return ambit_no_memory(f);
  double begun = ambit_context_seconds();
  j.tally = ambit_tally_begin(q->graph);
  ambit_status status = prepare(&j, f);
  ambit_tally_built(&j.tally);
  if (status == AMBIT_OK) status = run(&j, f);
  result->cpu_seconds = ambit_context_seconds() - begun;
  result->cpu_seconds_rank = fmax(0, result->cpu_seconds - j.outside);
  if (status == AMBIT_OK && report) fill_report(&j, report);
  ambit_context_close(&j.context);
  ambit_scope_close(j.scope);
  ambit_arena_close(j.arena);
  return status;
}
