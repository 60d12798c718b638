/* test_event.c -- zero crossings along records whose solutions are known: x(t) = x0 + t, so that the zeros of g(x) are
** those of a polynomial with given roots. */
#include <ambit/event.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define EVENTS_MAX 8

typedef struct line { /* x' = 1 with x0 in centre +- radius, watched */
  ambit_graph *graph;
  const char *name, *unit;
  ambit_expr x, rate;
  ambit_system system;
  double radius;
  size_t nevent;
  ambit_event event[EVENTS_MAX];
  bool dense, tube;
  double overlap; /* each step begins so much before the last one ended */
  double off;     /* of the records' clock */
  double spoil;   /* added to what the records say of x */
  ambit_sink sink;
  size_t steps, events; /* passed on */
  double last;          /* end of what was passed on last */
  bool in_order;
  bool was_open, is_open; /* after any step, after the last */
  ambit_event_watch *watch;
} line;

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  line *l = (line *)(void *)((char *)s - offsetof(line, sink));
  if (r->kind == AMBIT_REC_EVENT)
    l->events++;
  else
    l->steps++;
  l->is_open = ambit_event_watch_is_open(l->watch);
  l->was_open = l->was_open || l->is_open;
  if (r->t_to < l->last) l->in_order = false;
  l->last = r->kind == AMBIT_REC_EVENT ? r->t_from : r->t_to;
  return 0;
}

static int set_up(void **state) {
  line *l = calloc(1, sizeof *l);
  l->graph = ambit_graph_open();
  l->name = "x";
  l->unit = "1";
  l->x = ambit_graph_symbol(l->graph, "x", "1");
  l->rate = ambit_graph_number(l->graph, 1);
  l->system = (ambit_system) { .graph = l->graph, .nx = 1, .name = &l->name, .unit = &l->unit, .state = &l->x };
  l->system.rate = &l->rate;
  l->dense = l->tube = true;
  l->sink = (ambit_sink) { sizeof l->sink, emit, NULL };
  l->in_order = true;
  l->last = -INFINITY;
  *state = l;
  return 0;
}

static int tear_down(void **state) {
  line *l = *state;
  ambit_event_watch_close(l->watch);
  ambit_graph_close(l->graph);
  free(l);
  return 0;
}

/* -- formulas */

static ambit_expr number(line *l, double v) { return ambit_graph_number(l->graph, v); }

static ambit_expr op(line *l, uint32_t o, ambit_expr a, ambit_expr b) { return ambit_graph_op(l->graph, o, a, b); }

static ambit_expr minus(line *l, double root) { return op(l, AMBIT_OP_SUB, l->x, number(l, root)); }

/* prod (x - root[i]) */
static ambit_expr polynomial(line *l, size_t n, const double *root) {
  ambit_expr g = number(l, 1);
  for (size_t i = 0; i < n; i++) g = op(l, AMBIT_OP_MUL, g, minus(l, root[i]));
  return g;
}

static ambit_event *add(line *l, ambit_expr g, int direction) {
  ambit_event *e = &l->event[l->nevent++];
  *e = (ambit_event) { .name = "it", .g = g, .direction = direction };
  return e;
}

/* -- runs */

static ambit_status open_watch(line *l, double start, size_t room, ambit_failure *f) {
  double lo = start - l->radius, hi = start + l->radius;
  ambit_expr initial = ambit_graph_unknown(l->graph, "x0", (ambit_interval) { lo, hi });
  if (l->radius == 0) initial = number(l, start);
  ambit_event_watch_request q = { .system = &l->system, .initial = &initial, .t_start = start };
  q.n = l->nevent;
  q.event = l->event;
  q.room = room;
  return ambit_event_watch_open(&q, &l->watch, f);
}

