/* sample_error.c -- the same draws with two tolerances, in lanes and one by one. */
#include "verbs/sample/sample_error.h"
#include "num/interval.h"
#include <math.h>

#define TIGHTER 0.01      /* tolerances of the second run */
#define FEWEST_STEPS 128  /* of it */
#define CAUTION 10        /* times what it shows */
#define MOST_KEPT 4000000 /* numbers of the first run */

typedef struct keeping {
  const ambit_sample_error *q;
  const ambit_problem *problem;
  ambit_flow_block block;
  size_t n;
  bool again;    /* the second time, with tighter tolerances */
  double *x;     /* [ntime][nx][n] that came first; NaN: not reached */
  double *apart; /* [ntime * nx] the largest difference of others from them, NaN: none was found */
} keeping;

static void keep(void *user, uint32_t k, size_t lane, const double *x, size_t stride) {
  const keeping *kept = user;
  for (size_t i = 0; i < kept->problem->nx; i++) {
    size_t at = k * (size_t)kept->problem->nx + i;
    double *place = &kept->x[at * kept->n + lane];
    if (isnan(*place) && !kept->again)
      *place = x[i * stride];
    else if (!isnan(*place))
      kept->apart[at] = fmax(kept->apart[at], fabs(x[i * stride] - *place)); /* fmax leaves NaN out */
  }
}

static size_t count_witnesses(const ambit_sample_error *q) {
  const ambit_problem *p = ambit_flow_problem(q->flow);
  size_t most = ambit_flow_is_one_by_one(q->flow) ? q->draws / 10 + 1 : q->draws;
  size_t kept = MOST_KEPT / ((size_t)p->ntime * p->nx) + 1;
  most = most < kept ? most : kept;
  return most < AMBIT_FLOW_LANES ? most : AMBIT_FLOW_LANES;
}

static bool is_among(const ambit_extreme *x, size_t n, const ambit_extreme *const *row) {
  for (size_t k = 1; k < n; k++)
    if (row[k]->draw == x->draw) return true;
  return false;
}

/* The midpoint and the extremes, as many as there is room for: their points, [nu][n]; returns n. */
static size_t choose_witnesses(const ambit_sample_error *q, double *point) {
  const ambit_problem *p = ambit_flow_problem(q->flow);
  const ambit_extreme *row[AMBIT_FLOW_LANES] = { NULL };
  size_t n = 1, most = count_witnesses(q);
  for (size_t i = q->extremes->m * AMBIT_SIDES; i-- > 0 && n < most;) {
    const ambit_extreme *x = &q->extremes->at[i];
    if (x->seen && !is_among(x, n, row)) row[n++] = x;
  }
  for (size_t i = 0; i < p->nu; i++) {
    point[i * n] = ambit_interval_mid(ambit_flow_range(q->flow)[i]);
    for (size_t k = 1; k < n; k++) point[i * n + k] = row[k]->point[i];
  }
  return n;
}

static int32_t pause(void *user) {
  const keeping *kept = user;
  return kept->q->pause(kept->q->user);
}

/* All the way, or not. */
static bool make(const ambit_sample_error *q, keeping *kept, bool alone) {
  kept->block.alone = alone;
  return ambit_flow_make(q->flow, 0, &kept->block) == AMBIT_OK && !kept->block.stopped;
}

static bool run(const ambit_sample_error *q, keeping *kept, const double *point) {
  kept->block.n = kept->n;
  kept->block.point = point;
  kept->block.see = keep;
  kept->block.pause = pause;
  kept->block.user = kept;
  bool good = make(q, kept, false);
  if (ambit_flow_is_one_by_one(q->flow) || !ambit_flow_has_draws(q->flow)) return good;
  return good && make(q, kept, true);
}

ambit_status ambit_sample_estimate_error(const ambit_sample_error *q, ambit_arena *arena, double *error) {
  const ambit_problem *p = ambit_flow_problem(q->flow);
  size_t values = (size_t)p->ntime * p->nx;
  double *point = ambit_arena_alloc(arena, ((size_t)p->nu * AMBIT_FLOW_LANES + 1) * sizeof *point);
  keeping *kept = ambit_arena_alloc(arena, sizeof *kept);
  if (!point || !kept) return AMBIT_NOMEM;
  kept->q = q, kept->problem = p;
  kept->n = choose_witnesses(q, point);
  kept->x = ambit_arena_alloc(arena, values * kept->n * sizeof *kept->x);
  if (!kept->x) return AMBIT_NOMEM;
  for (size_t i = 0; i < values; i++) error[i] = NAN;
  for (size_t i = 0; i < values * kept->n; i++) kept->x[i] = NAN;
  kept->apart = error;
  bool done = run(q, kept, point) && ambit_flow_tighten(q->flow, TIGHTER, FEWEST_STEPS);
  kept->again = true;
  done = done && run(q, kept, point);
  for (size_t i = 0; i < values; i++) {
    double rounding = ambit_interval_is_empty(q->hull[i]) ? 0 : 0x1p-50 * ambit_interval_mag(q->hull[i]);
    error[i] = done ? CAUTION * error[i] + rounding : NAN;
  }
  return kept->block.stopped ? AMBIT_STOPPED : AMBIT_OK;
}

ambit_interval ambit_sample_sure(ambit_interval hull, double *error) {
  if (ambit_interval_is_empty(hull) || !isfinite(*error) || *error == 0) return hull;
  double lo = ambit_interval_add((ambit_interval) { hull.lo, hull.lo }, (ambit_interval) { *error, *error }).hi;
  double hi = ambit_interval_sub((ambit_interval) { hull.hi, hull.hi }, (ambit_interval) { *error, *error }).lo;
  if (lo < hi) return (ambit_interval) { lo, hi };
  double middle = ambit_interval_mid(hull), radius = ambit_interval_rad(hull);
  *error = ambit_interval_add((ambit_interval) { *error, *error }, (ambit_interval) { radius, radius }).hi;
  return (ambit_interval) { middle, middle };
}
