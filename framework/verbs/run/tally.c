/* tally.c -- sums over leases, differences of clocks. */
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

static void add_lease(ambit_work *sum, const ambit_lease *lease) {
  ambit_work work = ambit_lease_work(lease);
  ambit_work_add(sum, &work);
}

static ambit_work add_leases(const ambit_lease *lease, size_t ncontext, const ambit_context *context) {
  ambit_work sum = { 0 };
  add_lease(&sum, lease);
  for (size_t i = 0; i < ncontext; i++) {
    add_lease(&sum, context[i].lease);
    ambit_work_add(&sum, &context[i].spent);
  }
  return sum;
}

void ambit_tally_run(ambit_tally *t, const ambit_lease *lease, size_t ncontext, const ambit_context *context) {
  t->before = add_leases(lease, ncontext, context).allocations;
}

void ambit_tally_ran(ambit_tally *t, const ambit_lease *lease, size_t ncontext, const ambit_context *context) {
  t->work.allocations_run += add_leases(lease, ncontext, context).allocations - t->before;
}

void ambit_tally_report(const ambit_tally *t, const ambit_arena *arena, const ambit_lease *lease, size_t ncontext,
    const ambit_context *context, ambit_report *report) {
  report->seconds_build = t->built;
  report->seconds_tape = t->tape;
  for (size_t i = 0; i < ncontext; i++) report->seconds_context += context[i].seconds;
  double graph = t->built - report->seconds_tape - report->seconds_context;
  report->seconds_graph = graph > 0 ? graph : 0;
  report->seconds_open = t->open;
  report->seconds_close = t->close;
  report->work = add_leases(lease, ncontext, context);
  ambit_work_add(&report->work, &t->work);
  report->work.allocations += ambit_arena_count(arena);
  report->work.allocated += ambit_arena_bytes(arena);
}
