/* test_simulate.c -- the verb `simulate` with a mock solver that misbehaves on demand: pairs, times, initial sets,
** parameters, outcomes. */
#include <ambit/simulate.h>
#include "verbs/scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static const double instants[] = { 0, 1, 2, 3 };

static int set_up(void **state) {
  *state = scene_open();
  return 0;
}

static int tear_down(void **state) {
  scene_close(*state);
  return 0;
}

/* -- a receiver */

typedef struct receiver {
  ambit_sink sink; /* first */
  uint32_t records, stop_after;
  double lo[SCENE_STATES], hi[SCENE_STATES], done;
} receiver;

static int32_t emit(ambit_sink *s, const ambit_record *r) {
  receiver *to = (receiver *)(void *)s;
  for (uint32_t i = 0; i < r->nx; i++) {
    to->lo[i] = r->lo[i];
    to->hi[i] = r->hi[i];
  }
  return ++to->records == to->stop_after;
}

static int32_t progress(ambit_sink *s, double done, const char *message) {
  (void)message;
  ((receiver *)(void *)s)->done = done;
  return 0;
}

static receiver receive(uint32_t stop_after) {
  return (receiver) { .sink = { sizeof(ambit_sink), emit, progress }, .stop_after = stop_after };
}

/* x' = 0, x(0) in [1, 2] */
static void make_resting(scene *s) { scene_state(s, "x", scene_unknown(s, "x0", 1, 2)); }

