/* Watched conditions against sampling: solutions that are polynomials in time plus a constant offset, fed as records
** with dense enclosures, tubes or both; and the places where a mean value form must not be used. */
#include <ambit/watch.h>
#include "num/random.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#define N 2      /* states */
#define DEGREE 3 /* of the solutions */
#define STEPS 4  /* over [0, 2] */
#define SAMPLES 400
#define SLACK 1e-9

/* x_i(t) = sum_k a[i][k] t^k + offset, |offset| <= radius */
typedef struct world {
  ambit_graph *graph;
  ambit_arena *arena;
  ambit_expr state[N], rate[N];
  ambit_system system;
  double a[N][DEGREE + 1], radius, from, to;
  bool dense, tube;
} world;

static ambit_expr op(const world *w, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(w->graph, code, a, b);
}

static ambit_expr number(const world *w, double x) { return ambit_graph_number(w->graph, x); }

static world open_world(void) {
  static const char *const name[] = { "x", "y" }, *const unit[] = { "1", "1" };
  world w = { .graph = ambit_graph_open(), .arena = ambit_arena_open(), .to = 2, .dense = true };
  for (int i = 0; i < N; i++) w.state[i] = ambit_graph_symbol(w.graph, name[i], unit[i]);
  w.system = (ambit_system) { .graph = w.graph, .nx = N, .name = name, .unit = unit };
  return w;
}

static void close_world(world *w) {
  ambit_arena_close(w->arena);
  ambit_graph_close(w->graph);
}

/* x_i' as an expression of time, from the coefficients. The system points into the world from now on. */
static void write_rates(world *w) {
  ambit_expr t = ambit_graph_time(w->graph);
  for (int i = 0; i < N; i++) {
    w->rate[i] = number(w, 0);
    for (int k = DEGREE; k >= 1; k--)
      w->rate[i] = op(w, AMBIT_OP_ADD, op(w, AMBIT_OP_MUL, w->rate[i], t), number(w, k * w->a[i][k]));
  }
  w->system.state = w->state;
  w->system.rate = w->rate;
}

static double position(const world *w, int i, double t) {
  double x = 0;
  for (int k = DEGREE; k >= 0; k--) x = x * t + w->a[i][k];
  return x;
}

/* Coefficients of state i about time t. */
static void shift(const world *w, int i, double t, double out[DEGREE + 1]) {
  memcpy(out, w->a[i], sizeof w->a[i]);
  for (int k = 0; k < DEGREE; k++)
    for (int j = DEGREE - 1; j >= k; j--) out[j] += t * out[j + 1];
}

/* Records of STEPS equal steps. */
static void feed(const world *w, ambit_sink *sink) {
  for (int n = 0; n < STEPS; n++) {
    double t0 = w->from + (w->to - w->from) * n / STEPS, t1 = w->from + (w->to - w->from) * (n + 1) / STEPS;
    double lo[N], hi[N], tube_lo[N], tube_hi[N], mid[N][DEGREE + 1], rad[N][DEGREE + 1] = { 0 };
    double r = w->radius + 1e-13;
    for (int i = 0; i < N; i++) {
      shift(w, i, t0, mid[i]);
      rad[i][0] = r;
      lo[i] = position(w, i, t1) - r;
      hi[i] = position(w, i, t1) + r;
      tube_lo[i] = INFINITY;
      tube_hi[i] = -INFINITY;
      for (int s = 0; s <= 64; s++) { /* what is between the samples is less than a 4000th of the largest curvature */
        double x = position(w, i, t0 + (t1 - t0) * s / 64);
        tube_lo[i] = fmin(tube_lo[i], x - r - 0.01);
        tube_hi[i] = fmax(tube_hi[i], x + r + 0.01);
      }
    }
    ambit_record record = { .size = sizeof record, .kind = AMBIT_REC_STEP, .t_from = t0, .t_to = t1, .nx = N };
    record.lo = lo;
    record.hi = hi;
    if (w->tube) record.tube_lo = tube_lo, record.tube_hi = tube_hi;
    if (w->dense) record.ndense = DEGREE + 1, record.dense_mid = mid[0], record.dense_rad = rad[0];
    assert_int_equal(sink->emit(sink, &record), 0);
  }
}

