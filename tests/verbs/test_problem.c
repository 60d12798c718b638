/* Problems: what becomes a parameter, which tapes are built, and what is refused, with invariants and without. */
#include "verbs/simulate/problem.h"
#include "graph/tape.h"
#include "graph/hull.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

/* x' = a x, y' = -y with the invariants x y - b t and |x| - 1, all with unknown data */
typedef struct scene {
  ambit_graph *graph;
  ambit_arena *arena;
  ambit_expr state[2], rate[2], initial[2], invariant[2];
  ambit_system system;
  ambit_problem problem;
  ambit_failure failure;
} scene;

static ambit_expr op(scene *s, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(s->graph, code, a, b);
}

static void open_scene(scene *s) {
  static const char *const name[] = { "x", "y" }, *const unit[] = { "1", "1" };
  static const char *const row[] = { "loop: row 1", "loop: row 2" };
  *s = (scene) { .graph = ambit_graph_open(), .arena = ambit_arena_open() };
  for (size_t i = 0; i < 2; i++) {
    s->state[i] = ambit_graph_symbol(s->graph, name[i], unit[i]);
    s->initial[i] = ambit_graph_number(s->graph, 1);
  }
  ambit_expr a = ambit_graph_unknown(s->graph, "a", (ambit_interval) { 1, 2 });
  ambit_expr b = ambit_graph_unknown(s->graph, "b", (ambit_interval) { 3, 4 });
  s->rate[0] = op(s, AMBIT_OP_MUL, a, s->state[0]);
  s->rate[1] = op(s, AMBIT_OP_NEG, s->state[1], s->state[1]);
  ambit_expr product = op(s, AMBIT_OP_MUL, s->state[0], s->state[1]);
  s->invariant[0] = op(s, AMBIT_OP_SUB, product, op(s, AMBIT_OP_MUL, b, ambit_graph_time(s->graph)));
  ambit_expr size = op(s, AMBIT_OP_ABS, s->state[0], s->state[0]);
  s->invariant[1] = op(s, AMBIT_OP_SUB, size, ambit_graph_number(s->graph, 1));
  s->system =
      (ambit_system) { s->graph, 2, name, unit, s->state, s->rate, 1, s->invariant, row, NULL, 0, NULL, NULL, NULL };
}

static void close_scene(scene *s) {
  ambit_arena_close(s->arena);
  ambit_graph_close(s->graph);
}

static ambit_status build(scene *s, uint32_t want) {
  static const double time[] = { 0, 1 };
  const ambit_problem_request q = {
    .system = &s->system, .initial = s->initial, .ntime = 2, .time = time, .want = want
  };
  s->failure = (ambit_failure) { 0 };
  return ambit_problem_build(&q, s->arena, &s->problem, &s->failure);
}

static void invariants_nobody_wants_are_not_built(void **unused) {
  (void)unused;
  scene s;
  open_scene(&s);
  s.system.ninvariant = 2;
  assert_int_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_JACOBIAN), AMBIT_OK);
  const ambit_problem *p = &s.problem;
  assert_true(p->ninvariant == 0 && !p->invariant && !p->invariant_jacobian && !p->invariant_name);
  assert_true(p->np == 1 && p->nu == 1 && p->uses_time == 0 && p->rhs->nin == 3);
  close_scene(&s);
}

static void their_data_become_parameters(void **unused) {
  (void)unused;
  scene s;
  open_scene(&s);
  assert_int_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INVARIANT), AMBIT_OK);
  const ambit_problem *p = &s.problem;
  assert_true(p->ninvariant == 1 && !p->invariant_jacobian && p->np == 2 && p->nu == 2 && p->uses_time == 1);
  assert_string_equal(p->name[3], "b");
  assert_string_equal(p->invariant_name[0], "loop: row 1");
  assert_true(p->invariant->nout == 1 && p->invariant->nin == 5 && p->rhs->nin == 5);
  assert_true(p->invariant->flags & AMBIT_TAPE_SERIES);
  assert_true(p->p_lo[1] == 3 && p->p_hi[1] == 4);
  ambit_interval slot[64], in[5] = { { 2, 2 }, { 5, 5 }, { 9, 9 }, { 3, 3 }, { 0.5, 0.5 } }; /* x y a b t */
  assert_int_equal(ambit_hull(p->invariant, in, slot), 0);
  assert_true(slot[p->invariant->out[0]].lo == 8.5 && slot[p->invariant->out[0]].hi == 8.5);
  close_scene(&s);
}

