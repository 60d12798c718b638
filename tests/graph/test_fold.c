/* Folding: every rule keeps value and domain (MPFR, random expressions); the rules that models rely on fire; node
** facts hold. */
#include "sampler.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void report(const pool *q, ambit_expr e, const char *what) {
  char text[2000];
  ambit_graph_text(q->s.g, e, text, sizeof text);
  fail_msg("%s: %s", what, text);
}

/* Range and totality of all nodes, garbage included. */
static void check_nodes(const pool *q) {
  for (ambit_expr e = 0; e < ambit_graph_count(q->s.g); e++) {
    const ambit_node *x = ambit_graph_node(q->s.g, e);
    for (size_t p = 0; p < SAMPLER_POINTS; p++) {
      const sample *s = sampler_at(&q->s, e, p);
      if (x->total && s->state == UNDEFINED) report(q, e, "not total");
      if (s->state == DEFINED && !sample_inside(s, x->range)) report(q, e, "out of range");
    }
  }
}

static void random_expressions_keep_value_and_domain(void **unused) {
  (void)unused;
  uint64_t state = 11;
  static pool q;
  for (int round = 0; round < 1000; round++) {
    pool_open(&q, &state, pool_draw);
    while (q.count < POOL_MAX) {
      const judged *j = pool_grow(&q, &state, false);
      const char *wrong = pool_differs(&q, j, j->e);
      if (wrong) report(&q, j->e, wrong);
    }
    check_nodes(&q);
    pool_close(&q);
  }
}

/* -- rules by name */

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
#define ADD(a, b) OP(ADD, a, b)
#define SUB(a, b) OP(SUB, a, b)
#define MUL(a, b) OP(MUL, a, b)
#define DIV(a, b) OP(DIV, a, b)
#define NEG(a) OP(NEG, a, 0)
#define SQR(a) OP(SQR, a, 0)
#define SIN(a) OP(SIN, a, 0)
#define COS(a) OP(COS, a, 0)
#define NUMBER(c) ambit_graph_number(g, c)

static void constants(void **unused) {
  (void)unused;
  assert_int_equal(NUMBER(0), 0);
  assert_int_equal(NUMBER(-0.0), 0);
  assert_int_equal(ADD(NUMBER(2), NUMBER(3)), NUMBER(5));
  assert_int_equal(DIV(NUMBER(1), NUMBER(4)), NUMBER(0.25));
  const ambit_node *third = ambit_graph_node(g, DIV(NUMBER(1), NUMBER(3)));
  assert_int_equal(third->op, AMBIT_OP_DIV); /* 1/3 is no double: left to the tape */
  assert_true(third->constant && third->total && third->range.lo < third->range.hi);
  assert_int_equal(ambit_graph_node(g, ADD(NUMBER(1), NUMBER(0x1p-60)))->op, AMBIT_OP_ADD);
  assert_int_equal(ambit_graph_node(g, DIV(NUMBER(1), NUMBER(0)))->op, AMBIT_OP_DIV);
  assert_int_equal(NUMBER(NAN), AMBIT_NO_EXPR);
  assert_int_equal(NUMBER(INFINITY), AMBIT_NO_EXPR);
  assert_int_equal(OP(SQRT, NUMBER(9), 0), NUMBER(3));
  assert_int_equal(SIN(NUMBER(0)), 0);
  assert_int_equal(OP(EXP, NUMBER(0), 0), NUMBER(1));
  assert_int_equal(ambit_graph_pown(g, NUMBER(-2), 3), NUMBER(-8));
}

static void literals(void **unused) {
  (void)unused;
  ambit_failure f = { 0 };
  ambit_expr tenth = ambit_graph_decimal(g, " 0.1 ", &f);
  const ambit_node *node = ambit_graph_node(g, tenth);
  assert_int_equal(node->op, AMBIT_LEAF_CONSTANT);
  assert_string_equal(node->text, "0.1");
  assert_true(node->value.lo < node->value.hi && node->value.hi == nextafter(node->value.lo, 1));
  assert_int_equal(ambit_graph_decimal(g, "0.1", &f), tenth);
  assert_int_equal(ambit_graph_decimal(g, "-0.1", &f), NEG(tenth));
  assert_int_equal(ambit_graph_decimal(g, "+0.1", &f), tenth);
  assert_int_equal(ambit_graph_decimal(g, "0.5", &f), NUMBER(0.5));
  assert_int_equal(ambit_graph_decimal(g, "3/4", &f), NUMBER(0.75));
  assert_int_equal(ambit_graph_decimal(g, "pi", &f), ambit_graph_pi(g));
  static const char *const bad[] = { "", "one", "0.1 m", "[0.1, 0.2]", "3.56?2", "inf", "--1", "1/0" };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ambit_failure_clear(&f);
    assert_int_equal(ambit_graph_decimal(g, bad[i], &f), AMBIT_NO_EXPR);
    assert_int_equal(f.status, AMBIT_INVALID);
    assert_true(strlen(f.message) > 0);
  }
}

