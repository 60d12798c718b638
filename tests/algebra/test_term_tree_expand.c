/* Expanded forms: value and domain by MPFR on random expressions, the number of summands, what is left alone. */
#include "algebra/expand.h"
#include "graph/sampler.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void expansion_keeps_value_and_domain(void **unused) {
  (void)unused;
  uint64_t state = 5;
  static pool q;
  size_t longer = 0;
  for (int round = 0; round < 200; round++) {
    pool_open(&q, &state, pool_draw);
    while (q.count < 90) {
      const judged *j = pool_grow(&q, &state, false);
      ambit_expr e = ambit_graph_expand(q.s.g, j->e, 50);
      sampler_update(&q.s);
      const char *wrong = pool_differs(&q, j, e);
      if (wrong) fail_msg("expanded: %s", wrong);
      size_t before = ambit_graph_terms(q.s.g, j->e, 0, NULL, NULL);
      size_t after = ambit_graph_terms(q.s.g, e, 0, NULL, NULL);
      assert_true(e == j->e || after <= 50);
      longer += after > before;
    }
    pool_close(&q);
  }
  assert_true(longer > 400);
}

static ambit_graph *g;

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
#define ADD(a, b) OP(ADD, a, b)
#define SUB(a, b) OP(SUB, a, b)
#define MUL(a, b) OP(MUL, a, b)
#define DIV(a, b) OP(DIV, a, b)
#define NUMBER(v) ambit_graph_number(g, v)

static size_t terms_of(ambit_expr e) { return ambit_graph_terms(g, e, 0, NULL, NULL); }

static void expansions(void **unused) {
  (void)unused;
  g = ambit_graph_open();
  ambit_expr x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "y", "m");
  ambit_expr z = ambit_graph_symbol(g, "z", "m");
  ambit_expr s = ADD(x, y), d = ADD(NUMBER(2), OP(SQR, z, 0));
  assert_int_equal(ambit_graph_expand(g, MUL(z, s), 0), MUL(z, s));
  assert_int_equal(ambit_graph_expand(g, MUL(z, s), 1), MUL(z, s));
  assert_int_equal(ambit_graph_expand(g, MUL(z, s), 2), ADD(MUL(z, x), MUL(z, y)));
  assert_int_equal(ambit_graph_expand(g, DIV(MUL(z, s), d), 2), ADD(DIV(MUL(z, x), d), DIV(MUL(z, y), d)));
  assert_int_equal(ambit_graph_expand(g, MUL(s, SUB(x, y)), 9), SUB(OP(SQR, x, 0), OP(SQR, y, 0)));
  assert_int_equal(terms_of(ambit_graph_expand(g, ambit_graph_pown(g, ADD(s, z), 4), 99)), 15);
  assert_int_equal(terms_of(ambit_graph_expand(g, ambit_graph_pown(g, ADD(s, z), 4), 80)), 1);
  /* from left to right, what fits; a factor that is too long is one factor */
  ambit_expr big = ambit_graph_pown(g, ADD(ADD(s, z), NUMBER(5)), 9), mixed = ADD(MUL(z, s), MUL(big, s));
  assert_int_equal(terms_of(ambit_graph_expand(g, mixed, 4)), 4);
  assert_int_equal(terms_of(ambit_graph_expand(g, mixed, 3)), 3);
  ambit_expr wide = MUL(ambit_graph_pown(g, ADD(ADD(s, z), NUMBER(5)), 12), x);
  assert_int_equal(ambit_graph_expand(g, wide, SIZE_MAX), wide);
  ambit_graph_close(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(expansion_keeps_value_and_domain),
    cmocka_unit_test(expansions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