static void what_has_no_implicit_form_comes_without_unknowns(void **unused) {
  (void)unused;
  scene s;
  open_scene(&s);
  assert_int_equal(build(&s, AMBIT_WANT_RHS), AMBIT_OK);
  assert_null(s.problem.implicit);
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT), AMBIT_OK);
  const ambit_implicit *i = s.problem.implicit;
  assert_true(!s.problem.rhs && i->size == sizeof *i && i->na == 0 && i->nstage == 0 && i->stage_end && i->pivot);
  assert_true(i->tape->nin == 3 && i->tape->nout == 2 && (i->tape->flags & AMBIT_TAPE_SERIES));
  close_scene(&s);
}

/* x' = a v, y' = -y with x v - b = 0, and then, in a second stage, w + v^2 - c t = 0 */
typedef struct form {
  ambit_system_source source;
  ambit_expr unknown[2], rate[2], residual[2];
  uint32_t stage_end[2], pivot[2];
} form;

static ambit_status write_form(ambit_system_source *self, ambit_failure *f) {
  form *o = (form *)(void *)self;
  (void)f;
  self->form = (ambit_implicit_form) { 2, 2, o->unknown, o->rate, o->residual, o->stage_end, o->pivot };
  return AMBIT_OK;
}

static void open_form(scene *s, form *o) {
  *o = (form) { .source.write = write_form, .stage_end = { 1, 2 }, .pivot = { 0, 1 } };
  ambit_expr v = o->unknown[0] = ambit_graph_symbol(s->graph, "v", "1");
  ambit_expr w = o->unknown[1] = ambit_graph_symbol(s->graph, "w", "1");
  ambit_expr a = ambit_graph_unknown(s->graph, "of F", (ambit_interval) { 1, 2 });
  ambit_expr b = ambit_graph_unknown(s->graph, "of R", (ambit_interval) { 3, 4 });
  ambit_expr c = ambit_graph_unknown(s->graph, "point", (ambit_interval) { 7, 7 });
  o->rate[0] = op(s, AMBIT_OP_MUL, a, v);
  o->rate[1] = s->rate[1];
  o->residual[0] = op(s, AMBIT_OP_SUB, op(s, AMBIT_OP_MUL, s->state[0], v), b);
  ambit_expr driven = op(s, AMBIT_OP_MUL, c, ambit_graph_time(s->graph));
  o->residual[1] = op(s, AMBIT_OP_SUB, op(s, AMBIT_OP_ADD, w, op(s, AMBIT_OP_SQR, v, v)), driven);
  s->system.source = &o->source;
}

static void an_implicit_form_stands_for_the_rates(void **unused) {
  (void)unused;
  scene s;
  form o;
  open_scene(&s);
  open_form(&s, &o);
  assert_int_equal(build(&s, AMBIT_WANT_RHS), AMBIT_OK);
  assert_true(!o.source.written && s.problem.np == 1);
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT), AMBIT_OK);
  const ambit_problem *p = &s.problem;
  const ambit_implicit *i = p->implicit;
  assert_true(o.source.written && !p->rhs && p->np == 2 && p->nu == 2 && p->uses_time == 1);
  assert_string_equal(p->name[2], "of F");
  assert_string_equal(p->name[3], "of R");
  assert_true(i->na == 2 && i->nstage == 2 && i->stage_end[0] == 1 && i->stage_end[1] == 2 && i->pivot[1] == 1);
  assert_true(i->tape->nin == 7 && i->tape->nout == 4 && (i->tape->flags & AMBIT_TAPE_SERIES));
  ambit_interval slot[64], in[7] = { { 2, 2 }, { 5, 5 }, { 9, 9 }, { 3, 3 }, { 4, 4 }, { 6, 6 }, { 1, 1 } };
  assert_int_equal(ambit_hull(i->tape, in, slot), 0); /* x y v w a b t */
  static const double expected[] = { 36, -5, 12, 77 };
  for (int k = 0; k < 4; k++) {
    ambit_interval x = slot[i->tape->out[k]];
    assert_true(x.lo == expected[k] && x.hi == expected[k]);
  }
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT | AMBIT_WANT_RHS), AMBIT_OK);
  assert_true(p->np == 3 && p->rhs->nin == 6 && p->implicit->tape->nin == 8);
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT | AMBIT_WANT_INVARIANT), AMBIT_OK); /* each its own formulas */
  assert_true(p->np == 3 && p->ninvariant == 1 && p->invariant->nin == 6 && p->implicit->tape->nin == 8);
  ambit_interval of_x[6] = { { 2, 2 }, { 5, 5 }, { 3, 3 }, { 3, 3 }, { 3, 3 }, { 0.5, 0.5 } }; /* x y, three data, t */
  assert_int_equal(ambit_hull(p->invariant, of_x, slot), 0);
  assert_true(slot[p->invariant->out[0]].lo == 8.5 && slot[p->invariant->out[0]].hi == 8.5);
  ambit_interval all[8] = { { 2, 2 }, { 5, 5 }, { 4, 4 }, { 6, 6 }, { 3, 3 }, { 3, 3 }, { 3, 3 }, { 1, 1 } };
  assert_int_equal(ambit_hull(p->implicit->tape, all, slot), 0);
  static const double both[] = { 12, -5, 5, 15 };
  for (int k = 0; k < 4; k++) {
    ambit_interval x = slot[p->implicit->tape->out[k]];
    assert_true(x.lo == both[k] && x.hi == both[k]);
  }
  close_scene(&s);
}

