/* problem.h -- from a system and its initial expressions to the tapes and hulls that a solver wants, and nothing
** else. */
#ifndef AMBIT_PROBLEM_H
#define AMBIT_PROBLEM_H
#include <ambit/registry.h>
#include <ambit/system.h>
#include <ambit/solver.h>

typedef struct ambit_problem_request {
  const ambit_system *system;
  const ambit_expr *initial; /* [nx] over unknowns */
  size_t ntime;
  const double *time;
  uint32_t want;              /* AMBIT_WANT_* */
  uint32_t seal;              /* AMBIT_SEAL_KEEP or 0 */
  const ambit_expr **unknown; /* unless NULL, is told the unknowns [nu], in the order of the problem; in the arena */
  size_t nnarrow;             /* unknowns that have a narrower range in this problem than their own, and that range */
  const ambit_expr *narrow;
  const ambit_interval *range;
  const ambit_expr *final;  /* as in ambit_simulate_request */
  ambit_registry *registry; /* for sampled systems */
} ambit_problem_request;

/* Fills everything but arithmetic and actx; all of it lives in the arena. Parameters are the unknowns that the
** right-hand sides, the implicit form and the invariants reach, as far as they are wanted; unknowns are those that
** initial values and parameters reach, each once. Nothing is built for invariants that are not wanted. INVALID: f names
** the state or invariant and what is wrong with it. */
ambit_status ambit_problem_build(
    const ambit_problem_request *q, ambit_arena *arena, ambit_problem *p, ambit_failure *f);
#endif
