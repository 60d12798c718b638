/* test_split.c -- runs of pieces whose merged records do not depend on threads: with a solver of this file that sleeps,
** fails and misbehaves as told. */
#include "verbs/split/split.h"
#include "graph/tape.h"
#include "verbs/simulate/problem.h"
#include <ambit/code.h>
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>

#define NX 2
#define NTIME 6
#define THREADS_MAX 8

static void sleep_us(long us) {
  struct timespec t = { us / 1000000, us % 1000000 * 1000 };
  nanosleep(&t, NULL);
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* -- a solver for tests: the state rests, each instant is reached in `substeps` steps. Its context is a counter that
** tells whether two threads use it at once. */

typedef struct mischief {
  uint32_t substeps;
  long sleep_us;                  /* per step, times a number that depends on the piece */
  double fail_at[64], open_fails; /* time from which the piece by its least x fails; x whose open() is INVALID */
  bool skips, no_tube, domain, domain_everywhere, signed_zero;
  uint32_t dear;       /* the piece with this least x does as much as a hundred others; 0: none */
  uint32_t part_costs; /* operations of a step of what is not the whole; 0: as of the whole */
  double whole_ends;   /* the whole fails then */
  double top;          /* not 0: x is known within an eighth of the piece's width in x, y is -(x - top)^2 */
  _Atomic uint32_t shared;
} mischief;

static mischief behaviour; /* of the solver; set before a run */

typedef struct walker {
  const ambit_host *host;
  ambit_problem p;
  double lo[NX], hi[NX];
  uint32_t cell; /* floor of the least x */
  ambit_work *counted;
} walker;

static ambit_status walk_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self) {
  (void)option;
  walker *w = h->alloc(h, sizeof *w);
  w->host = h;
  w->p = *p;
  w->cell = (uint32_t)p->x0_lo[0];
  w->counted = ambit_work_open(h);
  if (behaviour.open_fails == p->x0_lo[0]) return (h->fail)(h, AMBIT_INVALID, "not this piece");
  if (behaviour.domain_everywhere || (behaviour.domain && p->x0_lo[0] >= 2))
    return (h->fail)(h, AMBIT_DOMAIN, "nothing from here");
  *self = w;
  return AMBIT_OK;
}

/* The set of a piece as wide as it is in x: x, and the range of -(x - top)^2. */
static void spread(walker *w) {
  double a = w->p.x0_lo[0], b = w->p.x0_hi[0], off = (b - a) / 8, top = behaviour.top;
  w->lo[0] = a - off, w->hi[0] = b + off;
  w->lo[1] = -fmax((a - top) * (a - top), (b - top) * (b - top));
  w->hi[1] = a <= top && top <= b ? 0 : -fmin((a - top) * (a - top), (b - top) * (b - top));
}

static bool is_whole(const walker *w) { return w->p.x0_hi[0] - w->p.x0_lo[0] == 8; }

static int32_t walk_step(walker *w, ambit_sink *s, double from, double to) {
  double tube_lo[NX], tube_hi[NX];
  uint32_t costs = is_whole(w) || !behaviour.part_costs ? 10 : behaviour.part_costs;
  w->counted->operations += behaviour.dear > 0 && w->cell == behaviour.dear ? 1000 : costs;
  for (int i = 0; i < NX; i++) {
    w->lo[i] = w->p.x0_lo[i] - to;
    w->hi[i] = w->p.x0_hi[i] + to;
  }
  if (behaviour.top != 0) spread(w);
  for (int i = 0; i < NX; i++) {
    tube_lo[i] = w->lo[i] - 1;
    tube_hi[i] = w->hi[i] + 1;
  }
  if (behaviour.signed_zero) w->lo[1] = w->hi[1] = w->cell % 2 ? -0.0 : 0.0;
  sleep_us(behaviour.sleep_us * (1 + w->cell * 7 % 5));
  const ambit_record r = { .size = sizeof r,
    .kind = AMBIT_REC_STEP,
    .t_from = from,
    .t_to = to,
    .nx = NX,
    .flags = w->cell == 3 ? AMBIT_F_PARTIAL : 0,
    .rigorous = 1,
    .lo = w->lo,
    .hi = w->hi,
    .tube_lo = behaviour.no_tube && w->cell == 1 ? NULL : tube_lo,
    .tube_hi = behaviour.no_tube && w->cell == 1 ? NULL : tube_hi,
    .order = w->cell };
  return s->progress(s, to / w->p.time[w->p.ntime - 1], "walking") || s->emit(s, &r);
}

