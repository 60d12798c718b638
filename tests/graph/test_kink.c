/* test_kink.c -- non-smooth formulas keep the name of who wrote them, through rewriting and onto tapes; jets find the
** one that a box meets. */
#include "graph/jet.h"
#include "graph/kink.h"
#include "graph/tape.h"
#include "graph/series_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

typedef struct scene {
  ambit_graph *g;
  ambit_arena *arena;
  ambit_expr x, y;
} scene;

static int open_scene(void **state) {
  static scene s;
  s.g = ambit_graph_open();
  s.arena = ambit_arena_open();
  s.x = ambit_graph_symbol(s.g, "x", "1");
  s.y = ambit_graph_symbol(s.g, "y", "1");
  *state = &s;
  return s.g && s.arena ? 0 : 1;
}

static int close_scene(void **state) {
  scene *s = *state;
  ambit_graph_close(s->g);
  ambit_arena_close(s->arena);
  return 0;
}

static ambit_expr written(scene *s, const char *who, uint32_t op, ambit_expr a, ambit_expr b) {
  const char *before = ambit_graph_written_by(s->g, who);
  ambit_expr e = ambit_graph_op(s->g, op, a, b);
  ambit_graph_written_by(s->g, before);
  return e;
}

static void test_writer_is_kept(void **state) {
  scene *s = *state;
  ambit_expr e = written(s, "foot", AMBIT_OP_ABS, s->x, s->x);
  assert_string_equal(ambit_graph_writer(s->g, e), "foot");
  assert_ptr_equal(ambit_graph_writer(s->g, s->x), NULL);
  /* the same formula again is the same node, and the first writer's */
  assert_int_equal(written(s, "hand", AMBIT_OP_ABS, s->x, s->x), e);
  assert_string_equal(ambit_graph_writer(s->g, e), "foot");
  assert_string_equal(ambit_kink_text(s->g, e, s->arena), "abs(x) of foot");
}

static void test_nobody_known(void **state) {
  scene *s = *state;
  ambit_expr e = ambit_graph_op(s->g, AMBIT_OP_MAX, s->x, s->y);
  assert_ptr_equal(ambit_graph_writer(s->g, e), NULL);
  assert_string_equal(ambit_kink_text(s->g, e, s->arena), "max(x, y)");
}

static void test_long_formula_is_cut(void **state) {
  scene *s = *state;
  ambit_expr sum = s->x;
  for (int i = 0; i < 40; i++)
    sum = ambit_graph_op(s->g, AMBIT_OP_SIN, ambit_graph_op(s->g, AMBIT_OP_ADD, sum, s->y), 0);
  const char *text = ambit_kink_text(s->g, written(s, "foot", AMBIT_OP_ABS, sum, sum), s->arena);
  assert_true(strlen(text) < 90);
  assert_non_null(strstr(text, " ... of foot"));
}

static void test_writer_survives_substitution(void **state) {
  scene *s = *state;
  ambit_expr e = written(s, "foot", AMBIT_OP_MIN, s->x, s->y), two = ambit_graph_number(s->g, 2);
  ambit_expr z = ambit_graph_symbol(s->g, "z", "1"), to = ambit_graph_op(s->g, AMBIT_OP_MUL, two, z);
  ambit_failure f = { 0 };
  assert_int_equal(ambit_graph_substitute(s->g, 1, &e, 1, &s->x, &to, &f), AMBIT_OK);
  assert_string_equal(ambit_graph_writer(s->g, e), "foot");
}

static void test_writer_survives_simplification(void **state) {
  scene *s = *state;
  ambit_graph *g = s->g;
  ambit_expr inner =
      ambit_graph_op(g, AMBIT_OP_SUB, ambit_graph_op(g, AMBIT_OP_SQR, ambit_graph_op(g, AMBIT_OP_ADD, s->x, s->y), 0),
          ambit_graph_op(g, AMBIT_OP_SQR, ambit_graph_op(g, AMBIT_OP_SUB, s->x, s->y), 0));
  ambit_expr e = ambit_graph_simplify(g, written(s, "foot", AMBIT_OP_MAX, inner, ambit_graph_number(g, 1)), 100);
  assert_int_equal(ambit_graph_node(g, e)->op, AMBIT_OP_MAX);
  assert_string_equal(ambit_graph_writer(g, e), "foot");
}

