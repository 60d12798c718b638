/* sample_system_draws.c -- the draws of a sample of a system: blocks on the threads of the pool, and those that the
** lanes lost once more one by one. Results of blocks are put together by hulls, so neither the order nor the number of
** threads matters.
*/
#include "verbs/sample/sample_job.h"
#include <stdlib.h>
#include <string.h>

/* -- what is seen of a draw */

static void see(void *user, uint32_t k, size_t lane, const double *x, size_t stride) {
  ambit_sample_drawer *d = user;
  const ambit_sample_job *j = d->job;
  size_t nx = j->problem->nx, at = j->instant[k] * nx;
  ambit_interval *hull = d->hull + k * nx;
  const double *point = d->block.point + lane;
  for (size_t i = 0; i < nx; i++) {
    double value = x[i * stride];
    hull[i] = ambit_interval_hull(hull[i], (ambit_interval) { value, value });
    if (j->instant[k] == j->ninstant) continue;
    if (d->value)
      d->value[(at + i) * d->count + d->column + lane] = value;
    else
      ambit_extremes_see(&d->extremes, at + i, value, d->first + lane, point, d->block.n);
  }
}

static int32_t tell_progress(void *user) {
  ambit_sample_job *j = user;
  pthread_mutex_lock(&j->lock);
  double done = (double)j->result->draws / (double)j->plan.draws;
  pthread_mutex_unlock(&j->lock);
  int32_t stop = ambit_sample_progress(j->plan.sink, done);
  if (stop) atomic_store(&j->stopping, true);
  return stop;
}

int32_t ambit_sample_pause(void *user) {
  ambit_sample_job *j = user;
  if (pthread_equal(pthread_self(), j->caller)) tell_progress(j);
  return atomic_load(&j->stopping);
}

static int32_t pause(void *user) {
  const ambit_sample_drawer *d = user;
  return ambit_sample_pause(d->job);
}

size_t ambit_sample_lanes_of_block(const ambit_sample_job *j) {
  return ambit_flow_is_one_by_one(j->flow) ? 1 : AMBIT_FLOW_LANES;
}

/* -- a block of draws */

void ambit_sample_begin_block(ambit_sample_drawer *d, size_t n, bool alone) {
  d->block.n = n;
  d->block.point = d->point;
  d->block.alone = alone;
  d->block.see = see;
  d->block.pause = pause;
  d->block.user = d;
}

/* [lock held] */
static ambit_status keep_lost(ambit_sample_job *j, const ambit_sample_drawer *d, size_t lane) {
  size_t nu = j->problem->nu;
  if (j->nlost == j->room_lost) {
    size_t most = j->room_lost ? 2 * j->room_lost : 64;
    ambit_sample_lost **grown = realloc(j->lost, most * sizeof *grown);
    if (!grown) return AMBIT_NOMEM;
    j->lost = grown, j->room_lost = most;
  }
  ambit_sample_lost *lost = malloc(sizeof *lost + nu * sizeof *lost->point);
  if (!lost) return AMBIT_NOMEM;
  lost->draw = d->first + lane;
  for (size_t i = 0; i < nu; i++) lost->point[i] = d->point[i * d->block.n + lane];
  j->lost[j->nlost++] = lost;
  return AMBIT_OK;
}

/* A draw of the lanes that is lost counts later; nobody is lost for good before it was tried one by one. */
static ambit_status count_block(ambit_sample_job *j, const ambit_sample_drawer *d, ambit_status status) {
  pthread_mutex_lock(&j->lock);
  if (status != AMBIT_OK) ambit_fail(&j->broken, status, "%s", d->block.reason);
  for (size_t lane = 0; lane < d->block.n && status == AMBIT_OK && !d->block.stopped; lane++) {
    ambit_fate fate = d->block.fate[lane];
    if (fate == AMBIT_FATE_LOST) status = keep_lost(j, d, lane);
    if (fate == AMBIT_FATE_LOST) continue;
    j->result->draws++;
    j->result->failed += fate != AMBIT_FATE_REACHED;
    j->result->off += fate == AMBIT_FATE_OFF;
    if (fate == AMBIT_FATE_REACHED || d->first + lane >= j->first_failed) continue;
    j->first_failed = d->first + lane;
    snprintf(j->result->reason, sizeof j->result->reason, "%s", d->block.reason);
  }
  pthread_mutex_unlock(&j->lock);
  return status;
}