static ambit_status walk(walker *w, ambit_sink *s) {
  for (uint32_t k = 0; k + 1 < w->p.ntime; k++) {
    double from = w->p.time[k], to = w->p.time[k + 1], h = (to - from) / behaviour.substeps;
    if (behaviour.skips && k == 2) continue;
    for (uint32_t i = 0; i < behaviour.substeps; i++) {
      double a = behaviour.skips && k == 3 ? w->p.time[2] : from + i * h,
             b = i + 1 == behaviour.substeps ? to : from + (i + 1) * h;
      if (behaviour.whole_ends > 0 && is_whole(w) && b > behaviour.whole_ends)
        return (w->host->fail)(w->host, AMBIT_UNABLE, "too wide at %g", a);
      if (behaviour.fail_at[w->cell] > 0 && b > behaviour.fail_at[w->cell])
        return (w->host->fail)(w->host, AMBIT_UNABLE, "cell %u ends at %g", w->cell, a);
      if (walk_step(w, s, a, b)) return AMBIT_STOPPED;
    }
  }
  return AMBIT_OK;
}

static ambit_status walk_run(void *self, ambit_sink *s) {
  walker *w = self;
  _Atomic uint32_t *inside = w->p.actx;
  if (atomic_fetch_add(inside, 1) != 0) atomic_store(&behaviour.shared, 1);
  ambit_status status = walk(w, s);
  atomic_fetch_sub(inside, 1);
  return status;
}

static void walk_close(void *self) { (void)self; }

static const ambit_solver walking = { .size = sizeof walking,
  .want = AMBIT_WANT_RHS,
  .needs_rigorous = 1,
  .open = walk_open,
  .run = walk_run,
  .close = walk_close };

/* -- what leaves */

typedef struct listener {
  ambit_sink sink; /* first */
  pthread_t thread;
  uint32_t records, stop_after, calls;
  bool strange, stop; /* a call from another thread, or progress that falls; stop at the next progress */
  const char *of;     /* what `done` is a share of */
  double done, value[NTIME][4 * NX], t[NTIME];
  uint32_t flags[NTIME], order[NTIME];
  bool tube[NTIME];
} listener;

static int32_t hear(ambit_sink *s, const ambit_record *r) {
  listener *l = (listener *)(void *)s;
  l->strange = l->strange || !pthread_equal(l->thread, pthread_self());
  uint32_t k = l->records++;
  memcpy(l->value[k], r->lo, NX * sizeof(double));
  memcpy(l->value[k] + NX, r->hi, NX * sizeof(double));
  l->tube[k] = r->tube_lo && r->tube_hi;
  if (l->tube[k]) {
    memcpy(l->value[k] + 2 * NX, r->tube_lo, NX * sizeof(double));
    memcpy(l->value[k] + 3 * NX, r->tube_hi, NX * sizeof(double));
  }
  l->t[k] = r->t_to;
  l->flags[k] = r->flags;
  l->order[k] = r->order;
  return l->records == l->stop_after;
}

static int32_t hear_progress(ambit_sink *s, double done, const char *message) {
  listener *l = (listener *)(void *)s;
  bool falls = done < l->done && l->of && strcmp(l->of, message) == 0;
  l->strange = l->strange || !pthread_equal(l->thread, pthread_self()) || falls || done > 1;
  l->done = done;
  l->of = message;
  l->calls++;
  return l->stop;
}