static const ambit_tape *seal(scene *s, ambit_expr e) {
  const ambit_expr in[] = { s->x, s->y };
  const ambit_tape *tape = NULL;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_tape_seal(s->g, s->arena, 1, &e, 2, in, 2, AMBIT_TAPE_SERIES, &tape, &f), AMBIT_OK);
  return tape;
}

/* tan is lowered to sin/cos on the way to the tape */
static void test_tape_names_its_kinks(void **state) {
  scene *s = *state;
  ambit_expr tangent = ambit_graph_op(s->g, AMBIT_OP_TAN, s->x, s->x);
  ambit_expr e = ambit_graph_op(s->g, AMBIT_OP_ADD, written(s, "foot", AMBIT_OP_ABS, tangent, tangent), s->y);
  const ambit_tape *tape = seal(s, e);
  uint32_t named = 0;
  for (uint32_t i = 0; i < tape->ninstr; i++) {
    assert_int_equal(tape->kink[i] != NULL, tape->op[i] == AMBIT_OP_ABS);
    if (!tape->kink[i]) continue;
    named++;
    assert_non_null(strstr(tape->kink[i], "of foot"));
  }
  assert_int_equal(named, 1);
}

/* |x| of foot and max(x, y) of hand over boxes that meet neither, the one and the other */
static void test_jet_finds_the_kink(void **state) {
  static const struct {
    double x, x_radius, y;
    const char *found;
  } box[] = { { 3, 1, 0, NULL }, { 3, 1, 2.5, "of hand" }, { 0.5, 1, 4, "of foot" }, { 1, 1, 4, "of foot" } };
  scene *s = *state;
  ambit_expr foot = written(s, "foot", AMBIT_OP_ABS, s->x, s->x), hand = written(s, "hand", AMBIT_OP_MAX, s->x, s->y);
  const ambit_tape *tape = seal(s, ambit_graph_op(s->g, AMBIT_OP_ADD, foot, hand));
  fixture_host host;
  fixture_host_open(&host);
  ambit_arithmetic full = fixture_arithmetic();
  ambit_jet *jet;
  const ambit_jet_service *service = &ambit_jet_service_v1;
  assert_int_equal(service->open(&host.host, tape, &full, NULL, 3, 0, NULL, &jet), AMBIT_OK);
  assert_null(service->kink(jet)); /* nothing is computed */
  for (size_t i = 0; i < sizeof box / sizeof *box; i++) {
    service->put(jet, 0, 0, box[i].x, box[i].x_radius, NULL, NULL);
    service->put(jet, 1, 0, box[i].y, 0, NULL, NULL);
    uint32_t flags = service->advance(jet, 0);
    const char *found = service->kink(jet);
    assert_int_equal(found != NULL, box[i].found != NULL);
    if (!found)
      assert_int_equal(flags, 0);
    else
      assert_non_null(strstr(found, box[i].found));
  }
  service->close(jet);
  fixture_host_close(&host);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(test_writer_is_kept, open_scene, close_scene),
    cmocka_unit_test_setup_teardown(test_nobody_known, open_scene, close_scene),
    cmocka_unit_test_setup_teardown(test_long_formula_is_cut, open_scene, close_scene),
    cmocka_unit_test_setup_teardown(test_writer_survives_substitution, open_scene, close_scene),
    cmocka_unit_test_setup_teardown(test_writer_survives_simplification, open_scene, close_scene),
    cmocka_unit_test_setup_teardown(test_tape_names_its_kinks, open_scene, close_scene),
    cmocka_unit_test_setup_teardown(test_jet_finds_the_kink, open_scene, close_scene),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