static ambit_watch_finding watch(const world *w, ambit_expr g, uint32_t kind, bool complete) {
  const ambit_watch_condition condition = { .g = g, .kind = kind, .name = "g" };
  const ambit_watch_request q = { .system = &w->system, .ncondition = 1, .condition = &condition, .cuts = 64 };
  ambit_watch *watch;
  ambit_watch_finding finding;
  ambit_failure f = { 0 };
  if (ambit_watch_open(&q, w->arena, &watch, &f) != AMBIT_OK) fail_msg("%s", f.message);
  feed(w, ambit_watch_sink(watch));
  ambit_watch_end(watch, complete, &finding);
  return finding;
}

/* -- random conditions */

typedef struct form {
  double c[7]; /* of 1, x, y, x y, x^2, sin x, t y */
} form;

static ambit_expr express(const world *w, const form *q) {
  ambit_expr x = w->state[0], y = w->state[1], t = ambit_graph_time(w->graph), sum = number(w, q->c[0]);
  ambit_expr term[] = { x, y, op(w, AMBIT_OP_MUL, x, y), op(w, AMBIT_OP_SQR, x, x), op(w, AMBIT_OP_SIN, x, x),
    op(w, AMBIT_OP_MUL, t, y) };
  for (int k = 0; k < 6; k++) sum = op(w, AMBIT_OP_ADD, sum, op(w, AMBIT_OP_MUL, number(w, q->c[k + 1]), term[k]));
  return sum;
}

static double value(const form *q, double x, double y, double t) {
  return q->c[0] + q->c[1] * x + q->c[2] * y + q->c[3] * x * y + q->c[4] * x * x + q->c[5] * sin(x) + q->c[6] * t * y;
}

/* max, min and last value of g along one solution */
static void sample(const world *w, const form *q, double dx, double dy, double out[3]) {
  out[0] = -INFINITY;
  out[1] = INFINITY;
  for (int s = 0; s <= SAMPLES; s++) {
    double t = w->from + (w->to - w->from) * s / SAMPLES;
    out[2] = value(q, position(w, 0, t) + dx, position(w, 1, t) + dy, t);
    out[0] = fmax(out[0], out[2]);
    out[1] = fmin(out[1], out[2]);
  }
}

static void judge(const world *w, const form *q, uint32_t kind, const ambit_watch_finding *found, int tally[3]) {
  static const int which[] = { 0, 2, 1 }; /* of sample(): by AMBIT_WATCH_* */
  assert_false(found->holds && found->fails);
  tally[found->holds ? 0 : found->fails ? 1 : 2]++;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++) {
      double all[3];
      sample(w, q, i * w->radius, j * w->radius, all);
      double truth = all[which[kind]];
      if (found->holds) assert_true(truth <= SLACK);
      if (found->fails && kind != AMBIT_WATCH_ALWAYS) assert_true(truth > -SLACK);
      /* sampling may miss the very top of g, but not the bounds' other side */
      if (kind != AMBIT_WATCH_ONCE) assert_true(truth <= found->bound.hi + SLACK);
      if (kind != AMBIT_WATCH_ALWAYS) assert_true(truth >= found->bound.lo - SLACK);
      if (ambit_interval_is_empty(found->when)) continue;
      double t = ambit_interval_mid(found->when);
      double g = value(q, position(w, 0, t) + i * w->radius, position(w, 1, t) + j * w->radius, t);
      assert_true(g >= found->value.lo - SLACK && g <= found->value.hi + SLACK);
      assert_true(kind == AMBIT_WATCH_ONCE ? found->value.hi <= 0 : found->value.lo > 0);
    }
}

static void agrees_with_sampling(void **unused) {
  (void)unused;
  ambit_random r = { 20240601 };
  const ambit_interval unit = { -1, 1 };
  int tally[3] = { 0 };
  for (int n = 0; n < 300; n++) {
    world w = open_world();
    form q;
    for (int i = 0; i < N; i++)
      for (int k = 0; k <= DEGREE; k++) w.a[i][k] = ambit_random_in(&r, unit);
    for (int k = 0; k < 7; k++) q.c[k] = ambit_random_in(&r, unit);
    w.radius = n % 3 == 0 ? 0 : n % 3 == 1 ? 0.001 : 0.05;
    w.dense = n % 4 != 0;
    w.tube = n % 4 != 1;
    if (n % 5 == 0) w.from = 2, w.to = -1;
    write_rates(&w);
    /* half of them near the edge: the offset is such that the sampled extreme is almost zero */
    double all[3];
    sample(&w, &q, 0, 0, all);
    uint32_t kind = (uint32_t)n % 3;
    if (n % 2)
      q.c[0] -= all[kind == AMBIT_WATCH_ALWAYS ? 0 : kind == AMBIT_WATCH_END ? 2 : 1] + (n % 4 == 1 ? 0.02 : -0.02);
    ambit_watch_finding found = watch(&w, express(&w, &q), kind, true);
    judge(&w, &q, kind, &found, tally);
    close_world(&w);
  }
  assert_true(tally[0] > 60 && tally[1] > 60); /* it decides, and both ways */
  assert_true(tally[2] < 150);
}