static void sums(void **unused) {
  (void)unused;
  assert_int_equal(ADD(x, 0), x);
  assert_int_equal(SUB(x, 0), x);
  assert_int_equal(SUB(0, x), NEG(x));
  assert_int_equal(SUB(x, x), 0);
  assert_int_equal(NEG(NEG(x)), x);
  assert_int_equal(ADD(x, y), ADD(y, x));
  assert_int_equal(ADD(x, NEG(y)), SUB(x, y));
  assert_int_equal(SUB(x, NEG(y)), ADD(x, y));
  assert_int_equal(ADD(NEG(x), NEG(y)), NEG(ADD(x, y)));
  assert_int_equal(NEG(SUB(x, y)), SUB(y, x));
  assert_int_equal(ADD(x, x), MUL(NUMBER(2), x));
  assert_int_equal(ADD(MUL(NUMBER(3), x), MUL(x, NUMBER(-5))), MUL(NUMBER(-2), x));
  assert_int_equal(SUB(ADD(ADD(x, y), z), x), ADD(y, z));
  assert_int_equal(SUB(ADD(x, ADD(y, z)), ADD(z, ADD(y, x))), 0);
  assert_int_equal(ADD(ADD(NUMBER(1), x), NUMBER(2)), ADD(x, NUMBER(3)));
  ambit_expr partial = OP(LOG, x, 0);
  assert_int_not_equal(SUB(partial, partial), 0); /* x <= 0 must stay outside the domain */
  ambit_expr tenth = ambit_graph_decimal(g, "0.1", NULL);
  assert_int_equal(SUB(tenth, tenth), 0);
  ambit_interval wide = { 0, 1 };
  assert_int_not_equal(SUB(ambit_graph_interval(g, wide), ambit_graph_interval(g, wide)), 0); /* two numbers */
}

static void products(void **unused) {
  (void)unused;
  assert_int_equal(MUL(x, NUMBER(1)), x);
  assert_int_equal(MUL(NUMBER(0), x), 0);
  assert_int_equal(MUL(x, y), MUL(y, x));
  assert_int_equal(MUL(NEG(x), y), NEG(MUL(x, y)));
  assert_int_equal(MUL(NEG(x), NEG(y)), MUL(x, y));
  assert_int_equal(MUL(x, x), SQR(x));
  assert_int_equal(MUL(SQR(x), x), ambit_graph_pown(g, x, 3));
  assert_int_equal(MUL(MUL(x, y), x), MUL(SQR(x), y));
  assert_int_equal(MUL(NUMBER(2), MUL(NUMBER(3), x)), MUL(NUMBER(6), x));
  assert_int_equal(
      ambit_graph_node(g, MUL(NUMBER(0.1), MUL(NUMBER(0.1), x)))->op, AMBIT_OP_MUL); /* 0.01 is no double */
  assert_int_equal(SQR(NEG(x)), SQR(x));
  assert_int_equal(SQR(SUB(x, y)), SQR(SUB(y, x)));
  assert_int_equal(ambit_graph_pown(g, x, 0), 1);
  assert_int_equal(ambit_graph_pown(g, x, 1), x);
  assert_int_equal(ambit_graph_pown(g, x, 2), SQR(x));
  assert_int_equal(ambit_graph_pown(g, x, -1), DIV(NUMBER(1), x));
  assert_int_equal(SQR(SQR(x)), ambit_graph_pown(g, x, 4));
  ambit_expr partial = DIV(NUMBER(1), x);
  assert_int_not_equal(MUL(NUMBER(0), partial), 0);
  assert_int_not_equal(MUL(partial, x), 1);
  assert_int_not_equal(ambit_graph_pown(g, partial, 0), 1);
}

static void quotients(void **unused) {
  (void)unused;
  ambit_expr positive = SUB(NUMBER(2), SQR(COS(x)));
  assert_true(ambit_graph_node(g, positive)->range.lo == 1 && ambit_graph_node(g, positive)->range.hi == 2);
  assert_true(ambit_graph_node(g, DIV(NUMBER(1), positive))->total);
  assert_false(ambit_graph_node(g, DIV(NUMBER(1), x))->total);
  assert_int_equal(DIV(positive, positive), 1);
  assert_int_not_equal(DIV(x, x), 1);
  assert_int_equal(DIV(x, NUMBER(4)), MUL(NUMBER(0.25), x));
  assert_int_equal(DIV(NEG(x), y), NEG(DIV(x, y)));
  assert_int_equal(DIV(0, positive), 0);
  assert_int_not_equal(DIV(0, x), 0);
  assert_int_equal(DIV(MUL(x, positive), positive), x);
  assert_int_equal(DIV(MUL(x, y), MUL(positive, x)), DIV(MUL(x, y), MUL(x, positive)));
  ambit_expr e = OP(EXP, x, 0);
  assert_int_equal(DIV(e, e), 1); /* e^x is not 0 although its range is bounded by it */
}

