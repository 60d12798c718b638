/* Affine coefficients: what is read, what is refused, and that the rest of the graph is left alone. */
#include "mechanics/affine_in.h"
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

typedef struct desk {
  ambit_graph *g;
  ambit_expr x, y, z, w, one, two; /* x, y, z: the symbols in question */
  ambit_affine *a;
} desk;

static ambit_expr op(const desk *d, uint32_t code, ambit_expr p, ambit_expr q) {
  return ambit_graph_op(d->g, code, p, q);
}

static desk open(void) {
  desk d = { .g = ambit_graph_open() };
  d.x = ambit_graph_symbol(d.g, "x", "1"), d.y = ambit_graph_symbol(d.g, "y", "1");
  d.z = ambit_graph_symbol(d.g, "z", "1"), d.w = ambit_graph_symbol(d.g, "w", "1");
  d.one = ambit_graph_number(d.g, 1), d.two = ambit_graph_number(d.g, 2);
  d.a = ambit_affine_open(d.g, 3, (const ambit_expr[]) { d.z, d.x, d.y });
  assert_non_null(d.a);
  return d;
}

static void close(desk *d) {
  ambit_affine_close(d->a);
  ambit_graph_close(d->g);
}

/* (2 x - w (y + 3)) / exp w - y, and the same times w */
static void coefficients(void **state) {
  (void)state;
  desk d = open();
  ambit_expr scale = op(&d, AMBIT_OP_EXP, d.w, d.w), three = ambit_graph_number(d.g, 3);
  ambit_expr inner = op(&d, AMBIT_OP_MUL, d.w, op(&d, AMBIT_OP_ADD, d.y, three));
  ambit_expr first = op(&d, AMBIT_OP_SUB, op(&d, AMBIT_OP_MUL, d.two, d.x), inner);
  ambit_expr e[2] = { op(&d, AMBIT_OP_SUB, op(&d, AMBIT_OP_DIV, first, scale), d.y) };
  e[1] = op(&d, AMBIT_OP_MUL, e[0], d.w);
  ambit_expr c[4], rest[2];
  assert_int_equal(ambit_affine_in(d.a, 2, e, 2, (const ambit_expr[]) { d.x, d.y }, c, rest), AMBIT_OK);
  assert_int_equal(c[0], op(&d, AMBIT_OP_DIV, d.two, scale));
  ambit_expr slope = op(&d, AMBIT_OP_DIV, op(&d, AMBIT_OP_NEG, d.w, 0), scale);
  assert_int_equal(c[1], op(&d, AMBIT_OP_SUB, slope, d.one));
  assert_int_equal(c[2], op(&d, AMBIT_OP_MUL, c[0], d.w));
  ambit_expr shift = op(&d, AMBIT_OP_NEG, op(&d, AMBIT_OP_MUL, d.w, three), 0);
  assert_int_equal(rest[0], op(&d, AMBIT_OP_DIV, shift, scale));
  close(&d);
}

/* Symbols that were told but not asked for stay in the constant; x - x leaves none. */
static void others_stay(void **state) {
  (void)state;
  desk d = open();
  ambit_expr e[2] = { op(&d, AMBIT_OP_ADD, d.x, op(&d, AMBIT_OP_SIN, d.z, d.z)), d.w }, c[2], rest[2];
  assert_int_equal(ambit_affine_in(d.a, 2, e, 1, &d.x, c, rest), AMBIT_OK);
  assert_int_equal(c[0], d.one);
  assert_int_equal(rest[0], op(&d, AMBIT_OP_SIN, d.z, d.z));
  assert_int_equal(c[1], 0);
  assert_int_equal(rest[1], d.w);
  assert_true(ambit_affine_varies(d.a, 1, rest));
  assert_false(ambit_affine_varies(d.a, 1, rest + 1));
  close(&d);
}

static void what_is_not_affine(void **state) {
  (void)state;
  desk d = open();
  ambit_expr e[] = { op(&d, AMBIT_OP_SQR, d.x, d.x), op(&d, AMBIT_OP_MUL, d.x, d.y), op(&d, AMBIT_OP_DIV, d.w, d.x),
    op(&d, AMBIT_OP_SIN, d.x, d.x), ambit_graph_pown(d.g, d.x, 3), op(&d, AMBIT_OP_MUL, d.x, d.z) };
  for (size_t i = 0; i < sizeof e / sizeof *e; i++) {
    ambit_expr c[2], rest;
    assert_int_equal(ambit_affine_in(d.a, 1, &e[i], 2, (const ambit_expr[]) { d.x, d.y }, c, &rest), AMBIT_DOMAIN);
  }
  /* the search has cleaned up behind itself */
  ambit_expr c, rest;
  assert_int_equal(ambit_affine_in(d.a, 1, &d.x, 1, &d.x, &c, &rest), AMBIT_OK);
  assert_int_equal(c, d.one);
  close(&d);
}

static void values_are_put_in(void **state) {
  (void)state;
  desk d = open();
  ambit_expr e[2] = { op(&d, AMBIT_OP_ADD, op(&d, AMBIT_OP_MUL, d.w, d.x), d.y), d.w };
  ambit_expr value[2] = { d.two, op(&d, AMBIT_OP_COS, d.w, d.w) };
  assert_int_equal(ambit_affine_put(d.a, 2, e, 2, (const ambit_expr[]) { d.x, d.y }, value, e), AMBIT_OK);
  assert_int_equal(e[0], op(&d, AMBIT_OP_ADD, op(&d, AMBIT_OP_MUL, d.w, d.two), value[1]));
  assert_int_equal(e[1], d.w);
  close(&d);
}

/* A chain of 10^5 operations below w costs nothing: the search stops where nothing varies. */
static void only_what_varies_is_searched(void **state) {
  (void)state;
  desk d = open();
  ambit_expr deep = d.w;
  for (int i = 0; i < 100000; i++) deep = op(&d, AMBIT_OP_COS, deep, deep);
  size_t before = 0;
  for (int i = 0; i < 1000; i++) {
    ambit_expr e = op(&d, AMBIT_OP_MUL, op(&d, AMBIT_OP_ADD, deep, ambit_graph_number(d.g, i)), d.x), c, rest;
    assert_int_equal(ambit_affine_in(d.a, 1, &e, 1, &d.x, &c, &rest), AMBIT_OK);
    assert_int_equal(rest, 0);
    assert_int_equal(c, op(&d, AMBIT_OP_ADD, deep, ambit_graph_number(d.g, i)));
    before = ambit_graph_count(d.g);
  }
  assert_in_range(before, 1, 110000);
  close(&d);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(coefficients),
    cmocka_unit_test(others_stay),
    cmocka_unit_test(what_is_not_affine),
    cmocka_unit_test(values_are_put_in),
    cmocka_unit_test(only_what_varies_is_searched),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
