/* probe_influence.c -- how much each uncertain datum matters: a run for its least value, one for its greatest. */
#include "graph/hull.h"
#include "verbs/split/probe.h"
#include <math.h>

#define INSTANTS 64
#define WORK UINT64_C(4000000) /* instructions for all runs: about a tenth of a second */
#define UNSEEN 1e-9            /* what a relative width counts where no run shows any influence */

typedef struct looker {
  const ambit_problem *p;
  const ambit_tape *initial;
  ambit_probe *probe;
  ambit_interval *u, *slot;
  double *start;               /* [nx + np] */
  double *least, *most, *size; /* [instants][nx], and [nx] */
  uint32_t instants;           /* at which runs are compared */
  uint32_t reached, seen;      /* of them, the first that the middle run and those compared reached */
  uint64_t work;               /* of one run */
} looker;

/* Instant k of those that are compared: all, or some of many. */
static double instant(const looker *l, uint32_t k) {
  uint64_t last = l->p->ntime - 1;
  return l->p->time[last * k / (l->instants - 1)];
}

static void observe(looker *l, double *trace, bool repeats) {
  const ambit_tape *t = l->initial;
  ambit_hull(t, l->u, l->slot);
  for (uint32_t i = 0; i < t->nout; i++) l->start[i] = ambit_interval_mid(l->slot[t->out[i]]);
  ambit_probe_start(l->probe, l->start, l->start + l->p->nx, l->work, repeats);
  uint32_t k = 0;
  for (; k < l->seen; k++) {
    if (k && !ambit_probe_advance(l->probe, instant(l, k))) break;
    const double *x = ambit_probe_state(l->probe);
    for (uint32_t i = 0; i < l->p->nx; i++) {
      trace[k * l->p->nx + i] = x[i];
      l->size[i] = fmax(l->size[i], fabs(x[i]));
    }
  }
  l->seen = k;
}

static double compare(const looker *l) {
  double worst = 0;
  for (uint32_t k = 0; k < l->seen; k++)
    for (uint32_t i = 0; i < l->p->nx; i++) {
      double apart = fabs(l->most[k * l->p->nx + i] - l->least[k * l->p->nx + i]);
      if (l->size[i] > 0) worst = fmax(worst, apart / l->size[i]);
    }
  return isfinite(worst) ? worst : 0;
}

static double look_at(looker *l, uint32_t j) {
  const ambit_problem *p = l->p;
  double lo = p->u_lo[j], hi = p->u_hi[j], largest = fmax(fabs(lo), fabs(hi));
  l->seen = l->reached;
  ambit_interval middle = l->u[j];
  l->u[j] = (ambit_interval) { lo, lo };
  observe(l, l->least, true);
  l->u[j] = (ambit_interval) { hi, hi };
  observe(l, l->most, true);
  l->u[j] = middle;
  return fmax(compare(l), largest > 0 ? UNSEEN * (hi / largest - lo / largest) : 0);
}

ambit_status ambit_probe_influence(
    const ambit_problem *p, const ambit_tape *initial, ambit_arena *arena, double *influence) {
  looker l = { .p = p, .initial = initial, .work = WORK / (2 * (uint64_t)p->nu + 1) };
  l.instants = p->ntime < INSTANTS ? p->ntime : INSTANTS;
  l.probe = ambit_probe_make(p, arena);
  l.u = ambit_arena_alloc(arena, (p->nu + 1u) * sizeof *l.u);
  l.slot = ambit_arena_alloc(arena, initial->nslot * sizeof *l.slot);
  l.start = ambit_arena_alloc(arena, (p->nx + p->np) * sizeof *l.start);
  l.least = ambit_arena_alloc(arena, (size_t)l.instants * p->nx * sizeof *l.least);
  l.most = ambit_arena_alloc(arena, (size_t)l.instants * p->nx * sizeof *l.most);
  l.size = ambit_arena_alloc(arena, p->nx * sizeof *l.size);
  if (!l.probe || !l.u || !l.slot || !l.start || !l.least || !l.most || !l.size) return AMBIT_NOMEM;
  for (uint32_t j = 0; j < p->nu; j++) {
    double middle = ambit_interval_mid((ambit_interval) { p->u_lo[j], p->u_hi[j] });
    l.u[j] = (ambit_interval) { middle, middle };
  }
  l.seen = l.instants;
  observe(&l, l.least, false); /* the middle, whose steps the others take */
  l.reached = l.seen;
  for (uint32_t j = 0; j < p->nu; j++) influence[j] = look_at(&l, j);
  return AMBIT_OK;
}
