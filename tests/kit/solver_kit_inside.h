/* solver_kit_inside.h -- what the files of the solver kit share. */
#ifndef AMBIT_SOLVER_KIT_INSIDE_H
#define AMBIT_SOLVER_KIT_INSIDE_H
#include "kit/solver_kit.h"
#include "kit/solver_kit_problems.h"

typedef struct state {
  const solver_kit *kit;
  const kit_problem *p;
  const double *option;
  ambit_problem problem;
  uint32_t datum[KIT_DATA]; /* the kit's datum of each unknown of the problem */
  size_t findings;
  solver_kit_counts *counts;
} state;

typedef struct watcher {
  ambit_sink sink; /* first */
  state *s;
  uint32_t records, stop_after, stop_progress_after; /* 0: never */
  uint32_t calls;                                    /* of progress */
  size_t next;                                       /* time[] ahead */
  double t, done;
  bool stopped;
  size_t first_count, last_count; /* allocations at the first and the last record */
  double lo[KIT_STATES], hi[KIT_STATES];
  uint64_t digest;
} watcher;

void kit_find_solver(state *s, const char *format, ...) AMBIT_PRINTF(2, 3);
bool kit_is_rigorous(const state *s);
int32_t kit_emit(ambit_sink *sink, const ambit_record *r);
int32_t kit_progress(ambit_sink *sink, double done, const char *message);
#endif
