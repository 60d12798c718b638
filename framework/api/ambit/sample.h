/* sample.h -- the verb `sample`: draws from the tolerances in ordinary floating point, and the hull of what they give.
**
** It proves nothing, but says how far its values can be off: the hull made smaller by `error` on each side is one of
** values that true solutions take, so what a proved enclosure must contain. Points: sample_points.h. With `polish` the
** extremes that were drawn are followed uphill (sample_polish.h), from ten draws on. The same seed gives the same
** result, however many threads there are.
*/
#ifndef AMBIT_SAMPLE_H
#define AMBIT_SAMPLE_H
#include <ambit/evaluate.h>
#include <ambit/simulate.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_sample_plan {
  size_t draws;
  uint64_t seed;
  const char *points; /* as ambit_sample_points_request */
  bool no_corners, polish;
  uint32_t threads;          /* at most; 0: as verbs/run/processors.h says */
  double relative, absolute; /* systems in lanes: local error allowed; 0, 0: 1e-10, 1e-12 */
  ambit_sink *sink;          /* sees progress(), or NULL */
} ambit_sample_plan;

typedef struct ambit_sample_result {
  ambit_status status;       /* OK, or STOPPED by the sink: what was drawn until then counts */
  size_t draws, failed;      /* made; of these did not reach the end (their hulls count up to there) */
  size_t polished;           /* evaluations of the search besides */
  size_t off;                /* systems: of `failed` those that start off a constraint */
  size_t one_by_one;         /* systems: draws that the solver made, lanes being too stiff or at an end for them */
  char reason[1024];         /* of the first that failed, or "" */
  char points[24], why[256]; /* the sequence; why it is "random" */
  char method[64];           /* systems: how they were integrated */
  uint32_t threads;
  double cpu_seconds, wall_seconds;
} ambit_sample_result;

/* Expressions, in the arithmetic of the request (NULL: "real"). hull [nexpr]: of the finite values, empty if there was
** none; error [nexpr]: how far its ends are off the true values there, proved (0 if it is empty, inf if unknown);
** defined [nexpr]: how many draws gave a value. error, defined, report may be NULL. */
AMBIT_EXPORT ambit_status ambit_sample_expressions(const ambit_evaluate_request *q, const ambit_sample_plan *plan,
    ambit_interval *hull, double *error, size_t *defined, ambit_sample_result *result, ambit_report *report,
    ambit_failure *f);

/* A system. Without a solver in the request, draws are integrated side by side (sample_lanes.h), those for which that
** fails one by one by "gsl", stiff systems all of them by its method msbdf; with a solver, one by one by that. The
** request's sink, threads, cuts and extras are not looked at. hull [ntime * nx]: of state i at time[k] at k * nx + i,
** empty if no draw reached it; error [ntime * nx] (or NULL): ten times what a hundredth of the tolerances changes in
** the extreme draws, an estimate; NaN where that is not known. */
AMBIT_EXPORT ambit_status ambit_sample_system(const ambit_simulate_request *q, const ambit_sample_plan *plan,
    ambit_interval *hull, double *error, ambit_sample_result *result, ambit_report *report, ambit_failure *f);

#ifdef __cplusplus
}
#endif
#endif
