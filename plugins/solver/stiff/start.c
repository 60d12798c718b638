/* start.c -- the initial set: a point in double-double, a column for each unknown, and what is beyond both.
**
** Initial states and parameters are functions g of the unknowns u = mid + radius xi: g(u) = g(mid) + sum_j s_j radius_j
** xi_j, with slopes s about mid from the kernel's series service, g(mid) from our own.
*/
#include "stiff.h"
#include <ambit/code.h>
#include <ambit/jet.h>
#include <string.h>

#define INFLATE (1 + 0x1p-40)

/* -- slopes, in upward mode */

typedef struct slopes_at_start {
  const ambit_jet_service *jet;
  ambit_jet *centre, *box;
  double *slope_mid, *slope_rad, *seed, *no_radius;
} slopes_at_start;

static AMBIT_WORKER uint32_t evaluate(stiff *s, slopes_at_start *o) {
  const ambit_problem *p = &s->problem;
  for (uint32_t i = 0; i < p->nu; i++) {
    for (uint32_t j = 0; j < p->nu; j++) o->seed[j] = i == j ? s->scale[i] : 0;
    o->jet->put(o->centre, i, 0, s->about[i], 0, NULL, NULL);
    o->jet->put(o->box, i, 0, s->about[i], s->scale[i], o->seed, o->no_radius);
  }
  uint32_t flags = o->jet->advance(o->centre, 0);
  flags |= o->jet->advance(o->box, 0);
  for (uint32_t i = 0; i < s->n && !flags; i++) {
    double mid, rad;
    o->jet->get(o->box, p->initial->out[i], 0, &mid, &rad, o->slope_mid, o->slope_rad);
    for (uint32_t j = 0; j < p->nu; j++) {
      s->start_column[i * p->nu + j] = o->slope_mid[j];
      s->start_rest[i] += o->slope_rad[j];
    }
  }
  return flags;
}

/* in round-to-nearest */
static ambit_status read_middle(stiff *s) {
  series initial;
  if (!series_open(s->host, s->num, s->problem.initial, 1, &initial))
    return s->host->fail(s->host, AMBIT_NOMEM, "stiff: out of memory");
  for (uint32_t i = 0; i < s->problem.nu; i++) {
    double lo = s->problem.u_lo[i], hi = s->problem.u_hi[i];
    s->about[i] = 0.5 * lo + 0.5 * hi;
    s->scale[i] = nextafter(fmax(hi - s->about[i], s->about[i] - lo), INFINITY);
    poly_constant(series_input(&initial, i), (dd) { s->about[i], 0 }, 0);
  }
  series_run(&initial);
  for (uint32_t i = 0; i < s->n; i++) {
    const poly *g = series_output(&initial, i);
    s->start[i] = poly_get(g, 0);
    s->start_rest[i] = g->tail;
  }
  return AMBIT_OK;
}

static ambit_status undefined(const stiff *s) {
  return s->host->fail_code(s->host, AMBIT_UNABLE, AMBIT_CODE_UNABLE_INITIAL,
      "at t = %.9g s the initial values could not be bounded for all values of their uncertain data; narrow the "
      "ranges of the data in `initial`",
      s->problem.time[0]);
}

static ambit_status read_slopes(stiff *s) {
  const ambit_host *h = s->host;
  const ambit_problem *p = &s->problem;
  slopes_at_start o = { .jet = h->service(h, AMBIT_JET_SERVICE) };
  if (!o.jet) return h->fail(h, AMBIT_INVALID, "stiff: this kernel does not lend `%s`", AMBIT_JET_SERVICE);
  double *room = h->alloc(h, 4 * (size_t)p->nu * sizeof *room);
  if (!room) return h->fail(h, AMBIT_NOMEM, "stiff: out of memory");
  o.slope_mid = room, o.slope_rad = room + p->nu, o.seed = room + 2 * p->nu, o.no_radius = room + 3 * p->nu;
  ambit_status status = o.jet->open(h, p->initial, p->arithmetic, p->actx, 1, 0, NULL, &o.centre);
  if (status == AMBIT_OK) {
    status = o.jet->open(h, p->initial, p->arithmetic, p->actx, 1, p->nu, o.centre, &o.box);
    if (status == AMBIT_OK) {
      ambit_rounding old = ambit_round_up();
      uint32_t flags = evaluate(s, &o);
      ambit_rounding_restore(old);
      if (flags) status = undefined(s);
      o.jet->close(o.box);
    }
    o.jet->close(o.centre);
  }
  return status;
}