static void is_sharp_with_dense_enclosures(void **unused) {
  (void)unused;
  world w = open_world();
  w.a[0][0] = 0; /* x = 2 t - t^2: max 1 at t = 1, inside a step of other bounds */
  w.a[0][1] = 2;
  w.a[0][2] = -1;
  w.to = 1.9;
  write_rates(&w);
  ambit_watch_finding f = watch(&w, op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 1 + 1e-6)), AMBIT_WATCH_ALWAYS, true);
  assert_true(f.holds && !f.fails);
  f = watch(&w, op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 1 - 1e-6)), AMBIT_WATCH_ALWAYS, true);
  assert_true(f.fails && !f.holds);
  f = watch(&w, op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 1)), AMBIT_WATCH_ALWAYS, true); /* touches */
  assert_true(!f.fails && !f.holds);
  assert_true(f.bound.lo > -1e-9 && f.bound.lo <= 0 && f.bound.hi >= 0 && f.bound.hi < 1e-9);
  close_world(&w);
}

/* max |g| over time and over the offsets of a solution: never below what is sampled, and not far above it. */
static void bounds_the_greatest_value(void **unused) {
  (void)unused;
  ambit_random r = { 777 };
  const ambit_interval unit = { -1, 1 };
  double loosest = 0;
  for (int n = 0; n < 100; n++) {
    world w = open_world();
    form q;
    for (int i = 0; i < N; i++)
      for (int k = 0; k <= DEGREE; k++) w.a[i][k] = ambit_random_in(&r, unit);
    for (int k = 0; k < 7; k++) q.c[k] = ambit_random_in(&r, unit);
    w.radius = n % 2 ? 0 : 0.01;
    w.dense = n % 5 != 0;
    w.tube = n % 5 != 1;
    if (n % 7 == 0) w.from = 2, w.to = -1;
    write_rates(&w);
    double most = 0;
    for (int i = -1; i <= 1; i++)
      for (int j = -1; j <= 1; j++) {
        double all[3];
        sample(&w, &q, i * w.radius, j * w.radius, all);
        most = fmax(most, fmax(fabs(all[0]), fabs(all[1])));
      }
    ambit_watch_finding f = watch(&w, express(&w, &q), AMBIT_WATCH_MOST, true);
    assert_true(f.bound.hi >= most - SLACK);
    if (w.dense) loosest = fmax(loosest, f.bound.hi / most);
    close_world(&w);
  }
  assert_true(loosest < 1.2);
}

static void gives_up_at_a_limit(void **unused) {
  (void)unused;
  world w = open_world();
  w.a[0][1] = 1; /* x = t, y = 0 */
  write_rates(&w);
  ambit_watch_condition c[] = { { .g = w.state[0], .kind = AMBIT_WATCH_MOST, .name = "g", .limit = 0.6, .rivals = 1 },
    { .g = w.state[0], .kind = AMBIT_WATCH_MOST, .name = "h", .limit = 1.2, .rivals = UINT32_MAX } };
  const ambit_watch_request q = { .system = &w.system, .ncondition = 2, .condition = c, .cuts = 64 };
  const double end[] = { 0.5, 1, 1.5, 2 };
  ambit_watch *one;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_watch_open(&q, w.arena, &one, &f), AMBIT_OK);
  for (int n = 0; n < 4; n++) {
    double lo[N] = { end[n] }, hi[N] = { end[n] }, tube_lo[N] = { end[n] - 0.5 };
    const ambit_record record = { .size = sizeof record,
      .kind = AMBIT_REC_STEP,
      .t_from = end[n] - 0.5,
      .t_to = end[n],
      .nx = N,
      .lo = lo,
      .hi = hi,
      .tube_lo = tube_lo,
      .tube_hi = hi };
    int32_t stop = ambit_watch_sink(one)->emit(ambit_watch_sink(one), &record);
    assert_int_equal(stop != 0, end[n] > 1.2); /* both limits */
    assert_int_equal(ambit_watch_gave_up(one), end[n] > 1.2);
  }
  close_world(&w);
}

