/* Sources of expressions: random ones by their brackets, deep and shared ones by their size, numbers and names by
** reading them. What Lua, Modelica and LaTeX make of them: tests/lua/source_spec.lua. */
#include "algebra/source.h"
#include "graph/store.h"
#include "graph/sampler.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>

static ambit_graph *g;
static ambit_expr x, y;

static int open_graph(void **unused) {
  (void)unused;
  g = ambit_graph_open();
  x = ambit_graph_symbol(g, "x", "m"), y = ambit_graph_symbol(g, "yaw_rate", "rad/s");
  return 0;
}

static int close_graph(void **unused) {
  (void)unused;
  ambit_graph_close(g);
  return 0;
}

static void assert_written(ambit_language language, ambit_expr e, const ambit_source_names *names, const char *want) {
  char *text;
  assert_int_equal(ambit_source_write(g, e, language, names, &text, NULL), AMBIT_OK);
  assert_string_equal(text, want);
  free(text);
}

#define OP(name, a, b) ambit_graph_op(g, AMBIT_OP_##name, a, b)
#define NUMBER(v) ambit_graph_number(g, v)

/* The beginning of the text: all of it if there is room for more. */
static void assert_begins(const ambit_graph *graph, ambit_expr e, const char *want) {
  size_t n = strlen(want), rooms[] = { 1, 2, n / 2 + 1, n, n + 1, n + 2 };
  char *out = malloc(n + 2);
  for (size_t k = 0; k < sizeof rooms / sizeof *rooms; k++) {
    size_t room = rooms[k] ? rooms[k] : 1, shown = n < room ? n : room - 1;
    assert_int_equal(ambit_writer_begin(graph, e, room, out), n + 2 <= room);
    assert_true(strlen(out) == shown && memcmp(out, want, shown) == 0);
  }
  free(out);
}

/* The source "text" is what ambit_graph_text says; brackets are balanced in all languages. */
static void random_expressions(void **unused) {
  (void)unused;
  uint64_t state = 3;
  static pool q;
  for (int round = 0; round < 60; round++) {
    pool_open(&q, &state, pool_draw);
    while (q.count < 60) {
      ambit_expr e = pool_grow(&q, &state, false)->e;
      size_t length = ambit_graph_text(q.s.g, e, NULL, 0);
      if (length > 20000) continue;
      char *want = malloc(length + 1);
      assert_int_equal(ambit_graph_text(q.s.g, e, want, length + 1), length);
      assert_begins(q.s.g, e, want);
      for (int k = 0; k < AMBIT_LANGUAGE_COUNT; k++) {
        char *text;
        assert_int_equal(ambit_source_write(q.s.g, e, (ambit_language)k, NULL, &text, NULL), AMBIT_OK);
        if (k == AMBIT_LANGUAGE_TEXT) assert_string_equal(text, want);
        int round_brackets = 0, braces = 0;
        for (const char *c = text; *c; c++) {
          round_brackets += (*c == '(') - (*c == ')');
          braces += (*c == '{') - (*c == '}');
          assert_true(round_brackets >= 0 && braces >= 0);
        }
        assert_true(round_brackets == 0 && braces == 0);
        free(text);
      }
      free(want);
    }
    pool_close(&q);
  }
}

static void languages(void **unused) {
  (void)unused;
  ambit_expr third = OP(DIV, NUMBER(1), NUMBER(3)), tenth = ambit_graph_decimal(g, "0.1", NULL);
  ambit_expr power = ambit_graph_pown(g, OP(SIN, x, 0), -3), e = OP(ADD, OP(MUL, OP(SUB, x, y), power), third);
  assert_written(AMBIT_LANGUAGE_LUA, third, NULL, "number(1)/3");
  assert_written(AMBIT_LANGUAGE_LUA, OP(MUL, tenth, x), NULL, "number \"0.1\"*x");
  assert_written(AMBIT_LANGUAGE_LUA, OP(SQRT, NUMBER(2), 0), NULL, "sqrt(number(2))");
  assert_written(AMBIT_LANGUAGE_MODELICA, power, NULL, "sin(x)^(-3)");
  assert_written(AMBIT_LANGUAGE_LATEX, power, NULL, "\\frac{1}{\\sin\\left(x\\right)^{3}}");
  assert_written(AMBIT_LANGUAGE_LATEX, OP(SQR, OP(SIN, x, 0), 0), NULL, "\\sin^{2}\\left(x\\right)");
  assert_written(AMBIT_LANGUAGE_LATEX, OP(DIV, x, OP(ADD, y, NUMBER(2))), NULL, "\\frac{x}{2 + \\mathrm{yaw\\_rate}}");
  assert_written(AMBIT_LANGUAGE_LATEX, OP(SQRT, OP(MUL, NUMBER(1e-5), x), 0), NULL, "\\sqrt{10^{-5} \\, x}");
  assert_written(AMBIT_LANGUAGE_MODELICA, ambit_graph_time(g), NULL, "time");
  assert_written(AMBIT_LANGUAGE_MODELICA, ambit_graph_decimal(g, ".1", NULL), NULL, "0.1");
  ambit_source_name list[] = { { power, "z1" }, { x, "s.x" }, { e, "whole" } };
  ambit_source_names_sort(3, list);
  ambit_source_names names = { 3, list };
  assert_written(AMBIT_LANGUAGE_LUA, OP(NEG, e, 0), &names, "-whole");
  assert_written(AMBIT_LANGUAGE_LUA, power, &names, "sin(s.x)^-3"); /* a definition */
  assert_written(AMBIT_LANGUAGE_LUA, OP(SQR, power, 0), &names, "sin(s.x)^-6");
  assert_written(AMBIT_LANGUAGE_LUA, x, &names, "s.x");
  assert_written(AMBIT_LANGUAGE_LUA, OP(MUL, OP(SUB, x, y), power), &names, "(s.x - yaw_rate)*z1");
}