static ambit_status make_block(void *user, uint32_t item, uint32_t worker) {
  (void)item; /* blocks are numbered by the points */
  ambit_sample_job *j = user;
  ambit_sample_drawer *d = &j->drawer[worker];
  size_t n;
  ambit_status status = ambit_sample_points_next(j->points, ambit_sample_lanes_of_block(j), d->point, &d->first, &n);
  if (status != AMBIT_OK || n == 0) return status;
  ambit_sample_begin_block(d, n, false);
  status = ambit_flow_make(j->flow, worker, &d->block);
  if (d->block.stiff) atomic_store(&j->stiff, true);
  return count_block(j, d, status);
}

static ambit_status make_lost(void *user, uint32_t item, uint32_t worker) {
  ambit_sample_job *j = user;
  ambit_sample_drawer *d = &j->drawer[worker];
  memcpy(d->point, j->lost[item]->point, j->problem->nu * sizeof *d->point);
  d->first = j->lost[item]->draw;
  ambit_sample_begin_block(d, 1, true);
  return count_block(j, d, ambit_flow_make(j->flow, worker, &d->block));
}

/* Items in runs of the pool, which counts them with 32 bits. */
ambit_status ambit_sample_run_pool(ambit_sample_job *j, size_t items, ambit_pool_job each) {
  if (items > UINT32_MAX) return AMBIT_INVALID;
  ambit_status status = ambit_pool_run(j->pool, (uint32_t)items, each, j, tell_progress);
  return status == AMBIT_OK && atomic_load(&j->stopping) ? AMBIT_STOPPED : status;
}

static ambit_status tell_broken(const ambit_sample_job *j, ambit_status status, ambit_failure *f) {
  if (status == AMBIT_OK || status == AMBIT_STOPPED) return status;
  if (status == AMBIT_NOMEM && !j->broken.message[0]) return ambit_no_memory(f);
  return ambit_fail(f, status, "%s", j->broken.message[0] ? j->broken.message : "sample: too many draws");
}

/* -- the passes */

/* The first block shows whether the lanes are for this system; if not, everything goes one by one from the start. */
static ambit_status try_first(ambit_sample_job *j, ambit_failure *f) {
  ambit_status status = make_block(j, 0, 0);
  if (status != AMBIT_OK || !atomic_load(&j->stiff)) return tell_broken(j, status, f);
  for (size_t i = 0; i < j->nlost; i++) free(j->lost[i]);
  j->nlost = 0;
  *j->result = (ambit_sample_result) { 0 };
  j->first_failed = SIZE_MAX;
  status = ambit_flow_use_draws(j->flow, true, true, f);
  if (status != AMBIT_OK) return status;
  ambit_sample_points_close(j->points);
  j->points = NULL;
  return ambit_sample_open_points(j->q->registry, &j->plan, j->problem->nu, ambit_flow_range(j->flow), &j->points, f);
}

static ambit_status draw_all(ambit_sample_job *j, ambit_failure *f) {
  ambit_status status = ambit_flow_is_one_by_one(j->flow) ? AMBIT_OK : try_first(j, f);
  size_t blocks = (j->plan.draws - 1) / ambit_sample_lanes_of_block(j) + 1;
  if (status == AMBIT_OK) status = tell_broken(j, ambit_sample_run_pool(j, blocks, make_block), f);
  return status;
}

static ambit_status draw_lost(ambit_sample_job *j, ambit_failure *f) {
  if (j->nlost == 0) return AMBIT_OK;
  ambit_failure own = { 0 };
  ambit_status status = ambit_flow_use_draws(j->flow, false, atomic_load(&j->stiff), &own);
  j->result->one_by_one = j->nlost;
  if (status == AMBIT_OK) return tell_broken(j, ambit_sample_run_pool(j, j->nlost, make_lost), f);
  j->result->draws += j->nlost;
  j->result->failed += j->nlost;
  if (!j->result->reason[0])
    snprintf(
        j->result->reason, sizeof j->result->reason, "the solution escapes or has no rate, and %.900s", own.message);
  return AMBIT_OK;
}

static void gather_extremes(ambit_sample_job *j) {
  for (uint32_t k = 1; k < j->plan.threads; k++) ambit_extremes_merge(&j->drawer[0].extremes, &j->drawer[k].extremes);
}

ambit_status ambit_sample_make_draws(ambit_sample_job *j, ambit_failure *f) {
  ambit_status status = draw_all(j, f);
  if (status == AMBIT_OK) status = draw_lost(j, f);
  gather_extremes(j);
  return status;
}
