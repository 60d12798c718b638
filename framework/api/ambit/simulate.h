/* simulate.h -- the verb `simulate`: from a system and its uncertain initial state to a stream of records. */
#ifndef AMBIT_SIMULATE_H
#define AMBIT_SIMULATE_H
#include <ambit/cut.h>
#include <ambit/registry.h>
#include <ambit/report.h>
#include <ambit/system.h>
#include <ambit/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_simulate_request {
  const ambit_system *system;
  ambit_registry *registry;
  const char *solver;     /* "lohner" */
  const char *arithmetic; /* NULL: the solver's default */
  size_t nsolver_option, narithmetic_option;
  const ambit_option *solver_option, *arithmetic_option;
  const ambit_expr *initial; /* [nx] over unknowns; every state */
  size_t ntime;              /* >= 2 */
  const double *time;
  uint32_t threads;           /* at most; 0: as many as the machine has for this process */
  size_t ncut;                /* uncertain data to cut, or names of others */
  const ambit_cut *cut;       /* without cuts and `pieces` the run is one */
  uint32_t pieces;            /* at most so many by choice of the data to cut; 0: only those of `cut` */
  const ambit_cut_band *band; /* or NULL: cuts where the sets reach beyond it, and no others but for their names */
  uint32_t extras;            /* AMBIT_EXTRA_*: what the sink asks for besides */
  /* or NULL: is told, before the first record, the unknowns that sets (ambit_set) are functions of */
  void (*prepared)(void *user, size_t nu, const ambit_expr *unknown);
  void *prepared_user;
  size_t nnarrow; /* unknowns that have a narrower range in this run than their own, and that range */
  const ambit_expr *narrow;
  const ambit_interval *range;
  /* of a sampled system: its true end, a constant expression not behind the last of `time`: no sample is taken then or
  ** later; NULL: that double */
  const ambit_expr *final;
  ambit_sink *sink; /* sees every record as it is made */
} ambit_simulate_request;

typedef struct ambit_simulate_result {
  ambit_status status;            /* OK = complete, UNABLE, STOPPED, DOMAIN */
  char code[AMBIT_CODE_MAX];      /* "" if complete */
  char reason[AMBIT_MESSAGE_MAX]; /* "" if complete; else why, and which knob to turn */
  double t_reached;
  double cpu_seconds; /* of the integration itself, over all threads */
  double wall_seconds;
  uint32_t steps, threads, pieces;
  uint32_t rigorous;
} ambit_simulate_result;

/* Returns INVALID or NOMEM for requests that cannot start (f explains: pairs that do not fit are refused by name with
** the list of what fits), otherwise OK with the outcome in `result`. Builds only what the solver wants. */
AMBIT_EXPORT ambit_status ambit_simulate(
    const ambit_simulate_request *q, ambit_simulate_result *result, ambit_report *report, ambit_failure *f);

#ifdef __cplusplus
}
#endif
#endif
