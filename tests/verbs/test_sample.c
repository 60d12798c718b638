/* test_sample.c -- hulls of draws lie inside the true range, come close to it, and are the same for the same seed,
** however many threads there are. */
#include <ambit/sample.h>
#include "verbs/sample/sample_error.h"
#include "num/random.h"
#include "verbs/scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static int set_up(void **state) {
  *state = scene_open();
  return 0;
}

static int tear_down(void **state) {
  scene_close(*state);
  return 0;
}

static void draws_uniformly(void **state) {
  (void)state;
  ambit_random r = { 42 };
  double sum = 0, square = 0;
  enum { N = 100000 };
  for (int i = 0; i < N; i++) {
    double v = ambit_random_in(&r, (ambit_interval) { -1, 3 });
    assert_true(v >= -1 && v <= 3);
    sum += v;
    square += (v - 1) * (v - 1);
  }
  assert_true(fabs(sum / N - 1) < 0.02);            /* mean 1, deviation of the mean 0.0037 */
  assert_true(fabs(square / N - 16.0 / 12) < 0.02); /* variance 4^2 / 12 */
  r.state = 1234567;
  assert_true(ambit_random_bits(&r) == UINT64_C(6457827717110365317)); /* published test value of SplitMix64 */
  ambit_interval huge = { -1.7e308, 1.7e308 };
  for (int i = 0; i < 1000; i++) assert_true(isfinite(ambit_random_in(&r, huge)));
}

static ambit_evaluate_request request(const scene *s, size_t n, const ambit_expr *e) {
  return (ambit_evaluate_request) { .graph = s->graph, .registry = s->registry, .nexpr = n, .expr = e };
}

static ambit_sample_plan plan_for(size_t draws, uint64_t seed) {
  return (ambit_sample_plan) { .draws = draws, .seed = seed };
}

static ambit_status sample(const ambit_evaluate_request *q, ambit_sample_plan plan, ambit_interval *hull, double *error,
    size_t *defined, ambit_sample_result *result) {
  ambit_failure f = { 0 };
  ambit_status status = ambit_sample_expressions(q, &plan, hull, error, defined, result, NULL, &f);
  if (status != AMBIT_OK) fail_msg("%s", f.message);
  return status;
}

static void estimates_from_inside(void **state) {
  scene *s = *state;
  ambit_graph *g = s->graph;
  ambit_expr x = scene_unknown(s, "x", 1, 2), y = scene_unknown(s, "y", -1, 3);
  ambit_expr e[] = { ambit_graph_op(g, AMBIT_OP_MUL, x, y), ambit_graph_op(g, AMBIT_OP_SQRT, y, y),
    ambit_graph_op(g, AMBIT_OP_SUB, x, x), 0 };
  ambit_expr phase = ambit_graph_op(g, AMBIT_OP_MUL, e[0], e[0]);
  e[3] = ambit_graph_op(g, AMBIT_OP_SIN, phase, phase); /* its extremes are inside */
  ambit_evaluate_request q = request(s, 4, e);
  ambit_interval hull[4], again[4], other[4];
  size_t defined[4];
  double error[4];
  ambit_sample_result result;
  ambit_report report;
  ambit_failure f = { 0 };
  ambit_sample_plan plan = plan_for(1000, 7);
  if (ambit_sample_expressions(&q, &plan, hull, error, defined, &result, &report, &f) != AMBIT_OK)
    fail_msg("%s", f.message);
  assert_true(hull[0].lo == -2 && hull[0].hi == 6); /* at corners */
  assert_true(hull[1].lo >= 0 && hull[1].hi <= sqrt(3));
  assert_true(hull[2].lo == 0 && hull[2].hi == 0);
  assert_true(error[0] < 1e-14 && error[1] < 1e-14 && error[3] > 0 && error[3] < 1e-12);
  assert_int_equal(defined[0], 1000);
  assert_in_range(defined[1], 720, 780); /* three quarters of the range of y, half of its four corners */
  assert_string_equal(report.arithmetic, "real");
  assert_int_equal(report.unknowns, 2);
  assert_string_equal(result.points, "sobol");
  sample(&q, plan, again, NULL, NULL, &result);
  assert_memory_equal(hull, again, sizeof hull);
  plan.seed = 8;
  sample(&q, plan, other, NULL, NULL, &result);
  assert_memory_not_equal(hull, other, sizeof hull);
}

