/* sample_job.h -- a sample of a system while it is made: what its passes share. Inside of sample_system.c,
** sample_system_draws.c (the draws) and sample_system_search.c (the search from the extremes).
*/
#ifndef AMBIT_SAMPLE_JOB_H
#define AMBIT_SAMPLE_JOB_H
#include "host/pool.h"
#include "verbs/sample/sample_extremes.h"
#include "verbs/sample/sample_flow.h"
#include "verbs/sample/sample_inside.h"
#include <pthread.h>
#include <stdatomic.h>

struct ambit_sample_job;

/* What one thread needs. */
typedef struct ambit_sample_drawer {
  struct ambit_sample_job *job;
  ambit_flow_block block;
  double *point; /* [nu][AMBIT_FLOW_LANES] */
  size_t first;  /* draw of its lane 0 */
  double *value; /* of a search: [quantities][count], lane 0 at `column`; or NULL */
  size_t column, count;
  ambit_interval *hull; /* [ntime * nx] */
  ambit_extremes extremes;
} ambit_sample_drawer;

/* A draw that the lanes lost. */
typedef struct ambit_sample_lost {
  size_t draw;
  double point[];
} ambit_sample_lost;

typedef struct ambit_sample_job {
  const ambit_simulate_request *q;
  ambit_sample_plan plan; /* threads > 0 */
  ambit_arena *arena;
  ambit_flow *flow;
  const ambit_problem *problem;
  ambit_sample_points *points;
  ambit_pool *pool;
  uint32_t ninstant, *instant; /* followed ones; [ntime] number among them, or ninstant */
  ambit_sample_drawer *drawer; /* [threads] */
  const double *candidates;    /* of a search, [nu][count] */
  pthread_t caller;            /* the thread on which the sink is asked */
  atomic_bool stopping;
  atomic_bool stiff; /* a block was */
  pthread_mutex_t lock;
  /* guarded by the lock */
  ambit_sample_result *result;
  size_t first_failed;      /* of the draws, whose reason is told */
  ambit_sample_lost **lost; /* [nlost] */
  size_t nlost, room_lost;
  ambit_failure broken;
} ambit_sample_job;

/* -- sample_system_draws.c */

size_t ambit_sample_lanes_of_block(const ambit_sample_job *job);
/* The drawer's block: n points at its `point`, from which `see` goes into its hull and extremes, or its `value`. */
void ambit_sample_begin_block(ambit_sample_drawer *drawer, size_t n, bool alone);
/* Between steps, of a job: nonzero if the sink wants to stop, which the caller asks and others hear of. */
int32_t ambit_sample_pause(void *job);
/* Items on the threads of the pool; STOPPED if the sink said so. */
ambit_status ambit_sample_run_pool(ambit_sample_job *job, size_t items, ambit_pool_job each);
/* All draws, then those that the lanes lost once more one by one. The extremes of all drawers are then the first's. */
ambit_status ambit_sample_make_draws(ambit_sample_job *job, ambit_failure *f);

/* -- sample_system_search.c */

/* Follows the extremes uphill; STOPPED by the sink, NOMEM without a message. */
ambit_status ambit_sample_search(ambit_sample_job *job);
#endif
