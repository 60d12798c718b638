/* reduction.h -- the verb `reduce`, one pass of it: candidates, references and proofs are handed to a solver plugin,
** which chooses the candidates that are cut.
**
** What is accepted is checked here: the plugin may call a cut accepted only right after a full proof of exactly that
** cut with every error within its bound. A plugin without this discipline is BROKEN; it cannot spoil a certificate.
*/
#ifndef AMBIT_MODEL_REDUCTION_H
#define AMBIT_MODEL_REDUCTION_H
#include <ambit/graph.h>
#include <ambit/registry.h>
#include <ambit/report.h>
#include <ambit/solver.h>

/* A solution of the detailed model, in ordinary doubles. */
typedef struct ambit_reduction_reference {
  uint32_t scenario;
  size_t ntime;       /* >= 1 */
  const double *time; /* [ntime] s, strictly ascending */
  const double *x;    /* [ntime x nx] by rows */
  const double *data; /* [ntime x ndata] by rows */
} ambit_reduction_reference;

typedef struct ambit_reduction_request {
  ambit_graph *graph;
  size_t nx;
  const char *const *state; /* [nx] names */
  const ambit_expr *symbol; /* [nx] leaves that stand for them */
  const ambit_expr *rate;   /* [nx] of the model that the references solve */
  size_t ndata;
  const ambit_expr *data; /* [ndata] leaves that references give a value; an unknown that is not here counts as its
                          ** range's middle */
  size_t noutput;
  const char *const *output;
  const ambit_expr *output_expression;
  const double *bound; /* [noutput] */
  size_t ncandidate;
  const char *const *candidate;
  size_t neffect; /* changes of rates, see ambit_reduction.effect */
  const ambit_expr *effect;
  const uint32_t *effect_candidate, *effect_state;
  size_t nreference;
  const ambit_reduction_reference *reference;
  ambit_registry *registry;
  const char *solver; /* "reduction" */
  size_t nsolver_option;
  const ambit_option *solver_option;
  /* as in ambit_reduction; these may not raise or jump */
  ambit_status (*prove)(void *user, uint32_t how, const uint8_t *cut, double *error);
  void (*tried)(void *user, const ambit_try *t);
  void (*rank)(void *user, uint32_t ranking, const double *value); /* or NULL */
  void *user;
  ambit_sink *sink; /* progress() only; or NULL */
} ambit_reduction_request;

typedef struct ambit_reduction_result {
  ambit_status status; /* OK: every candidate was decided; STOPPED, UNABLE: `cut` is what was accepted until then */
  char code[AMBIT_CODE_MAX]; /* "" if OK */
  char reason[AMBIT_MESSAGE_MAX];
  double cpu_seconds, cpu_seconds_rank; /* in all; of these in the solver itself and for its tapes, not in callbacks */
  uint32_t proofs, lowered;             /* calls of prove: full and of lowered order */
} ambit_reduction_result;

/* cut [ncandidate] := 1 for each candidate that is accepted. Returns INVALID or NOMEM for requests that cannot start,
** else OK with the outcome in `result`; report may be NULL. */
ambit_status ambit_reduction_run(const ambit_reduction_request *q, uint8_t *cut, ambit_reduction_result *result,
    ambit_report *report, ambit_failure *f);

/* "residual", "one_step", "lowered_order", "exact", "adjoint": what the AMBIT_RANK_* are called */
const char *ambit_reduction_ranking_name(uint32_t ranking);
#endif