static void threads_change_nothing(void **state) {
  scene *s = *state;
  ambit_expr x = scene_unknown(s, "x", 1, 2), y = scene_unknown(s, "y", -1, 3);
  ambit_expr xy = ambit_graph_op(s->graph, AMBIT_OP_MUL, x, y), e = ambit_graph_op(s->graph, AMBIT_OP_SIN, xy, xy);
  ambit_evaluate_request q = request(s, 1, &e);
  static const char *const points[] = { NULL, "niederreiter", "halton", "reverse_halton", "random" };
  for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
    ambit_interval hull[4];
    double error[4];
    size_t defined[4];
    for (uint32_t k = 0; k < 4; k++) {
      ambit_sample_result result;
      ambit_sample_plan plan = plan_for(20000, 5);
      plan.points = points[i], plan.threads = k + 1, plan.polish = true;
      sample(&q, plan, &hull[k], &error[k], &defined[k], &result);
      assert_int_equal(result.threads, k + 1);
      assert_true(hull[k].lo == hull[0].lo && hull[k].hi == hull[0].hi && error[k] == error[0]);
      assert_int_equal(defined[k], 20000);
    }
  }
}

/* A product of many data has its extremes at two of 2^20 corners; 200 draws find them only by climbing. */
static void follows_extremes(void **state) {
  scene *s = *state;
  enum { N = 20 };
  ambit_expr product = ambit_graph_number(s->graph, 1);
  double most = 1, least = 1;
  for (int i = 0; i < N; i++) {
    char name[8];
    snprintf(name, sizeof name, "x%d", i);
    product = ambit_graph_op(s->graph, AMBIT_OP_MUL, product, scene_unknown(s, name, 0.5, 1.5));
    most *= 1.5, least *= 0.5;
  }
  ambit_evaluate_request q = request(s, 1, &product);
  ambit_interval plain, followed;
  double error;
  ambit_sample_result result;
  ambit_sample_plan plan = plan_for(200, 1);
  sample(&q, plan, &plain, NULL, NULL, &result);
  assert_int_equal(result.polished, 0);
  assert_true(plain.hi < 0.9 * most);
  plan.polish = true;
  sample(&q, plan, &followed, &error, NULL, &result);
  assert_true(result.polished > 0 && result.polished <= 12800);
  assert_true(fabs(followed.hi - most) <= error && fabs(followed.lo - least) <= error && error < 1e-10);
}

static void draws_exactly_as_many_as_asked(void **state) {
  scene *s = *state;
  ambit_expr x = scene_unknown(s, "x", 1, 2);
  ambit_evaluate_request q = request(s, 1, &x);
  ambit_interval hull;
  ambit_sample_result result;
  size_t defined, counts[] = { 1, 2, 63, 64, 65, 129, 1024, 1025, 3000 };
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    ambit_sample_plan plan = plan_for(counts[i], 1);
    plan.polish = true;
    sample(&q, plan, &hull, NULL, &defined, &result);
    assert_int_equal(defined, counts[i]);
    assert_int_equal(result.draws, counts[i]);
    if (counts[i] == 1) assert_true(hull.lo == 1.5 && hull.hi == 1.5); /* the midpoint */
  }
}

static void refuses_what_cannot_be_drawn(void **state) {
  scene *s = *state;
  ambit_failure f = { 0 };
  ambit_interval hull;
  ambit_sample_result result;
  ambit_expr x = scene_unknown(s, "x", 0, INFINITY);
  ambit_evaluate_request q = request(s, 1, &x);
  ambit_sample_plan plan = plan_for(0, 1);
  assert_int_equal(ambit_sample_expressions(&q, &plan, &hull, NULL, NULL, &result, NULL, &f), AMBIT_INVALID);
  ambit_failure_clear(&f);
  plan.draws = 10;
  assert_int_equal(ambit_sample_expressions(&q, &plan, &hull, NULL, NULL, &result, NULL, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "`x` from [0, inf]"));
}

static int32_t stop_at_once(ambit_sink *sink, double done, const char *message) {
  (void)sink, (void)done, (void)message;
  return 1;
}

static void keeps_what_was_drawn(void **state) {
  scene *s = *state;
  ambit_expr x = scene_unknown(s, "x", 1, 2);
  ambit_evaluate_request q = request(s, 1, &x);
  ambit_interval hull;
  ambit_sample_result result;
  ambit_sink sink = { sizeof sink, NULL, stop_at_once };
  ambit_sample_plan plan = plan_for(10000000, 1);
  plan.sink = &sink, plan.polish = true;
  for (plan.threads = 1; plan.threads <= 2; plan.threads++) {
    sample(&q, plan, &hull, NULL, NULL, &result);
    assert_int_equal(result.status, AMBIT_STOPPED);
    assert_true(result.draws < 10000000 && hull.lo == 1 && hull.hi == 2);
    assert_int_equal(result.polished, 0);
  }
}

