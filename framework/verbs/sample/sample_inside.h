/* sample_inside.h -- what sampling expressions and sampling systems share. */
#ifndef AMBIT_SAMPLE_INSIDE_H
#define AMBIT_SAMPLE_INSIDE_H
#include <ambit/sample.h>
#include "graph/name.h"
#include "verbs/sample/sample_points.h"
#include <stdio.h>
#include <time.h>

#define AMBIT_SAMPLE_FEWEST 10 /* draws, from which on extremes are followed uphill */

/* A datum that can be drawn has a range with ends. */
static inline ambit_status ambit_sample_check_range(const ambit_graph *g, ambit_expr datum, ambit_failure *f) {
  ambit_interval x = ambit_graph_node(g, datum)->value;
  if (ambit_interval_is_bounded(x) && !ambit_interval_is_empty(x)) return AMBIT_OK;
  char name[AMBIT_DATUM_NAME_MAX];
  ambit_graph_leaf_name(g, datum, name);
  return ambit_fail(f, AMBIT_INVALID, "cannot draw `%s` from [%g, %g]: its range is not bounded", name, x.lo, x.hi);
}

/* Draws are made from what the tolerances surely allow. Where no value is known to be allowed, draws have one of the
** middle, which may not be allowed: the result is then off by what the whole of the range can change. */
static inline ambit_interval ambit_sample_range(const ambit_node *datum) {
  if (!ambit_interval_is_empty(datum->inner)) return datum->inner;
  double middle = ambit_interval_mid(datum->value);
  return (ambit_interval) { middle, middle };
}

static inline ambit_status ambit_sample_open_points(ambit_registry *registry, const ambit_sample_plan *plan, size_t n,
    const ambit_interval *range, ambit_sample_points **points, ambit_failure *f) {
  const ambit_sample_points_request q = { plan->draws, plan->seed, plan->points, plan->no_corners, n, range };
  return ambit_sample_points_open(registry, &q, points, f);
}

static inline void ambit_sample_tell_points(const ambit_sample_points *points, ambit_sample_result *result) {
  snprintf(result->points, sizeof result->points, "%s", ambit_sample_points_name(points));
  snprintf(result->why, sizeof result->why, "%s", ambit_sample_points_why(points));
}

static inline int32_t ambit_sample_progress(ambit_sink *sink, double done) {
  return sink && sink->progress ? sink->progress(sink, done, "sampling") : 0;
}

static inline double ambit_sample_wall(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
#endif
