/* test_suggest.c -- the facts by which a solver is chosen, against systems whose answers are known in closed form. */
#include "verbs/simulate/suggest.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

enum { MOST = 2 };

typedef struct stage {
  ambit_graph *g;
  ambit_expr state[MOST], rate[MOST], initial[MOST];
  ambit_system system;
} stage;

static const char *const names[] = { "x", "y" }, *const units[] = { "1", "1" };

static void open_stage(stage *s, size_t nx) {
  *s = (stage) { .g = ambit_graph_open() };
  for (size_t i = 0; i < nx; i++) s->state[i] = ambit_graph_symbol(s->g, names[i], units[i]);
  s->system = (ambit_system) { s->g, nx, names, units, s->state, s->rate, 0, NULL, NULL, NULL, 0, NULL, NULL, NULL };
}

static ambit_expr number(stage *s, double x) { return ambit_graph_number(s->g, x); }
static ambit_expr op(stage *s, uint32_t code, ambit_expr a, ambit_expr b) { return ambit_graph_op(s->g, code, a, b); }
static ambit_expr add(stage *s, ambit_expr a, ambit_expr b) { return op(s, AMBIT_OP_ADD, a, b); }
static ambit_expr mul(stage *s, ambit_expr a, ambit_expr b) { return op(s, AMBIT_OP_MUL, a, b); }
static ambit_expr range(stage *s, double lo, double hi) {
  return ambit_graph_unknown(s->g, NULL, (ambit_interval) { lo, hi });
}