/* x' = -k x, x(0) in [1, 2], k in [1, 1.5]: x(t) = x0 exp(-k t) exactly. */
static void make_decay(scene *s) {
  ambit_expr k = scene_unknown(s, "k", 1, 1.5);
  size_t i = scene_state(s, "x", scene_unknown(s, "x0", 1, 2));
  s->rate[i] = ambit_graph_op(s->graph, AMBIT_OP_NEG, ambit_graph_op(s->graph, AMBIT_OP_MUL, k, s->state[i]), 0);
}

static ambit_status sample_flow(const ambit_simulate_request *q, ambit_sample_plan plan, ambit_interval *hull,
    double *error, ambit_sample_result *result) {
  ambit_failure f = { 0 };
  ambit_status status = ambit_sample_system(q, &plan, hull, error, result, NULL, &f);
  if (status != AMBIT_OK) fail_msg("%s", f.message);
  return status;
}

static void samples_a_system(void **state) {
  scene *s = *state;
  static const double time[] = { 0, 0.5, 2 };
  make_decay(s);
  static const char *const solver[] = { NULL, "gsl" };
  for (size_t way = 0; way < 2; way++) {
    ambit_simulate_request q = scene_request(s, solver[way], 3, time);
    ambit_interval hull[3], again[3];
    double error[3];
    ambit_sample_result result;
    ambit_report report;
    ambit_failure f = { 0 };
    ambit_sample_plan plan = plan_for(200, 3);
    if (ambit_sample_system(&q, &plan, hull, error, &result, &report, &f) != AMBIT_OK) fail_msg("%s", f.message);
    assert_int_equal(result.status, AMBIT_OK);
    assert_int_equal(result.draws, 200);
    assert_int_equal(result.failed, 0);
    for (int k = 0; k < 3; k++) {
      double lo = exp(-1.5 * time[k]), hi = 2 * exp(-time[k]);
      assert_true(hull[k].lo >= lo - error[k] && hull[k].hi <= hi + error[k] && error[k] < 1e-8);
      assert_true(fabs(hull[k].lo - lo) <= error[k] + 1e-15 && fabs(hull[k].hi - hi) <= error[k] + 1e-15);
    }
    assert_string_equal(report.solver, way ? "gsl" : "lanes");
    assert_int_equal(report.unknowns, 2);
    for (plan.threads = 1; plan.threads <= 5; plan.threads += 2) { /* the same draws, whoever makes them */
      sample_flow(&q, plan, again, NULL, &result);
      assert_int_equal(result.draws, 200);
      assert_memory_equal(hull, again, sizeof hull);
    }
  }
}

static void stops_a_system(void **state) {
  scene *s = *state;
  static const double time[] = { 0, 0.5, 2 };
  make_decay(s);
  ambit_simulate_request q = scene_request(s, NULL, 3, time);
  ambit_sink sink = { sizeof sink, NULL, stop_at_once };
  ambit_interval hull[3];
  double error[3];
  ambit_sample_result result;
  ambit_sample_plan plan = plan_for(1000000, 3);
  plan.sink = &sink, plan.polish = true;
  for (plan.threads = 1; plan.threads <= 2; plan.threads++) {
    sample_flow(&q, plan, hull, error, &result);
    assert_int_equal(result.status, AMBIT_STOPPED);
    assert_true(result.draws < 500000 && hull[0].lo >= 1 && hull[0].hi <= 2 && isnan(error[2]));
  }
}

static int32_t stop_behind_the_draws(ambit_sink *sink, double done, const char *message) {
  (void)sink, (void)message;
  return done == 1;
}

/* also while it estimates the error, and within a draw of a solver */
static void stops_a_system_everywhere(void **state) {
  scene *s = *state;
  static const double time[] = { 0, 0.5, 2 };
  make_decay(s);
  ambit_sink late = { sizeof late, NULL, stop_behind_the_draws }, soon = { sizeof soon, NULL, stop_at_once };
  static const char *const solver[] = { NULL, "gsl" };
  for (size_t way = 0; way < 4; way++) {
    ambit_simulate_request q = scene_request(s, solver[way % 2], 3, time);
    ambit_interval hull[3];
    double error[3];
    ambit_sample_result result;
    ambit_sample_plan plan = plan_for(200, 3);
    plan.sink = way < 2 ? &late : &soon, plan.threads = way == 3 ? 1 : 2; /* a pool may be faster than its caller */
    sample_flow(&q, plan, hull, error, &result);
    assert_int_equal(result.status, AMBIT_STOPPED);
    assert_int_equal(result.draws, way < 2 ? 200 : 0);
    assert_int_equal(result.failed, 0);
    assert_true(isnan(error[2]));
  }
}

