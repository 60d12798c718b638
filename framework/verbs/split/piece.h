/* piece.h -- the run of one piece of a split. */
#ifndef AMBIT_PIECE_H
#define AMBIT_PIECE_H
#include "verbs/run/guard.h"
#include "verbs/split/merge.h"
#include "verbs/split/split.h"
#include <ambit/interval.h>

/* What one thread needs to run pieces, one after another. */
typedef struct ambit_piece {
  ambit_sink sink; /* first: behind the guard of the piece's solver */
  const ambit_split *split;
  ambit_context *context;
  ambit_merge *merge;
  uint32_t number, completed; /* intervals */
  bool over, skipped, spent;  /* told to stop; a step went over an instant; told to stop for its work */
  const ambit_scope *scope;   /* of the run that is on */
  uint64_t done;              /* operations of the last run */
  double allowed;             /* after so many it is told to stop; 0: any number */
  int32_t (*look)(void *user);
  void *user;
  ambit_problem problem;             /* its hulls are the arrays below */
  double *u_lo, *u_hi, *x_lo, *x_hi; /* [nu], [nx + np] */
  ambit_interval *u, *slot;
  ambit_merge_part part; /* of the interval that is being done */
  ambit_work work;       /* of the scopes of all pieces so far */
} ambit_piece;

ambit_status ambit_piece_prepare(ambit_piece *p, const ambit_split *s, ambit_context *context, ambit_arena *arena);

/* Runs piece `number` into the merge; look is called with each step, nonzero: stop. Not OK: the solver could not even
** be opened, for reasons that are no result (the merge has been told). */
ambit_status ambit_piece_run(
    ambit_piece *p, const ambit_split *s, ambit_merge *merge, uint32_t number, int32_t (*look)(void *user), void *user);
#endif
