/* sample_flow.c -- starts from points, constraints at the start, then lanes or draws. */
#include "verbs/sample/sample_flow.h"
#include "verbs/sample/batch.h"
#include "verbs/split/approximate.h"
#include "verbs/run/context.h"
#include "verbs/run/pair.h"
#include "verbs/simulate/problem.h"
#include "verbs/sample/sample_inside.h"
#include "verbs/sample/sample_lanes.h"
#include "models/default.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TORN 1e-6 /* of a constraint: more than any rounding, less than anybody wants */
#define RELATIVE 1e-10
#define ABSOLUTE 1e-12
#define TIGHTEST 2e-14 /* relative: below it steps fail by rounding */

/* What one thread needs. */
typedef struct drawer {
  ambit_context context;
  ambit_batch *initial;
  ambit_lanes *lanes;
  double *start, *upper; /* [nx + np][AMBIT_FLOW_LANES] */
  double *in, *slot;     /* of the invariants, one lane */
} drawer;

struct ambit_flow {
  const ambit_simulate_request *q;
  ambit_arena *arena;
  char arithmetic[AMBIT_NAME_MAX];
  ambit_problem problem;
  const ambit_expr *unknown; /* [nu] */
  ambit_interval *range;     /* [nu] */
  bool vague;                /* of some datum no value is known to be allowed */
  double relative, absolute;
  double longest; /* step; 0: any */
  uint32_t threads, ndrawer;
  drawer *drawer;
  ambit_draws *draws; /* or NULL */
  bool one_by_one;
};

static void *room(const ambit_flow *flow, size_t n, size_t size) {
  return ambit_arena_alloc(flow->arena, (n + 1) * size);
}

/* -- life */

static ambit_status find_ranges(ambit_flow *flow, ambit_failure *f) {
  const ambit_problem *p = &flow->problem;
  flow->range = room(flow, p->nu, sizeof *flow->range);
  if (!flow->range) return ambit_no_memory(f);
  for (uint32_t i = 0; i < p->nu; i++) {
    const ambit_node *datum = ambit_graph_node(flow->q->system->graph, flow->unknown[i]);
    ambit_status status = ambit_sample_check_range(flow->q->system->graph, flow->unknown[i], f);
    if (status != AMBIT_OK) return status;
    flow->range[i] = ambit_sample_range(datum);
    flow->vague = flow->vague || ambit_interval_is_empty(datum->inner);
  }
  return AMBIT_OK;
}

static ambit_status build(ambit_flow *flow, ambit_failure *f) {
  const ambit_simulate_request *q = flow->q;
  ambit_problem_request request = { .system = q->system,
    .initial = q->initial,
    .ntime = q->ntime,
    .time = q->time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_INITIAL | AMBIT_WANT_INVARIANT | AMBIT_WANT_JUMP,
    .unknown = &flow->unknown,
    .final = q->final,
    .registry = q->registry };
  ambit_status status = ambit_problem_build(&request, flow->arena, &flow->problem, f);
  return status == AMBIT_OK ? find_ranges(flow, f) : status;
}

static ambit_status open_drawer(ambit_flow *flow, drawer *d, ambit_failure *f) {
  const ambit_simulate_request *q = flow->q;
  const ambit_problem *p = &flow->problem;
  size_t n = (size_t)p->nx + p->np;
  d->start = room(flow, n * AMBIT_FLOW_LANES, sizeof *d->start);
  d->upper = room(flow, n * AMBIT_FLOW_LANES, sizeof *d->upper);
  d->in = room(flow, n + 1, sizeof *d->in);
  d->slot = room(flow, p->invariant ? p->invariant->nslot : 0, sizeof *d->slot);
  if (!d->start || !d->upper || !d->in || !d->slot) return ambit_no_memory(f);
  size_t noption = flow->one_by_one ? 0 : q->narithmetic_option;
  ambit_status status = ambit_context_open(q->registry, flow->one_by_one ? AMBIT_DEFAULT_POINTS : flow->arithmetic,
      noption, q->arithmetic_option, (uint32_t)n, &d->context, f);
  if (status == AMBIT_OK && d->context.arithmetic->rigorous)
    return ambit_fail(f, AMBIT_INVALID, "arithmetic `%s` encloses sets; draws are made in `" AMBIT_DEFAULT_POINTS "`",
        flow->arithmetic);
  if (status == AMBIT_OK) status = ambit_batch_open(p->initial, d->context.arithmetic, d->context.ctx, &d->initial, f);
  if (status == AMBIT_OK && !flow->one_by_one)
    status = ambit_lanes_open(p, d->context.arithmetic, d->context.ctx, AMBIT_FLOW_LANES, &d->lanes, f);
  return status;
}

