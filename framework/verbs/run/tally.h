/* tally.h -- what a verb spent, by stage, and the work that was counted on its scopes: from these its report.
**
** Stages: `graph` (values put in, derivatives), `tape` (sealing), `context` (arithmetics), `open`, `run`, `close` (the
** solver). Seconds are CPU time of the process; work is counted (ambit/work.h).
*/
#ifndef AMBIT_TALLY_H
#define AMBIT_TALLY_H
#include "base/meter.h"
#include <ambit/graph.h>
#include "verbs/run/context.h"
#include <ambit/report.h>

typedef struct ambit_tally {
  const ambit_graph *graph;
  double start, sealing; /* s; what sealing had taken until then */
  double built, tape, open, close;
  ambit_work work; /* of scopes that are closed, and of what has no scope */
  uint64_t before; /* allocations when the run began */
} ambit_tally;

/* A stage of a profile, and whose work it is: the name of a solver or an arithmetic. */
static inline void ambit_stage_enter(const char *stage, uint32_t kind, const char *name) {
  ambit_meter_enter(AMBIT_FRAME_STAGE, stage);
  ambit_meter_enter(kind, name);
}
static inline void ambit_stage_leave(void) {
  ambit_meter_leave();
  ambit_meter_leave();
}

ambit_tally ambit_tally_begin(const ambit_graph *g);
void ambit_tally_built(ambit_tally *t); /* the build is over; also if it failed */
/* Around the run itself: allocations between the two are those of the run. */
void ambit_tally_run(ambit_tally *t, const ambit_scope *scope, size_t ncontext, const ambit_context *context);
void ambit_tally_ran(ambit_tally *t, const ambit_scope *scope, size_t ncontext, const ambit_context *context);
/* Stages and work into the report; arena: the verb's own. Leases that are open are read, not closed. */
void ambit_tally_report(const ambit_tally *t, const ambit_arena *arena, const ambit_scope *scope, size_t ncontext,
    const ambit_context *context, ambit_report *report);
#endif
