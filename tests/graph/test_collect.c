/* test_collect.c -- nodes live as long as something holds them, and nobody can tell that others were freed. */
#include "graph/collect.h"
#include "graph/kink.h"
#include "algebra/node_map.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#define HELD_MAX 16

typedef struct held {
  ambit_holder holder;
  size_t n;
  ambit_expr e[HELD_MAX];
} held;

static ambit_graph *g;

static void mark(ambit_holder *holder, ambit_graph *graph) {
  held *h = (held *)(void *)holder;
  ambit_graph_mark(graph, h->n, h->e);
}

static held *hold(held *h, ambit_expr e) {
  *h = (held) { .holder = { .mark = mark }, .n = 1, .e = { e } };
  ambit_graph_hold(g, &h->holder);
  return h;
}

static int open_graph(void **unused) {
  (void)unused;
  g = ambit_graph_open();
  return 0;
}

static int close_graph(void **unused) {
  (void)unused;
  ambit_graph_close(g);
  return 0;
}

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
static ambit_expr symbol(const char *name) { return ambit_graph_symbol(g, name, "m"); }
static ambit_expr datum(void) { return ambit_graph_unknown(g, "datum", (ambit_interval) { 1, 2 }); }

static void what_is_held_stays(void **unused) {
  (void)unused;
  static held h;
  uint32_t before = ambit_graph_living(g);
  ambit_expr x = symbol("x"), e = OP(SIN, OP(MUL, x, datum()), 0);
  hold(&h, e);
  OP(COS, OP(ADD, symbol("y"), datum()), 0);
  uint32_t with_all = ambit_graph_living(g);
  ambit_graph_collect(g);
  assert_int_equal(ambit_graph_living(g), before + 4); /* sin, product, x, datum */
  assert_true(with_all > before + 4);
  char text[64];
  ambit_graph_text(g, e, text, sizeof text);
  assert_string_equal(text, "sin(x*datum)");
  assert_int_equal(OP(SIN, OP(MUL, symbol("x"), ambit_graph_node(g, ambit_graph_node(g, e)->a)->b), 0), e); /* found */
  ambit_graph_release(&h.holder);
  ambit_graph_collect(g);
  assert_int_equal(ambit_graph_living(g), before);
  ambit_graph_release(&h.holder); /* once more does nothing */
}

/* x + y + z, in the order in which the symbols were first made, whatever was freed in between. */
static void symbols_keep_their_places(void **unused) {
  (void)unused;
  char text[2][64];
  static held z;
  for (int turn = 0; turn < 2; turn++) {
    const char *name[] = { "x", "y", "z" };
    ambit_expr sum = 0;
    if (turn == 0)
      for (size_t i = 0; i < 3; i++) symbol(name[i]);
    for (size_t i = 3; i-- > 0;) sum = OP(ADD, OP(SQR, symbol(name[i]), 0), sum);
    ambit_graph_text(g, sum, text[turn], sizeof text[turn]);
    if (turn == 0) hold(&z, symbol("z"));
    ambit_graph_collect(g); /* x and y go, z stays */
  }
  assert_string_equal(text[0], text[1]);
  assert_string_equal(ambit_graph_node(g, ambit_graph_symbol(g, "x", "s"))->unit, "m"); /* as it was first made */
  ambit_graph_release(&z.holder);
}

/* A leaf's number is never another one's, also when the node's is used again. */
static void data_stay_different(void **unused) {
  (void)unused;
  uint64_t last = 0;
  for (int i = 0; i < 100; i++) {
    ambit_expr e = datum();
    assert_true(ambit_graph_birth(g, e) > last);
    last = ambit_graph_birth(g, e);
    ambit_graph_collect(g);
  }
  assert_true(ambit_graph_count(g) < 100); /* numbers were used again */
}

static void numbers_are_used_again(void **unused) {
  (void)unused;
  static held h;
  ambit_expr x = symbol("x");
  hold(&h, x);
  for (int round = 0; round < 50; round++) {
    ambit_expr sum = 0, parts[64];
    for (int i = 0; i < 64; i++) sum = OP(ADD, sum, parts[i] = OP(SIN, OP(MUL, x, ambit_graph_number(g, i + 2)), 0));
    for (int i = 0; i < 64; i++) /* found, not made anew */
      assert_int_equal(OP(SIN, OP(MUL, x, ambit_graph_number(g, i + 2)), 0), parts[i]);
    h.n = 2, h.e[1] = parts[round % 64]; /* another one each time */
    ambit_graph_collect(g);
    assert_int_equal(OP(SIN, OP(MUL, x, ambit_graph_number(g, round % 64 + 2)), 0), parts[round % 64]);
    assert_true(ambit_graph_living(g) < 12);
  }
  assert_true(ambit_graph_count(g) < 1000);
  ambit_graph_release(&h.holder);
}

static void writers_of_kinks_go_with_them(void **unused) {
  (void)unused;
  static held h;
  ambit_expr x = symbol("x");
  char who[] = "friction `knee`";
  ambit_graph_written_by(g, who);
  ambit_expr e = OP(ABS, x, x);
  ambit_graph_written_by(g, NULL);
  memset(who, '?', sizeof who - 1);
  hold(&h, x);
  assert_string_equal(ambit_graph_writer(g, e), "friction `knee`");
  ambit_graph_collect(g);
  assert_null(ambit_graph_writer(g, OP(ABS, x, x)));
  ambit_graph_release(&h.holder);
}

static void collections_are_due_by_what_was_made(void **unused) {
  (void)unused;
  static held h;
  assert_false(ambit_graph_is_due(g));
  ambit_expr sum = symbol("x");
  hold(&h, sum);
  for (uint32_t i = 0; i < AMBIT_COLLECT_LEAST; i++) h.e[0] = sum = OP(SIN, sum, 0);
  assert_true(ambit_graph_is_due(g));
  ambit_graph_postpone(g);
  assert_false(ambit_graph_is_due(g));
  ambit_graph_hasten(g);
  assert_true(ambit_graph_is_due(g));
  uint32_t all = ambit_graph_living(g);
  ambit_graph_collect(g);
  assert_int_equal(ambit_graph_living(g), all); /* all of it is held */
  assert_false(ambit_graph_is_due(g));
  for (uint32_t i = 0; i < all - 1; i++) OP(COS, datum(), 0);
  assert_true(ambit_graph_is_due(g));
  ambit_graph_release(&h.holder);
}

static void maps_of_nodes(void **unused) {
  (void)unused;
  ambit_node_map map = { 0 };
  assert_int_equal(ambit_node_map_get(&map, 3), 0);
  for (uint32_t k = 0; k < 5000; k++) *ambit_node_map_at(&map, 7 * k) = k + 1;
  for (uint32_t k = 0; k < 35000; k++) assert_int_equal(ambit_node_map_get(&map, k), k % 7 ? 0 : k / 7 + 1);
  ambit_node_map_close(&map);
  assert_int_equal(ambit_node_map_get(&map, 7), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(what_is_held_stays, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(symbols_keep_their_places, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(data_stay_different, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(numbers_are_used_again, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(writers_of_kinks_go_with_them, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(collections_are_due_by_what_was_made, open_graph, close_graph),
    cmocka_unit_test(maps_of_nodes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
