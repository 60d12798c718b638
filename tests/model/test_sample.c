/* test_sample.c -- Monte Carlo hulls lie inside the true range, come close to it, and are the same for the same
** seed. */
#include "model/sample.h"
#include "num/random.h"
#include "model/scene.h"
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
  ambit_report report;
  ambit_failure f = { 0 };
  if (ambit_sample_expressions(&q, 1000, 7, hull, defined, &report, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_true(hull[0].lo == -2 && hull[0].hi == 6); /* at corners */
  assert_true(hull[1].lo >= 0 && hull[1].hi <= sqrt(3));
  assert_true(hull[2].lo == 0 && hull[2].hi == 0);
  assert_int_equal(defined[0], 1000);
  assert_in_range(defined[1], 560, 690); /* three quarters of the range of y, half of its corners */
  assert_string_equal(report.arithmetic, "real");
  assert_int_equal(report.unknowns, 2);
  assert_int_equal(ambit_sample_expressions(&q, 1000, 7, again, NULL, NULL, NULL), AMBIT_OK);
  assert_memory_equal(hull, again, sizeof hull);
  assert_int_equal(ambit_sample_expressions(&q, 1000, 8, other, NULL, NULL, NULL), AMBIT_OK);
  assert_memory_not_equal(hull, other, sizeof hull);
}

static void draws_exactly_as_many_as_asked(void **state) {
  scene *s = *state;
  ambit_expr x = scene_unknown(s, "x", 1, 2);
  ambit_evaluate_request q = request(s, 1, &x);
  ambit_interval hull;
  size_t defined, counts[] = { 1, 2, 63, 64, 65, 129 };
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    assert_int_equal(ambit_sample_expressions(&q, counts[i], 1, &hull, &defined, NULL, NULL), AMBIT_OK);
    assert_int_equal(defined, counts[i]);
    if (counts[i] == 1) assert_true(hull.lo == 1.5 && hull.hi == 1.5); /* the midpoint */
  }
}

static void refuses_what_cannot_be_drawn(void **state) {
  scene *s = *state;
  ambit_failure f = { 0 };
  ambit_interval hull;
  ambit_expr x = scene_unknown(s, "x", 0, INFINITY);
  ambit_evaluate_request q = request(s, 1, &x);
  assert_int_equal(ambit_sample_expressions(&q, 0, 1, &hull, NULL, NULL, &f), AMBIT_INVALID);
  ambit_failure_clear(&f);
  assert_int_equal(ambit_sample_expressions(&q, 10, 1, &hull, NULL, NULL, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "`x` from [0, inf]"));
}

static int32_t stop_at_once(ambit_sink *sink, double done, const char *message) {
  (void)sink, (void)done, (void)message;
  return 1;
}

/* x' = -k x, x(0) in [1, 2], k in [1, 1.5]: x(t) = x0 exp(-k t) exactly. */
static void make_decay(scene *s) {
  ambit_expr k = scene_unknown(s, "k", 1, 1.5);
  size_t i = scene_state(s, "x", scene_unknown(s, "x0", 1, 2));
  s->rate[i] = ambit_graph_op(s->graph, AMBIT_OP_NEG, ambit_graph_op(s->graph, AMBIT_OP_MUL, k, s->state[i]), 0);
}

static void samples_a_system(void **state) {
  scene *s = *state;
  static const double time[] = { 0, 0.5, 2 };
  make_decay(s);
  ambit_simulate_request q = scene_request(s, NULL, 3, time);
  ambit_interval hull[3], again[3];
  ambit_sample_result result;
  ambit_report report;
  ambit_failure f = { 0 };
  if (ambit_sample_system(&q, 200, 3, hull, &result, &report, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_int_equal(result.status, AMBIT_OK);
  assert_int_equal(result.draws, 200);
  assert_int_equal(result.failed, 0);
  for (int k = 0; k < 3; k++) {
    double lo = exp(-1.5 * time[k]), hi = 2 * exp(-time[k]);
    assert_true(hull[k].lo >= lo - 1e-6 && hull[k].hi <= hi + 1e-6);
    assert_true(hull[k].hi - hull[k].lo > 0.75 * (hi - lo));
  }
  assert_string_equal(report.solver, "gsl");
  assert_int_equal(report.unknowns, 2);
  assert_int_equal(ambit_sample_system(&q, 200, 3, again, &result, NULL, NULL), AMBIT_OK);
  assert_memory_equal(hull, again, sizeof hull);
  for (q.threads = 1; q.threads <= 5; q.threads += 2) { /* the same draws, whoever makes them */
    assert_int_equal(ambit_sample_system(&q, 200, 3, again, &result, NULL, NULL), AMBIT_OK);
    assert_int_equal(result.draws, 200);
    assert_memory_equal(hull, again, sizeof hull);
  }
  ambit_sink sink = { sizeof sink, NULL, stop_at_once };
  q.sink = &sink;
  q.threads = 1;
  assert_int_equal(ambit_sample_system(&q, 200, 3, again, &result, NULL, NULL), AMBIT_OK);
  assert_int_equal(result.status, AMBIT_STOPPED);
  assert_int_equal(result.draws, 1);
  q.threads = 2;
  assert_int_equal(ambit_sample_system(&q, 1000000, 3, again, &result, NULL, NULL), AMBIT_OK);
  assert_int_equal(result.status, AMBIT_STOPPED);
  assert_true(result.draws < 500000);
}

static void counts_of_draws_skip_numbers(void **state) {
  (void)state;
  static const ambit_interval range[] = { { 0, 1 }, { -2, 2 }, { 5, 5 } };
  ambit_random through = { 99 };
  for (size_t draw = 0; draw < 50; draw++) {
    double one[3], other[3];
    ambit_random jumped = { 99 };
    if (draw) ambit_random_skip(&jumped, (draw - 1) * 3);
    ambit_random_draw(&through, draw, 3, range, one, 1);
    ambit_random_draw(&jumped, draw, 3, range, other, 1);
    assert_memory_equal(one, other, sizeof one);
  }
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
  if (ambit_sample_system(&q, 20, 3, hull, &result, NULL, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_int_equal(result.draws, 20);
  assert_int_equal(result.failed, 20);
  assert_non_null(strstr(result.reason, "blew up"));
  assert_true(hull[1].lo >= 1 && hull[1].hi <= 2 && hull[1].lo < hull[1].hi);
  assert_true(ambit_interval_is_empty(hull[2]));
  option.text = "refuse";
  assert_int_equal(ambit_sample_system(&q, 20, 3, hull, &result, NULL, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "solver `mock`: this system is not for me"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(draws_uniformly),
    cmocka_unit_test_setup_teardown(estimates_from_inside, set_up, tear_down),
    cmocka_unit_test_setup_teardown(draws_exactly_as_many_as_asked, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_what_cannot_be_drawn, set_up, tear_down),
    cmocka_unit_test_setup_teardown(samples_a_system, set_up, tear_down),
    cmocka_unit_test(counts_of_draws_skip_numbers),
    cmocka_unit_test_setup_teardown(counts_draws_that_fail, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
