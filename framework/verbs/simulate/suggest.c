/* suggest.c -- looks at a problem before a solver does. */
#include "verbs/simulate/suggest.h"
#include "graph/hull.h"
#include "verbs/split/probe.h"
#include "verbs/simulate/problem.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define INSTANTS 16u            /* at which the three runs are compared */
#define WORK UINT64_C(60000)    /* instructions for each of them: a third of a millisecond ... */
#define WORK_PER_INSTRUCTION 60 /* ... and for large systems so many evaluations */

typedef struct looker {
  ambit_problem problem;
  ambit_arena *arena;
  ambit_probe *probe;
  ambit_interval *u, *slot;
  double *start, *size, *trace[3]; /* [nx + np], [nx], [INSTANTS + 1][nx] of the middle, least and greatest data */
  uint32_t seen;                   /* instants that all runs reached */
} looker;

static bool make_room(looker *l) {
  const ambit_problem *p = &l->problem;
  l->probe = ambit_probe_make(p, l->arena);
  l->u = ambit_arena_alloc(l->arena, (p->nu + 1u) * sizeof *l->u);
  l->slot = ambit_arena_alloc(l->arena, p->initial->nslot * sizeof *l->slot);
  l->start = ambit_arena_alloc(l->arena, (p->nx + p->np) * sizeof *l->start);
  l->size = ambit_arena_alloc(l->arena, p->nx * sizeof *l->size);
  bool good = l->probe && l->u && l->slot && l->start && l->size;
  for (int i = 0; i < 3; i++) {
    l->trace[i] = ambit_arena_alloc(l->arena, (INSTANTS + 1) * p->nx * sizeof *l->trace[i]);
    good = good && l->trace[i];
  }
  return good;
}

static double instant(const ambit_problem *p, uint32_t k) {
  double s = (double)k / INSTANTS;
  return k == INSTANTS ? p->time[p->ntime - 1] : p->time[0] * (1 - s) + p->time[p->ntime - 1] * s;
}

/* where: 0 the middle of the data, 1 the least, 2 the greatest */
static void observe(looker *l, int where) {
  const ambit_problem *p = &l->problem;
  for (uint32_t j = 0; j < p->nu; j++) {
    double middle = ambit_interval_mid((ambit_interval) { p->u_lo[j], p->u_hi[j] });
    double v = where == 0 ? middle : where == 1 ? p->u_lo[j] : p->u_hi[j];
    l->u[j] = (ambit_interval) { v, v };
  }
  ambit_hull(p->initial, l->u, l->slot);
  for (uint32_t i = 0; i < p->initial->nout; i++) l->start[i] = ambit_interval_mid(l->slot[p->initial->out[i]]);
  uint64_t work = WORK + (uint64_t)WORK_PER_INSTRUCTION * p->rhs->ninstr;
  ambit_probe_start(l->probe, l->start, l->start + p->nx, work, where != 0);
  uint32_t k = 0;
  for (; k < l->seen; k++) {
    if (k && !ambit_probe_advance(l->probe, instant(p, k))) break;
    memcpy(l->trace[where] + (size_t)k * p->nx, ambit_probe_state(l->probe), p->nx * sizeof(double));
  }
  const double *size = ambit_probe_size(l->probe);
  for (uint32_t i = 0; i < p->nx; i++) l->size[i] = fmax(l->size[i], size[i]);
  l->seen = k;
}

static double relative(double x, double size) { return x == 0 ? 0 : size > 0 ? x / size : INFINITY; }

static void compare(const looker *l, ambit_suggest_facts *facts) {
  const ambit_problem *p = &l->problem;
  if (!p->nu) return;
  double noise = 0;
  for (uint32_t i = 0; i < p->nx; i++) noise = fmax(noise, AMBIT_PROBE_NOISE * l->size[i]);
  for (uint32_t i = 0; i < p->nx; i++)
    facts->width = fmax(facts->width, relative(p->x0_hi[i] - p->x0_lo[i], l->size[i]));
  for (uint32_t i = 0; i < p->np; i++)
    facts->width = fmax(facts->width, relative(p->p_hi[i] - p->p_lo[i], fmax(fabs(p->p_lo[i]), fabs(p->p_hi[i]))));
  for (uint32_t k = 0; k < l->seen; k++)
    for (uint32_t i = 0; i < p->nx; i++) {
      if (l->size[i] <= noise) continue;
      size_t at = (size_t)k * p->nx + i;
      double middle = l->trace[0][at], least = l->trace[1][at], most = l->trace[2][at];
      facts->spread = fmax(facts->spread, relative(fabs(most - least), l->size[i]));
      facts->bend = fmax(facts->bend, relative(fabs(0.5 * least + 0.5 * most - middle), l->size[i]));
    }
}

static void find_kink(const looker *l, char kink[160]) {
  const ambit_tape *t = l->problem.rhs;
  uint32_t i = ambit_probe_kink(l->probe);
  if (i == UINT32_MAX) return;
  const char *name = t->op[i] == AMBIT_OP_ABS ? "abs" : t->op[i] == AMBIT_OP_MIN ? "min" : "max";
  snprintf(kink, 160, "%s", t->kink && t->kink[i] ? t->kink[i] : name);
}

static void look(looker *l, const ambit_system *system, ambit_suggest_facts *facts) {
  const ambit_problem *p = &l->problem;
  facts->states = p->nx;
  facts->parameters = p->np;
  facts->unknowns = p->nu;
  facts->varying = p->nvarying;
  facts->invariants = (uint32_t)system->ninvariant;
  facts->kinks = ambit_probe_kinks(l->probe);
  facts->horizon = fabs(p->time[p->ntime - 1] - p->time[0]);
  l->seen = INSTANTS + 1;
  observe(l, 0);
  ambit_probe_facts told = ambit_probe_tell(l->probe);
  facts->seen = fabs(told.reached - p->time[0]) / facts->horizon;
  facts->decay = told.decay;
  facts->swing = told.swing;
  facts->steps = told.steps;
  if (p->nu) observe(l, 1);
  if (p->nu) observe(l, 2);
  compare(l, facts);
  find_kink(l, facts->kink);
}

ambit_status ambit_suggest_look(const ambit_simulate_request *q, ambit_suggest_facts *facts, ambit_failure *f) {
  looker l = { .arena = ambit_arena_open() };
  *facts = (ambit_suggest_facts) { 0 };
  if (!l.arena) return ambit_no_memory(f);
  ambit_problem_request request = { .system = q->system,
    .initial = q->initial,
    .ntime = q->ntime,
    .time = q->time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_INITIAL | AMBIT_WANT_VARYING,
    .nnarrow = q->nnarrow,
    .narrow = q->narrow,
    .range = q->range,
    .final = q->final,
    .registry = q->registry };
  ambit_status status = ambit_problem_build(&request, l.arena, &l.problem, f);
  if (status == AMBIT_OK && !make_room(&l)) status = ambit_no_memory(f);
  if (status == AMBIT_OK) look(&l, q->system, facts);
  ambit_arena_close(l.arena);
  return status;
}
