/* sample_system_search.c -- the search from the extremes of a sample of a system: candidates as blocks on its
** threads. */
#include "verbs/sample/sample_job.h"
#include "verbs/sample/sample_polish.h"
#include <math.h>
#include <string.h>

#define FINEST 0x1p-10 /* part of a range, at which the search ends */

static ambit_status make_candidates(void *user, uint32_t item, uint32_t worker) {
  ambit_sample_job *j = user;
  ambit_sample_drawer *d = &j->drawer[worker];
  size_t most = ambit_sample_lanes_of_block(j), first = item * most;
  size_t n = d->count - first < most ? d->count - first : most;
  for (size_t i = 0; i < j->problem->nu; i++)
    memcpy(d->point + i * n, j->candidates + i * d->count + first, n * sizeof *d->point);
  d->column = first;
  ambit_sample_begin_block(d, n, false);
  ambit_status status = ambit_flow_make(j->flow, worker, &d->block);
  return status == AMBIT_OK && d->block.stopped ? AMBIT_STOPPED : status;
}

static ambit_status evaluate(void *user, size_t count, const double *point, double *value) {
  ambit_sample_job *j = user;
  for (size_t i = 0; i < (size_t)j->ninstant * j->problem->nx * count; i++) value[i] = NAN;
  j->candidates = point;
  for (uint32_t k = 0; k < j->plan.threads; k++) j->drawer[k].value = value, j->drawer[k].count = count;
  ambit_status status = ambit_sample_run_pool(j, (count - 1) / ambit_sample_lanes_of_block(j) + 1, make_candidates);
  for (uint32_t k = 0; k < j->plan.threads; k++) j->drawer[k].value = NULL;
  return status;
}

ambit_status ambit_sample_search(ambit_sample_job *j) {
  if (!j->plan.polish || j->plan.draws < AMBIT_SAMPLE_FEWEST) return AMBIT_OK;
  const ambit_polish q = { .range = ambit_flow_range(j->flow),
    .extremes = &j->drawer[0].extremes,
    .budget = j->plan.draws,
    .finest = FINEST,
    .first = j->plan.draws,
    .evaluate = evaluate,
    .user = j };
  ambit_status status = ambit_polish_run(&q, j->arena, &j->result->polished);
  return status == AMBIT_NOMEM || status == AMBIT_STOPPED ? status : AMBIT_OK;
}