/* -- where g is not smooth or not defined */

/* x = t - 1/2 on [0, 1]: the angle of (-1, x) jumps from -pi to pi at t = 1/2 */
static void sees_the_jump_of_atan2(void **unused) {
  (void)unused;
  world w = open_world();
  w.to = 1;
  w.a[0][0] = -0.5;
  w.a[0][1] = 1;
  write_rates(&w);
  ambit_expr angle = op(&w, AMBIT_OP_ATAN2, w.state[0], number(&w, -1));
  ambit_watch_finding f = watch(&w, op(&w, AMBIT_OP_SUB, angle, number(&w, 3)), AMBIT_WATCH_ALWAYS, true);
  assert_true(f.fails && !f.holds);
  f = watch(&w, op(&w, AMBIT_OP_SUB, angle, number(&w, 3.2)), AMBIT_WATCH_ALWAYS, true);
  assert_true(f.holds);
  /* x = 1e-4 - (t - 0.7)^2: up and down again between the times that are looked at first, with a harmless slope */
  w.to = 2;
  w.a[0][0] = 1e-4 - 0.49;
  w.a[0][1] = 1.4;
  w.a[0][2] = -1;
  write_rates(&w);
  f = watch(&w, op(&w, AMBIT_OP_SUB, angle, number(&w, 3)), AMBIT_WATCH_ALWAYS, true);
  assert_false(f.holds);
  close_world(&w);
}

static void does_not_claim_where_nothing_is_defined(void **unused) {
  (void)unused;
  world w = open_world();
  w.a[0][0] = 1; /* x = 1 - t, negative after 1 */
  w.a[0][1] = -1;
  write_rates(&w);
  ambit_expr root = op(&w, AMBIT_OP_SUB, op(&w, AMBIT_OP_SQRT, w.state[0], 0), number(&w, 5));
  ambit_watch_finding f = watch(&w, root, AMBIT_WATCH_ALWAYS, true);
  assert_true(f.undefined && !f.holds && !f.fails);
  f = watch(&w, root, AMBIT_WATCH_END, true);
  assert_true(f.undefined && !f.holds && !f.fails);
  f = watch(&w, root, AMBIT_WATCH_ONCE, true); /* it was below zero while it was defined */
  assert_true(f.holds);
  memset(w.a, 0, sizeof w.a);
  w.a[0][0] = 0.05;
  w.radius = 0.1; /* some solutions are where there is no root */
  write_rates(&w);
  for (uint32_t kind = 0; kind < 3; kind++) {
    f = watch(&w, root, kind, true);
    assert_true(f.undefined && !f.holds && !f.fails);
  }
  close_world(&w);
}

static void bounds_kinks_without_a_derivative(void **unused) {
  (void)unused;
  world w = open_world();
  w.a[0][0] = -1; /* x = t - 1 on [0, 2] */
  w.a[0][1] = 1;
  write_rates(&w);
  ambit_expr size = op(&w, AMBIT_OP_ABS, w.state[0], 0);
  assert_true(watch(&w, op(&w, AMBIT_OP_SUB, size, number(&w, 1.01)), AMBIT_WATCH_ALWAYS, true).holds);
  assert_true(watch(&w, op(&w, AMBIT_OP_SUB, size, number(&w, 0.99)), AMBIT_WATCH_ALWAYS, true).fails);
  close_world(&w);
}