/* From `start` to `end` in steps of h, time and x being the same number; the step count until the sink said stop. */
static size_t run(line *l, double start, double end, double h, size_t room) {
  ambit_failure f = { 0 };
  if (open_watch(l, start, room, &f) != AMBIT_OK) fail_msg("%s", f.message);
  ambit_sink *sink = ambit_event_watch_sink(l->watch, &l->sink);
  size_t steps = 0;
  double way = end < start ? -1 : 1;
  for (double t = start; t != end;) {
    double next = way * (t + way * h - end) > 0 ? end : t + way * h;
    if (steps) t -= way * l->overlap;
    double r = l->radius, at = next + l->spoil, from = t + l->spoil;
    double lo = at - r, hi = at + r, tube_lo = fmin(at, from) - r, tube_hi = fmax(at, from) + r;
    double mid[2] = { from, 1 }, rad[2] = { r, 0 };
    ambit_record record = { .size = sizeof record,
      .kind = AMBIT_REC_STEP,
      .t_from = t,
      .t_to = next,
      .nx = 1,
      .rigorous = 1,
      .clock_error = l->off,
      .lo = &lo,
      .hi = &hi };
    if (l->tube) record.tube_lo = &tube_lo, record.tube_hi = &tube_hi;
    if (l->dense) record.ndense = 2, record.dense_mid = mid, record.dense_rad = rad;
    steps++;
    t = next;
    if (sink->emit(sink, &record)) break;
  }
  ambit_event_watch_end(l->watch);
  return steps;
}

static const ambit_event_found *found(line *l, size_t i) {
  if (i >= ambit_event_watch_count(l->watch)) fail_msg("event %zu was not found", i);
  return ambit_event_watch_found(l->watch, i);
}

static void assert_crossed(line *l, size_t i, double root, int direction, double width) {
  const ambit_event_found *e = found(l, i);
  assert_int_equal(e->outcome, AMBIT_EVENT_CROSSED);
  assert_int_equal(e->direction, direction);
  assert_true(e->rigorous);
  if (!(e->t_lo <= root - l->radius && root + l->radius <= e->t_hi))
    fail_msg("root %.17g +- %g is not in [%.17g, %.17g]", root, l->radius, e->t_lo, e->t_hi);
  if (!(e->t_hi - e->t_lo <= width)) fail_msg("wide: [%.17g, %.17g]", e->t_lo, e->t_hi);
  assert_true(e->lo[0] <= root && root <= e->hi[0]);
}

static void assert_found(line *l, size_t n, uint32_t outcome) {
  assert_int_equal(ambit_event_watch_count(l->watch), n);
  for (size_t i = 0; i < n; i++) assert_int_equal(found(l, i)->outcome, outcome);
}

/* -- crossings */

static double uniform(uint64_t *seed) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) / 9007199254740992.0;
}

static void sort(size_t n, double *x) {
  for (size_t i = 1; i < n; i++)
    for (size_t k = i; k > 0 && x[k] < x[k - 1]; k--) {
      double swap = x[k];
      x[k] = x[k - 1];
      x[k - 1] = swap;
    }
}

static void roots_of_random_polynomials(void **state) {
  uint64_t seed = 1;
  for (int trial = 0; trial < 60; trial++) {
    if (trial) {
      tear_down(state);
      set_up(state);
    }
    line *l = *state;
    double root[5];
    size_t n = 1 + (size_t)(uniform(&seed) * 5);
    for (size_t i = 0; i < n; i++) root[i] = (double)i + 0.1 + 0.8 * uniform(&seed);
    sort(n, root);
    l->radius = trial % 3 == 0 ? 0 : trial % 3 == 1 ? 1e-9 : 1e-3;
    l->dense = trial % 4 != 3;
    add(l, polynomial(l, n, root), 0);
    run(l, -0.5, 5.5, 0.07 + uniform(&seed), 16);
    assert_int_equal(ambit_event_watch_count(l->watch), n);
    assert_int_equal(l->events, n);
    assert_true(l->in_order);
    for (size_t i = 0; i < n; i++) assert_crossed(l, i, root[i], (n - i) % 2 ? 1 : -1, 2.6 * l->radius + 1e-11);
  }
}

static void a_spoilt_enclosure_is_noticed(void **state) {
  line *l = *state;
  l->spoil = 1e-6;
  add(l, minus(l, 1), 0);
  run(l, 0, 2, 0.3, 4);
  const ambit_event_found *e = found(l, 0);
  assert_false(e->t_lo <= 1 && 1 <= e->t_hi);
}

static void a_zero_at_the_end_of_a_step(void **state) {
  line *l = *state;
  static const double root[] = { -0.5, 0.5 };
  add(l, polynomial(l, 2, root), 0);
  run(l, -1, 1, 0.5, 4);
  assert_int_equal(ambit_event_watch_count(l->watch), 2);
  assert_crossed(l, 0, -0.5, -1, 1e-12);
  assert_crossed(l, 1, 0.5, 1, 1e-12);
}

