/* test_faults.c -- arithmetics that say they are rigorous and give what no enclosure can be: the verbs say BROKEN and
** whose fault it is, and give nothing out. */
#include <ambit/evaluate.h>
#include "verbs/scene.h"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static ambit_status evaluate(const char *lie, ambit_interval box, ambit_interval *out, ambit_failure *f) {
  scene *s = scene_open();
  ambit_expr x = ambit_graph_unknown(s->graph, "x", box), y = ambit_graph_op(s->graph, AMBIT_OP_EXP, x, x);
  ambit_option option = { "lie", lie };
  ambit_evaluate_request q = { .graph = s->graph,
    .registry = s->registry,
    .arithmetic = "liar",
    .noption = 1,
    .option = &option,
    .nexpr = 1,
    .expr = &y };
  ambit_status status = ambit_evaluate(&q, out, NULL, NULL, f);
  scene_close(s);
  return status;
}

static void evaluations_are_refused(void **state) {
  static const struct {
    const char *lie, *message;
  } expected[] = {
    { "nan", "it says that it is rigorous, and gave the bounds [nan, " },
    { "reversed", "it says that it is rigorous, and gave the bounds [2, 1]" },
    { "empty", "gave an empty set of what is defined everywhere, [inf, -inf]" },
    { "derivative", "gave a derivative within [nan, inf]" },
  };
  (void)state;
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
    ambit_failure f = { 0 };
    ambit_interval out;
    assert_int_equal(evaluate(expected[i].lie, (ambit_interval) { 1, 2 }, &out, &f), AMBIT_BROKEN);
    if (!strstr(f.message, "arithmetic `liar` is broken: ") || !strstr(f.message, expected[i].message))
      fail_msg("%s: %s", expected[i].lie, f.message);
  }
}

/* The same arithmetic, as long as it says nothing wrong; and a domain that is left. */
static void honest_ones_are_believed(void **state) {
  ambit_failure f = { 0 };
  ambit_interval out;
  (void)state;
  assert_int_equal(evaluate("nothing", (ambit_interval) { 1, 2 }, &out, &f), AMBIT_OK);
  assert_true(out.lo < 2.72 && out.hi > 7.38);
  assert_int_equal(evaluate("reversed", (ambit_interval) { 0, 0 }, &out, &f), AMBIT_OK); /* a number */
  scene *s = scene_open();
  ambit_expr x = scene_unknown(s, "x", -2, -1), y = ambit_graph_op(s->graph, AMBIT_OP_SQRT, x, x);
  ambit_evaluate_request q = {
    .graph = s->graph, .registry = s->registry, .arithmetic = "small", .nexpr = 1, .expr = &y
  };
  uint32_t flags = 0;
  assert_int_equal(ambit_evaluate(&q, &out, &flags, NULL, &f), AMBIT_OK);
  assert_true(ambit_interval_is_empty(out));
  assert_int_equal(flags, AMBIT_F_PARTIAL | AMBIT_F_EMPTY);
  scene_close(s);
}

/* A solver that gets such bounds: the run is broken, whatever the solver makes of them. */
static void runs_are_broken(void **state) {
  static const double time[] = { 0, 1 };
  (void)state;
  scene *s = scene_open();
  size_t i = scene_state(s, "x", scene_unknown(s, "x0", 1, 2));
  s->rate[i] = ambit_graph_op(s->graph, AMBIT_OP_SIN, s->state[i], s->state[i]);
  ambit_simulate_request q = scene_request(s, "lohner", 2, time);
  q.arithmetic = "liar";
  ambit_simulate_result result;
  ambit_failure f = { 0 };
  if (ambit_simulate(&q, &result, NULL, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_int_equal(result.status, AMBIT_BROKEN);
  if (!strstr(result.reason, "arithmetic `liar` is broken")) fail_msg("%s", result.reason);
  scene_close(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(evaluations_are_refused),
    cmocka_unit_test(honest_ones_are_believed),
    cmocka_unit_test(runs_are_broken),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
