/* roots.h -- the verb `roots`: every root of equations in a box, proved, and a plain Newton iteration to find one. */
#ifndef AMBIT_ROOTS_H
#define AMBIT_ROOTS_H
#include <ambit/graph.h>
#include <ambit/registry.h>
#include <ambit/report.h>
#include <ambit/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* f(x) = 0; unknowns are symbols, all other symbols have a binding (leaf := expression over uncertain data). */
typedef struct ambit_equations {
  ambit_graph *graph;
  size_t ne;
  const ambit_expr *equation;
  size_t nx;
  const ambit_expr *unknown;
  const char *const *name; /* [nx] */
  size_t nbinding;
  const ambit_expr *leaf, *value;
} ambit_equations;

typedef struct ambit_roots_request {
  const ambit_equations *equations; /* as many as unknowns or more */
  const ambit_interval *box;        /* [nx], may be unbounded */
  const double *centre; /* [nx] where nx independent equations are chosen if there are more, or NULL: the middle */
  /* 0; or the number of equations that are solved: those behind them hold at each root of these, or are off by more
  ** than an enclosure of it is wide; they only narrow and exclude */
  size_t leading;
  ambit_registry *registry;
  const char *solver;     /* "krawczyk" */
  const char *arithmetic; /* NULL: the solver's default */
  size_t nsolver_option, narithmetic_option;
  const ambit_option *solver_option, *arithmetic_option;
  ambit_sink *sink; /* sees every record of kind AMBIT_REC_ROOT as it is made */
} ambit_roots_request;

typedef struct ambit_roots_result {
  ambit_status status;       /* OK: every box is decided; UNABLE, STOPPED */
  char code[AMBIT_CODE_MAX]; /* "" if OK */
  char reason[AMBIT_MESSAGE_MAX];
  double cpu_seconds;
  uint32_t boxes, proved, partly, undecided; /* partly: for a part of the uncertain data's values */
  uint32_t further; /* equations beyond the unknowns that had to hold, and could not be proved to: all roots are then
                    ** undecided */
  uint32_t rigorous;
} ambit_roots_result;

/* Returns INVALID or NOMEM for requests that cannot start, else OK with the outcome in `result`. Equations that are 0 =
** 0 are left out. */
AMBIT_EXPORT ambit_status ambit_roots(
    const ambit_roots_request *q, ambit_roots_result *result, ambit_report *report, ambit_failure *f);

/* Levenberg's damped Gauss-Newton iteration from x [nx], at the middle of uncertain data; proves nothing. On return x
** is where it ended and residual [ne] what is left of each equation there. *converged: Newton's next step would be
** negligible. UNABLE: it left the domain of the equations at the start. */
AMBIT_EXPORT ambit_status ambit_roots_approach(
    const ambit_equations *q, double *x, double *residual, bool *converged, ambit_failure *f);

#ifdef __cplusplus
}
#endif
#endif