static void needs_the_whole_run(void **unused) {
  (void)unused;
  world w = open_world();
  w.a[0][1] = 1; /* x = t */
  write_rates(&w);
  ambit_watch_finding f = watch(&w, op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 5)), AMBIT_WATCH_ALWAYS, false);
  assert_true(!f.holds && !f.fails && isinf(f.bound.hi));
  f = watch(&w, op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 1)), AMBIT_WATCH_ALWAYS, false);
  assert_true(f.fails); /* what was seen, was seen */
  f = watch(&w, op(&w, AMBIT_OP_SUB, number(&w, 5), w.state[0]), AMBIT_WATCH_ONCE, false);
  assert_true(!f.holds && !f.fails && isinf(f.bound.lo));
  f = watch(&w, op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 5)), AMBIT_WATCH_END, false);
  assert_true(!f.holds && !f.fails);
  w.dense = false; /* a solver that says nothing between its steps proves nothing there, */
  w.a[1][0] = 1;   /* unless the slope is known without the states: now x' = y */
  w.rate[0] = w.state[1];
  f = watch(&w, op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 5)), AMBIT_WATCH_ALWAYS, true);
  assert_true(!f.holds && !f.fails);
  close_world(&w);
}

static void knows_the_start_without_the_solver(void **unused) {
  (void)unused;
  world w = open_world();
  w.a[0][0] = 1; /* x = 1 - t: most at the start, where the tube is 0.01 wider */
  w.a[0][1] = -1;
  w.dense = false;
  w.tube = true;
  write_rates(&w);
  ambit_expr u = ambit_graph_unknown(w.graph, "u", (ambit_interval) { 0, 1 });
  const ambit_expr initial[] = { op(&w, AMBIT_OP_ADD, number(&w, 0.5), u), number(&w, 0) };
  const ambit_watch_condition condition = { .g = op(&w, AMBIT_OP_SUB, w.state[0], number(&w, 0.999)), .name = "x" };
  const ambit_interval range = { 0.5, 0.5 };
  for (int known = 0; known < 2; known++) {
    const ambit_watch_request q = { .system = &w.system,
      .ncondition = 1,
      .condition = &condition,
      .cuts = 4,
      .initial = known ? initial : NULL,
      .nnarrow = 1,
      .narrow = &u,
      .range = &range };
    ambit_watch *one;
    ambit_watch_finding f;
    assert_int_equal(ambit_watch_open(&q, w.arena, &one, NULL), AMBIT_OK);
    feed(&w, ambit_watch_sink(one));
    ambit_watch_end(one, true, &f);
    assert_true(f.fails == known && !f.holds);
  }
  close_world(&w);
}

/* -- what conditions depend on */

static void takes_narrower_ranges(void **unused) {
  (void)unused;
  world w = open_world();
  write_rates(&w);
  ambit_expr u = ambit_graph_unknown(w.graph, "u", (ambit_interval) { 0, 2 });
  const ambit_watch_condition condition = { .g = op(&w, AMBIT_OP_SUB, u, number(&w, 1)), .name = "u" };
  const ambit_interval range[] = { { 0, 2 }, { 0, 0.5 }, { 1.5, 2 } };
  for (int n = 0; n < 3; n++) {
    const ambit_watch_request q = { .system = &w.system,
      .ncondition = 1,
      .condition = &condition,
      .cuts = 4,
      .nnarrow = 1,
      .narrow = &u,
      .range = &range[n] };
    ambit_watch *one;
    ambit_watch_finding f;
    assert_int_equal(ambit_watch_open(&q, w.arena, &one, NULL), AMBIT_OK);
    feed(&w, ambit_watch_sink(one));
    ambit_watch_end(one, true, &f);
    assert_true(f.holds == (n == 1) && f.fails == (n == 2));
  }
  close_world(&w);
}

static void refuses_strangers(void **unused) {
  (void)unused;
  world w = open_world();
  write_rates(&w);
  const ambit_watch_condition condition = { .g = ambit_graph_symbol(w.graph, "z", "1"), .name = "far" };
  const ambit_watch_request q = { .system = &w.system, .ncondition = 1, .condition = &condition, .cuts = 4 };
  ambit_watch *one;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_watch_open(&q, w.arena, &one, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "the condition `far` depends on `z`"));
  close_world(&w);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(agrees_with_sampling),
    cmocka_unit_test(is_sharp_with_dense_enclosures),
    cmocka_unit_test(bounds_the_greatest_value),
    cmocka_unit_test(gives_up_at_a_limit),
    cmocka_unit_test(sees_the_jump_of_atan2),
    cmocka_unit_test(does_not_claim_where_nothing_is_defined),
    cmocka_unit_test(bounds_kinks_without_a_derivative),
    cmocka_unit_test(needs_the_whole_run),
    cmocka_unit_test(knows_the_start_without_the_solver),
    cmocka_unit_test(takes_narrower_ranges),
    cmocka_unit_test(refuses_strangers),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