static ambit_status open_drawers(ambit_flow *flow, ambit_failure *f) {
  flow->drawer = room(flow, flow->threads, sizeof *flow->drawer);
  if (!flow->drawer) return ambit_no_memory(f);
  ambit_status status = AMBIT_OK;
  while (flow->ndrawer < flow->threads && status == AMBIT_OK)
    status = open_drawer(flow, &flow->drawer[flow->ndrawer++], f);
  return status;
}

static ambit_status prepare(ambit_flow *flow, ambit_failure *f) {
  const ambit_simulate_request *q = flow->q;
  ambit_status status = build(flow, f);
  if (status != AMBIT_OK) return status;
  flow->one_by_one = q->solver != NULL;
  if (flow->one_by_one) {
    const ambit_draws_request request = { .q = q, .threads = flow->threads };
    status = ambit_draws_open(&request, &flow->draws, f);
    if (status == AMBIT_OK)
      snprintf(flow->arithmetic, sizeof flow->arithmetic, "%s", ambit_draws_arithmetic(flow->draws));
  } else {
    snprintf(flow->arithmetic, sizeof flow->arithmetic, "%s", q->arithmetic ? q->arithmetic : AMBIT_DEFAULT_POINTS);
  }
  return status == AMBIT_OK ? open_drawers(flow, f) : status;
}

ambit_status ambit_flow_open(
    const ambit_simulate_request *q, const ambit_sample_plan *plan, ambit_flow **flow, ambit_failure *f) {
  *flow = NULL;
  ambit_arena *arena = ambit_arena_open();
  ambit_flow *made = arena ? ambit_arena_alloc(arena, sizeof *made) : NULL;
  if (!made) {
    ambit_arena_close(arena);
    return ambit_no_memory(f);
  }
  bool given = plan->relative > 0 || plan->absolute > 0;
  *made = (ambit_flow) { .q = q,
    .arena = arena,
    .threads = plan->threads,
    .relative = given ? plan->relative : RELATIVE,
    .absolute = given ? plan->absolute : ABSOLUTE };
  ambit_status status = prepare(made, f);
  if (status == AMBIT_OK)
    *flow = made;
  else
    ambit_flow_close(made);
  return status;
}

void ambit_flow_close(ambit_flow *flow) {
  if (!flow) return;
  for (uint32_t i = 0; i < flow->ndrawer; i++) {
    ambit_lanes_close(flow->drawer[i].lanes);
    ambit_batch_close(flow->drawer[i].initial);
    ambit_context_close(&flow->drawer[i].context);
  }
  ambit_draws_close(flow->draws);
  ambit_arena_close(flow->arena);
}

ambit_work ambit_flow_work(const ambit_flow *flow) {
  ambit_work sum = { 0 };
  for (uint32_t i = 0; i < flow->ndrawer; i++) {
    ambit_work opened = ambit_scope_work(flow->drawer[i].context.scope);
    ambit_work_add(&sum, &opened);
    if (flow->drawer[i].initial) ambit_work_add(&sum, ambit_batch_work(flow->drawer[i].initial));
    if (flow->drawer[i].lanes) ambit_work_add(&sum, ambit_lanes_work(flow->drawer[i].lanes));
  }
  if (flow->draws) ambit_draws_work(flow->draws, &sum);
  return sum;
}