/* What would be ambiguous, or no Modelica, if it were not bracketed. */
static void signs(void **unused) {
  (void)unused;
  ambit_expr minus = ambit_store_make(g, AMBIT_OP_MUL, NUMBER(-2), x);
  assert_written(AMBIT_LANGUAGE_MODELICA, ambit_store_make(g, AMBIT_OP_MUL, y, minus), NULL, "yaw_rate*(-2*x)");
  assert_written(AMBIT_LANGUAGE_TEXT, ambit_store_make(g, AMBIT_OP_ADD, y, minus), NULL, "yaw_rate + (-2*x)");
  assert_written(AMBIT_LANGUAGE_MODELICA, ambit_store_make(g, AMBIT_OP_SUB, minus, minus), NULL, "-2*x - (-2*x)");
  ambit_expr reciprocal = ambit_graph_pown(g, NUMBER(-3), -1);
  assert_written(AMBIT_LANGUAGE_LUA, reciprocal, NULL, "number(-3)^-1");
}

static void deep_and_shared(void **unused) {
  (void)unused;
  ambit_expr deep = x, shared = x;
  for (int i = 0; i < 20000; i++) deep = OP(ADD, OP(SIN, deep, 0), y);
  char *text;
  for (int k = 0; k < AMBIT_LANGUAGE_COUNT; k++) {
    assert_int_equal(ambit_source_write(g, deep, (ambit_language)k, NULL, &text, NULL), AMBIT_OK);
    assert_true(strlen(text) > 200000);
    free(text);
  }
  for (int i = 0; i < 100; i++) shared = OP(MUL, OP(SIN, shared, 0), OP(COS, shared, 0));
  ambit_failure f = { 0 };
  assert_int_equal(ambit_source_write(g, shared, AMBIT_LANGUAGE_LUA, NULL, &text, &f), AMBIT_INVALID);
  assert_non_null(strstr(f.message, "longer than 1000000"));
  free(text);
  ambit_expr power = ambit_graph_pown(g, x, INT32_MAX);
  assert_int_equal(ambit_source_write(g, power, AMBIT_LANGUAGE_LUA, NULL, &text, &f), AMBIT_INVALID);
  free(text);
}

/* With the parts named, no text is long, and each part is listed behind what it is made of. */
static void parts(void **unused) {
  (void)unused;
  ambit_expr e[3] = { x, x, y };
  for (int i = 0; i < 3000; i++) e[0] = OP(ADD, OP(SIN, e[0], 0), y);
  for (int i = 0; i < 200; i++) e[1] = OP(MUL, OP(SIN, e[1], 0), OP(COS, e[1], 0));
  for (int i = 1; i < 3000; i++) e[2] = OP(ADD, e[2], OP(COS, OP(MUL, NUMBER(i), x), 0));
  size_t n = ambit_source_share(g, 3, e, 0, NULL);
  assert_true(n > 200 && n < 2000);
  ambit_expr *part = malloc(n * sizeof *part);
  ambit_source_name *list = malloc(n * sizeof *list);
  assert_int_equal(ambit_source_share(g, 3, e, n, part), n);
  for (size_t i = 0; i < n; i++) {
    list[i] = (ambit_source_name) { part[i], "z" };
    for (size_t k = 0; k < i; k++) assert_true(part[k] != part[i]);
  }
  ambit_source_names_sort(n, list);
  ambit_source_names names = { n, list };
  for (size_t i = 0; i < n + 3; i++) {
    char *text;
    assert_int_equal(
        ambit_source_write(g, i < n ? part[i] : e[i - n], AMBIT_LANGUAGE_TEXT, &names, &text, NULL), AMBIT_OK);
    assert_true(strlen(text) < 1000);
    free(text);
  }
  free(part);
  free(list);
  ambit_expr small[] = { OP(ADD, x, y), OP(MUL, x, y) };
  assert_int_equal(ambit_source_share(g, 2, small, 0, NULL), 0);
}

static void numbers(void **unused) {
  (void)unused;
  uint64_t state = 17;
  for (int i = 0; i < 20000; i++) {
    double v;
    uint64_t bits = oracle_random(&state) & ~(1ull << 63);
    memcpy(&v, &bits, sizeof v);
    if (!isfinite(v)) continue;
    char *text;
    assert_int_equal(ambit_source_write(g, NUMBER(v), AMBIT_LANGUAGE_MODELICA, NULL, &text, NULL), AMBIT_OK);
    assert_true(strtod(text, NULL) == v);
    free(text);
    assert_int_equal(ambit_source_write(g, NUMBER(-v), AMBIT_LANGUAGE_LUA, NULL, &text, NULL), AMBIT_OK);
    assert_true(strtod(text, NULL) == -v);
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_expressions),
    cmocka_unit_test_setup_teardown(languages, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(signs, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(deep_and_shared, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(parts, open_graph, close_graph),
    cmocka_unit_test_setup_teardown(numbers, open_graph, close_graph),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