/* A set wider than many steps: the crossing is followed from record to record. */
static void a_wide_set_crosses_over_many_steps(void **state) {
  line *l = *state;
  l->radius = 0.5;
  add(l, minus(l, 1), 1);
  run(l, 0, 3, 0.01, 4);
  assert_int_equal(ambit_event_watch_count(l->watch), 1);
  assert_crossed(l, 0, 1, 1, 1.1);
}

/* A solver may go back a bit: nothing is counted twice. */
static void steps_that_overlap(void **state) {
  line *l = *state;
  static const double root[] = { 0.95, 1.95, 2.9 };
  l->overlap = 0.2;
  add(l, polynomial(l, 3, root), 0);
  run(l, 0, 4, 1, 8);
  assert_int_equal(ambit_event_watch_count(l->watch), 3);
  for (size_t i = 0; i < 3; i++) assert_crossed(l, i, root[i], i % 2 ? -1 : 1, 1e-11);
}

static void directions_are_told_apart(void **state) {
  line *l = *state;
  static const double root[] = { 1, 2, 3 };
  ambit_expr g = polynomial(l, 3, root);
  add(l, g, 1);
  add(l, g, -1);
  run(l, 0, 4, 0.3, 8);
  assert_int_equal(ambit_event_watch_count(l->watch), 3);
  assert_int_equal(found(l, 0)->event, 0);
  assert_int_equal(found(l, 1)->event, 1);
  assert_crossed(l, 0, 1, 1, 1e-11);
  assert_crossed(l, 1, 2, -1, 1e-11);
}

/* The direction is that of g as time grows, whichever way the run goes. */
static void backwards(void **state) {
  line *l = *state;
  static const double root[] = { 1, 2 };
  l->radius = 1e-6;
  add(l, polynomial(l, 2, root), 0);
  run(l, 3, 0, 0.3, 8);
  assert_int_equal(ambit_event_watch_count(l->watch), 2);
  assert_crossed(l, 0, 2, 1, 3e-6);
  assert_crossed(l, 1, 1, -1, 3e-6);
}

/* Without dense enclosure and tube x is known at the ends of the steps only: enough where g' = 1 whatever x. */
static void steps_without_a_tube(void **state) {
  line *l = *state;
  static const double root[] = { 1, -5 };
  l->dense = l->tube = false;
  add(l, minus(l, 1), 0);
  add(l, polynomial(l, 2, root), 0);
  run(l, 0.25, 2.25, 0.5, 4);
  size_t crossed = 0;
  for (size_t i = 0; i < ambit_event_watch_count(l->watch); i++)
    if (found(l, i)->event == 0) {
      assert_crossed(l, i, 1, 1, 0.5);
      crossed++;
    } else
      assert_true(found(l, i)->outcome != AMBIT_EVENT_CROSSED);
  assert_int_equal(crossed, 1);
}

/* -- what cannot be proved */

static void grazing_is_undecided(void **state) {
  line *l = *state;
  static const double touch[] = { 1, 1 }, flat[] = { 2, 2, 2 };
  add(l, polynomial(l, 2, touch), 0);
  add(l, polynomial(l, 3, flat), 0);
  run(l, 0, 3, 0.3, 8);
  assert_int_equal(ambit_event_watch_count(l->watch), 2);
  assert_int_equal(found(l, 0)->outcome, AMBIT_EVENT_TOUCHES);
  assert_true(found(l, 0)->t_lo <= 1 && 1 <= found(l, 0)->t_hi);
  assert_int_equal(found(l, 1)->outcome, AMBIT_EVENT_CROSSES);
  assert_true(found(l, 1)->t_lo <= 2 && 2 <= found(l, 1)->t_hi);
}

/* (x - 1)^2 + gap: missed, however closely, is no event; with -gap there are two. */
static void near_misses_are_decided(void **state) {
  for (double gap = 1e-2; gap > 1e-11; gap /= 10) {
    tear_down(state);
    set_up(state);
    line *l = *state;
    ambit_expr square = op(l, AMBIT_OP_SQR, minus(l, 1), 0);
    add(l, op(l, AMBIT_OP_ADD, square, number(l, gap)), 0);
    add(l, op(l, AMBIT_OP_SUB, square, number(l, gap)), 0);
    run(l, 0, 2.2, 0.3, 8);
    assert_found(l, 2, AMBIT_EVENT_CROSSED);
    assert_crossed(l, 0, 1 - sqrt(gap), -1, 1e-9);
    assert_crossed(l, 1, 1 + sqrt(gap), 1, 1e-9);
  }
}