/* backwards in time, x(t) = x0 exp(-k t) from t = 2 to 0 */
static void goes_backwards(void **state) {
  scene *s = *state;
  static const double time[] = { 2, 1, 0 };
  make_decay(s);
  ambit_simulate_request q = scene_request(s, NULL, 3, time);
  ambit_interval hull[3];
  double error[3];
  ambit_sample_result result;
  ambit_sample_plan plan = plan_for(100, 3);
  sample_flow(&q, plan, hull, error, &result);
  assert_true(fabs(hull[2].hi - 2 * exp(3)) <= error[2] && fabs(hull[2].lo - exp(2)) <= error[2] && error[2] < 1e-6);
}

/* x' = x^2 from x0 escapes at t = 1 / x0: draws above 1 do not reach t = 1, the others are x0 / (1 - x0 t). */
static void drops_what_escapes(void **state) {
  scene *s = *state;
  static const double time[] = { 0, 0.5, 1 };
  size_t i = scene_state(s, "x", scene_unknown(s, "x0", 0.5, 1.2));
  s->rate[i] = ambit_graph_op(s->graph, AMBIT_OP_MUL, s->state[i], s->state[i]);
  ambit_simulate_request q = scene_request(s, NULL, 3, time);
  ambit_interval hull[3];
  double error[3];
  ambit_sample_result result;
  ambit_sample_plan plan = plan_for(300, 3);
  plan.no_corners = true;
  sample_flow(&q, plan, hull, error, &result);
  assert_int_equal(result.draws, 300);
  assert_in_range(result.failed, 76, 96); /* two sevenths */
  assert_true(result.one_by_one >= result.failed && strstr(result.reason, "at t = "));
  assert_true(hull[1].hi > 2.9 && hull[1].hi < 3.001);
  assert_true(fabs(hull[2].lo - hull[0].lo / (1 - hull[0].lo)) < 1e-8 && hull[2].hi > 50);
}

/* x' = -1e5 (x - cos t): after the first instant x is cos t + 1e-5 sin t but for 1e-10 */
static void leaves_stiff_systems_to_gsl(void **state) {
  scene *s = *state;
  static const double time[] = { 0, 1, 10 };
  ambit_graph *g = s->graph;
  size_t i = scene_state(s, "x", scene_unknown(s, "x0", 0.9, 1.1));
  ambit_expr t = ambit_graph_time(g), cosine = ambit_graph_op(g, AMBIT_OP_COS, t, t);
  ambit_expr apart = ambit_graph_op(g, AMBIT_OP_SUB, cosine, s->state[i]);
  s->rate[i] = ambit_graph_op(g, AMBIT_OP_MUL, ambit_graph_number(g, 1e5), apart);
  ambit_simulate_request q = scene_request(s, NULL, 3, time);
  ambit_interval hull[3];
  double error[3];
  ambit_sample_result result;
  ambit_sample_plan plan = plan_for(12, 3);
  plan.relative = 1e-8, plan.absolute = 1e-10;
  sample_flow(&q, plan, hull, error, &result);
  assert_non_null(strstr(result.method, "stiff"));
  assert_int_equal(result.one_by_one, 12);
  assert_int_equal(result.failed, 0);
  for (int k = 1; k < 3; k++)
    assert_true(fabs(ambit_interval_mid(hull[k]) - cos(time[k]) - 1e-5 * sin(time[k])) < error[k] + 1e-9);
}

/* x' = y, y' = -x with the invariant x^2 + y^2 - 1 */
static void refuses_starts_off_a_constraint(void **state) {
  scene *s = *state;
  ambit_graph *g = s->graph;
  static const double time[] = { 0, 1 };
  static const char *const name[] = { "circle" };
  ambit_expr angle = scene_unknown(s, "angle", 0, 1);
  size_t x = scene_state(s, "x", ambit_graph_op(g, AMBIT_OP_COS, angle, angle));
  size_t y = scene_state(s, "y", ambit_graph_op(g, AMBIT_OP_SIN, angle, angle));
  s->rate[x] = s->state[y];
  s->rate[y] = ambit_graph_op(g, AMBIT_OP_NEG, s->state[x], 0);
  ambit_expr square = ambit_graph_op(g, AMBIT_OP_ADD, ambit_graph_op(g, AMBIT_OP_MUL, s->state[x], s->state[x]),
      ambit_graph_op(g, AMBIT_OP_MUL, s->state[y], s->state[y]));
  ambit_expr circle = ambit_graph_op(g, AMBIT_OP_SUB, square, ambit_graph_number(g, 1));
  s->system.ninvariant = 1;
  s->system.invariant = &circle;
  s->system.invariant_name = name;
  ambit_simulate_request q = scene_request(s, NULL, 2, time);
  ambit_interval hull[4];
  ambit_sample_result result;
  sample_flow(&q, plan_for(50, 1), hull, NULL, &result);
  assert_int_equal(result.failed, 0);
  s->initial[y] = scene_unknown(s, "y0", 0.1, 1); /* a box: nearly nothing of it is on the circle */
  ambit_failure f = { 0 };
  ambit_sample_plan plan = plan_for(50, 1);
  assert_int_equal(ambit_sample_system(&q, &plan, hull, NULL, &result, NULL, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "none of 50 draws can start: the constraint `circle` is off by"));
}