ambit_status start_read(stiff *s) {
  ambit_status status = s->spread ? spread_read(s) : read_middle(s);
  if (status == AMBIT_OK && s->problem.nu && !s->spread) status = read_slopes(s);
  for (uint32_t i = 0; i < s->inputs && status == AMBIT_OK; i++)
    if (!(s->start_rest[i] < INFINITY)) status = undefined(s);
  return status;
}

/* -- the set at the start */

/* B := columns of the unknowns, filled up with unit vectors, the farthest from what there is; 0: they are dependent */
static int independent_columns(const stiff *s, double *B) {
  uint32_t n = s->n, nu = s->problem.nu, used[N_MAX] = { 0 };
  square Q;
  double scale[N_MAX] = { 0 };
  if (nu > n) return 0;
  for (uint32_t i = 0; i < n; i++) {
    scale[i] = fabs(s->start[i].hi) + 1e-300;
    for (uint32_t j = 0; j < nu; j++) scale[i] += fabs(s->start_column[i * nu + j]);
    if (scale[i] < 1e-30) scale[i] = 1;
    for (uint32_t j = 0; j < n; j++) B[i * n + j] = j < nu ? s->start_column[i * nu + j] : 0;
  }
  memcpy(Q, s->start_column, (size_t)n * nu * sizeof *Q);
  if (!orthonormalise(n, nu, Q, scale, NULL)) return 0;
  for (uint32_t j = nu; j < n; j++) {
    double most = -1;
    uint32_t best = 0;
    for (uint32_t i = 0; i < n; i++) { /* 1 - the squared length of e_i's projection */
      double rest = 1;
      for (uint32_t k = 0; k < j; k++) rest -= (Q[i * j + k] / scale[i]) * (Q[i * j + k] / scale[i]);
      if (!used[i] && rest > most) most = rest, best = i;
    }
    used[best] = 1;
    B[best * n + j] = scale[best];
    square grown;
    double unit[N_MAX] = { 0 };
    unit[best] = scale[best];
    join_columns(n, j, Q, 1, unit, grown);
    if (!orthonormalise(n, j + 1, grown, scale, NULL)) return 0;
    memcpy(Q, grown, (size_t)n * (j + 1) * sizeof *Q);
  }
  return scaled_condition(n, B, scale) < 1e6;
}

/* w := |B^-1| rest, and 1 more for each unknown */
static int width_in_columns(stiff *s, double *w) {
  uint32_t n = s->n;
  square C;
  iv B[N_MAX * N_MAX], X[N_MAX * N_MAX];
  square T;
  for (uint32_t i = 0; i < n * n; i++) {
    B[i] = iv_of(s->carried.B[i]);
    X[i] = iv_of(i % (n + 1) == 0 ? s->start_rest[i / n] : 0);
  }
  if (!matrix_inverse(n, s->carried.B, C) || !bound_solution(n, C, B, n, X, T)) return 0;
  for (uint32_t i = 0; i < n; i++) {
    w[i] = i < s->problem.nu;
    for (uint32_t k = 0; k < n; k++) w[i] += T[i * n + k];
  }
  return 1;
}

static int is_a_point(const stiff *s) { return s->problem.nu == 0 || s->spread; }

void start_set(stiff *s) {
  carried *c = &s->carried;
  uint32_t n = s->n, nu = s->problem.nu;
  c->fast = 0, c->blocks = n, c->valid = !is_a_point(s);
  for (uint32_t i = 0; i < n; i++) {
    c->block[i] = i;
    s->end[i] = s->start[i], s->end_error[i] = 0;
  }
  if (s->spread) spread_start(s);
  if (!is_a_point(s) && independent_columns(s, c->B) && width_in_columns(s, c->w)) return;
  for (uint32_t i = 0; i < n * n; i++) c->B[i] = i % (n + 1) == 0;
  for (uint32_t i = 0; i < n; i++) {
    c->w[i] = s->start_rest[i];
    for (uint32_t j = 0; j < nu && !s->spread; j++) c->w[i] += fabs(s->start_column[i * nu + j]);
  }
}