/* -- scenes: x0 in [0, 8] in 8 pieces (or 4 of x0 and 3 of y0) */

typedef struct stage {
  ambit_graph *graph;
  ambit_registry *registry;
  ambit_arena *arena;
  ambit_expr state[NX], rate[NX], initial[NX];
  ambit_system system;
  ambit_problem problem;
  const ambit_expr *unknown;
  const ambit_tape *start;
} stage;

static const char *const names[] = { "x", "y" }, *const units[] = { "1", "1" };

static void open_stage(stage *g) {
  static const double time[NTIME] = { 0, 1, 2, 3, 4, 5 };
  *g = (stage) { .graph = ambit_graph_open(), .registry = ambit_registry_open(NULL), .arena = ambit_arena_open() };
  for (size_t i = 0; i < NX; i++) {
    g->state[i] = ambit_graph_symbol(g->graph, names[i], units[i]);
    g->initial[i] = ambit_graph_unknown(g->graph, NULL, (ambit_interval) { 0, i == 0 ? 8 : 3 });
    g->rate[i] = ambit_graph_number(g->graph, 0);
  }
  g->system =
      (ambit_system) { g->graph, NX, names, units, g->state, g->rate, 0, NULL, NULL, NULL, 0, NULL, NULL, NULL };
  ambit_problem_request q = { .system = &g->system,
    .initial = g->initial,
    .ntime = NTIME,
    .time = time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_INITIAL,
    .unknown = &g->unknown };
  ambit_failure f = { 0 };
  if (ambit_problem_build(&q, g->arena, &g->problem, &f) != AMBIT_OK) fail_msg("%s", f.message);
  g->start = g->problem.initial;
}

static void close_stage(stage *g) {
  ambit_arena_close(g->arena);
  ambit_registry_close(g->registry);
  ambit_graph_close(g->graph);
}

typedef struct outcome {
  ambit_status returned;
  ambit_split_outcome split;
  ambit_failure failure;
  listener heard;
} outcome;

static outcome *play(stage *g, uint32_t threads, uint32_t x_parts, uint32_t y_parts, uint32_t stop_after) {
  static _Atomic uint32_t inside[THREADS_MAX];
  ambit_context context[THREADS_MAX] = { 0 };
  for (int i = 0; i < THREADS_MAX; i++) context[i].ctx = &inside[i];
  const uint32_t parts[NX] = { x_parts, y_parts };
  ambit_pieces pieces;
  outcome *o = calloc(1, sizeof *o);
  assert_int_equal(
      ambit_pieces_cut(g->arena, NX, g->problem.u_lo, g->problem.u_hi, parts, &pieces, &o->failure), AMBIT_OK);
  o->heard = (listener) {
    .sink = { sizeof(ambit_sink), hear, hear_progress }, .thread = pthread_self(), .stop_after = stop_after
  };
  static const char *const unknown[] = { "x", NULL };
  ambit_split s = { &g->problem, g->start, &pieces, unknown, g->registry, &walking, "walking", NULL, threads, context,
    &o->heard.sink, NULL };
  o->returned = ambit_split_run(&s, g->arena, &o->split, &o->failure);
  assert_false(o->heard.strange);
  assert_int_equal(behaviour.shared, 0);
  assert_int_equal(o->split.threads, threads);
  return o;
}

