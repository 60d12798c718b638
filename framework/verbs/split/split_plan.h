/* split_plan.h -- which data a split cuts, and into how many parts. */
#ifndef AMBIT_SPLIT_PLAN_H
#define AMBIT_SPLIT_PLAN_H
#include <ambit/cut.h>
#include <ambit/graph.h>
#include "verbs/split/pieces.h"
#include <ambit/solver.h>

typedef struct ambit_split_plan {
  ambit_pieces pieces;
  const char *const *name; /* [nu] or NULL each */
} ambit_split_plan;

/* Cuts as asked and, with total > 0, the others by their influence on the solution (probe.h), so that there are at most
** `total` pieces. INVALID: an unknown that the problem does not depend on, more than one request for an unknown. */
ambit_status ambit_split_plan_make(const ambit_problem *p, const ambit_tape *initial, const ambit_expr *unknown,
    size_t ncut, const ambit_cut *cut, uint32_t total, ambit_arena *arena, ambit_split_plan *plan, ambit_failure *f);

/* The instants of a run whose pieces are to be merged: the given ones, or, if only a start and an end are given, these
** and equal intervals between them, so that the tubes say something. n is changed; NULL: out of memory. */
const double *ambit_split_plan_instants(ambit_arena *arena, const double *time, size_t *n);
/* A band for the given instants as one for those of the run, `now` in number; NULL: out of memory. */
const ambit_cut_band *ambit_split_plan_band(
    ambit_arena *arena, const ambit_cut_band *band, uint32_t nx, size_t given, size_t now);
#endif
