/* euler_solver.c -- the smallest solver: Euler's method (1768) from the midpoint of the initial set. It proves nothing,
** and says so.
*/
#include <ambit/block.h>
#include <ambit/solver.h>
#include <string.h>

static const ambit_param params[] = {
  { "steps", "1", "integer", "100", "steps between two listed times" },
  { NULL, NULL, NULL, NULL, NULL },
};

typedef struct euler {
  const ambit_problem *problem;
  ambit_lane rhs;
  double *x, steps;
} euler;

static ambit_status open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  euler *e = h->alloc(h, sizeof *e);
  if (!e) return AMBIT_NOMEM;
  if (!(option[0] >= 1)) return h->fail(h, AMBIT_INVALID, "`steps` must be at least 1");
  *e = (euler) { .problem = p, .x = h->alloc(h, p->nx * sizeof(double)), .steps = option[0] };
  *self = e;
  return e->x ? ambit_lane_open(&e->rhs, h, p->rhs, p->arithmetic, p->actx) : AMBIT_NOMEM;
}

static void step(euler *e, double t, double h) {
  const ambit_problem *p = e->problem;
  for (uint32_t i = 0; i < p->nx; i++) ambit_lane_set(&e->rhs, i, e->x[i], e->x[i]);
  for (uint32_t i = 0; i < p->np; i++) ambit_lane_set(&e->rhs, p->nx + i, p->p_lo[i], p->p_hi[i]);
  if (p->uses_time) ambit_lane_set(&e->rhs, p->nx + p->np, t, t);
  ambit_lane_run(&e->rhs);
  for (uint32_t i = 0; i < p->nx; i++) {
    double lo, hi;
    ambit_lane_get(&e->rhs, i, &lo, &hi);
    e->x[i] += h * (0.5 * lo + 0.5 * hi);
  }
}

static ambit_status run(void *self, ambit_sink *s) {
  euler *e = self;
  const ambit_problem *p = e->problem;
  for (uint32_t i = 0; i < p->nx; i++) e->x[i] = 0.5 * p->x0_lo[i] + 0.5 * p->x0_hi[i];
  for (uint32_t k = 1; k < p->ntime; k++) {
    double from = p->time[k - 1], to = p->time[k], h = (to - from) / e->steps;
    for (double i = 0; i < e->steps; i++) step(e, from + i * h, h);
    ambit_record r = {
      .size = sizeof r, .kind = AMBIT_REC_STEP, .t_from = from, .t_to = to, .nx = p->nx, .lo = e->x, .hi = e->x
    };
    if (s->emit(s, &r) || s->progress(s, (double)k / (p->ntime - 1), NULL)) return AMBIT_STOPPED;
  }
  return AMBIT_OK;
}

static void close(void *self) { ambit_lane_close(&((euler *)self)->rhs); }

static const ambit_solver solver = { .size = sizeof solver,
  .want = AMBIT_WANT_RHS,
  .arithmetics = "real",
  .param = params,
  .open = open,
  .run = run,
  .close = close };

static const void *get(const char *id) { return strcmp(id, AMBIT_SOLVER) == 0 ? &solver : NULL; }
const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.euler", "1.0",
  "Euler's method; proves nothing.", get };
