/* test_evaluate.c -- expressions in an arithmetic that has nothing of its own, so that the enclosures are those of
** the kernel. */
#include <ambit/evaluate.h>
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

static ambit_evaluate_request request(const scene *s, size_t n, const ambit_expr *e) {
  return (ambit_evaluate_request) {
    .graph = s->graph, .registry = s->registry, .arithmetic = "small", .nexpr = n, .expr = e
  };
}

static ambit_interval evaluate(const ambit_evaluate_request *q, uint32_t *flags, ambit_report *report) {
  ambit_failure f = { 0 };
  ambit_interval out[8];
  if (ambit_evaluate(q, out, flags, report, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return out[0];
}

static void assert_refused(const ambit_evaluate_request *q, const char *part) {
  ambit_failure f = { 0 };
  ambit_interval out[8];
  assert_int_equal(ambit_evaluate(q, out, NULL, NULL, &f), AMBIT_INVALID);
  if (!strstr(f.message, part)) fail_msg("\"%s\" expected, got: %s", part, f.message);
}

static void encloses_the_image(void **state) {
  scene *s = *state;
  ambit_expr x = scene_unknown(s, "x", 1, 2), y = scene_unknown(s, "y", -1, 3);
  ambit_expr product = ambit_graph_op(s->graph, AMBIT_OP_MUL, x, y);
  ambit_evaluate_request q = request(s, 1, &product);
  uint32_t flags = 99;
  ambit_report report;
  ambit_interval z = evaluate(&q, &flags, &report);
  assert_true(z.lo == -2 && z.hi == 6);
  assert_int_equal(flags, 0);
  assert_int_equal(report.unknowns, 2);
  assert_int_equal(report.expressions, 1);
  assert_int_equal(report.tape_instructions, 1);
  assert_string_equal(report.arithmetic, "small");
}

static void shares_unknowns(void **state) {
  scene *s = *state;
  ambit_expr x = scene_unknown(s, "x", 1, 2), y = scene_unknown(s, "y", 1, 2);
  ambit_expr e[] = { ambit_graph_op(s->graph, AMBIT_OP_SUB, x, x), ambit_graph_op(s->graph, AMBIT_OP_SUB, x, y) };
  ambit_evaluate_request same = request(s, 1, &e[0]), other = request(s, 1, &e[1]);
  ambit_interval z = evaluate(&same, NULL, NULL);
  assert_true(z.lo == 0 && z.hi == 0);
  z = evaluate(&other, NULL, NULL);
  assert_true(z.lo == -1 && z.hi == 1);
}

static void carries_only_what_is_uncertain(void **state) {
  scene *s = *state;
  ambit_report report;
  ambit_expr x = scene_unknown(s, "x", 1, 2), fixed = scene_unknown(s, "fixed", 3, 3),
             unused = scene_unknown(s, "unused", 0, 1);
  ambit_expr e = ambit_graph_op(
      s->graph, AMBIT_OP_ADD, x, ambit_graph_op(s->graph, AMBIT_OP_MUL, fixed, ambit_graph_number(s->graph, 2)));
  ambit_evaluate_request q = request(s, 1, &e);
  ambit_interval z = evaluate(&q, NULL, &report);
  assert_true(z.lo == 7 && z.hi == 8);
  assert_int_equal(report.unknowns, 1);
  assert_true(unused != x);
}

static void puts_values_in(void **state) {
  scene *s = *state;
  ambit_expr q1 = ambit_graph_symbol(s->graph, "q1", "rad"), q2 = ambit_graph_symbol(s->graph, "q2", "rad");
  ambit_expr sum = ambit_graph_op(s->graph, AMBIT_OP_ADD, q1, q2);
  ambit_expr leaf[] = { q1, q2 }, value[] = { ambit_graph_number(s->graph, 4), scene_unknown(s, NULL, 0, 1) };
  ambit_evaluate_request q = request(s, 1, &sum);
  assert_refused(&q, "`q1`, `q2` have no value; `at`");
  q.nbinding = 1;
  q.leaf = leaf;
  q.value = value;
  assert_refused(&q, "`q2` has no value");
  q.nbinding = 2;
  ambit_interval z = evaluate(&q, NULL, NULL);
  assert_true(z.lo == 4 && z.hi == 5);
  ambit_expr t = ambit_graph_time(s->graph);
  q = request(s, 1, &t);
  assert_refused(&q, "`t` has no value");
}

static void raises_flags(void **state) {
  static const struct {
    uint32_t op;
    double lo, hi;
    uint32_t flags;
  } expected[] = {
    { AMBIT_OP_SQRT, -1, 4, AMBIT_F_PARTIAL },
    { AMBIT_OP_LOG, -2, -1, AMBIT_F_PARTIAL | AMBIT_F_EMPTY },
    { AMBIT_OP_LOG, 0, 1, AMBIT_F_PARTIAL | AMBIT_F_UNBOUNDED },
    { AMBIT_OP_EXP, 0, 1, 0 },
  };
  scene *s = *state;
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
    ambit_expr x = scene_unknown(s, NULL, expected[i].lo, expected[i].hi),
               e = ambit_graph_op(s->graph, expected[i].op, x, x);
    ambit_evaluate_request q = request(s, 1, &e);
    uint32_t flags = 0;
    ambit_interval z = evaluate(&q, &flags, NULL);
    assert_int_equal(flags, expected[i].flags);
    assert_false(isnan(z.lo) || isnan(z.hi));
    assert_int_equal(ambit_interval_is_empty(z), (flags & AMBIT_F_EMPTY) != 0);
  }
}

static void takes_options(void **state) {
  scene *s = *state;
  ambit_expr x = scene_unknown(s, "x", 1, 2);
  ambit_option option = { "degree", "3" };
  ambit_evaluate_request q = request(s, 1, &x);
  q.arithmetic = "newer";
  q.noption = 1;
  q.option = &option;
  ambit_interval z = evaluate(&q, NULL, NULL);
  assert_true(z.lo == 1 && z.hi == 2);
  option.text = "0";
  assert_refused(&q, "arithmetic `newer`: degree 0 is below 1");
  option.text = "high";
  assert_refused(&q, "arithmetic `newer`: option `degree` must be an integer");
  option.name = "degre";
  assert_refused(&q, "did you mean `degree`?");
  q.arithmetic = "small";
  assert_refused(&q, "has no options");
  q.arithmetic = "smal";
  assert_refused(&q, "did you mean `small`?");
}

static void takes_no_expression_and_no_uncertainty(void **state) {
  scene *s = *state;
  ambit_evaluate_request q = request(s, 0, NULL);
  ambit_interval out = { 5, 5 };
  assert_int_equal(ambit_evaluate(&q, &out, NULL, NULL, NULL), AMBIT_OK);
  assert_true(out.lo == 5);
  ambit_expr pi = ambit_graph_pi(s->graph), none = AMBIT_NO_EXPR;
  q = request(s, 1, &pi);
  out = evaluate(&q, NULL, NULL);
  assert_true(out.lo == 0x1.921fb54442d18p1 && out.hi == 0x1.921fb54442d19p1);
  q = request(s, 1, &none);
  assert_refused(&q, "expression 1");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(encloses_the_image, set_up, tear_down),
    cmocka_unit_test_setup_teardown(shares_unknowns, set_up, tear_down),
    cmocka_unit_test_setup_teardown(carries_only_what_is_uncertain, set_up, tear_down),
    cmocka_unit_test_setup_teardown(puts_values_in, set_up, tear_down),
    cmocka_unit_test_setup_teardown(raises_flags, set_up, tear_down),
    cmocka_unit_test_setup_teardown(takes_options, set_up, tear_down),
    cmocka_unit_test_setup_teardown(takes_no_expression_and_no_uncertainty, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