/* Cut where x reaches beyond [0, 8] by more than a 64th of that. */
static outcome *refine(stage *g, uint32_t threads, uint32_t most, double work, bool stop) {
  static _Atomic uint32_t inside[THREADS_MAX];
  static const double lo[NX * (NTIME - 1)] = { 0 };
  static const double hi[NX * (NTIME - 1)] = { [NX * (NTIME - 2)] = 8 }; /* at the end, and nothing else counts */
  ambit_context context[THREADS_MAX] = { 0 };
  for (int i = 0; i < THREADS_MAX; i++) context[i].ctx = &inside[i];
  const uint32_t parts[NX] = { 1, 1 };
  ambit_pieces pieces;
  outcome *o = calloc(1, sizeof *o);
  assert_int_equal(
      ambit_pieces_cut(g->arena, NX, g->problem.u_lo, g->problem.u_hi, parts, &pieces, &o->failure), AMBIT_OK);
  o->heard = (listener) { .sink = { sizeof(ambit_sink), hear, hear_progress }, .thread = pthread_self(), .stop = stop };
  static const char *const unknown[] = { "x", NULL };
  const ambit_cut_band band = { most, 1.0 / 64, work, lo, hi };
  ambit_split s = { &g->problem, g->start, &pieces, unknown, g->registry, &walking, "walking", NULL, threads, context,
    &o->heard.sink, &band };
  o->returned = ambit_split_run(&s, g->arena, &o->split, &o->failure);
  assert_false(o->heard.strange);
  assert_int_equal(behaviour.shared, 0);
  return o;
}

static void behave(mischief how) {
  if (!how.substeps) how.substeps = 2;
  if (!(how.open_fails > 0)) how.open_fails = -1; /* no piece's */
  memcpy(&behaviour, &how, sizeof how);
}

static void merges_pieces_in_time_order(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  behave((mischief) { .sleep_us = 200 });
  for (uint32_t threads = 1; threads <= 4; threads++) {
    outcome *o = play(&g, threads, 8, 3, 0);
    assert_int_equal(o->returned, AMBIT_OK);
    assert_int_equal(o->split.said, AMBIT_OK);
    assert_string_equal(o->split.why.message, "");
    assert_int_equal(o->heard.records, NTIME - 1);
    assert_true(o->heard.done == 1 && o->heard.calls > 0);
    for (uint32_t k = 0; k + 1 < NTIME; k++) {
      double t = k + 1, expected[] = { -t, -t, 8 + t, 3 + t, -t - 1, -t - 1, 9 + t, 4 + t };
      assert_true(o->heard.t[k] == t && o->heard.tube[k]);
      assert_memory_equal(o->heard.value[k], expected, sizeof expected);
      assert_int_equal(o->heard.flags[k], AMBIT_F_PARTIAL); /* of one of them */
      assert_int_equal(o->heard.order[k], 7);
    }
    free(o);
  }
  close_stage(&g);
}

static void one_missing_tube_is_none(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  behave((mischief) { .no_tube = true });
  outcome *o = play(&g, 2, 8, 1, 0);
  assert_int_equal(o->split.said, AMBIT_OK);
  for (uint32_t k = 0; k + 1 < NTIME; k++) assert_false(o->heard.tube[k]);
  free(o);
  close_stage(&g);
}

static void zeros_have_no_sign(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  behave((mischief) { .signed_zero = true, .sleep_us = 100 });
  for (int round = 0; round < 10; round++) {
    outcome *o = play(&g, 3, 8, 1, 0);
    for (uint32_t k = 0; k + 1 < NTIME; k++)
      assert_true(!signbit(o->heard.value[k][1]) && !signbit(o->heard.value[k][3]));
    free(o);
  }
  close_stage(&g);
}

/* Pieces 5 and 2 fail within the same interval, 6 later: 2 counts, whoever is first in time. */
static void the_piece_that_got_least_far_counts(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  for (int round = 0; round < 20; round++) {
    behave((mischief) { .sleep_us = round % 2 ? 200 : 10, .fail_at = { [2] = 3.6, [5] = 3.1, [6] = 4.5 } });
    outcome *o = play(&g, 1 + (uint32_t)round % 5, 8, 1, 0);
    assert_int_equal(o->returned, AMBIT_OK);
    assert_int_equal(o->split.said, AMBIT_UNABLE);
    assert_string_equal(o->split.why.message, "piece 3 of 8 (x in [2, 3]): cell 2 ends at 3.5");
    assert_int_equal(o->heard.records, 3);
    assert_true(o->heard.value[2][0] == -3 && o->heard.value[2][NX] == 11); /* all pieces, also the failed ones */
    free(o);
  }
  behave((mischief) { .fail_at = { [7] = 0.4 } }); /* before the first instant; the data are named as the user knows */
  outcome *o = play(&g, 2, 8, 3, 0);
  assert_string_equal(o->split.why.message, "piece 22 of 24 (x in [7, 8], datum 2 in [0, 1]): cell 7 ends at 0");
  assert_int_equal(o->heard.records, 0);
  free(o);
  close_stage(&g);
}

