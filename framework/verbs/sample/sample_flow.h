/* sample_flow.h -- points of the data of a system -> its states at the times of a request, in lanes or one by one.
**
** A start off a constraint (an invariant above 1e-6 there) is no start of the system: it is left out and counted.
*/
#ifndef AMBIT_SAMPLE_FLOW_H
#define AMBIT_SAMPLE_FLOW_H
#include <ambit/sample.h>
#include "verbs/sample/sample_draws.h"

#define AMBIT_FLOW_LANES 128u

typedef struct ambit_flow ambit_flow;

/* threads > 0: of the plan. Lanes unless the request names a solver. */
ambit_status ambit_flow_open(
    const ambit_simulate_request *q, const ambit_sample_plan *plan, ambit_flow **flow, ambit_failure *f);
void ambit_flow_close(ambit_flow *flow); /* NULL is allowed */
const ambit_problem *ambit_flow_problem(const ambit_flow *flow);
const ambit_interval *ambit_flow_range(const ambit_flow *flow); /* [nu] bounded */
bool ambit_flow_is_vague(const ambit_flow *flow); /* draws may be off what is allowed (ambit_sample_range) */
const char *ambit_flow_arithmetic(const ambit_flow *flow);
ambit_work ambit_flow_work(const ambit_flow *flow); /* counted until now; nobody works meanwhile */
uint32_t ambit_flow_threads(const ambit_flow *flow);

/* From now on blocks that want `alone` go one by one through "gsl", all blocks if `all`; stiff: by its method msbdf, if
** the system has a Jacobian. */
ambit_status ambit_flow_use_draws(ambit_flow *flow, bool all, bool stiff, ambit_failure *f);
bool ambit_flow_is_one_by_one(const ambit_flow *flow);
bool ambit_flow_has_draws(const ambit_flow *flow); /* can blocks go `alone`? */
/* From now on with tolerances that are so much tighter, and no fewer steps; false: not possible. */
bool ambit_flow_tighten(ambit_flow *flow, double by, double steps);

typedef enum ambit_fate {
  AMBIT_FATE_REACHED,
  AMBIT_FATE_LOST,   /* by the lanes: one by one it may do better */
  AMBIT_FATE_FAILED, /* one by one too: it has a reason */
  AMBIT_FATE_OFF     /* it starts off a constraint */
} ambit_fate;

typedef struct ambit_flow_block {
  size_t n;            /* at most AMBIT_FLOW_LANES */
  const double *point; /* [nu][n] */
  bool alone;          /* one by one, if that was prepared */
  /* state i of lane `lane` at time[k]: x[i * stride] */
  void (*see)(void *user, uint32_t k, size_t lane, const double *x, size_t stride);
  int32_t (*pause)(void *user); /* nonzero: stop; or NULL */
  void *user;
  ambit_fate fate[AMBIT_FLOW_LANES]; /* out, [n] */
  bool stiff, stopped;               /* out: the lanes gave up; `pause` said so */
  char reason[512];                  /* out: of the first lane that failed or is off, or "" */
} ambit_flow_block;

/* [worker's thread] Other than OK: not even a start was possible; reason says why. */
ambit_status ambit_flow_make(ambit_flow *flow, uint32_t worker, ambit_flow_block *block);
#endif
