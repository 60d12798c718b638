/* tally.c -- sums over scopes, differences of clocks. */
#include "verbs/run/tally.h"

ambit_tally ambit_tally_begin(const ambit_graph *g) {
  ambit_meter_enter(AMBIT_FRAME_STAGE, "graph");
  return (ambit_tally) { .graph = g, .start = ambit_context_seconds(), .sealing = ambit_graph_sealing_seconds(g) };
}

void ambit_tally_built(ambit_tally *t) {
  ambit_meter_leave();
  t->built = ambit_context_seconds() - t->start;
  t->tape = ambit_graph_sealing_seconds(t->graph) - t->sealing;
}

static void add_scope(ambit_work *sum, const ambit_scope *scope) {
  ambit_work work = ambit_scope_work(scope);
  ambit_work_add(sum, &work);
}

static ambit_work add_scopes(const ambit_scope *scope, size_t ncontext, const ambit_context *context) {
  ambit_work sum = { 0 };
  add_scope(&sum, scope);
  for (size_t i = 0; i < ncontext; i++) {
    add_scope(&sum, context[i].scope);
    ambit_work_add(&sum, &context[i].spent);
  }
  return sum;
}

void ambit_tally_run(ambit_tally *t, const ambit_scope *scope, size_t ncontext, const ambit_context *context) {
  t->before = add_scopes(scope, ncontext, context).allocations;
}

void ambit_tally_ran(ambit_tally *t, const ambit_scope *scope, size_t ncontext, const ambit_context *context) {
  t->work.allocations_run += add_scopes(scope, ncontext, context).allocations - t->before;
}

void ambit_tally_report(const ambit_tally *t, const ambit_arena *arena, const ambit_scope *scope, size_t ncontext,
    const ambit_context *context, ambit_report *report) {
  report->seconds_build = t->built;
  report->seconds_tape = t->tape;
  for (size_t i = 0; i < ncontext; i++) report->seconds_context += context[i].seconds;
  double graph = t->built - report->seconds_tape - report->seconds_context;
  report->seconds_graph = graph > 0 ? graph : 0;
  report->seconds_open = t->open;
  report->seconds_close = t->close;
  report->work = add_scopes(scope, ncontext, context);
  ambit_work_add(&report->work, &t->work);
  report->work.allocations += ambit_arena_count(arena);
  report->work.allocated += ambit_arena_bytes(arena);
}
