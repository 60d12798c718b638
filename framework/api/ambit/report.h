/* report.h -- what a verb loaded, built and left out, in numbers; collected always, printed by `ambit explain`. */
#ifndef AMBIT_REPORT_H
#define AMBIT_REPORT_H
#include <ambit/tape.h>
#include <ambit/work.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_report {
  char arithmetic[32], solver[32];
  uint32_t expressions; /* asked for */
  uint64_t graph_nodes; /* made so far in the whole graph */
  uint32_t tape_slots, tape_constants, tape_instructions, tape_runs;
  uint32_t states, parameters, unknowns; /* uncertain data that are variables */
  uint32_t constant_slots;               /* degree 0: one Taylor coefficient instead of all */
  uint32_t steps;
  double seconds_build, seconds_run; /* CPU */
  /* parts of seconds_build: values and derivatives in the graph, sealing of tapes, opening of contexts; then the
  ** solver's own opening and closing, which are in neither */
  double seconds_graph, seconds_tape, seconds_context, seconds_open, seconds_close;
  ambit_work work; /* counted, not measured: the same on every machine */
} ambit_report;

/* Adds what a tape holds; NULL: nothing. */
static inline void ambit_report_count(ambit_report *report, const ambit_tape *t) {
  if (!t) return;
  report->tape_slots += t->nslot;
  report->tape_constants += t->nconst;
  report->tape_instructions += t->ninstr;
  report->tape_runs += t->nrun;
  for (uint32_t i = 0; i < t->nslot; i++) report->constant_slots += t->degree[i] == 0;
}

#ifdef __cplusplus
}
#endif
#endif