static ambit_suggest_facts look(stage *s, double end) {
  const double time[] = { 0, end };
  ambit_simulate_request q = { .system = &s->system, .initial = s->initial, .ntime = 2, .time = time };
  ambit_suggest_facts facts, again;
  ambit_failure f = { 0 };
  if (ambit_suggest_look(&q, &facts, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_int_equal(ambit_suggest_look(&q, &again, &f), AMBIT_OK);
  assert_memory_equal(&facts, &again, sizeof facts); /* no clock, no chance */
  assert_true(facts.horizon == fabs(end));
  return facts;
}

/* x' = a x + b y, y' = c x + d y */
static ambit_suggest_facts look_linear(const double m[4], double end) {
  stage s;
  open_stage(&s, 2);
  for (int i = 0; i < 2; i++) {
    s.rate[i] = add(&s, mul(&s, number(&s, m[2 * i]), s.state[0]), mul(&s, number(&s, m[2 * i + 1]), s.state[1]));
    s.initial[i] = range(&s, 1, 2 + i);
  }
  ambit_suggest_facts facts = look(&s, end);
  ambit_graph_close(s.g);
  return facts;
}

static void assert_near(double x, double expected, double part) {
  if (!(fabs(x - expected) <= part * fabs(expected))) fail_msg("%g where %g was expected", x, expected);
}

static void finds_the_fastest_motion(void **state) {
  (void)state;
  ambit_suggest_facts f = look_linear((double[]) { -1000, 3, 0, -1 }, 2); /* real: -1000 and -1 */
  assert_near(f.decay, 2000, 0.01);
  assert_true(f.seen == 1 && f.swing == 0 && f.steps < 200);
  f = look_linear((double[]) { -1, 10, -10, -1 }, 3); /* -1 +- 10 i */
  assert_near(f.decay, 3, 0.01);
  assert_near(f.swing, 30, 0.01);
  f = look_linear((double[]) { 0, 5, -5, 0 }, 2); /* +- 5 i */
  assert_true(f.decay < 1e-6);
  assert_near(f.swing, 10, 0.01);
  f = look_linear((double[]) { 0, 4, 4, 0 }, 1); /* +- 4: one of them decays */
  assert_near(f.decay, 4, 0.01);
  f = look_linear((double[]) { 0, 0, 0, 0 }, 1);
  assert_true(f.decay == 0 && f.swing == 0 && f.seen == 1);
  f = look_linear((double[]) { -7, 0, 0, -7 }, 1); /* all directions alike */
  assert_near(f.decay, 7, 0.01);
}

static void linear_equations_do_not_bend(void **state) {
  (void)state;
  ambit_suggest_facts f = look_linear((double[]) { -1, 10, -10, -1 }, 3);
  if (!(f.bend < 1e-9 && f.spread > 0.4 && f.width > 0.4)) fail_msg("%g %g %g", f.bend, f.spread, f.width);
  assert_int_equal(f.unknowns, 2);
  f = look_linear((double[]) { -1000, 3, 0, -1 }, 2);
  assert_true(f.bend < 1e-9);
}

/* x' = -a x^2, x(t) = x0 / (1 + a x0 t) */
static void measures_how_data_bend_the_solution(void **state) {
  (void)state;
  stage s;
  open_stage(&s, 1);
  ambit_expr a = range(&s, 0.5, 1);
  s.rate[0] = op(&s, AMBIT_OP_NEG, mul(&s, a, op(&s, AMBIT_OP_SQR, s.state[0], s.state[0])), 0);
  s.initial[0] = range(&s, 1, 3);
  ambit_suggest_facts f = look(&s, 1);
  double worst = 0;
  for (int k = 0; k <= 16; k++) {
    double t = k / 16.0, least = 1 / (1 + 0.5 * t), most = 3 / (1 + 3 * t), middle = 2 / (1 + 0.75 * 2 * t);
    worst = fmax(worst, fabs(0.5 * least + 0.5 * most - middle) / 3);
  }
  assert_near(f.bend, worst, 0.1);
  assert_near(f.spread, 2.0 / 3, 1e-9);
  assert_near(f.width, 2.0 / 3, 1e-9);
  assert_int_equal(f.parameters, 1);
  ambit_graph_close(s.g);
}

static void stops_looking_where_solutions_end(void **state) {
  (void)state;
  stage s;
  open_stage(&s, 1);
  s.rate[0] = op(&s, AMBIT_OP_SQR, s.state[0], s.state[0]); /* escapes at t = 1 */
  s.initial[0] = number(&s, 1);
  assert_near(look(&s, 2).seen, 0.5, 0.05);
  s.rate[0] = op(&s, AMBIT_OP_SQRT, s.state[0], s.state[0]); /* not defined from the start */
  s.initial[0] = number(&s, -1);
  assert_true(look(&s, 2).seen == 0);
  ambit_graph_close(s.g);
}

/* y = x' = -sin t changes its sign at pi */
static void sees_kinks_only_where_they_are_crossed(void **state) {
  (void)state;
  stage s;
  open_stage(&s, 2);
  s.rate[0] = s.state[1];
  s.rate[1] =
      add(&s, op(&s, AMBIT_OP_NEG, s.state[0], 0), mul(&s, number(&s, 1e-6), op(&s, AMBIT_OP_ABS, s.state[1], 0)));
  s.initial[0] = number(&s, 1);
  s.initial[1] = number(&s, -1e-3);
  assert_string_equal(look(&s, 3).kink, "");
  assert_int_equal(look(&s, 3).kinks, 1);
  assert_non_null(strstr(look(&s, 4).kink, "abs"));
  ambit_graph_close(s.g);
}

static void explains_what_cannot_be_looked_at(void **state) {
  (void)state;
  stage s;
  open_stage(&s, 1);
  s.rate[0] = s.state[0];
  s.initial[0] = op(&s, AMBIT_OP_SQRT, range(&s, -1, 1), 0);
  const double time[] = { 0, 1 };
  ambit_simulate_request q = { .system = &s.system, .initial = s.initial, .ntime = 2, .time = time };
  ambit_suggest_facts facts;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_suggest_look(&q, &facts, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "not defined for all values"));
  ambit_graph_close(s.g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(finds_the_fastest_motion),
    cmocka_unit_test(linear_equations_do_not_bend),
    cmocka_unit_test(measures_how_data_bend_the_solution),
    cmocka_unit_test(stops_looking_where_solutions_end),
    cmocka_unit_test(sees_kinks_only_where_they_are_crossed),
    cmocka_unit_test(explains_what_cannot_be_looked_at),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
