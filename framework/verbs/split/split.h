/* split.h -- one run made of many: the box of the uncertain data is cut into pieces, each is integrated by itself on a
** thread of a pool, and one stream of records leaves.
**
** Why it holds: every choice of the data lies in some piece (pieces.h), whose solver encloses its solution; the hull
** over all pieces then encloses it too. The union is taken at the instants of the problem, where every piece ends a
** step: one record for each interval between them, with the hull of the ends and the hull of all tubes in it.
** Results do not depend on the number of threads or on who is done first: a hull is the same in every order, each
** piece computes by itself, and if some cannot go on, the one that counts is the one with the fewest completed
** intervals (of those the first by number). The others are told to stop where they can no longer be it.
** Memory: solvers and contexts for as many pieces as there are threads, and four numbers per state and interval.
*/
#ifndef AMBIT_SPLIT_H
#define AMBIT_SPLIT_H
#include "verbs/run/context.h"
#include "verbs/split/pieces.h"
#include <ambit/cut.h>

typedef struct ambit_split {
  const ambit_problem *problem; /* of the whole box */
  const ambit_tape *initial;    /* x(t0) [nx], p [np] over the unknowns */
  const ambit_pieces *pieces;
  const char *const *unknown; /* [nu] names, for messages; an entry may be NULL */
  ambit_registry *registry;
  const ambit_solver *solver;
  const char *solver_name;
  const double *option;
  uint32_t ncontext;          /* threads */
  ambit_context *context;     /* [ncontext]; renewed for each piece, whatever it keeps (noise symbols) */
  ambit_sink *sink;           /* its functions are called on the caller's thread, in the order of time */
  const ambit_cut_band *band; /* or NULL; else of the intervals of the problem, and pieces is one */
} ambit_split;

typedef struct ambit_split_outcome {
  ambit_status said; /* OK, or what the piece that got least far said */
  uint32_t threads;  /* that worked: fewer than asked for where the system refuses them */
  uint32_t pieces;
  ambit_work work;   /* of the scopes of all pieces */
  ambit_failure why; /* which piece, its data, its own reason */
} ambit_split_outcome;

/* INVALID, NOMEM or BROKEN if a piece could not be opened; otherwise OK and the outcome. */
ambit_status ambit_split_run(const ambit_split *s, ambit_arena *arena, ambit_split_outcome *out, ambit_failure *f);
#endif