static void refuses_what_cannot_be_opened(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  for (uint32_t threads = 1; threads <= 3; threads++) {
    behave((mischief) { .open_fails = 4 });
    outcome *o = play(&g, threads, 8, 1, 0);
    assert_int_equal(o->returned, AMBIT_INVALID);
    assert_string_equal(o->failure.message, "piece 5 of 8 (x in [4, 5]): not this piece");
    assert_int_equal(o->heard.records, 0);
    free(o);
  }
  close_stage(&g);
}

static void notices_a_missing_instant(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  behave((mischief) { .skips = true });
  outcome *o = play(&g, 2, 4, 1, 0);
  assert_int_equal(o->split.said, AMBIT_BROKEN);
  assert_non_null(strstr(o->split.why.message, "piece 1 of 4"));
  assert_non_null(strstr(o->split.why.message, "stepped over an instant"));
  assert_int_equal(o->heard.records, 2);
  free(o);
  close_stage(&g);
}

/* With constraints, a piece may hold no solution: it adds nothing. Without, the answer is that there is none. */
static void empty_pieces_add_nothing(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  behave((mischief) { .domain = true });
  outcome *o = play(&g, 2, 8, 1, 0);
  assert_int_equal(o->split.said, AMBIT_DOMAIN);
  assert_string_equal(o->split.why.message, "piece 3 of 8 (x in [2, 3]): nothing from here");
  free(o);
  g.problem.ninvariant = 1;
  o = play(&g, 2, 8, 1, 0);
  assert_int_equal(o->split.said, AMBIT_OK);
  assert_int_equal(o->heard.records, NTIME - 1);
  assert_true(o->heard.value[0][0] == -1 && o->heard.value[0][NX] == 3); /* x0 in [0, 2] */
  free(o);
  for (uint32_t threads = 1; threads <= 4; threads++) { /* whoever is done last */
    behave((mischief) { .domain_everywhere = true });
    o = play(&g, threads, 8, 1, 0);
    assert_int_equal(o->split.said, AMBIT_DOMAIN);
    assert_string_equal(o->split.why.message, "piece 1 of 8 (x in [0, 1]): nothing from here");
    free(o);
  }
  close_stage(&g);
}

static void stops_on_request(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  for (uint32_t threads = 1; threads <= 3; threads++) {
    behave((mischief) { .sleep_us = 100 });
    outcome *o = play(&g, threads, 8, 1, 2);
    assert_int_equal(o->split.said, AMBIT_STOPPED);
    assert_int_equal(o->heard.records, 2);
    free(o);
  }
  close_stage(&g);
}

/* -- Ctrl-C: asked for while pieces of seconds are under way */

static int32_t stop_soon(ambit_sink *s, double done, const char *message) {
  (void)done, (void)message;
  listener *l = (listener *)(void *)s;
  if (!l->calls++) l->done = now();
  return now() - l->done > 0.05;
}