/* Whatever lies before the surface crosses, whatever lies behind does not. */
static void a_set_on_both_sides_at_the_start(void **state) {
  line *l = *state;
  l->radius = 0.1;
  add(l, minus(l, 0), 1);
  add(l, minus(l, 0), -1); /* none of its */
  run(l, 0, 1, 0.03, 4);
  assert_found(l, 1, AMBIT_EVENT_STARTS);
  assert_int_equal(found(l, 0)->event, 0);
}

static void a_start_on_the_surface_is_no_event(void **state) {
  line *l = *state;
  add(l, minus(l, 0), 0);
  run(l, 0, 1, 0.3, 4);
  assert_found(l, 0, 0);
  tear_down(state);
  set_up(state);
  l = *state;
  l->radius = 1e-9; /* known to the caller, if not to the enclosure */
  add(l, minus(l, 0), 0)->starts_on = 1;
  run(l, 0, 1, 0.3, 4);
  assert_found(l, 0, 0);
}

static void a_start_that_must_be_left(void **state) {
  line *l = *state;
  add(l, minus(l, 0), 1)->must_leave = 1;  /* goes on in its direction */
  add(l, minus(l, 0), -1)->must_leave = 1; /* leaves it */
  add(l, minus(l, 0), 0)->must_leave = 1;  /* has none */
  run(l, 0, 1, 0.3, 4);
  assert_found(l, 1, AMBIT_EVENT_STARTS);
  assert_int_equal(found(l, 0)->event, 0);
}

static void a_run_that_ends_in_the_middle(void **state) {
  line *l = *state;
  l->radius = 0.1;
  add(l, minus(l, 1), 0);
  run(l, 0, 1, 0.3, 4);
  assert_found(l, 1, AMBIT_EVENT_PART);
  assert_int_equal(l->events, 1);
}

/* atan2 jumps by 2 pi where x passes 1: not a zero, although the sign changes. */
static void a_jump_is_no_crossing(void **state) {
  line *l = *state;
  add(l, op(l, AMBIT_OP_ATAN2, minus(l, 1), number(l, -1)), 0);
  run(l, 0, 2, 0.3, 4);
  for (size_t i = 0; i < ambit_event_watch_count(l->watch); i++)
    assert_true(found(l, i)->outcome != AMBIT_EVENT_CROSSED);
}

/* -- zeros at which g has no derivative */

/* Only `outcome`, at x = 1, for a set of that radius. */
static void assert_only_at_one(void **state, double radius, uint32_t outcome, ambit_expr (*formula)(line *)) {
  for (int backwards = 0; backwards < 2; backwards++) {
    tear_down(state);
    set_up(state);
    line *l = *state;
    l->radius = radius;
    add(l, formula(l), 0);
    run(l, backwards ? 2.2 : 0, backwards ? 0 : 2.2, 0.3, 8);
    assert_found(l, 1, outcome);
    assert_true(found(l, 0)->t_lo <= 1 - radius && 1 + radius <= found(l, 0)->t_hi);
    assert_true(found(l, 0)->t_hi - found(l, 0)->t_lo < 1e-7 + 3 * radius);
  }
}

static ambit_expr distance_of(line *l) {
  ambit_expr a = op(l, AMBIT_OP_SQR, minus(l, 1), 0), b = op(l, AMBIT_OP_SQR, op(l, AMBIT_OP_SIN, minus(l, 1), 0), 0);
  return op(l, AMBIT_OP_SQRT, op(l, AMBIT_OP_ADD, a, b), 0);
}

static ambit_expr root_of(line *l) { return op(l, AMBIT_OP_SQRT, minus(l, 1), 0); }
static ambit_expr magnitude_of(line *l) { return op(l, AMBIT_OP_ABS, minus(l, 1), 0); }
static ambit_expr arc_of(line *l) {
  return op(l, AMBIT_OP_ACOS, op(l, AMBIT_OP_SUB, number(l, 1), op(l, AMBIT_OP_SQR, minus(l, 1), 0)), 0);
}
static ambit_expr bend_of(line *l) {
  return op(l, AMBIT_OP_MAX, minus(l, 1), op(l, AMBIT_OP_MUL, number(l, 2), minus(l, 1)));
}
/* defined at x = 1 and nowhere else */
static ambit_expr instant_of(line *l) { return op(l, AMBIT_OP_SQRT, op(l, AMBIT_OP_NEG, magnitude_of(l), 0), 0); }