const ambit_problem *ambit_flow_problem(const ambit_flow *flow) { return &flow->problem; }
const ambit_interval *ambit_flow_range(const ambit_flow *flow) { return flow->range; }
bool ambit_flow_is_vague(const ambit_flow *flow) { return flow->vague; }
const char *ambit_flow_arithmetic(const ambit_flow *flow) { return flow->arithmetic; }
uint32_t ambit_flow_threads(const ambit_flow *flow) { return flow->threads; }
bool ambit_flow_is_one_by_one(const ambit_flow *flow) { return flow->one_by_one; }
bool ambit_flow_has_draws(const ambit_flow *flow) { return flow->draws != NULL; }

/* -- the way a block goes */

static ambit_status open_draws(ambit_flow *flow, const char *method, ambit_failure *f) {
  char relative[32], absolute[32];
  snprintf(relative, sizeof relative, "%.17g", flow->relative);
  snprintf(absolute, sizeof absolute, "%.17g", flow->absolute);
  const ambit_option option[] = { { "relative", relative }, { "absolute", absolute }, { "method", method } };
  const ambit_draws_request request = {
    .q = flow->q, .solver = AMBIT_DEFAULT_DRAWS, .noption = 3, .option = option, .threads = flow->threads
  };
  return ambit_draws_open(&request, &flow->draws, f);
}

ambit_status ambit_flow_use_draws(ambit_flow *flow, bool all, bool stiff, ambit_failure *f) {
  ambit_draws_close(flow->draws);
  flow->draws = NULL;
  ambit_failure no_jacobian = { 0 };
  ambit_status status = stiff ? open_draws(flow, "msbdf", &no_jacobian) : AMBIT_INVALID;
  if (status != AMBIT_OK) status = open_draws(flow, "rk8pd", f);
  if (status == AMBIT_OK && all) flow->one_by_one = true;
  return status;
}

bool ambit_flow_tighten(ambit_flow *flow, double by, double steps) {
  const ambit_problem *p = &flow->problem;
  flow->longest = fabs(p->time[p->ntime - 1] - p->time[0]) / steps;
  flow->relative = flow->relative > 0 ? fmax(flow->relative * by, TIGHTEST) : 0;
  flow->absolute *= by;
  return !flow->draws || ambit_draws_tighten(flow->draws, by, flow->longest);
}

/* -- starts */

static void find_starts(const ambit_flow *flow, drawer *d, const ambit_flow_block *block) {
  size_t n = ((size_t)flow->problem.nx + flow->problem.np) * block->n;
  ambit_batch_run(d->initial, block->n, block->point, block->point, NULL, d->start, d->upper);
  for (size_t i = 0; i < n; i++)
    d->start[i] = d->start[i] <= d->upper[i] ? ambit_interval_mid((ambit_interval) { d->start[i], d->upper[i] }) : NAN;
}

static void check_constraints(const ambit_flow *flow, drawer *d, ambit_flow_block *block, size_t lane) {
  const ambit_problem *p = &flow->problem;
  if (!p->ninvariant) return;
  uint32_t n = p->nx + p->np;
  for (uint32_t i = 0; i < n; i++) d->in[i] = d->start[i * block->n + lane];
  d->in[n] = p->time[0];
  ambit_approximate(p->invariant, d->in, d->slot);
  for (uint32_t i = 0; i < p->ninvariant; i++) {
    double off = fabs(d->slot[p->invariant->out[i]]);
    if (off <= TORN) continue;
    block->fate[lane] = AMBIT_FATE_OFF;
    if (!block->reason[0])
      snprintf(block->reason, sizeof block->reason,
          "the constraint `%s` is off by %.3g at the start: give initial values that fit together for all data, as "
          "m:assemble finds them",
          p->invariant_name[i], off);
    return;
  }
}