static void stops_within_a_fifth_of_a_second(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  for (uint32_t threads = 1; threads <= 2; threads++) {
    behave((mischief) { .sleep_us = 2000, .substeps = 200 });
    static _Atomic uint32_t inside[2];
    ambit_context context[] = { { .ctx = &inside[0] }, { .ctx = &inside[1] } };
    const uint32_t parts[NX] = { 8, 1 };
    ambit_pieces pieces;
    ambit_failure f = { 0 };
    ambit_split_outcome out;
    listener l = { .sink = { sizeof(ambit_sink), hear, stop_soon }, .thread = pthread_self() };
    ambit_pieces_cut(g.arena, NX, g.problem.u_lo, g.problem.u_hi, parts, &pieces, &f);
    static const char *const unknown[] = { "x", NULL };
    ambit_split s = { &g.problem, g.start, &pieces, unknown, g.registry, &walking, "walking", NULL, threads, context,
      &l.sink, NULL };
    double start = now();
    assert_int_equal(ambit_split_run(&s, g.arena, &out, &f), AMBIT_OK);
    assert_int_equal(out.said, AMBIT_STOPPED);
    assert_true(now() - start < 0.05 + 0.2 + 0.1); /* the last: a busy machine */
  }
  close_stage(&g);
}

/* Only what holds 0 or 8 is too wide: 8 / 2^3 is the first width of which an eighth is at most 8 / 64. No part is lost:
** the one that holds `top` makes the greatest y. */
static void cuts_where_sets_are_too_wide(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  for (int n = 1; n < 16; n++) {
    behave((mischief) { .top = 0.5 * n, .sleep_us = n % 4 ? 0 : 100 });
    outcome *first = NULL;
    for (uint32_t threads = 1; threads <= 3; threads++) {
      outcome *o = refine(&g, threads, 80, 0, false);
      assert_int_equal(o->returned, AMBIT_OK);
      assert_int_equal(o->split.said, AMBIT_OK);
      assert_int_equal(o->heard.records, NTIME - 1);
      const double *end = o->heard.value[NTIME - 2], least = fmax(behaviour.top, 8 - behaviour.top);
      assert_true(end[0] <= 0 && end[0] >= -0.125 && end[NX] >= 8 && end[NX] <= 8.125);
      assert_true(end[1] == -least * least && end[NX + 1] == 0);
      assert_in_range(o->split.pieces, 8,
          23); /* a grid that is as fine in x, and cuts y in three as the first one does, takes 24 */
      if (!first) {
        first = o;
        continue;
      }
      assert_memory_equal(first->heard.value, o->heard.value, sizeof o->heard.value);
      assert_int_equal(first->split.pieces, o->split.pieces);
      free(o);
    }
    free(first);
  }
  close_stage(&g);
}

static void parts_that_fail_replace_nothing(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  behave((mischief) { .top = 1, .fail_at = { [4] = 4.5, [6] = 2, [7] = 2 } });
  outcome *o = refine(&g, 2, 100, 0, false);
  assert_int_equal(o->split.said, AMBIT_OK);
  assert_int_equal(o->heard.records, NTIME - 1);
  assert_true(o->heard.value[NTIME - 2][NX] >= 8 && o->heard.value[NTIME - 2][1] == -49);
  free(o);
  behave((mischief) { .top = 1, .fail_at = { [0] = 3.6 } }); /* and so does the whole */
  o = refine(&g, 2, 100, 0, false);
  assert_int_equal(o->split.said, AMBIT_UNABLE);
  assert_int_equal(o->heard.records, 3);
  assert_non_null(strstr(o->split.why.message, "cell 0 ends at 3.5"));
  free(o);
  close_stage(&g);
}

#define RUN (20.0 * (NTIME - 1)) /* operations of a run in two steps for each interval */

/* Counted, so that neither time nor threads have a part in it. */
static void a_band_is_kept_to_its_work(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  for (uint32_t threads = 1; threads <= 3; threads++) {
    behave((mischief) { .top = 3, .sleep_us = threads == 2 ? 100 : 0 });
    outcome *o = refine(&g, threads, 100, 28.5 * RUN, false); /* the whole, 8 parts; not 20 more */
    assert_int_equal(o->split.said, AMBIT_OK);
    assert_int_equal(o->split.pieces, 8);
    free(o);
    o = refine(&g, threads, 100, 29 * RUN, false);
    assert_int_equal(o->split.said, AMBIT_OK);
    assert_in_range(o->split.pieces, 9, 20);
    free(o);
    behave((mischief) { .top = 3, .dear = 5 }); /* what takes too long is not waited for; what it is a part of counts */
    o = refine(&g, threads, 100, 1000 * RUN, false);
    assert_int_equal(o->split.said, AMBIT_OK);
    assert_int_equal(o->heard.records, NTIME - 1);
    assert_true(o->split.pieces > 1 && (double)o->split.work.operations < 300 * RUN);
    assert_true(o->heard.value[NTIME - 2][0] <= 0 && o->heard.value[NTIME - 2][NX] >= 8);
    free(o);
  }
  close_stage(&g);
}

