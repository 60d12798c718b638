/* test_monotone.c -- evaluate with derivatives: hand-made cases with known ranges, and random expressions against dense
** sampling at 200 bits.
*/
#include <ambit/graph.h>
#include <ambit/evaluate.h>
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct stage {
  ambit_graph *g;
  ambit_registry *registry;
} stage;

static int set_up(void **state) {
  stage *s = calloc(1, sizeof *s);
  s->g = ambit_graph_open();
  s->registry = ambit_registry_open(NULL);
  *state = s;
  return 0;
}

static int tear_down(void **state) {
  stage *s = *state;
  ambit_graph_close(s->g);
  ambit_registry_close(s->registry);
  free(s);
  return 0;
}

static ambit_expr unknown(stage *s, double lo, double hi) {
  return ambit_graph_unknown(s->g, NULL, (ambit_interval) { lo, hi });
}
static ambit_expr op(stage *s, uint32_t o, ambit_expr a, ambit_expr b) { return ambit_graph_op(s->g, o, a, b); }
static ambit_expr number(stage *s, double x) { return ambit_graph_number(s->g, x); }

static ambit_interval evaluate(stage *s, const char *arithmetic, ambit_expr e, uint32_t *flags) {
  ambit_failure f = { 0 };
  ambit_interval out;
  const ambit_evaluate_request q = {
    .graph = s->g, .registry = s->registry, .arithmetic = arithmetic, .nexpr = 1, .expr = &e
  };
  if (ambit_evaluate(&q, &out, flags, NULL, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return out;
}

static void expect(stage *s, ambit_expr e, double lo, double hi) {
  uint32_t flags;
  ambit_interval x = evaluate(s, "gradient", e, &flags);
  double room = 1e-14 * fmax(fabs(lo), fabs(hi));
  if (!(x.lo <= lo && hi <= x.hi && x.lo >= lo - room && x.hi <= hi + room))
    fail_msg("[%.17g, %.17g], expected [%.17g, %.17g]", x.lo, x.hi, lo, hi);
}

static void finds_corners(void **state) {
  stage *s = *state;
  ambit_expr x = unknown(s, 1, 2), y = unknown(s, 2, 3);
  expect(s, op(s, AMBIT_OP_SUB, op(s, AMBIT_OP_MUL, x, y), x), 1, 4); /* natural: [0, 5] */
  ambit_expr square = op(s, AMBIT_OP_SQR, x, x);
  expect(s, op(s, AMBIT_OP_SUB, square, op(s, AMBIT_OP_MUL, number(s, 6), x)), -8, -5); /* falls */
}

/* falls with x only where y is low, rises where y is high: seen after y is fixed */
static void becomes_monotone_on_a_face(void **state) {
  stage *s = *state;
  ambit_expr x = unknown(s, 0, 1), y = unknown(s, 0.5, 1.5);
  ambit_expr e = op(s, AMBIT_OP_SUB, op(s, AMBIT_OP_MUL, x, y), x);
  expect(s, op(s, AMBIT_OP_ADD, e, op(s, AMBIT_OP_MUL, number(s, 10), y)), 4.5, 15.5);
}

static void takes_kinks(void **state) {
  stage *s = *state;
  ambit_expr x = unknown(s, -1, 1);
  ambit_expr size = op(s, AMBIT_OP_ABS, x, x), twice = op(s, AMBIT_OP_MUL, number(s, 2), x);
  expect(s, op(s, AMBIT_OP_SUB, size, twice), -1, 3); /* natural: [-2, 3] */
  ambit_expr larger = op(s, AMBIT_OP_MAX, x, number(s, 0));
  expect(s, op(s, AMBIT_OP_ADD, larger, twice), -2, 3);
}

static void does_not_trust_a_jump(void **state) {
  stage *s = *state;
  ambit_expr y = unknown(s, -1, 1);
  /* the derivative is negative wherever there is one, but the angle jumps from -pi to pi */
  expect(s, op(s, AMBIT_OP_ATAN2, y, number(s, -1)), -0x1.921fb54442d19p1, 0x1.921fb54442d19p1);
}

static void needs_the_whole_domain(void **state) {
  stage *s = *state;
  uint32_t flags;
  ambit_expr x = unknown(s, -1, 1), root = op(s, AMBIT_OP_SQRT, x, x);
  ambit_interval r = evaluate(s, "gradient", op(s, AMBIT_OP_SUB, root, x), &flags);
  assert_true((flags & AMBIT_F_PARTIAL) && r.lo <= 0 && r.hi >= 0.25);
  /* 1/x rises nowhere and jumps at 0 */
  r = evaluate(s, "gradient", op(s, AMBIT_OP_DIV, number(s, 1), x), &flags);
  assert_true((flags & AMBIT_F_PARTIAL) && r.lo == -INFINITY && r.hi == INFINITY);
}

static void partial_elsewhere_does_not_matter(void **state) {
  stage *s = *state;
  ambit_expr x = unknown(s, 1, 2), y = unknown(s, -1, 1);
  ambit_expr e[] = { op(s, AMBIT_OP_SUB, op(s, AMBIT_OP_SQR, x, x), x), op(s, AMBIT_OP_LOG, y, y) };
  ambit_failure f = { 0 };
  ambit_interval out[2];
  uint32_t flags;
  const ambit_evaluate_request q = {
    .graph = s->g, .registry = s->registry, .arithmetic = "gradient", .nexpr = 2, .expr = e
  };
  assert_int_equal(ambit_evaluate(&q, out, &flags, NULL, &f), AMBIT_OK);
  assert_true(flags & AMBIT_F_PARTIAL);
  assert_true(out[0].lo == 0 && out[0].hi == 2 && out[1].lo == -INFINITY && out[1].hi >= 0);
}

static void unbounded_unknowns(void **state) {
  stage *s = *state;
  ambit_expr x = unknown(s, -INFINITY, 1), e = op(s, AMBIT_OP_EXP, x, x);
  uint32_t flags;
  ambit_interval r = evaluate(s, "gradient", op(s, AMBIT_OP_ADD, e, x), &flags);
  assert_true(r.lo == -INFINITY && r.hi >= 1 + exp(1) - 1e-15 && r.hi < 1 + exp(1) + 1e-14);
  assert_int_equal(flags, AMBIT_F_UNBOUNDED);
}

/* -- random expressions */

enum { UNKNOWNS = 4, POOL = 24, SAMPLES = 12 };

static bool is_tame(stage *s, ambit_expr e) {
  if (e == AMBIT_NO_EXPR) return false;
  const ambit_node *x = ambit_graph_node(s->g, e);
  return x->total && x->range.lo > -1e3 && x->range.hi < 1e3;
}

static ambit_expr random_expression(stage *s, uint64_t *seed, const ambit_expr *x) {
  ambit_expr pool[POOL];
  size_t n = 0;
  for (; n < UNKNOWNS; n++) pool[n] = x[n];
  pool[n++] = number(s, oracle_uniform(seed, -3, 3));
  for (int tries = 0; n < POOL && tries < 200; tries++) {
    uint32_t o = (uint32_t)(oracle_random(seed) % AMBIT_OP_COUNT);
    ambit_expr a = pool[oracle_random(seed) % n], b = pool[oracle_random(seed) % n];
    ambit_expr r =
        o == AMBIT_OP_POWN ? ambit_graph_pown(s->g, a, (int32_t)(oracle_random(seed) % 6) - 2) : op(s, o, a, b);
    if (is_tame(s, r) && !ambit_graph_node(s->g, r)->constant) pool[n++] = r;
  }
  ambit_expr product = op(s, AMBIT_OP_MUL, pool[n - 1], pool[n - 2]); /* so that unknowns occur often */
  return op(s, AMBIT_OP_SUB, product, pool[n - 3]);
}

/* an enclosure of the value at a point, about one ulp wide */
static ambit_interval value_at(stage *s, ambit_expr e, const ambit_expr *x, const double *at) {
  ambit_expr value[UNKNOWNS];
  ambit_failure f = { 0 };
  ambit_interval out;
  for (int j = 0; j < UNKNOWNS; j++) value[j] = number(s, at[j]);
  const ambit_option bits = { "precision", "200" };
  const ambit_evaluate_request q = { .graph = s->g,
    .registry = s->registry,
    .arithmetic = "mpfr",
    .noption = 1,
    .option = &bits,
    .nexpr = 1,
    .expr = &e,
    .nbinding = UNKNOWNS,
    .leaf = x,
    .value = value };
  if (ambit_evaluate(&q, &out, NULL, NULL, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return out;
}

static void contains_samples_and_is_narrower(void **state) {
  stage *s = *state;
  uint64_t seed = 2024;
  int narrower = 0;
  for (int i = 0; i < 1500; i++) {
    ambit_expr x[UNKNOWNS];
    double width = ldexp(1, -(int)(oracle_random(&seed) % 8));
    for (int j = 0; j < UNKNOWNS; j++) {
      double c = oracle_uniform(&seed, -2, 2);
      x[j] = unknown(s, c - width, c + width);
    }
    ambit_expr e = random_expression(s, &seed, x);
    ambit_interval tight = evaluate(s, "gradient", e, NULL), natural = evaluate(s, "interval", e, NULL);
    assert_true(natural.lo <= tight.lo && tight.hi <= natural.hi);
    narrower += tight.hi - tight.lo < 0.99 * (natural.hi - natural.lo);
    for (int k = 0; k < SAMPLES; k++) {
      double at[UNKNOWNS];
      for (int j = 0; j < UNKNOWNS; j++) {
        ambit_interval box = ambit_graph_node(s->g, x[j])->value;
        uint64_t where = oracle_random(&seed) % 4;
        at[j] = where == 0 ? box.lo : where == 1 ? box.hi : oracle_uniform(&seed, box.lo, box.hi);
      }
      ambit_interval v = value_at(s, e, x, at);
      if (!(v.hi >= tight.lo && v.lo <= tight.hi))
        fail_msg("expression %d: [%.17g, %.17g] misses [%.17g, %.17g]", i, tight.lo, tight.hi, v.lo, v.hi);
    }
  }
  if (narrower < 400) fail_msg("only %d of 1500 are narrower", narrower);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(finds_corners, set_up, tear_down),
    cmocka_unit_test_setup_teardown(becomes_monotone_on_a_face, set_up, tear_down),
    cmocka_unit_test_setup_teardown(takes_kinks, set_up, tear_down),
    cmocka_unit_test_setup_teardown(does_not_trust_a_jump, set_up, tear_down),
    cmocka_unit_test_setup_teardown(needs_the_whole_domain, set_up, tear_down),
    cmocka_unit_test_setup_teardown(partial_elsewhere_does_not_matter, set_up, tear_down),
    cmocka_unit_test_setup_teardown(unbounded_unknowns, set_up, tear_down),
    cmocka_unit_test_setup_teardown(contains_samples_and_is_narrower, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