/* Runs the mock solver with one mischief to t = 3. */
static ambit_simulate_result misbehave(scene *s, const char *mischief, receiver *to, ambit_report *report) {
  ambit_option option = { "does", mischief };
  ambit_simulate_request q = scene_request(s, "mock", 4, instants);
  q.arithmetic = "small";
  q.nsolver_option = 1;
  q.solver_option = &option;
  q.sink = to ? &to->sink : NULL;
  ambit_simulate_result result;
  ambit_failure f = { 0 };
  if (ambit_simulate(&q, &result, report, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return result;
}

static void assert_refused(const ambit_simulate_request *q, const char *part) {
  ambit_failure f = { 0 };
  ambit_simulate_result result;
  assert_int_equal(ambit_simulate(q, &result, NULL, &f), AMBIT_INVALID);
  if (!strstr(f.message, part)) fail_msg("\"%s\" expected, got: %s", part, f.message);
}

/* -- outcomes */

static void runs_to_the_end(void **state) {
  scene *s = *state;
  make_resting(s);
  receiver to = receive(0);
  ambit_report report;
  ambit_simulate_result result = misbehave(s, "nothing", &to, &report);
  assert_int_equal(result.status, AMBIT_OK);
  assert_string_equal(result.reason, "");
  assert_true(result.t_reached == 3 && to.done == 1);
  assert_int_equal(result.steps, 3);
  assert_int_equal(to.records, 3);
  assert_int_equal(result.rigorous, 1);
  assert_true(to.lo[0] == 1 && to.hi[0] == 2);
  assert_true(result.cpu_seconds >= 0);
  assert_string_equal(report.solver, "mock");
  assert_string_equal(report.arithmetic, "small");
  assert_int_equal(report.states, 1);
  assert_int_equal(report.unknowns, 1);
  assert_int_equal(report.parameters, 0);
  assert_int_equal(report.steps, 3);
  assert_string_equal(s->note, "mock solver with 1 states");
  assert_int_equal(misbehave(s, "nothing", NULL, NULL).status, AMBIT_OK); /* nobody listens */
}

static void tells_why_it_stopped(void **state) {
  static const struct {
    const char *mischief;
    ambit_status status;
    double reached;
    const char *reason;
  } expected[] = {
    { "fail", AMBIT_UNABLE, 1, "the enclosure blew up; lower `tolerance`" },
    { "fail_silently", AMBIT_UNABLE, 1, "solver `mock` could not go on and gave no reason" },
    { "unable", AMBIT_UNABLE, 0, "no first step; raise `order`" },
    { "odd_status", AMBIT_BROKEN, 1, "gave no reason" },
    { "stop_early", AMBIT_BROKEN, 1, "before the end" },
    { "nan", AMBIT_BROKEN, 0, "empty or NaN enclosure" },
    { "reversed", AMBIT_BROKEN, 0, "empty or NaN enclosure" },
    { "gap", AMBIT_BROKEN, 0, "a gap in time" },
    { "turn_back", AMBIT_BROKEN, 0, "against the direction of time" },
    { "wrong_count", AMBIT_BROKEN, 0, "without an enclosure of every state" },
    { "dense_nan", AMBIT_BROKEN, 0, "a dense enclosure with a NaN or a negative radius" },
    { "dense_negative", AMBIT_BROKEN, 0, "a dense enclosure with a NaN or a negative radius" },
    { "set_negative", AMBIT_BROKEN, 0, "a set with a NaN or a negative radius" },
    { "outside_tube", AMBIT_BROKEN, 0, "outside its own tube" },
  };
  scene *s = *state;
  make_resting(s);
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
    receiver to = receive(0);
    ambit_simulate_result result = misbehave(s, expected[i].mischief, &to, NULL);
    assert_int_equal(result.status, expected[i].status);
    assert_true(result.t_reached == expected[i].reached);
    assert_int_equal(to.records, (uint32_t)expected[i].reached); /* a faulty record is not passed on */
    if (!strstr(result.reason, expected[i].reason)) fail_msg("%s: %s", expected[i].mischief, result.reason);
  }
}

static void stops_on_request(void **state) {
  scene *s = *state;
  make_resting(s);
  receiver to = receive(2);
  ambit_simulate_result result = misbehave(s, "nothing", &to, NULL);
  assert_int_equal(result.status, AMBIT_STOPPED);
  assert_true(result.t_reached == 2);
  assert_non_null(strstr(result.reason, "on request at t = 2"));
  to = receive(3);
  assert_int_equal(misbehave(s, "nothing", &to, NULL).status, AMBIT_OK); /* asked at the end: complete all the same */
  to = receive(1);
  assert_int_equal(misbehave(s, "ignore_stop", &to, NULL).status, AMBIT_OK);
}

static void refuses_to_start(void **state) {
  scene *s = *state;
  make_resting(s);
  ambit_option option = { "does", "refuse" };
  ambit_simulate_request q = scene_request(s, "mock", 4, instants);
  q.arithmetic = "small";
  q.nsolver_option = 1;
  q.solver_option = &option;
  assert_refused(&q, "solver `mock`: this system is not for me");
  option.text = "nothin";
  assert_refused(&q, "did you mean `nothing`?");
  q.solver = "moc";
  assert_refused(&q, "did you mean `mock`?");
}

/* -- pairs */

static void refuses_pairs_that_do_not_fit(void **state) {
  scene *s = *state;
  make_resting(s);
  ambit_simulate_request q = scene_request(s, "mock", 4, instants);
  q.arithmetic = "newer"; /* not rigorous */
  assert_refused(&q, "solver `mock` does not work with arithmetic `newer` (it proves its results); what fits: ");
  assert_refused(&q, "small");
  q.solver = "pinned";
  q.arithmetic = "interval";
  assert_refused(&q, "solver `pinned` does not work with arithmetic `interval`; what fits: newer small");
  q.arithmetic = NULL; /* the first on its list */
  ambit_report report;
  ambit_simulate_result result;
  assert_int_equal(ambit_simulate(&q, &result, &report, NULL), AMBIT_OK);
  assert_string_equal(report.arithmetic, "newer");
  assert_int_equal(result.rigorous, 0);
}

/* -- times */

static void checks_times(void **state) {
  static const struct {
    double t[3];
    size_t n;
    const char *part;
  } wrong[] = {
    { { 1, 1 }, 2, "time span is zero" },
    { { 1, 2, 1 }, 3, "time span is zero" },
    { { -1.7e308, 1.7e308 }, 2, "too long" },
    { { 0, INFINITY }, 2, "not a finite number" },
    { { NAN, 1 }, 2, "not a finite number" },
    { { 0, 2, 1 }, 3, "ascend" },
    { { 0, 0, 1 }, 3, "ascend" },
    { { 3, 4, 1 }, 3, "descend" },
    { { 0 }, 1, "a start and an end" },
  };
  scene *s = *state;
  make_resting(s);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    ambit_simulate_request q = scene_request(s, "mock", wrong[i].n, wrong[i].t);
    q.arithmetic = "small";
    assert_refused(&q, wrong[i].part);
  }
  static const double backwards[] = { 3, 2, -1 };
  receiver to = receive(0);
  ambit_simulate_request q = scene_request(s, "mock", 3, backwards);
  q.arithmetic = "small";
  q.sink = &to.sink;
  ambit_simulate_result result;
  assert_int_equal(ambit_simulate(&q, &result, NULL, NULL), AMBIT_OK);
  assert_int_equal(result.status, AMBIT_OK);
  assert_true(result.t_reached == -1);
}

