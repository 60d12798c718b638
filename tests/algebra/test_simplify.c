/* Simplification: value and domain stay (MPFR, random expressions), operations never grow, the mass matrix comes out
** right. */
#include "graph/sampler.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static size_t simplify_random(pool *q, uint64_t *state) {
  size_t shorter = 0;
  while (q->count < 120) {
    const judged *j = pool_grow(q, state, false);
    ambit_expr s = ambit_graph_simplify(q->s.g, j->e, 200);
    sampler_update(&q->s);
    size_t before = ambit_graph_size(q->s.g, 1, &j->e), after = ambit_graph_size(q->s.g, 1, &s);
    assert_true(s == j->e || after < before);
    shorter += after < before;
    const char *wrong = pool_differs(q, j, s);
    if (!wrong) continue;
    char old[2000], new[2000];
    ambit_graph_text(q->s.g, j->e, old, sizeof old);
    ambit_graph_text(q->s.g, s, new, sizeof new);
    fail_msg("%s: %s -> %s", wrong, old, new);
  }
  return shorter;
}

static void random_expressions_keep_value_and_domain(void **unused) {
  (void)unused;
  uint64_t state = 31;
  static pool q;
  size_t shorter = 0;
  for (int round = 0; round < 1000; round++) {
    pool_open(&q, &state, pool_draw);
    shorter += simplify_random(&q, &state);
    pool_close(&q);
  }
  assert_true(shorter > 1000);
}

static ambit_graph *g;
static ambit_expr x, y, z, c, s;

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
#define ADD(a, b) OP(ADD, a, b)
#define SUB(a, b) OP(SUB, a, b)
#define MUL(a, b) OP(MUL, a, b)
#define DIV(a, b) OP(DIV, a, b)
#define SQR(a) OP(SQR, a, 0)
#define NUMBER(v) ambit_graph_number(g, v)

static int open_graph(void **unused) {
  (void)unused;
  g = ambit_graph_open();
  x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "y", "m"), z = ambit_graph_symbol(g, "z", "m");
  c = OP(COS, x, 0), s = OP(SIN, x, 0);
  return 0;
}

static int close_graph(void **unused) {
  (void)unused;
  ambit_graph_close(g);
  return 0;
}

static ambit_expr simple(ambit_expr e) { return ambit_graph_simplify(g, e, 1000); }

static void double_pendulum_mass_matrix(void **unused) {
  (void)unused;
  ambit_expr one = NUMBER(1);
  ambit_expr m11 = ADD(ADD(ADD(ADD(one, MUL(c, ADD(c, one))), MUL(s, s)), c), one);
  ambit_expr want = ADD(NUMBER(3), MUL(NUMBER(2), c));
  assert_int_equal(simple(m11), want);
  ambit_expr determinant = simple(SUB(want, SQR(ADD(one, c))));
  assert_int_equal(determinant, SUB(NUMBER(2), SQR(c)));
  assert_true(ambit_graph_node(g, determinant)->range.lo == 1); /* proves that it is never 0 */
}

static void polynomials(void **unused) {
  (void)unused;
  assert_int_equal(simple(SUB(MUL(ADD(x, y), SUB(x, y)), SUB(SQR(x), SQR(y)))), 0);
  assert_int_equal(simple(SUB(ambit_graph_pown(g, ADD(x, y), 3), ambit_graph_pown(g, ADD(x, y), 3))), 0);
  ambit_expr e = ADD(MUL(x, z), MUL(y, z));
  assert_int_equal(simple(e), MUL(z, ADD(x, y)));
  assert_int_equal(simple(OP(SIN, e, 0)), OP(SIN, MUL(z, ADD(x, y)), 0)); /* inside functions too */
  assert_int_equal(simple(x), x);
  assert_int_equal(simple(NUMBER(3)), NUMBER(3));
  ambit_expr tenth = ambit_graph_decimal(g, "0.1", NULL);
  assert_int_equal(simple(SUB(MUL(tenth, ADD(x, y)), MUL(tenth, x))), MUL(tenth, y));
  ambit_expr powers = SUB(ADD(SQR(SQR(s)), MUL(NUMBER(2), SQR(MUL(s, c)))), NUMBER(1));
  assert_int_equal(simple(ADD(powers, SQR(SQR(c)))), 0); /* (sin^2 + cos^2)^2 - 1 */
}

static void domains_do_not_grow(void **unused) {
  (void)unused;
  ambit_expr e = ADD(ADD(DIV(x, z), DIV(y, z)), DIV(SUB(x, y), z));
  assert_int_equal(simple(e), MUL(NUMBER(2), DIV(x, z)));
  ambit_expr inverse = DIV(NUMBER(1), z), gone = SUB(MUL(inverse, ADD(x, y)), ADD(MUL(inverse, x), MUL(inverse, y)));
  assert_false(ambit_graph_node(g, simple(gone))->total); /* 0, but not at z = 0 */
  ambit_expr zero = SUB(MUL(x, ADD(x, y)), ADD(SQR(x), MUL(x, y)));
  assert_false(ambit_graph_node(g, simple(MUL(zero, inverse)))->total);
}

static void work_is_bounded(void **unused) {
  (void)unused;
  ambit_expr e = NUMBER(1);
  for (int i = 0; i < 40; i++) {
    char name[16];
    name[0] = 'a', name[1] = (char)('A' + i), name[2] = '\0';
    e = MUL(e, ADD(ambit_graph_symbol(g, name, "1"), ADD(x, y))); /* 3^40 terms */
  }
  assert_int_equal(ambit_graph_simplify(g, e, 100), e);
  ambit_expr power = ambit_graph_pown(g, ADD(x, y), INT32_MAX);
  assert_int_equal(ambit_graph_simplify(g, power, 100), power);
  assert_int_equal(ambit_graph_simplify(g, e, 0), e);
  assert_int_equal(ambit_graph_simplify(g, AMBIT_NO_EXPR, 100), AMBIT_NO_EXPR);
  assert_int_equal(ambit_graph_simplify(g, ambit_graph_count(g), 100), ambit_graph_count(g));
  ambit_expr sum = 0; /* all powers of x: factoring nests deeply */
  for (int i = 1; i < 600; i++) sum = ADD(sum, ambit_graph_pown(g, x, i));
  assert_int_not_equal(ambit_graph_simplify(g, sum, 1000), AMBIT_NO_EXPR);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_expressions_keep_value_and_domain),
    cmocka_unit_test_setup_teardown(double_pendulum_mass_matrix, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(polynomials, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(domains_do_not_grow, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(work_is_bounded, open_graph, close_graph),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
