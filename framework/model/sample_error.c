/* sample_error.c -- the same draws with two tolerances. */
#include "model/sample_error.h"
#include <math.h>

#define TIGHTER 0.01      /* tolerances of the second run */
#define CAUTION 10        /* times what it shows */
#define MOST_KEPT 4000000 /* numbers of the first run */

typedef struct keeping {
  const ambit_problem *problem;
  ambit_flow_block block;
  size_t n;
  double *x;     /* [ntime][nx][n] of the first run; NaN: not reached */
  double *apart; /* [ntime * nx] of the second run the largest difference, NaN: none was found; NULL in the first */
} keeping;

static void keep(void *user, uint32_t k, size_t lane, const double *x, size_t stride) {
  const keeping *kept = user;
  for (size_t i = 0; i < kept->problem->nx; i++) {
    size_t at = k * (size_t)kept->problem->nx + i;
    double *place = &kept->x[at * kept->n + lane];
    if (!kept->apart)
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

/* The midpoint and the extremes, as many as there is room for: their points, [nu][n]; returns n. */
static size_t choose_witnesses(const ambit_sample_error *q, double *point) {
  const ambit_problem *p = ambit_flow_problem(q->flow);
  const double *row[AMBIT_FLOW_LANES] = { NULL };
  size_t n = 1, most = count_witnesses(q);
  for (size_t i = 0; i < (size_t)p->nx * AMBIT_SIDES && n < most; i++)
    if (q->extreme[i].seen) row[n++] = q->extreme[i].point;
  for (size_t i = 0; i < p->nu; i++) {
    point[i * n] = ambit_interval_mid(ambit_flow_range(q->flow)[i]);
    for (size_t k = 1; k < n; k++) point[i * n + k] = row[k][i];
  }
  return n;
}

static bool run(const ambit_sample_error *q, keeping *kept, const double *point) {
  kept->block.n = kept->n;
  kept->block.point = point;
  kept->block.see = keep;
  kept->block.user = kept;
  return ambit_flow_make(q->flow, 0, &kept->block) == AMBIT_OK;
}

ambit_status ambit_sample_estimate_error(const ambit_sample_error *q, ambit_arena *arena, double *error) {
  const ambit_problem *p = ambit_flow_problem(q->flow);
  size_t values = (size_t)p->ntime * p->nx;
  double *point = ambit_arena_alloc(arena, ((size_t)p->nu * AMBIT_FLOW_LANES + 1) * sizeof *point);
  keeping *kept = ambit_arena_alloc(arena, sizeof *kept);
  if (!point || !kept) return AMBIT_NOMEM;
  kept->problem = p;
  kept->n = choose_witnesses(q, point);
  kept->x = ambit_arena_alloc(arena, values * kept->n * sizeof *kept->x);
  if (!kept->x) return AMBIT_NOMEM;
  for (size_t i = 0; i < values; i++) error[i] = NAN;
  for (size_t i = 0; i < values * kept->n; i++) kept->x[i] = NAN;
  bool done = run(q, kept, point) && ambit_flow_tighten(q->flow, TIGHTER);
  kept->apart = error;
  if (!done || !run(q, kept, point)) return AMBIT_OK;
  for (size_t i = 0; i < values; i++)
    error[i] =
        CAUTION * error[i] + (ambit_interval_is_empty(q->hull[i]) ? 0 : 0x1p-50 * ambit_interval_mag(q->hull[i]));
  return AMBIT_OK;
}