static void a_form_that_is_none_is_refused(void **unused) {
  (void)unused;
  scene s;
  form o;
  open_scene(&s);
  open_form(&s, &o);
  ambit_expr second = o.residual[1];
  o.residual[1] = op(&s, AMBIT_OP_ADD, second, op(&s, AMBIT_OP_SQR, o.unknown[1], o.unknown[1]));
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT), AMBIT_INVALID); /* not affine */
  assert_non_null(strstr(s.failure.message, "not linear in their accelerations"));
  o.residual[1] = second;
  ambit_expr first = o.residual[0];
  o.residual[0] = op(&s, AMBIT_OP_ADD, first, o.unknown[1]);
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT), AMBIT_INVALID); /* depends on a later stage */
  o.residual[0] = op(&s, AMBIT_OP_ADD, first, ambit_graph_symbol(s.graph, "tau", "1"));
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT), AMBIT_INVALID);
  assert_non_null(strstr(s.failure.message, "the equation for `v` depends on `tau`"));
  o.residual[0] = first;
  o.rate[0] = op(&s, AMBIT_OP_SIN, o.unknown[1], o.unknown[1]);
  assert_int_equal(build(&s, AMBIT_WANT_IMPLICIT), AMBIT_INVALID);
  close_scene(&s);
}

static void their_jacobian_comes_with_jacobians(void **unused) {
  (void)unused;
  scene s;
  open_scene(&s);
  assert_int_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_JACOBIAN | AMBIT_WANT_INVARIANT), AMBIT_OK);
  const ambit_tape *t = s.problem.invariant_jacobian;
  assert_true(t->nout == 2 && t->nin == 5 && !(s.problem.invariant->flags & AMBIT_TAPE_SERIES));
  ambit_interval slot[64], in[5] = { { 2, 2 }, { 5, 5 }, { 9, 9 }, { 3, 3 }, { 0.5, 0.5 } };
  assert_int_equal(ambit_hull(t, in, slot), 0);
  assert_true(slot[t->out[0]].lo == 5 && slot[t->out[1]].hi == 2);
  close_scene(&s);
}

static void no_derivative_is_an_error_only_where_one_is_needed(void **unused) {
  (void)unused;
  scene s;
  open_scene(&s);
  s.system.ninvariant = 2;
  assert_int_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INVARIANT), AMBIT_OK);
  assert_int_equal(s.problem.ninvariant, 2);
  assert_int_not_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_JACOBIAN | AMBIT_WANT_INVARIANT), AMBIT_OK);
  assert_non_null(strstr(s.failure.message, "invariant `loop: row 2` has no derivative"));
  close_scene(&s);
}

static void strangers_are_named(void **unused) {
  (void)unused;
  scene s;
  open_scene(&s);
  ambit_expr stranger = ambit_graph_symbol(s.graph, "lambda", "N");
  s.invariant[0] = op(&s, AMBIT_OP_MUL, stranger, s.state[0]);
  assert_int_equal(build(&s, AMBIT_WANT_RHS), AMBIT_OK);
  assert_int_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_INVARIANT), AMBIT_INVALID);
  assert_non_null(strstr(s.failure.message, "the invariant `loop: row 1` depends on `lambda`"));
  s.invariant[0] = AMBIT_NO_EXPR;
  assert_int_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_INVARIANT), AMBIT_INVALID);
  assert_non_null(strstr(s.failure.message, "invariant `loop: row 1` has no formula"));
  s.invariant[0] = s.state[0], s.rate[1] = stranger;
  assert_int_equal(build(&s, AMBIT_WANT_RHS | AMBIT_WANT_INVARIANT), AMBIT_INVALID);
  assert_non_null(strstr(s.failure.message, "the right-hand side of state `y` depends on `lambda`"));
  close_scene(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(invariants_nobody_wants_are_not_built),
    cmocka_unit_test(their_data_become_parameters),
    cmocka_unit_test(what_has_no_implicit_form_comes_without_unknowns),
    cmocka_unit_test(an_implicit_form_stands_for_the_rates),
    cmocka_unit_test(a_form_that_is_none_is_refused),
    cmocka_unit_test(their_jacobian_comes_with_jacobians),
    cmocka_unit_test(no_derivative_is_an_error_only_where_one_is_needed),
    cmocka_unit_test(strangers_are_named),
  };
  return cmocka_run_group_tests_name("problem", tests, NULL, NULL);
}