static void zeros_without_a_derivative(void **state) {
  for (double radius = 0; radius < 0.2; radius += 0.1) {
    assert_only_at_one(state, radius, AMBIT_EVENT_TOUCHES, distance_of);
    assert_only_at_one(state, radius, AMBIT_EVENT_TOUCHES, magnitude_of);
    assert_only_at_one(state, radius, AMBIT_EVENT_EDGE, root_of);
    assert_only_at_one(state, radius, AMBIT_EVENT_TOUCHES, arc_of);
    assert_only_at_one(state, radius, AMBIT_EVENT_CROSSES, bend_of);
    assert_only_at_one(state, radius, AMBIT_EVENT_EDGE, instant_of);
  }
}

/* |x - 1| - 1/2 has kinks elsewhere: its zeros are ordinary ones. */
static void zeros_beside_a_kink_are_certain(void **state) {
  line *l = *state;
  ambit_expr far = op(l, AMBIT_OP_SUB, magnitude_of(l), number(l, 0.5));
  add(l, far, 0);
  add(l, op(l, AMBIT_OP_MIN, minus(l, 0.25), far), 0);
  run(l, 0, 2.2, 0.3, 8);
  assert_int_equal(ambit_event_watch_count(l->watch), 5);
  double root[] = { 0.25, 0.5, 0.5, 1.5, 1.5 };
  int direction[] = { 1, -1, -1, 1, 1 };
  for (size_t i = 0; i < 5; i++) assert_crossed(l, i, root[i], direction[i], 1e-9);
}

/* Where g leaves its domain without being 0 there is no event, and no sign is carried over. */
static void edges_without_a_zero(void **state) {
  line *l = *state;
  add(l, op(l, AMBIT_OP_LOG, op(l, AMBIT_OP_DIV, minus(l, 1), number(l, 8)), 0), 0);
  add(l, op(l, AMBIT_OP_DIV, number(l, 1), minus(l, 1)), 0);
  add(l, op(l, AMBIT_OP_SQRT, op(l, AMBIT_OP_SUB, number(l, -3), op(l, AMBIT_OP_SQR, l->x, 0)), 0), 0);
  run(l, 0, 2.2, 0.3, 8);
  assert_found(l, 0, 0);
}

/* -- ends */

static void stops_behind_the_first(void **state) {
  line *l = *state;
  static const double root[] = { 1, 1.01, 2 };
  add(l, polynomial(l, 3, root), 0);
  add(l, minus(l, 1.005), 0)->stop = 1;
  assert_int_equal(run(l, 0, 4, 0.3, 8), 4);
  assert_int_equal(ambit_event_watch_count(l->watch), 2); /* 1 and 1.005; 1.01 and 2 come after the end */
  assert_int_equal(ambit_event_watch_stopped_by(l->watch), 1);
  assert_crossed(l, 1, 1.005, 1, 1e-11);
  assert_int_equal(l->steps, 4);
}

/* Two that may come in either order are both reported. */
static void events_that_overlap(void **state) {
  line *l = *state;
  l->radius = 0.1;
  add(l, minus(l, 1), 0)->stop = 1;
  add(l, minus(l, 1.05), 0)->stop = 1;
  run(l, 0, 4, 0.05, 8);
  assert_int_equal(ambit_event_watch_count(l->watch), 2);
  assert_true(found(l, 1)->t_lo <= found(l, 0)->t_hi);
}

/* The first is open from 0.8 to 1.2, over two steps, and the second happens within the first step. */
static void begun_first_ended_last(line *l, double way) {
  double touched[] = { way, way };
  l->radius = 0.2;
  add(l, polynomial(l, 2, touched), 0)->stop = 1;
  add(l, op(l, AMBIT_OP_SUB, ambit_graph_time(l->graph), number(l, way * 0.95)), 0);
  run(l, 0, 2 * way, 1, 8);
  assert_int_equal(ambit_event_watch_count(l->watch), 2);
  assert_int_equal(found(l, 0)->event, 0);
  assert_int_equal(found(l, 1)->event, 1);
  assert_int_equal(ambit_event_watch_stopped_by(l->watch), 0);
}

