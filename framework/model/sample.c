/* sample.c -- draws of expressions, a batch of lanes at a time. */
#include "model/sample.h"
#include "graph/batch.h"
#include "graph/tape.h"
#include "model/bound.h"
#include "model/context.h"
#include "num/random.h"
#include <math.h>
#include <stdio.h>

#define LANES 256u

typedef struct job {
  const ambit_evaluate_request *q;
  const char *arithmetic;
  ambit_arena *arena;
  ambit_bound bound;
  ambit_interval *range; /* [nunknown] */
  const ambit_tape *tape;
  ambit_context context;
  ambit_batch *batch;
  double *point;     /* [nunknown][LANES] */
  double *rlo, *rhi; /* [nexpr][LANES] */
} job;

static ambit_status find_ranges(job *j, ambit_failure *f) {
  j->range = ambit_arena_alloc(j->arena, j->bound.nunknown * sizeof *j->range);
  if (!j->range) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  for (size_t i = 0; i < j->bound.nunknown; i++) {
    const ambit_node *node = ambit_graph_node(j->q->graph, j->bound.unknown[i]);
    j->range[i] = node->value;
    if (ambit_interval_is_empty(node->value) || !ambit_interval_is_bounded(node->value))
      return ambit_fail(f, AMBIT_INVALID, "cannot draw %s%s%s from [%g, %g]: its range is not bounded",
          node->text ? "`" : "", node->text ? node->text : "an unknown", node->text ? "`" : "", node->value.lo,
          node->value.hi);
  }
  return AMBIT_OK;
}

static ambit_status make_room(job *j, ambit_failure *f) {
  size_t results = j->q->nexpr * LANES;
  j->point = ambit_arena_alloc(j->arena, j->bound.nunknown * LANES * sizeof *j->point);
  j->rlo = ambit_arena_alloc(j->arena, 2 * results * sizeof *j->rlo);
  if (!j->point || !j->rlo) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  j->rhi = j->rlo + results;
  return AMBIT_OK;
}

static ambit_status prepare(job *j, ambit_failure *f) {
  const ambit_evaluate_request *q = j->q;
  ambit_status status = ambit_bound_build(q, j->arena, &j->bound, f);
  if (status == AMBIT_OK) status = find_ranges(j, f);
  if (status == AMBIT_OK) status = make_room(j, f);
  if (status != AMBIT_OK) return status;
  size_t nu = j->bound.nunknown;
  status = ambit_tape_seal(q->graph, j->arena, q->nexpr, j->bound.expr, nu, j->bound.unknown, 0, 0, &j->tape, f);
  if (status == AMBIT_OK)
    status = ambit_context_open(q->registry, j->arithmetic, q->noption, q->option, (uint32_t)nu, &j->context, f);
  if (status != AMBIT_OK) return status;
  return ambit_batch_open(j->tape, j->context.arithmetic, j->context.ctx, &j->batch, f);
}

/* Draws number done to done + lanes - 1. */
static void run_lanes(job *j, size_t done, size_t lanes, ambit_random *random, ambit_interval *out, size_t *defined) {
  for (size_t lane = 0; lane < lanes; lane++)
    ambit_random_draw(random, done + lane, j->bound.nunknown, j->range, j->point + lane, lanes);
  ambit_batch_run(j->batch, lanes, j->point, j->point, NULL, j->rlo, j->rhi);
  for (size_t e = 0; e < j->q->nexpr; e++)
    for (size_t lane = 0; lane < lanes; lane++) {
      ambit_interval x = { j->rlo[e * lanes + lane], j->rhi[e * lanes + lane] };
      double v = ambit_interval_mid(x);
      if (ambit_interval_is_empty(x) || !ambit_interval_is_bounded(x)) continue;
      out[e] = ambit_interval_hull(out[e], (ambit_interval) { v, v });
      if (defined) defined[e]++;
    }
}

static void fill_report(const job *j, double start, double built, ambit_report *report) {
  if (!report) return;
  *report = (ambit_report) { .expressions = (uint32_t)j->q->nexpr, .unknowns = (uint32_t)j->bound.nunknown };
  snprintf(report->arithmetic, sizeof report->arithmetic, "%.31s", j->arithmetic);
  report->graph_nodes = ambit_graph_count(j->q->graph);
  report->tape_slots = j->tape->nslot;
  report->tape_constants = j->tape->nconst;
  report->tape_instructions = j->tape->ninstr;
  report->tape_runs = j->tape->nrun;
  report->seconds_build = built - start;
  report->seconds_run = ambit_context_seconds() - built;
}

ambit_status ambit_sample_expressions(const ambit_evaluate_request *q, size_t draws, uint64_t seed, ambit_interval *out,
    size_t *defined, ambit_report *report, ambit_failure *f) {
  if (draws == 0) return ambit_fail(f, AMBIT_INVALID, "sample needs at least one draw");
  job j = { .q = q, .arithmetic = q->arithmetic ? q->arithmetic : "real", .arena = ambit_arena_open() };
  if (!j.arena) return ambit_fail(f, AMBIT_NOMEM, "out of memory");
  double start = ambit_context_seconds();
  ambit_status status = prepare(&j, f);
  if (status == AMBIT_OK) {
    double built = ambit_context_seconds();
    ambit_random random = { seed };
    for (size_t e = 0; e < q->nexpr; e++) {
      out[e] = AMBIT_EMPTY;
      if (defined) defined[e] = 0;
    }
    for (size_t done = 0; done < draws; done += LANES)
      run_lanes(&j, done, draws - done < LANES ? draws - done : LANES, &random, out, defined);
    fill_report(&j, start, built, report);
  }
  ambit_batch_close(j.batch);
  ambit_context_close(&j.context);
  ambit_arena_close(j.arena);
  return status;
}