/* The whole fails early, so that its parts may do little: they are told to stop, and that is no contradiction. */
static void parts_that_creep_are_told(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  for (uint32_t threads = 1; threads <= 3; threads++) {
    behave((mischief) { .top = 3, .whole_ends = 1.2, .part_costs = 30 });
    outcome *o = refine(&g, threads, 100, 1000 * RUN, false);
    assert_int_equal(o->split.said, AMBIT_UNABLE);
    assert_string_equal(o->split.why.code, AMBIT_CODE_UNABLE_SHORT_STEPS);
    assert_in_range(o->heard.records, 1, NTIME - 2);
    free(o);
    behave((mischief) { .top = 3, .whole_ends = 1.2 }); /* parts that cost no more come to the end */
    o = refine(&g, threads, 100, 1000 * RUN, false);
    assert_int_equal(o->split.said, AMBIT_OK);
    assert_int_equal(o->heard.records, NTIME - 1);
    free(o);
  }
  close_stage(&g);
}

static void a_band_is_kept_to_its_runs(void **state) {
  (void)state;
  stage g;
  open_stage(&g);
  behave((mischief) { .top = 3 });
  outcome *o = refine(&g, 1, 32, 0, false); /* the whole, 8 parts, 2 halves for each datum; then no more than 19 */
  assert_int_equal(o->split.said, AMBIT_OK);
  assert_in_range(o->split.pieces, 7, 27);
  free(o);
  o = refine(&g, 1, 2, 0, false);
  assert_int_equal(o->split.pieces, 1);
  assert_true(o->heard.value[NTIME - 2][NX] == 9);
  free(o);
  o = refine(&g, 1, 100, RUN / 2, false);
  assert_int_equal(o->split.said, AMBIT_UNABLE);
  assert_non_null(strstr(o->split.why.message, "the work that cutting"));
  assert_string_equal(o->split.why.code, AMBIT_CODE_UNABLE_SHORT_STEPS);
  assert_in_range(o->heard.records, 1, NTIME - 2);
  free(o);
  o = refine(&g, 2, 100, 0, true);
  assert_int_equal(o->split.said, AMBIT_STOPPED);
  free(o);
  behave((mischief) { .top = 3, .open_fails = 4 });
  o = refine(&g, 2, 100, 0, false);
  assert_int_equal(o->returned, AMBIT_INVALID);
  assert_non_null(strstr(o->failure.message, "not this piece"));
  free(o);
  close_stage(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(merges_pieces_in_time_order),
    cmocka_unit_test(one_missing_tube_is_none),
    cmocka_unit_test(zeros_have_no_sign),
    cmocka_unit_test(the_piece_that_got_least_far_counts),
    cmocka_unit_test(refuses_what_cannot_be_opened),
    cmocka_unit_test(notices_a_missing_instant),
    cmocka_unit_test(empty_pieces_add_nothing),
    cmocka_unit_test(stops_on_request),
    cmocka_unit_test(stops_within_a_fifth_of_a_second),
    cmocka_unit_test(cuts_where_sets_are_too_wide),
    cmocka_unit_test(parts_that_fail_replace_nothing),
    cmocka_unit_test(a_band_is_kept_to_its_work),
    cmocka_unit_test(parts_that_creep_are_told),
    cmocka_unit_test(a_band_is_kept_to_its_runs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