/* -- in lanes */

typedef struct passage {
  ambit_flow_block *block;
  bool lost[AMBIT_FLOW_LANES];
} passage;

static void take(void *user, uint32_t k, size_t n, const double *x, const bool *lost) {
  const passage *way = user;
  for (size_t lane = 0; lane < n; lane++)
    if (!lost[lane]) way->block->see(way->block->user, k, lane, x + lane, n);
}

static int32_t pause(void *user) {
  const passage *way = user;
  return way->block->pause ? way->block->pause(way->block->user) : 0;
}

static void go_in_lanes(const ambit_flow *flow, drawer *d, ambit_flow_block *block) {
  passage way = { .block = block };
  for (size_t lane = 0; lane < block->n; lane++) way.lost[lane] = block->fate[lane] != AMBIT_FATE_REACHED;
  take(&way, 0, block->n, d->start, way.lost);
  const ambit_lanes_run run = { .n = block->n,
    .x0 = d->start,
    .p = d->start + flow->problem.nx * block->n,
    .relative = flow->relative,
    .absolute = flow->absolute,
    .longest = flow->longest,
    .take = take,
    .pause = pause,
    .user = &way,
    .lost = way.lost };
  size_t steps;
  ambit_lanes_outcome outcome = ambit_lanes_integrate(d->lanes, &run, &steps);
  block->stiff = outcome == AMBIT_LANES_STIFF;
  block->stopped = outcome == AMBIT_LANES_STOPPED;
  for (size_t lane = 0; lane < block->n; lane++)
    if (way.lost[lane] && block->fate[lane] == AMBIT_FATE_REACHED) block->fate[lane] = AMBIT_FATE_LOST;
}

/* -- one by one */

typedef struct alone {
  const ambit_flow_block *block;
  size_t lane;
  bool stopped;
} alone;

static void see_alone(void *user, uint32_t k, const double *x) {
  const alone *one = user;
  one->block->see(one->block->user, k, one->lane, x, 1);
}

static int32_t pause_alone(void *user) {
  alone *one = user;
  one->stopped = one->stopped || (one->block->pause && one->block->pause(one->block->user));
  return one->stopped;
}

static ambit_status go_alone(ambit_flow *flow, uint32_t worker, ambit_flow_block *block) {
  for (size_t lane = 0; lane < block->n; lane++) {
    char reason[sizeof block->reason];
    alone here = { block, lane, false };
    const ambit_draws_one one = { .point = block->point + lane,
      .stride = block->n,
      .see = see_alone,
      .pause = pause_alone,
      .user = &here,
      .reason = reason,
      .room = sizeof reason };
    bool reached;
    if (block->fate[lane] != AMBIT_FATE_REACHED) continue;
    ambit_status status = ambit_draws_make(flow->draws, worker, &one, &reached);
    if (here.stopped || (lane + 1 < block->n && pause_alone(&here))) {
      block->stopped = true;
      break;
    }
    if (!reached && !block->reason[0]) memcpy(block->reason, reason, sizeof reason);
    if (status != AMBIT_OK) return status;
    if (!reached) block->fate[lane] = AMBIT_FATE_FAILED;
  }
  return AMBIT_OK;
}

ambit_status ambit_flow_make(ambit_flow *flow, uint32_t worker, ambit_flow_block *block) {
  drawer *d = &flow->drawer[worker];
  block->stiff = block->stopped = false;
  block->reason[0] = '\0';
  find_starts(flow, d, block);
  for (size_t lane = 0; lane < block->n; lane++) {
    block->fate[lane] = AMBIT_FATE_REACHED;
    check_constraints(flow, d, block, lane);
  }
  if (flow->one_by_one || (block->alone && flow->draws)) return go_alone(flow, worker, block);
  go_in_lanes(flow, d, block);
  return AMBIT_OK;
}