static void counts_draws_that_fail(void **state) {
  scene *s = *state;
  static const double time[] = { 0, 1, 2 };
  ambit_option option = { "does", "fail" };
  scene_state(s, "x", scene_unknown(s, "x0", 1, 2));
  ambit_simulate_request q = scene_request(s, "mock", 3, time);
  q.arithmetic = "small";
  q.nsolver_option = 1;
  q.solver_option = &option;
  ambit_interval hull[3];
  ambit_sample_result result;
  ambit_failure f = { 0 };
  ambit_sample_plan plan = plan_for(20, 3);
  if (ambit_sample_system(&q, &plan, hull, NULL, &result, NULL, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_int_equal(result.draws, 20);
  assert_int_equal(result.failed, 20);
  assert_non_null(strstr(result.reason, "blew up"));
  assert_true(hull[1].lo >= 1 && hull[1].hi <= 2 && hull[1].lo < hull[1].hi);
  assert_true(ambit_interval_is_empty(hull[2]));
  option.text = "refuse";
  assert_int_equal(ambit_sample_system(&q, &plan, hull, NULL, &result, NULL, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "solver `mock`: this system is not for me"));
}

static void keeps_what_its_error_leaves(void **state) {
  (void)state;
  double error = 0.25, small = 0x1p-60, none = 0, unknown = NAN, endless = INFINITY;
  ambit_interval hull = { 1, 2 }, x = ambit_sample_sure(hull, &error);
  assert_true(x.lo == 1.25 && x.hi == 1.75 && error == 0.25);
  x = ambit_sample_sure(hull, &small); /* rounded inward */
  assert_true(x.lo > 1 && x.hi < 2);
  x = ambit_sample_sure((ambit_interval) { 1, 1.25 }, &error);
  assert_true(x.lo == 1.125 && x.hi == 1.125 && error == 0.375);
  x = ambit_sample_sure(hull, &none);
  assert_true(x.lo == 1 && x.hi == 2);
  x = ambit_sample_sure(hull, &unknown);
  assert_true(x.lo == 1 && x.hi == 2 && isnan(unknown));
  x = ambit_sample_sure(hull, &endless);
  assert_true(x.lo == 1 && x.hi == 2 && isinf(endless));
  assert_true(ambit_interval_is_empty(ambit_sample_sure(AMBIT_EMPTY, &error)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(draws_uniformly),
    cmocka_unit_test(keeps_what_its_error_leaves),
    cmocka_unit_test_setup_teardown(estimates_from_inside, set_up, tear_down),
    cmocka_unit_test_setup_teardown(threads_change_nothing, set_up, tear_down),
    cmocka_unit_test_setup_teardown(follows_extremes, set_up, tear_down),
    cmocka_unit_test_setup_teardown(draws_exactly_as_many_as_asked, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_what_cannot_be_drawn, set_up, tear_down),
    cmocka_unit_test_setup_teardown(keeps_what_was_drawn, set_up, tear_down),
    cmocka_unit_test_setup_teardown(samples_a_system, set_up, tear_down),
    cmocka_unit_test_setup_teardown(stops_a_system, set_up, tear_down),
    cmocka_unit_test_setup_teardown(stops_a_system_everywhere, set_up, tear_down),
    cmocka_unit_test_setup_teardown(goes_backwards, set_up, tear_down),
    cmocka_unit_test_setup_teardown(drops_what_escapes, set_up, tear_down),
    cmocka_unit_test_setup_teardown(leaves_stiff_systems_to_gsl, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_starts_off_a_constraint, set_up, tear_down),
    cmocka_unit_test_setup_teardown(counts_draws_that_fail, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
