/* receiver.h -- where a solver's records go while a verb runs: into the track that Lua reads afterwards, and to the
** JSON lines of `ambit run --json`; with progress and Ctrl-C.
*/
#ifndef AMBIT_LUA_RECEIVER_H
#define AMBIT_LUA_RECEIVER_H
#include "script/interrupt.h"
#include "script/progress.h"
#include "script/track.h"

/* Is a run so slow that its end is out of reach? Looked at when it has taken `patience`, twice that, and so on: the
** time that it covered since half of that says how long the rest will take, and that before how much faster it gets.
** `due` is the CPU time that it may take without question: then it has twice that if it goes on steadily, as fast as
** before, and if the rest takes at most `reach` times what it has taken, and so on. */
typedef struct ambit_pace {
  double patience;             /* s of CPU time; 0: never */
  double first, last;          /* of the run's own time */
  double began, look, t;       /* CPU time: when it began, when it is looked at next; the time reached by then */
  double t_half;               /* the time that was reached at half of that, */
  double t_quarter;            /* and at a quarter */
  double due, reach, t_middle; /* s of CPU time, 0: never; the time that was reached at half of that */
  bool has_moved, has_half, has_quarter, has_middle, is_hopeless, is_overdue;
} ambit_pace;

typedef struct ambit_receiver {
  ambit_sink sink;    /* first: what the solver sees */
  ambit_track *track; /* NULL: records are not kept */
  ambit_graph *graph; /* of the unknowns of sets that the track keeps */
  ambit_records *records;
  const char *const *name; /* [nx] */
  ambit_progress progress;
  ambit_interrupt interrupt;
  double deadline; /* s of CPU time of this process; 0: none */
  ambit_pace pace;
  ambit_failure failure; /* why the receiver stopped the run: memory, a full disk */
} ambit_receiver;

/* A receiver of records of nx values with these names; pushes its track, which keeps AMBIT_TRACK_*. */
ambit_receiver ambit_receiver_push(lua_State *L, size_t nx, const char *const *name, uint32_t keep);
/* For ambit_simulate_request.prepared, `user` being the receiver. */
void ambit_receiver_prepared(void *user, size_t nu, const ambit_expr *unknown);
/* One that only draws progress. */
ambit_receiver ambit_receiver_silent(void);
/* Around the run: progress, interrupt and deadline. Nothing between them may raise. */
void ambit_receiver_begin(lua_State *L, ambit_receiver *r);
void ambit_receiver_end(ambit_receiver *r);
/* The fields status ("complete", "impossible", "unable", "stopped" or "broken"), code and reason of the table on top of
** the stack; they are the receiver's own if it stopped the run. */
void ambit_receiver_tell(
    lua_State *L, const ambit_receiver *r, ambit_status status, const char *code, const char *reason);
#endif
