/* skeleton.c -- a solver to start from: Heun's method (1900) from the midpoint of the initial set. It proves
** nothing, and
** says so.
**
** `open` allocates everything, `run` emits a record for each step and allocates nothing, `close` frees. A solver
** that proves something sets needs_rigorous and the records' `rigorous`; <ambit/solver.h> has the contract, and the
** service <ambit/jet.h> gives it Taylor series with proved tails. `ambit check` solves small problems with it.
*/
#include <ambit/block.h>
#include <ambit/solver.h>
#include <string.h>

enum { STEPS }; /* options, in the order of `params` */

static const ambit_param params[] = {
  { "steps", "1", "integer", "1000", "between two listed times" },
  { NULL, NULL, NULL, NULL, NULL },
};

typedef struct heun {
  const ambit_host *host;
  const ambit_problem *problem;
  ambit_lane rhs;                     /* the right-hand side as a tape, one lane */
  double *x, *ahead, *slope, *slope2; /* [nx] each */
  double steps;
} heun;

static ambit_status open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  if (!(option[STEPS] >= 1)) return h->fail(h, AMBIT_INVALID, "`steps` must be at least 1");
  heun *s = h->alloc(h, sizeof *s);
  double *room = h->alloc(h, 4 * p->nx * sizeof *room);
  if (!s || !room) return AMBIT_NOMEM;
  *s = (heun) { .host = h,
    .problem = p,
    .x = room,
    .ahead = room + p->nx,
    .slope = room + 2 * p->nx,
    .slope2 = room + 3 * p->nx,
    .steps = option[STEPS] };
  *self = s;
  return ambit_lane_open(&s->rhs, h, p->rhs, p->arithmetic, p->actx);
}

/* f(t, x): the inputs of the tape are the states, the parameters, and the time if it occurs */
static void derivative(heun *s, double t, const double *x, double *slope) {
  const ambit_problem *p = s->problem;
  for (uint32_t i = 0; i < p->nx; i++) ambit_lane_set(&s->rhs, i, x[i], x[i]);
  for (uint32_t i = 0; i < p->np; i++) ambit_lane_set(&s->rhs, p->nx + i, p->p_lo[i], p->p_hi[i]);
  if (p->uses_time) ambit_lane_set(&s->rhs, p->nx + p->np, t, t);
  ambit_lane_run(&s->rhs);
  for (uint32_t i = 0; i < p->nx; i++) {
    double lo, hi;
    ambit_lane_get(&s->rhs, i, &lo, &hi);
    slope[i] = 0.5 * lo + 0.5 * hi;
  }
}

static void step(heun *s, double t, double h) {
  uint32_t n = s->problem->nx;
  derivative(s, t, s->x, s->slope);
  for (uint32_t i = 0; i < n; i++) s->ahead[i] = s->x[i] + h * s->slope[i];
  derivative(s, t + h, s->ahead, s->slope2);
  for (uint32_t i = 0; i < n; i++) s->x[i] += 0.5 * h * (s->slope[i] + s->slope2[i]);
}

/* one step and its record; t_to must be a listed time exactly when the step ends there */
static ambit_status advance(heun *s, ambit_sink *sink, double from, double to) {
  const ambit_problem *p = s->problem;
  step(s, from, to - from);
  for (uint32_t i = 0; i < p->nx; i++)
    if (!(s->x[i] - s->x[i] == 0)) /* infinite or NaN */
      return s->host->fail(s->host, AMBIT_UNABLE, "%s grew without bound; more `steps` may help", p->name[i]);
  ambit_record r = {
    .size = sizeof r, .kind = AMBIT_REC_STEP, .t_from = from, .t_to = to, .nx = p->nx, .lo = s->x, .hi = s->x
  };
  double begin = p->time[0], end = p->time[p->ntime - 1];
  if (sink->emit(sink, &r) || sink->progress(sink, (to - begin) / (end - begin), NULL)) return AMBIT_STOPPED;
  return AMBIT_OK;
}

static ambit_status run(void *self, ambit_sink *sink) {
  heun *s = self;
  const ambit_problem *p = s->problem;
  for (uint32_t i = 0; i < p->nx; i++) s->x[i] = 0.5 * p->x0_lo[i] + 0.5 * p->x0_hi[i];
  for (uint32_t k = 1; k < p->ntime; k++) {
    double from = p->time[k - 1], to = p->time[k], t = from;
    for (double i = 1; i <= s->steps; i++) {
      double next = i < s->steps ? from + i / s->steps * (to - from) : to;
      ambit_status status = advance(s, sink, t, next);
      if (status != AMBIT_OK) return status;
      t = next;
    }
  }
  return AMBIT_OK;
}

static void close(void *self) { ambit_lane_close(&((heun *)self)->rhs); }

static const ambit_solver solver = { .size = sizeof solver,
  .want = AMBIT_WANT_RHS,
  .arithmetics = "real",
  .param = params,
  .open = open,
  .run = run,
  .close = close };

static const void *get(const char *id) { return strcmp(id, AMBIT_SOLVER) == 0 ? &solver : NULL; }

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "solver.skeleton", "0.1",
  "Heun's method of order 2; proves nothing.", get };