/* -- initial sets and parameters */

static void assert_start_refused(scene *s, ambit_expr initial, const char *part) {
  scene_state(s, "x", initial);
  ambit_simulate_request q = scene_request(s, "mock", 4, instants);
  q.arithmetic = "small";
  assert_refused(&q, part);
  s->system.nx = 0;
}

static void checks_initial_values(void **state) {
  scene *s = *state;
  ambit_graph *g = s->graph;
  ambit_expr u = scene_unknown(s, "u", -2, -1), wide = scene_unknown(s, "w", -1, 1);
  assert_start_refused(s, AMBIT_NO_EXPR, "state `x` has no initial value");
  assert_start_refused(s, ambit_graph_op(g, AMBIT_OP_LOG, u, u), "`x` is empty");
  assert_start_refused(
      s, ambit_graph_op(g, AMBIT_OP_LOG, ambit_graph_op(g, AMBIT_OP_ABS, wide, wide), 0), "`x` is not bounded");
  assert_start_refused(s, ambit_graph_op(g, AMBIT_OP_SQRT, wide, wide), "not defined for all values");
  assert_start_refused(s, ambit_graph_symbol(g, "y", "m"), "initial value of state `x` depends on `y`");
  assert_start_refused(s, ambit_graph_time(g), "depends on `t`");
  ambit_simulate_request q = scene_request(s, "mock", 4, instants);
  q.arithmetic = "small";
  assert_refused(&q, "no states");
}

static void checks_the_right_hand_side(void **state) {
  scene *s = *state;
  ambit_graph *g = s->graph;
  size_t i = scene_state(s, "x", ambit_graph_number(g, 1));
  ambit_simulate_request q = scene_request(s, "mock", 4, instants);
  q.arithmetic = "small";
  s->rate[i] = ambit_graph_op(g, AMBIT_OP_ADD, s->state[i], ambit_graph_symbol(g, "torque", "N m"));
  assert_refused(&q, "right-hand side of state `x` depends on `torque`");
  s->rate[i] = AMBIT_NO_EXPR;
  assert_refused(&q, "state `x` has no equation");
  s->rate[i] = ambit_graph_op(g, AMBIT_OP_ABS, s->state[i], 0);
  q.solver = "pinned"; /* wants the Jacobian */
  ambit_failure f = { 0 };
  ambit_simulate_result result;
  ambit_report report;
  assert_int_equal(ambit_simulate(&q, &result, &report, &f), AMBIT_OK); /* a run without a step */
  assert_int_equal(result.status, AMBIT_UNABLE);
  assert_string_equal(result.code, AMBIT_CODE_UNABLE_KINK);
  assert_true(strstr(result.reason, "state `x` has no derivative: abs") != NULL);
  assert_true(result.t_reached == instants[0] && result.steps == 0);
  assert_string_equal(report.solver, "pinned");
  assert_int_equal(f.status, AMBIT_OK);
}

