/* Derivatives against central differences in 400 bits; substitution, terms, leaves, text. */
#include "sampler.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <time.h>
#include <cmocka.h>

#define STEP (-100) /* h = 2^STEP: the difference quotient is off by f''' h^2/6 */

/* Velocities of the five leaves; x alone moves when `only_x`. */
static const double rate[5] = { 1, -0.5, 0.25, 2, 1 };
static bool only_x;

/* Points 0, 1, 2: a random point, and h forward and back along the velocities. */
static void draw_values(uint64_t *state, size_t which, mpfr_t value[SAMPLER_POINTS]) {
  double middle = which == 2 || which == 3 ? oracle_uniform(state, 1.1, 1.9) : oracle_uniform(state, -3, 3);
  double velocity = only_x ? which == 0 : rate[which];
  for (size_t p = 0; p < SAMPLER_POINTS; p++) {
    double h = p == 0 ? 0 : p == 1 ? ldexp(velocity, STEP) : -ldexp(velocity, STEP);
    mpfr_set_d(value[p], middle, MPFR_RNDN);
    mpfr_add_d(value[p], value[p], h, MPFR_RNDN);
  }
}

static void check_derivative(const pool *q, const judged *j, ambit_expr d) {
  const sample *derivative = sampler_at(&q->s, d, 0);
  for (size_t p = 0; p < SAMPLER_POINTS; p++)
    if (j->truth[p].state != DEFINED) return;
  if (derivative->state != DEFINED) return; /* sqrt, asin at the ends of their domains */
  sample quotient;
  sample_init(&quotient);
  mpfr_sub(quotient.v, j->truth[1].v, j->truth[2].v, MPFR_RNDN);
  mpfr_mul_2si(quotient.v, quotient.v, -STEP - 1, MPFR_RNDN);
  if (!sample_close(&quotient, derivative, 1e-20)) {
    char text[2000];
    ambit_graph_text(q->s.g, j->e, text, sizeof text);
    fail_msg("wrong derivative of %s", text);
  }
  mpfr_clear(quotient.v);
}

static size_t differentiate_random(pool *q, uint64_t *state) {
  size_t count = 0;
  ambit_failure f = { 0 };
  ambit_expr leaf[] = { q->x, q->y, q->u, q->v }, speed[4];
  for (size_t i = 0; i < 4; i++) speed[i] = ambit_graph_number(q->s.g, rate[i]);
  while (q->count < 120) {
    judged *j = pool_grow(q, state, true);
    ambit_expr d = only_x ? ambit_graph_derivative(q->s.g, j->e, q->x, &f)
                          : ambit_graph_time_derivative(q->s.g, j->e, 4, leaf, speed, &f);
    assert_int_equal(f.status, AMBIT_OK);
    assert_int_not_equal(d, AMBIT_NO_EXPR);
    sampler_update(&q->s);
    check_derivative(q, j, d);
    count += d > 1 && sampler_at(&q->s, d, 0)->state == DEFINED;
  }
  return count;
}

static void random_derivatives(void **unused) {
  (void)unused;
  uint64_t state = 21;
  static pool q;
  size_t count = 0;
  for (int round = 0; round < 120; round++) {
    only_x = round % 2;
    pool_open(&q, &state, draw_values);
    count += differentiate_random(&q, &state);
    pool_close(&q);
  }
  assert_true(count > 1000);
}

/* -- by hand */

static ambit_graph *g;
static ambit_expr x, y, z;

static int open_graph(void **unused) {
  (void)unused;
  g = ambit_graph_open();
  x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "y", "m"), z = ambit_graph_symbol(g, "z", "m");
  return 0;
}

static int close_graph(void **unused) {
  (void)unused;
  ambit_graph_close(g);
  return 0;
}

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
#define NUMBER(c) ambit_graph_number(g, c)

static ambit_expr of_x(uint32_t op, ambit_expr a, ambit_expr b) {
  ambit_failure f = { 0 };
  return ambit_graph_derivative(g, ambit_graph_op(g, op, a, b), x, &f);
}

