/* test_sample_lanes.c -- the tableau fulfils the conditions of its orders, of all rooted trees; lanes agree with closed
** forms, alone and side by side, and tighter tolerances give smaller errors. */
#include "graph/tape.h"
#include "verbs/run/context.h"
#include "verbs/simulate/problem.h"
#include "verbs/sample/sample_lanes.h"
#include "verbs/sample/sample_tableau.h"
#include "verbs/scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

/* -- order conditions: for each rooted tree t, sum_i b_i phi_i(t) = 1 / gamma(t) (Butcher) */

#define TREES_MAX 256
#define ORDER_MAX 8

typedef struct tree {
  int order;
  double gamma, phi[AMBIT_STAGES];
} tree;

typedef struct forest {
  int n;
  tree tree[TREES_MAX];
} forest;

/* phi of a child as its parent sees it: sum_j a_ij phi_j */
static double below(const tree *child, int i) {
  double sum = 0;
  for (int j = 0; j < i; j++) sum += ambit_stage_weight[i][j] * child->phi[j];
  return sum;
}

/* All trees of `order` whose children have numbers from `first` down and orders that add up to `left`. */
static void grow(forest *f, tree t, int first, int left) {
  if (left == 0) {
    t.gamma *= t.order;
    assert_true(f->n < TREES_MAX);
    f->tree[f->n++] = t;
    return;
  }
  for (int k = first; k >= 0; k--) {
    const tree *child = &f->tree[k];
    tree next = t;
    if (child->order > left) continue;
    next.gamma *= child->gamma;
    for (int i = 0; i < AMBIT_STAGES; i++) next.phi[i] *= below(child, i);
    grow(f, next, k, left - child->order);
  }
}

static void plant(forest *f, int order) {
  tree root = { .order = order, .gamma = 1 };
  for (int i = 0; i < AMBIT_STAGES; i++) root.phi[i] = 1;
  grow(f, root, f->n - 1, order - 1);
}

static void tableau_has_its_orders(void **state) {
  (void)state;
  static const int counts[] = { 1, 2, 4, 8, 17, 37, 85, 200 }; /* trees up to each order */
  forest *f = calloc(1, sizeof *f);
  assert_non_null(f);
  for (int order = 1; order <= ORDER_MAX; order++) {
    plant(f, order);
    assert_int_equal(f->n, counts[order - 1]);
  }
  double worst = 0;
  for (int k = 0; k < f->n; k++) {
    double step = 0, third = 0, fifth = 0;
    for (int i = 0; i < AMBIT_STAGES; i++) {
      step += ambit_step_weight[i] * f->tree[k].phi[i];
      third += ambit_error_weight_3[i] * f->tree[k].phi[i];
      fifth += ambit_error_weight_5[i] * f->tree[k].phi[i];
    }
    worst = fmax(worst, fabs(step - 1 / f->tree[k].gamma));
    if (f->tree[k].order <= 3) assert_true(fabs(third) < 1e-14);
    if (f->tree[k].order <= 5) assert_true(fabs(fifth) < 1e-14);
  }
  assert_true(worst < 1e-14);
  for (int i = 0; i < AMBIT_STAGES; i++) {
    double sum = 0;
    for (int j = 0; j < i; j++) sum += ambit_stage_weight[i][j];
    assert_true(fabs(sum - ambit_stage_time[i]) < 1e-14);
  }
  free(f);
}

/* -- x'' = -k x with time and parameters: x = x0 cos(sqrt(k) t), and a state that is sin(t) by its rate cos(t) */

typedef struct bench {
  scene *s;
  ambit_arena *arena;
  ambit_problem problem;
  ambit_context context;
  ambit_lanes *lanes;
} bench;

static const double times[] = { 0, 0.3, 5 };
#define NX 3u
#define WIDTH 32u

static void open_lanes(bench *b, const double *time) {
  ambit_failure f = { 0 };
  ambit_problem_request q = {
    .system = &b->s->system, .initial = b->s->initial, .ntime = 3, .time = time, .want = AMBIT_WANT_RHS
  };
  if (ambit_problem_build(&q, b->arena, &b->problem, &f) != AMBIT_OK) fail_msg("%s", f.message);
  if (ambit_context_open(b->s->registry, "real", 0, NULL, 0, &b->context, &f) != AMBIT_OK) fail_msg("%s", f.message);
  if (ambit_lanes_open(&b->problem, b->context.arithmetic, b->context.ctx, WIDTH, &b->lanes, &f) != AMBIT_OK)
    fail_msg("%s", f.message);
}

static void open_bench(bench *b) {
  *b = (bench) { .s = scene_open(), .arena = ambit_arena_open() };
  ambit_graph *g = b->s->graph;
  ambit_expr k = scene_unknown(b->s, "k", 1, 4), t = ambit_graph_time(g);
  size_t x = scene_state(b->s, "x", scene_unknown(b->s, "x0", 1, 2));
  size_t v = scene_state(b->s, "v", ambit_graph_number(g, 0));
  size_t y = scene_state(b->s, "y", ambit_graph_number(g, 0));
  b->s->rate[x] = b->s->state[v];
  b->s->rate[v] = ambit_graph_op(g, AMBIT_OP_NEG, ambit_graph_op(g, AMBIT_OP_MUL, k, b->s->state[x]), 0);
  b->s->rate[y] = ambit_graph_op(g, AMBIT_OP_COS, t, t);
  open_lanes(b, times);
}

