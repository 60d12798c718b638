/* evaluate.c -- expressions -> tape -> arithmetic -> enclosures.
**
** Sound because every step is: substitution and sealing keep identities, the arithmetic encloses the exact image of
** its inputs, and an unknown that several expressions share is one variable. An arithmetic that is not rigorous
** proves nothing and says so. Where the arithmetic tells derivatives, results are narrowed by monotonicity
** (monotone.h).
*/
#include <ambit/evaluate.h>
#include "graph/interpreter.h"
#include "graph/tape.h"
#include "verbs/evaluate/bound.h"
#include "verbs/run/context.h"
#include "verbs/evaluate/monotone.h"
#include "verbs/evaluate/partial.h"
#include "verbs/run/share.h"
#include "verbs/run/tally.h"
#include <stdio.h>
#include <string.h>

typedef struct job {
  const ambit_evaluate_request *q;
  ambit_arena *arena;
  ambit_bound bound;
  const ambit_tape *tape;
  uint32_t seal; /* flags of sealing */
  ambit_context context;
  ambit_block *block;
  ambit_tally tally;
} job;

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_evaluate_request *q = j->q;
  ambit_status status = ambit_bound_build(q, j->arena, &j->bound, f);
  if (status != AMBIT_OK) return status;
  size_t nu = j->bound.nunknown;
  status = ambit_context_open(q->registry, q->arithmetic, q->noption, q->option, (uint32_t)nu, &j->context, f);
  if (status != AMBIT_OK) return status;
  j->seal = ambit_arithmetic_seal(j->context.arithmetic);
  status = ambit_tape_seal(q->graph, j->arena, q->nexpr, j->bound.expr, nu, j->bound.unknown, 0, j->seal, &j->tape, f);
  if (status != AMBIT_OK) return status;
  ambit_share_note(j->tape, "results", j->tape->nout, NULL);
  return ambit_block_open(j->tape, j->context.arithmetic, j->context.ctx, 1, &j->block, f);
}

/* Without the memory for it the enclosure stays as wide as it is. */
static ambit_status narrow(job *j, size_t i, ambit_interval *x, ambit_failure *f) {
  const ambit_monotone m = { j->q->graph, &j->context, j->seal, j->bound.nunknown, j->bound.unknown, &j->tally.work };
  ambit_failure own = { 0 };
  ambit_status status = ambit_monotone_narrow(&m, j->bound.expr[i], x, &own);
  return status == AMBIT_OK || status == AMBIT_NOMEM ? AMBIT_OK : ambit_fail(f, status, "%s", own.message);
}

/* Behind the run, whose results have been read. */
static ambit_status find_partial(job *j, uint32_t *flags, ambit_failure *f) {
  const ambit_evaluate_request *q = j->q;
  ambit_partial p = { q->graph, j->arena, &j->bound, j->tape, j->block, q->nexpr, (*flags & AMBIT_F_PARTIAL) != 0,
    !(j->seal & AMBIT_SEAL_KEEP) };
  if (q->partial) memset(q->partial, 0, q->nexpr);
  if (q->blame) q->blame[0] = '\0';
  if (!ambit_partial_possible(&p)) return AMBIT_OK;
  char blame[AMBIT_BLAME_MAX];
  uint8_t *partial = q->partial ? q->partial : ambit_arena_alloc(j->arena, q->nexpr + 1);
  if (!partial) return ambit_no_memory(f);
  ambit_status status = ambit_partial_find(&p, partial, q->blame ? q->blame : blame, f);
  for (size_t i = 0; i < q->nexpr; i++)
    if (partial[i]) *flags |= AMBIT_F_PARTIAL;
  return status;
}

static ambit_status run(job *j, ambit_interval *out, uint32_t *flags, ambit_failure *f) {
  ambit_work_evaluate(&j->tally.work, j->tape->ninstr, 1);
  for (size_t i = 0; i < j->bound.nunknown; i++)
    ambit_block_set(j->block, (uint32_t)i, 0, ambit_graph_node(j->q->graph, j->bound.unknown[i])->value, (int32_t)i);
  *flags = ambit_block_run(j->block) & AMBIT_F_PARTIAL;
  for (size_t i = 0; i < j->q->nexpr; i++) {
    out[i] = ambit_block_get(j->block, (uint32_t)i, 0);
    ambit_status status = narrow(j, i, &out[i], f);
    if (status != AMBIT_OK) return status;
    if (ambit_interval_is_empty(out[i]))
      *flags |= AMBIT_F_EMPTY;
    else if (!ambit_interval_is_bounded(out[i]))
      *flags |= AMBIT_F_UNBOUNDED;
  }
  ambit_status status = find_partial(j, flags, f);
  return status == AMBIT_OK ? ambit_context_sound(&j->context, f) : status;
}

static void fill_report(const job *j, double ran, ambit_report *report) {
  if (!report) return;
  *report = (ambit_report) { 0 };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->q->arithmetic);
  report->expressions = (uint32_t)j->q->nexpr;
  report->graph_nodes = ambit_graph_made(j->q->graph);
  report->tape_slots = j->tape->nslot;
  report->tape_constants = j->tape->nconst;
  report->tape_instructions = j->tape->ninstr;
  report->tape_runs = j->tape->nrun;
  report->unknowns = (uint32_t)j->bound.nunknown;
  report->seconds_run = ran;
  ambit_tally_report(&j->tally, j->arena, NULL, 1, &j->context, report);
}

ambit_status ambit_evaluate(
    const ambit_evaluate_request *q, ambit_interval *out, uint32_t *flags, ambit_report *report, ambit_failure *f) {
  job j = { .q = q, .arena = ambit_arena_open() };
  if (!j.arena) return ambit_no_memory(f);
  j.tally = ambit_tally_begin(q->graph);
  ambit_status status = prepare(&j, f);
  ambit_tally_built(&j.tally);
  if (status == AMBIT_OK) {
    double built = ambit_context_seconds();
    uint32_t raised = 0;
    ambit_stage_enter("run", AMBIT_FRAME_ARITHMETIC, q->arithmetic);
    status = run(&j, out, &raised, f);
    ambit_stage_leave();
    if (flags) *flags = raised;
    fill_report(&j, ambit_context_seconds() - built, report);
  }
  ambit_block_close(j.block);
  ambit_context_close(&j.context);
  ambit_arena_close(j.arena);
  return status;
}