static void simple_derivatives(void **unused) {
  (void)unused;
  assert_int_equal(of_x(AMBIT_OP_ADD, x, y), 1);
  assert_int_equal(of_x(AMBIT_OP_MUL, x, y), y);
  assert_int_equal(of_x(AMBIT_OP_SQR, x, 0), OP(MUL, NUMBER(2), x));
  assert_int_equal(of_x(AMBIT_OP_SIN, x, 0), OP(COS, x, 0));
  assert_int_equal(of_x(AMBIT_OP_COS, x, 0), OP(NEG, OP(SIN, x, 0), 0));
  assert_int_equal(of_x(AMBIT_OP_EXP, x, 0), OP(EXP, x, 0));
  assert_int_equal(of_x(AMBIT_OP_SIN, y, 0), 0);
  ambit_failure f = { 0 };
  assert_int_equal(ambit_graph_derivative(g, ambit_graph_pown(g, x, 3), x, &f), OP(MUL, NUMBER(3), OP(SQR, x, 0)));
  ambit_expr t = ambit_graph_time(g), leaf[] = { x }, rates[] = { y };
  assert_int_equal(ambit_graph_time_derivative(g, OP(MUL, x, t), 1, leaf, rates, &f), OP(ADD, x, OP(MUL, t, y)));
  assert_int_equal(ambit_graph_derivative(g, OP(MUL, x, t), x, &f), t);
}

static void kinks_are_refused_by_name(void **unused) {
  (void)unused;
  static const uint32_t op[] = { AMBIT_OP_ABS, AMBIT_OP_MIN, AMBIT_OP_MAX };
  static const char *const name[] = { "abs", "min", "max" };
  for (size_t i = 0; i < 3; i++) {
    ambit_failure f = { 0 };
    ambit_expr e = OP(ADD, x, ambit_graph_op(g, op[i], x, y));
    assert_int_equal(ambit_graph_derivative(g, e, x, &f), AMBIT_NO_EXPR);
    assert_int_equal(f.status, AMBIT_INVALID);
    assert_non_null(strstr(f.message, name[i]));
    ambit_failure_clear(&f);
    assert_int_equal(ambit_graph_derivative(g, OP(ADD, z, e), z, &f), 1); /* fixed operands */
    assert_int_equal(f.status, AMBIT_OK);
  }
}

static ambit_interval at(ambit_expr e, double vx, double vy) {
  ambit_failure f = { 0 };
  ambit_expr from[] = { x, y }, to[] = { NUMBER(vx), NUMBER(vy) };
  assert_int_equal(ambit_graph_substitute(g, 1, &e, 2, from, to, &f), AMBIT_OK);
  return ambit_graph_node(g, e)->range;
}

/* With x' = 3 and y' = 5: that of the operand that is taken; no value where both are. */
static void rates_off_kinks(void **unused) {
  (void)unused;
  ambit_failure f = { 0 };
  ambit_expr leaf[] = { x, y }, rates[] = { NUMBER(3), NUMBER(5) };
  ambit_expr e[] = { OP(ABS, x, 0), OP(MIN, x, y), OP(MAX, x, y) };
  static const double value[][5] = { { -2, 7, -3, 3, 5 }, { 2, 1, 3, 5, 3 } }; /* x, y; the rates */
  for (size_t i = 0; i < 3; i++) {
    ambit_expr d = ambit_graph_rate_off_kinks(g, e[i], 2, leaf, rates, &f);
    for (size_t k = 0; k < 2; k++) {
      ambit_interval r = at(d, value[k][0], value[k][1]);
      assert_true(r.lo == value[k][2 + i] && r.hi == r.lo);
    }
    assert_false(ambit_interval_is_bounded(at(d, 0, 0)) && !ambit_interval_is_empty(at(d, 0, 0)));
  }
}

static void substitution(void **unused) {
  (void)unused;
  ambit_failure f = { 0 };
  ambit_expr e[] = { OP(SIN, OP(ADD, x, y), 0), OP(SUB, x, y), z, ambit_graph_pown(g, x, 3) };
  ambit_expr from[] = { x, y }, to[] = { y, x };
  ambit_expr want[] = { e[0], OP(SUB, y, x), z, ambit_graph_pown(g, y, 3) };
  assert_int_equal(ambit_graph_substitute(g, 4, e, 2, from, to, &f), AMBIT_OK); /* at once, not one after the other */
  assert_memory_equal(e, want, sizeof e);
  to[0] = to[1] = NUMBER(2);
  assert_int_equal(ambit_graph_substitute(g, 4, e, 2, from, to, &f), AMBIT_OK);
  assert_int_equal(e[1], 0);
  assert_int_equal(e[3], NUMBER(8));
}

static void additive_terms(void **unused) {
  (void)unused;
  ambit_expr p = OP(SIN, x, 0), q = OP(MUL, x, y), e = OP(SUB, OP(SUB, p, q), OP(NEG, OP(ADD, z, NUMBER(3)), 0)),
             term[8];
  bool negative[8];
  assert_int_equal(ambit_graph_terms(g, e, 8, term, negative), 4);
  size_t plus = 0, minus = 0;
  for (size_t i = 0; i < 4; i++) *(negative[i] ? &minus : &plus) += term[i];
  assert_int_equal(minus, q);
  assert_int_equal(plus, p + z + NUMBER(3));
  assert_int_equal(ambit_graph_terms(g, e, 2, term, negative), 4);
  assert_int_equal(ambit_graph_terms(g, p, 8, term, negative), 1);
  assert_int_equal(term[0], p);
}

