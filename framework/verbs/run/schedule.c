/* schedule.c -- the samples of a run, in their true order, and doubles for them. */
#include "verbs/run/schedule.h"
#include "num/interval.h"
#include "verbs/run/rational.h"
#include <ambit/code.h>
#include <math.h>
#include <string.h>

#define MOST_SAMPLES 1e8

/* -- instants */

typedef struct clock {
  ambit_expr first, period; /* from the time 0 on; what is not exact is compared by these */
  bool exact;
  ambit_rational *first_exact, *period_exact;
} clock;

/* The clocks of a system, and behind them another instant: `first` of clock n. */
typedef struct clocks {
  ambit_graph *graph;
  const ambit_rational_service *rational;
  size_t n;
  clock *clock;          /* [n + 1] */
  ambit_rational *a, *b; /* of one comparison */
} clocks;

/* a sample */
typedef struct sample {
  size_t clock;
  uint32_t k;
  ambit_interval near; /* holds its instant */
} sample;

static bool open_clock(clocks *c, size_t i, ambit_expr first, ambit_expr period) {
  const ambit_rational_service *s = c->rational;
  clock *own = &c->clock[i];
  *own = (clock) { .first = first, .period = period, .first_exact = s->open(), .period_exact = s->open() };
  if (first == AMBIT_NO_EXPR || !own->first_exact || !own->period_exact) return false;
  own->exact = ambit_rational_of(s, c->graph, first, own->first_exact) &&
               ambit_rational_of(s, c->graph, period, own->period_exact);
  return true;
}

static void clocks_close(clocks *c) {
  const ambit_rational_service *s = c->rational;
  for (size_t i = 0; c->clock && i <= c->n; i++) s->close(c->clock[i].first_exact), s->close(c->clock[i].period_exact);
  if (s) s->close(c->a), s->close(c->b);
}

/* To be closed, whatever is returned. */
static ambit_status clocks_open(
    clocks *c, const ambit_schedule *q, ambit_expr other, ambit_arena *arena, ambit_failure *f) {
  const ambit_system *s = q->system;
  *c = (clocks) { .graph = s->graph, .n = s->njump };
  ambit_status status = ambit_rational_find(q->registry, &c->rational, f);
  if (status != AMBIT_OK) return status;
  c->a = c->rational->open(), c->b = c->rational->open();
  c->clock = ambit_arena_alloc(arena, (s->njump + 1) * sizeof *c->clock);
  if (!c->clock || !c->a || !c->b) return ambit_no_memory(f);
  memset(c->clock, 0, (s->njump + 1) * sizeof *c->clock);
  ambit_expr from = ambit_graph_number(s->graph, q->start), zero = ambit_graph_number(s->graph, 0);
  bool good = from != AMBIT_NO_EXPR && zero != AMBIT_NO_EXPR && open_clock(c, s->njump, other, zero);
  for (size_t i = 0; i < s->njump && good; i++)
    good = open_clock(c, i, ambit_graph_op(s->graph, AMBIT_OP_ADD, s->jump[i].first, from), s->jump[i].period);
  return good ? AMBIT_OK : ambit_no_memory(f);
}

static void exact_instant(const clocks *c, const sample *s, ambit_rational *to) {
  c->rational->go(to, c->clock[s->clock].first_exact, c->clock[s->clock].period_exact, s->k);
}

static sample sample_of(clocks *c, size_t i, uint32_t k) {
  const clock *own = &c->clock[i];
  sample s = { .clock = i, .k = k };
  if (own->exact) {
    exact_instant(c, &s, c->a);
    c->rational->enclose(c->a, &s.near.lo, &s.near.hi);
    return s;
  }
  s.near = (ambit_interval) { k, k };
  ambit_interval_op(AMBIT_OP_MUL, &s.near, s.near, ambit_graph_node(c->graph, own->period)->range);
  ambit_interval_op(AMBIT_OP_ADD, &s.near, s.near, ambit_graph_node(c->graph, own->first)->range);
  return s;
}

static ambit_expr expression_of(const clocks *c, const sample *s) {
  const clock *own = &c->clock[s->clock];
  ambit_expr way = ambit_graph_op(c->graph, AMBIT_OP_MUL, ambit_graph_number(c->graph, s->k), own->period);
  return ambit_graph_op(c->graph, AMBIT_OP_ADD, own->first, way);
}

#define UNKNOWN 2

/* -1: x is before y, 0: they are one instant, 1: behind it, or UNKNOWN */
static int order(clocks *c, const sample *x, const sample *y) {
  if (x->clock == y->clock) return (x->k > y->k) - (x->k < y->k);
  if (x->near.hi < y->near.lo) return -1;
  if (x->near.lo > y->near.hi) return 1;
  if (c->clock[x->clock].exact && c->clock[y->clock].exact) {
    exact_instant(c, x, c->a);
    exact_instant(c, y, c->b);
    return c->rational->compare(c->a, c->b);
  }
  ambit_expr e = ambit_graph_op(c->graph, AMBIT_OP_SUB, expression_of(c, x), expression_of(c, y));
  if (e == AMBIT_NO_EXPR) return UNKNOWN;
  ambit_interval way = ambit_graph_node(c->graph, e)->range;
  if (way.lo > 0 || way.hi < 0) return way.lo > 0 ? 1 : -1;
  return way.lo == 0 && way.hi == 0 ? 0 : UNKNOWN;
}

static ambit_status not_ordered(const sample *x, ambit_failure *f) {
  return ambit_fail(f, AMBIT_UNABLE,
      "sampled: near t = %.17g s it cannot be told whether two samples, or a sample and a time that was asked for, are "
      "at one instant: write periods, starts and times as decimals or quotients of decimals, or by one formula",
      x->near.lo);
}

/* -- the schedule */

