/* How operations that were asked for are answered: by new nodes, by nodes that were there, by folding. */
#include <ambit/graph.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void check(const ambit_graph *g, uint64_t asked, uint64_t shared, uint64_t folded) {
  ambit_graph_tally tally = ambit_graph_answers(g);
  assert_int_equal(tally.asked, asked);
  assert_int_equal(tally.shared, shared);
  assert_int_equal(tally.folded, folded);
}

static void new_nodes_are_neither_shared_nor_folded(void **unused) {
  (void)unused;
  ambit_graph *g = ambit_graph_open();
  ambit_expr x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "y", "m");
  check(g, 0, 0, 0); /* leaves are no operations */
  uint32_t before = ambit_graph_count(g);
  ambit_graph_op(g, AMBIT_OP_ADD, x, y);
  ambit_graph_op(g, AMBIT_OP_SIN, x, x);
  ambit_graph_pown(g, x, 3);
  assert_int_equal(ambit_graph_count(g), before + 3);
  check(g, 3, 0, 0);
  ambit_graph_close(g);
}

static void equal_operations_are_shared(void **unused) {
  (void)unused;
  ambit_graph *g = ambit_graph_open();
  ambit_expr x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "y", "m");
  ambit_expr sum = ambit_graph_op(g, AMBIT_OP_ADD, x, y), cube = ambit_graph_pown(g, x, 3);
  uint32_t before = ambit_graph_count(g);
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_ADD, y, x), sum);
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_POWN, x, 3), cube);
  assert_int_equal(ambit_graph_count(g), before);
  check(g, 4, 2, 0);
  ambit_graph_close(g);
}

static void constants_and_operands_are_folded(void **unused) {
  (void)unused;
  ambit_graph *g = ambit_graph_open();
  ambit_expr x = ambit_graph_symbol(g, "x", "m"), zero = ambit_graph_number(g, 0), one = ambit_graph_number(g, 1);
  ambit_expr five = ambit_graph_op(g, AMBIT_OP_ADD, ambit_graph_number(g, 2), ambit_graph_number(g, 3));
  assert_int_equal(five, ambit_graph_number(g, 5)); /* a constant, though a new node */
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_ADD, x, zero), x);
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_MUL, one, x), x);
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_SUB, x, x), zero);
  assert_int_equal(ambit_graph_pown(g, x, 1), x);
  check(g, 5, 0, 5);
  ambit_graph_close(g);
}

static void refused_operations_do_not_count(void **unused) {
  (void)unused;
  ambit_graph *g = ambit_graph_open();
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_COUNT, 0, 0), AMBIT_NO_EXPR);
  assert_int_equal(ambit_graph_op(g, AMBIT_OP_ADD, 0, AMBIT_NO_EXPR), AMBIT_NO_EXPR);
  assert_int_equal(ambit_graph_pown(g, AMBIT_NO_EXPR, 2), AMBIT_NO_EXPR);
  check(g, 0, 0, 0);
  ambit_graph_close(g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(new_nodes_are_neither_shared_nor_folded),
    cmocka_unit_test(equal_operations_are_shared),
    cmocka_unit_test(constants_and_operands_are_folded),
    cmocka_unit_test(refused_operations_do_not_count),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