static void leaves_and_size(void **unused) {
  (void)unused;
  ambit_expr u = ambit_graph_unknown(g, "u", (ambit_interval) { 0, 1 }), t = ambit_graph_time(g), leaf[8];
  ambit_expr e[] = { OP(ADD, OP(MUL, t, u), OP(SIN, y, 0)), OP(SIN, y, 0) };
  assert_int_equal(ambit_graph_leaves(g, 2, e, 8, leaf), 3);
  assert_int_equal(leaf[0], y);
  assert_int_equal(leaf[1], u);
  assert_int_equal(leaf[2], t);
  assert_int_equal(ambit_graph_size(g, 2, e), 3);
  assert_int_equal(ambit_graph_size(g, 1, &x), 0);
}

static void expect_text(ambit_expr e, const char *want) {
  char text[200];
  size_t n = ambit_graph_text(g, e, text, sizeof text);
  assert_string_equal(text, want);
  assert_int_equal(n, strlen(want));
  char few[5];
  assert_int_equal(ambit_graph_text(g, e, few, sizeof few), n);
  assert_int_equal(strlen(few), n < 4 ? n : 4);
  assert_memory_equal(few, want, strlen(few));
}

static void text(void **unused) {
  (void)unused;
  expect_text(OP(ADD, OP(MUL, NUMBER(0.5), OP(SIN, x, 0)), y), "y + 0.5*sin(x)");
  expect_text(OP(SUB, x, OP(SUB, y, z)), "x - (y - z)");
  expect_text(OP(MUL, OP(ADD, x, y), z), "z*(x + y)");
  expect_text(OP(DIV, x, OP(MUL, y, z)), "x/(y*z)");
  expect_text(OP(NEG, OP(ADD, x, y), 0), "-(x + y)");
  expect_text(OP(MUL, NUMBER(-2), x), "-2*x");
  expect_text(ambit_graph_pown(g, OP(ADD, x, y), -3), "(x + y)^-3");
  expect_text(OP(SQR, OP(COS, x, 0), 0), "cos(x)^2");
  expect_text(OP(ATAN2, x, OP(ADD, y, z)), "atan2(x, y + z)");
  expect_text(OP(SQR, ambit_graph_decimal(g, "1/3", NULL), 0), "(1/3)^2");
  expect_text(OP(MUL, NUMBER(2), ambit_graph_pi(g)), "2*pi");
}

/* 100 000 nodes deep: no recursion may follow the chain; text of astronomical length. */
static void deep_and_large(void **unused) {
  (void)unused;
  ambit_failure f = { 0 };
  clock_t start = clock();
  ambit_expr e = x;
  for (int i = 0; i < 100000; i++) e = OP(SIN, OP(ADD, e, y), 0);
  double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  assert_true(seconds < 5); /* a sanitizer build is slow; 0.06 otherwise */
  ambit_expr d = ambit_graph_derivative(g, e, x, &f), from = x, to = z;
  assert_int_not_equal(d, AMBIT_NO_EXPR);
  assert_int_equal(ambit_graph_substitute(g, 1, &e, 1, &from, &to, &f), AMBIT_OK);
  assert_int_equal(ambit_graph_size(g, 1, &e), 200000);
  char few[10];
  assert_int_equal(ambit_graph_text(g, e, few, sizeof few), 900001);
  assert_true(ambit_graph_text(g, d, few, sizeof few) > 900001);
  ambit_expr sum = 0, product = 1, other = OP(ADD, x, y);
  for (int i = 0; i < 100000; i++) {
    ambit_expr s = ambit_graph_unknown(g, NULL, (ambit_interval) { -1, 1 });
    sum = OP(ADD, sum, s);
    other = OP(ADD, other, s);
    if (i < 20000) product = OP(MUL, s, product);
  }
  ambit_expr term[3];
  bool negative[3];
  assert_int_equal(ambit_graph_terms(g, sum, 3, term, negative), 100000);
  assert_int_equal(OP(SUB, other, sum), OP(ADD, x, y)); /* all terms cancel, one after the other */
  assert_int_not_equal(OP(MUL, product, OP(MUL, product, x)), AMBIT_NO_EXPR);
  assert_int_equal(ambit_graph_simplify(g, e, 50), e);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_derivatives),
    cmocka_unit_test_setup_teardown(simple_derivatives, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(kinks_are_refused_by_name, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(rates_off_kinks, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(substitution, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(additive_terms, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(leaves_and_size, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(text, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(deep_and_large, open_graph, close_graph),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
