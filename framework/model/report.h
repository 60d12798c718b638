/* report.h -- what a verb loaded, built and left out, in numbers; collected always, printed by `ambit explain`. */
#ifndef AMBIT_REPORT_H
#define AMBIT_REPORT_H
#include <stddef.h>
#include <stdint.h>

typedef struct ambit_report {
  char arithmetic[32], solver[32];
  uint32_t expressions; /* asked for */
  uint32_t graph_nodes; /* in the whole graph */
  uint32_t tape_slots, tape_constants, tape_instructions, tape_runs;
  uint32_t states, parameters, unknowns; /* uncertain data that are variables */
  uint32_t constant_slots;               /* degree 0: one Taylor coefficient instead of all */
  uint32_t steps;
  double seconds_build, seconds_run; /* CPU */
} ambit_report;
#endif