static void close_bench(bench *b) {
  ambit_lanes_close(b->lanes);
  ambit_context_close(&b->context);
  ambit_arena_close(b->arena);
  scene_close(b->s);
}

typedef struct watch {
  double error;
  const double *p, *x0;
  uint32_t instants;
} watch;

static void take(void *user, uint32_t k, size_t n, const double *x, const bool *lost) {
  watch *w = user;
  assert_int_equal(k, ++w->instants);
  for (size_t lane = 0; lane < n; lane++) {
    if (lost[lane]) continue;
    double truth = w->x0[lane] * cos(sqrt(w->p[lane]) * times[k]);
    w->error = fmax(w->error, fmax(fabs(x[lane] - truth), fabs(x[2 * n + lane] - sin(times[k]))));
  }
}

/* Largest error over n lanes; lane `bad` starts at NaN. */
static double run(bench *b, size_t n, double tolerance, size_t bad, size_t *steps) {
  double x0[NX * WIDTH] = { 0 }, p[WIDTH];
  bool lost[WIDTH] = { false };
  for (size_t lane = 0; lane < n; lane++) {
    x0[lane] = lane == bad ? NAN : 1 + (double)lane / WIDTH;
    p[lane] = 4 - 3 * (double)lane / WIDTH;
  }
  watch w = { .p = p, .x0 = x0 };
  const ambit_lanes_run q = {
    .n = n, .x0 = x0, .p = p, .relative = tolerance, .absolute = tolerance, .take = take, .user = &w, .lost = lost
  };
  assert_int_equal(ambit_lanes_integrate(b->lanes, &q, steps), AMBIT_LANES_DONE);
  assert_int_equal(w.instants, bad == 0 && n == 1 ? 0 : 2);
  for (size_t lane = 0; lane < n; lane++) assert_int_equal(lost[lane], lane == bad);
  return w.error;
}

static void lanes_follow_closed_forms(void **state) {
  (void)state;
  bench b;
  size_t coarse, fine, steps;
  open_bench(&b);
  double loose = run(&b, WIDTH, 1e-5, SIZE_MAX, &coarse), tight = run(&b, WIDTH, 1e-12, SIZE_MAX, &fine);
  assert_true(loose < 1e-4 && tight < 1e-11 && tight < loose);
  assert_true(fine < 10 * coarse); /* the eighth root of 1e7 is 7.5 */
  assert_true(run(&b, 1, 1e-10, SIZE_MAX, &steps) < 1e-9);
  assert_true(run(&b, 17, 1e-10, 5, &steps) < 1e-9); /* a lane that can't start does not disturb the others */
  run(&b, 1, 1e-10, 0, &steps);
  assert_int_equal(steps, 0);
  close_bench(&b);
}

/* -- where doubles are 2 or 1 s apart: x' = 1 counts them, x' = -x / 1000 */

static const double far[] = { -0x1p53 - 64, -0x1p53 + 2, -0x1p53 + 936 };

static void take_far(void *user, uint32_t k, size_t n, const double *x, const bool *lost) {
  double *error = user, gone = far[k] - far[0];
  assert_true(n == 1 && !lost[0]);
  *error = fmax(*error, fmax(fabs(x[0] - gone), fabs(x[1] - exp(-gone / 1000))));
}

static void lanes_go_from_double_to_double(void **state) {
  (void)state;
  bench b = { .s = scene_open(), .arena = ambit_arena_open() };
  ambit_graph *g = b.s->graph;
  size_t c = scene_state(b.s, "c", ambit_graph_number(g, 0)), x = scene_state(b.s, "x", ambit_graph_number(g, 1));
  b.s->rate[c] = ambit_graph_number(g, 1);
  b.s->rate[x] = ambit_graph_op(g, AMBIT_OP_DIV, b.s->state[x], ambit_graph_number(g, -1000));
  open_lanes(&b, far);
  static const double longest[] = { 0, 0.5, 3 }; /* the second is no step, the third none of theirs */
  for (size_t i = 0; i < sizeof longest / sizeof *longest; i++) {
    const double x0[] = { 0, 1 };
    bool lost = false;
    double error = 0;
    size_t steps;
    const ambit_lanes_run q = { .n = 1,
      .x0 = x0,
      .relative = 1e-10,
      .absolute = 1e-12,
      .longest = longest[i],
      .take = take_far,
      .user = &error,
      .lost = &lost };
    assert_int_equal(ambit_lanes_integrate(b.lanes, &q, &steps), AMBIT_LANES_DONE);
    assert_true(!lost && error < 1e-8);
    if (longest[i] == 0.5) assert_int_equal(steps, 32 + 936); /* below -2^53 doubles are 2 apart */
  }
  close_bench(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(tableau_has_its_orders),
    cmocka_unit_test(lanes_follow_closed_forms), cmocka_unit_test(lanes_go_from_double_to_double) };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