typedef struct build {
  clocks clocks;
  sample *next, last; /* next [n] of each clock */
  sample end;
  double end_time;
  ambit_schedule *to;
  ambit_failure *f;
} build;

static ambit_status check(const ambit_system *s, double start, double end, double *most, ambit_failure *f) {
  *most = 0;
  if (end < start) return ambit_fail(f, AMBIT_INVALID, "a sampled system has no time before its start");
  for (size_t i = 0; i < s->njump; i++) {
    double period = ambit_graph_node(s->graph, s->jump[i].period)->range.lo;
    double n = (end - start) / period + 2;
    if (!(period > 0) || !(ambit_graph_node(s->graph, s->jump[i].first)->range.lo >= 0) || !(n < MOST_SAMPLES))
      return ambit_fail(f, AMBIT_INVALID,
          "sampled: a period of %g s is too short for a run of %g s: at most %g samples", period, end - start,
          MOST_SAMPLES);
    *most += n;
  }
  return AMBIT_OK;
}

/* The double for a sample, whose instant is that of the last one or not. */
static double place(const build *b, const sample *x, bool is_same) {
  const ambit_schedule *to = b->to;
  if (is_same) return to->time[to->n - 1];
  return x->near.lo < x->near.hi ? fmax(x->near.lo, nextafter(x->near.hi, -INFINITY)) : x->near.lo;
}

/* Puts the first of the next samples in the schedule; *done: it is not before the end. */
static ambit_status put_next(build *b, bool *done) {
  ambit_schedule *to = b->to;
  size_t which = 0;
  for (size_t i = 1; i < b->clocks.n; i++) {
    int side = order(&b->clocks, &b->next[i], &b->next[which]);
    if (side == UNKNOWN) return not_ordered(&b->next[i], b->f);
    if (side < 0) which = i;
  }
  sample x = b->next[which];
  int side = order(&b->clocks, &x, &b->end);
  if (side == UNKNOWN) return not_ordered(&x, b->f);
  *done = side >= 0;
  if (*done) return AMBIT_OK;
  side = to->n ? order(&b->clocks, &b->last, &x) : -1;
  if (side == UNKNOWN) return not_ordered(&x, b->f);
  double t = place(b, &x, side == 0);
  if (!(t < b->end_time) || (side != 0 && to->n && t <= to->time[to->n - 1]))
    return ambit_fail(b->f, AMBIT_UNABLE,
        "sampled: samples at different instants, or one and the end of the run, lie nearer to each other than doubles "
        "can tell, at t = %.17g s: write periods and starts all as texts or all as numbers, and end the run earlier or "
        "later",
        t);
  ambit_interval off = { t, t };
  ambit_interval_op(AMBIT_OP_SUB, &off, off, x.near);
  to->error = fmax(to->error, ambit_interval_mag(off));
  to->time[to->n] = t, to->number[to->n] = (uint32_t)which, to->count[to->n++] = x.k;
  b->last = x;
  b->next[which] = sample_of(&b->clocks, which, x.k + 1);
  return AMBIT_OK;
}

static ambit_status fill(build *b, double most) {
  bool done = b->clocks.n == 0;
  ambit_status status = AMBIT_OK;
  b->end = sample_of(&b->clocks, b->clocks.n, 0);
  for (size_t i = 0; i < b->clocks.n; i++) b->next[i] = sample_of(&b->clocks, i, 0);
  while (status == AMBIT_OK && !done && b->to->n < most) status = put_next(b, &done);
  return status;
}

ambit_status ambit_schedule_build(const ambit_system *s, ambit_registry *registry, double start, double end,
    const ambit_expr *final, ambit_arena *arena, ambit_schedule *to, ambit_failure *f) {
  double most;
  *to = (ambit_schedule) { .system = s, .registry = registry, .start = start };
  ambit_status status = check(s, start, end, &most, f);
  if (status != AMBIT_OK) return status;
  build b = { .end_time = end, .to = to, .f = f, .next = ambit_arena_alloc(arena, (s->njump + 1) * sizeof *b.next) };
  to->time = ambit_arena_alloc(arena, ((size_t)most + 1) * sizeof *to->time);
  to->number = ambit_arena_alloc(arena, ((size_t)most + 1) * sizeof *to->number);
  to->count = ambit_arena_alloc(arena, ((size_t)most + 1) * sizeof *to->count);
  if (!b.next || !to->time || !to->number || !to->count) return ambit_no_memory(f);
  status = clocks_open(&b.clocks, to, final ? *final : ambit_graph_number(s->graph, end), arena, f);
  if (status == AMBIT_OK) status = fill(&b, most);
  clocks_close(&b.clocks);
  return status;
}

/* *n := how many of them are before `at` */
static ambit_status search(const ambit_schedule *s, clocks *c, uint32_t *n, ambit_failure *f) {
  const sample at = sample_of(c, c->n, 0);
  uint32_t from = 0, to = s->n;
  while (from < to) {
    uint32_t mid = from + (to - from) / 2;
    sample x = sample_of(c, s->number[mid], s->count[mid]);
    int side = order(c, &x, &at);
    if (side == UNKNOWN) return not_ordered(&x, f);
    if (side < 0)
      from = mid + 1;
    else
      to = mid;
  }
  *n = from;
  return AMBIT_OK;
}

ambit_status ambit_schedule_before(const ambit_schedule *s, ambit_expr t, uint32_t *n, ambit_failure *f) {
  ambit_arena *arena = ambit_arena_open();
  if (!arena) return ambit_no_memory(f);
  clocks c;
  ambit_status status = clocks_open(&c, s, t, arena, f);
  if (status == AMBIT_OK) status = search(s, &c, n, f);
  clocks_close(&c);
  ambit_arena_close(arena);
  return status;
}