static void are_in_the_order_of_their_beginnings(void **state) {
  line *l = *state;
  begun_first_ended_last(l, 1);
  tear_down(state);
  set_up(state);
  begun_first_ended_last(*state, -1);
}

static void more_events_than_room(void **state) {
  line *l = *state;
  add(l, op(l, AMBIT_OP_SIN, l->x, 0), 0);
  assert_true(run(l, 0.5, 100, 0.5, 5) < 199);
  assert_true(ambit_event_watch_is_full(l->watch));
  assert_int_equal(ambit_event_watch_count(l->watch), 5);
  for (size_t i = 0; i < 5; i++) assert_crossed(l, i, 3.141592653589793 * (double)(i + 1), i % 2 ? 1 : -1, 1e-11);
}

/* Solutions and their times are beside those of the records: zeros may be so much earlier or later, and g that reads
** the time is taken at all of it, but not before the start. */
static void a_clock_that_is_off(void **state) {
  for (double way = -1; way <= 1; way += 2) {
    line *l = *state;
    l->off = 0.01, l->radius = 0.02;
    add(l, minus(l, 1), 0);
    run(l, 1 - way, 1 + way, 0.3, 8);
    assert_crossed(l, 0, 1, 1, 0.07);
    assert_true(found(l, 0)->t_lo <= 1 - 0.03 && found(l, 0)->t_hi >= 1 + 0.03);
    tear_down(state);
    set_up(state);
    l = *state;
    l->off = 0.01;
    ambit_expr ahead = op(l, AMBIT_OP_SUB, ambit_graph_time(l->graph), l->x); /* 0 by the records' clock */
    add(l, op(l, AMBIT_OP_ADD, ahead, number(l, 0.005)), 0);
    add(l, op(l, AMBIT_OP_ADD, ahead, number(l, 0.011)), 0);
    add(l, op(l, AMBIT_OP_SUB, ambit_graph_time(l->graph), number(l, 1 - 1.005 * way)), 0);
    run(l, 1 - way, 1 + way, 0.3, 8);
    assert_int_equal(ambit_event_watch_count(l->watch), 1);
    assert_int_equal(found(l, 0)->event, 0);
    assert_true(found(l, 0)->outcome != AMBIT_EVENT_CROSSED);
    assert_true(way < 0 ? found(l, 0)->t_hi <= 2 : found(l, 0)->t_lo >= 0);
    tear_down(state);
    set_up(state);
  }
}

static void says_whether_one_is_open(void **state) {
  line *l = *state;
  l->radius = 0.1;
  add(l, minus(l, 1), 0);
  run(l, 0, 3, 0.95, 4); /* the first step ends within the passage */
  assert_true(l->was_open);
  assert_false(l->is_open);
}

/* -- refusals */

static void assert_refused(line *l, const char *part) {
  ambit_failure f = { 0 };
  assert_true(open_watch(l, 0, 4, &f) != AMBIT_OK);
  assert_null(l->watch);
  if (!strstr(f.message, part)) fail_msg("\"%s\" expected, got: %s", part, f.message);
}

static void refuses_foreign_variables(void **state) {
  line *l = *state;
  add(l, ambit_graph_symbol(l->graph, "elbow", "rad"), 0)->name = "stop";
  assert_refused(l, "event `stop`: g depends on `elbow`");
}

int main(void) {
#define T(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
  const struct CMUnitTest tests[] = { T(roots_of_random_polynomials), T(a_spoilt_enclosure_is_noticed),
    T(a_zero_at_the_end_of_a_step), T(a_wide_set_crosses_over_many_steps), T(steps_that_overlap),
    T(directions_are_told_apart), T(backwards), T(steps_without_a_tube), T(grazing_is_undecided),
    T(near_misses_are_decided), T(a_set_on_both_sides_at_the_start), T(a_start_on_the_surface_is_no_event),
    T(a_start_that_must_be_left), T(are_in_the_order_of_their_beginnings), T(a_run_that_ends_in_the_middle),
    T(a_jump_is_no_crossing), T(stops_behind_the_first), T(events_that_overlap), T(more_events_than_room),
    T(a_clock_that_is_off), T(says_whether_one_is_open), T(zeros_without_a_derivative),
    T(zeros_beside_a_kink_are_certain), T(edges_without_a_zero), T(refuses_foreign_variables) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