/* What the solver was given, as `pinned` reports it: np + 10 nu + 100 inputs. */
static double given(scene *s) {
  receiver to = receive(0);
  ambit_simulate_request q = scene_request(s, "pinned", 2, instants);
  q.sink = &to.sink;
  ambit_simulate_result result;
  ambit_failure f = { 0 };
  if (ambit_simulate(&q, &result, NULL, &f) != AMBIT_OK || result.status != AMBIT_OK)
    fail_msg("%s%s", f.message, result.reason);
  return to.lo[0];
}

static void builds_only_what_is_uncertain(void **state) {
  scene *s = *state;
  ambit_graph *g = s->graph;
  ambit_expr u = scene_unknown(s, "u", 1, 2), v = scene_unknown(s, "v", 1, 2), point = scene_unknown(s, "point", 5, 5);
  size_t x = scene_state(s, "x", u), y = scene_state(s, "y", ambit_graph_op(g, AMBIT_OP_MUL, u, u));
  assert_true(given(s) == 0 + 10 * 1 + 100 * 2); /* one unknown, shared by two states */
  s->rate[x] = ambit_graph_op(g, AMBIT_OP_MUL, s->state[y], point);
  assert_true(given(s) == 0 + 10 * 1 + 100 * 2); /* a point is no parameter */
  s->rate[x] = ambit_graph_op(g, AMBIT_OP_MUL, s->state[y], v);
  assert_true(given(s) == 1 + 10 * 2 + 100 * 3); /* a parameter is an unknown, too */
  s->rate[y] = ambit_graph_op(g, AMBIT_OP_MUL, s->state[x], u);
  assert_true(given(s) == 2 + 10 * 2 + 100 * 4); /* u is shared by initial values and parameters */
  s->rate[y] = ambit_graph_op(g, AMBIT_OP_SIN, ambit_graph_time(g), 0);
  assert_true(given(s) == 1 + 10 * 2 + 100 * 4); /* time is an input only if it is used */
}

static void encloses_initial_values(void **state) {
  scene *s = *state;
  ambit_graph *g = s->graph;
  ambit_expr u = scene_unknown(s, "u", -1, 2), third;
  ambit_failure f = { 0 };
  third = ambit_graph_decimal(g, "1/3", &f);
  scene_state(s, "x", ambit_graph_op(g, AMBIT_OP_SQR, u, u));
  scene_state(s, "y", ambit_graph_op(g, AMBIT_OP_EXP, u, u));
  scene_state(s, "z", third);
  scene_state(s, "w", ambit_graph_pown(g, u, 3));
  receiver to = receive(0);
  assert_int_equal(misbehave(s, "nothing", &to, NULL).status, AMBIT_OK);
  assert_true(to.lo[0] == 0 && to.hi[0] == 4);
  assert_true(to.lo[1] <= 0.36787944117144233 && to.hi[1] >= 7.38905609893065 && to.hi[1] - to.lo[1] < 7.0211766577593);
  assert_true(to.lo[2] == 0x1.5555555555555p-2 && to.hi[2] == 0x1.5555555555556p-2);
  assert_true(to.lo[3] <= -1 && to.hi[3] >= 8 && to.lo[3] >= -4 && to.hi[3] <= 8);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(runs_to_the_end, set_up, tear_down),
    cmocka_unit_test_setup_teardown(tells_why_it_stopped, set_up, tear_down),
    cmocka_unit_test_setup_teardown(stops_on_request, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_to_start, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_pairs_that_do_not_fit, set_up, tear_down),
    cmocka_unit_test_setup_teardown(checks_times, set_up, tear_down),
    cmocka_unit_test_setup_teardown(checks_initial_values, set_up, tear_down),
    cmocka_unit_test_setup_teardown(checks_the_right_hand_side, set_up, tear_down),
    cmocka_unit_test_setup_teardown(builds_only_what_is_uncertain, set_up, tear_down),
    cmocka_unit_test_setup_teardown(encloses_initial_values, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