static void functions(void **unused) {
  (void)unused;
  assert_int_equal(SIN(NEG(x)), NEG(SIN(x)));
  assert_int_equal(COS(NEG(x)), COS(x));
  assert_int_equal(COS(SUB(x, y)), COS(SUB(y, x)));
  assert_int_equal(OP(ABS, SQR(x), 0), SQR(x));
  assert_int_equal(OP(ABS, NEG(x), 0), OP(ABS, x, 0));
  assert_int_equal(OP(MIN, x, x), x);
  assert_int_equal(OP(MAX, x, y), OP(MAX, y, x));
  assert_int_equal(OP(MAX, SIN(x), NUMBER(1)), 1);
  assert_int_equal(OP(LOG, OP(EXP, x, 0), 0), x);
  assert_int_not_equal(OP(EXP, OP(LOG, x, 0), 0), x);
  assert_int_equal(SQR(OP(SQRT, ADD(NUMBER(1), SQR(x)), 0)), ADD(NUMBER(1), SQR(x)));
  assert_int_not_equal(SQR(OP(SQRT, x, 0)), x);
  ambit_expr pi = ambit_graph_pi(g);
  assert_int_equal(SIN(pi), 0);
  assert_int_equal(COS(pi), NUMBER(-1));
  assert_int_equal(SIN(DIV(pi, NUMBER(2))), 1);
  assert_int_equal(COS(DIV(MUL(NUMBER(-270), pi), NUMBER(180))), 0);
  assert_int_equal(SIN(MUL(NUMBER(-90), DIV(pi, NUMBER(180)))), NUMBER(-1));
}

static void angle_sums(void **unused) {
  (void)unused;
  ambit_expr sx = SIN(x), cx = COS(x), sy = SIN(y), cy = COS(y);
  assert_int_equal(ADD(SQR(sx), SQR(cx)), 1);
  assert_int_equal(ADD(ADD(SQR(sx), y), SQR(cx)), ADD(NUMBER(1), y));
  assert_int_equal(SUB(SQR(cx), SQR(sx)), COS(MUL(NUMBER(2), x)));
  assert_int_equal(SUB(MUL(cx, cy), MUL(sx, sy)), COS(ADD(x, y)));
  assert_int_equal(ADD(MUL(cx, cy), MUL(sx, sy)), COS(SUB(x, y)));
  assert_int_equal(ADD(MUL(sx, cy), MUL(cx, sy)), SIN(ADD(x, y)));
  assert_int_equal(SUB(MUL(sx, cy), MUL(cx, sy)), SIN(SUB(x, y)));
  assert_int_equal(SUB(MUL(MUL(z, cx), cy), MUL(MUL(z, sx), sy)), MUL(z, COS(ADD(x, y))));
  assert_int_equal(SUB(MUL(NUMBER(3), MUL(cx, cy)), MUL(MUL(NUMBER(3), sx), sy)), MUL(NUMBER(3), COS(ADD(x, y))));
  ambit_expr partial = OP(LOG, x, 0);
  assert_int_not_equal(ADD(SQR(SIN(partial)), SQR(COS(partial))), 1);
}

/* A planar arm of n joints with angles phi[i]; the last rotation */
static void turn(size_t n, const ambit_expr *phi, ambit_expr r[4]) {
  r[0] = r[3] = 1, r[1] = r[2] = 0;
  for (size_t i = 0; i < n; i++) {
    ambit_expr c = COS(phi[i]), s = SIN(phi[i]), m = NEG(s);
    ambit_expr a = ADD(MUL(r[0], c), MUL(r[1], s)), b = ADD(MUL(r[0], m), MUL(r[1], c));
    ambit_expr d = ADD(MUL(r[2], c), MUL(r[3], s)), e = ADD(MUL(r[2], m), MUL(r[3], c));
    r[0] = a, r[1] = b, r[2] = d, r[3] = e;
  }
}

static void rotations_about_one_axis_add(void **unused) {
  (void)unused;
  ambit_expr phi[5], sum = 0, r[4];
  for (size_t i = 0; i < 5; i++) {
    phi[i] = ambit_graph_unknown(g, "phi", (ambit_interval) { 0.1, 0.2 });
    sum = ADD(sum, phi[i]);
  }
  turn(5, phi, r);
  assert_int_equal(r[0], COS(sum));
  assert_int_equal(r[1], NEG(SIN(sum)));
  assert_int_equal(r[2], SIN(sum));
  assert_int_equal(r[3], COS(sum));
  for (size_t i = 0; i < 5; i++) phi[i] = x; /* the same angle five times */
  turn(5, phi, r);
  assert_int_equal(r[0], COS(MUL(NUMBER(5), x)));
  assert_int_equal(r[2], SIN(MUL(NUMBER(5), x)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_expressions_keep_value_and_domain),
    cmocka_unit_test_setup_teardown(constants, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(literals, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(sums, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(products, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(quotients, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(functions, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(angle_sums, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(rotations_about_one_axis_add, open_graph, close_graph),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
