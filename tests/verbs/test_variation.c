/* Systems with their variational equations: which entries are built, what they are called, and their right-hand sides
** against differences of the original ones. */
#include <ambit/variation.h>
#include "graph/hull.h"
#include "graph/tape.h"
#include "num/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define STATES_MAX 4
#define BY_MAX 4

typedef struct source {
  ambit_graph *graph;
  const char *name[STATES_MAX], *unit[STATES_MAX];
  ambit_expr state[STATES_MAX], rate[STATES_MAX], initial[STATES_MAX];
  ambit_system system;
} source;

typedef struct stage {
  source *s;
  ambit_arena *arena;
  ambit_variation_by by[BY_MAX];
  size_t nby;
  ambit_variation v;
  ambit_failure failure;
} stage;

static int set_up(void **state) {
  stage *g = calloc(1, sizeof *g);
  source *s = g->s = calloc(1, sizeof *s);
  s->graph = ambit_graph_open();
  s->system =
      (ambit_system) { .graph = s->graph, .name = s->name, .unit = s->unit, .state = s->state, .rate = s->rate };
  g->arena = ambit_arena_open();
  *state = g;
  return 0;
}

static int tear_down(void **state) {
  stage *g = *state;
  ambit_graph_close(g->s->graph);
  free(g->s);
  ambit_arena_close(g->arena);
  free(g);
  return 0;
}

static ambit_expr op(const stage *g, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(g->s->graph, code, a, b);
}

static ambit_expr number(const stage *g, double x) { return ambit_graph_number(g->s->graph, x); }

static ambit_expr unknown(const stage *g, double lo, double hi) {
  return ambit_graph_unknown(g->s->graph, NULL, (ambit_interval) { lo, hi });
}

/* A state at rest. */
static ambit_expr add_state(stage *g, const char *name, ambit_expr initial) {
  source *s = g->s;
  size_t i = s->system.nx++;
  s->name[i] = name;
  s->unit[i] = "1";
  s->initial[i] = initial;
  s->rate[i] = number(g, 0);
  return s->state[i] = ambit_graph_symbol(s->graph, name, "1");
}

static void by_state(stage *g, const char *name, uint32_t i) {
  g->by[g->nby++] = (ambit_variation_by) { .name = name, .unit = g->s->unit[i], .initial_of = i };
}

static void by_datum(stage *g, const char *name, ambit_expr datum) {
  g->by[g->nby++] = (ambit_variation_by) { .name = name, .initial_of = AMBIT_VARIATION_ZERO, .datum = datum };
}

static ambit_status build(stage *g) {
  const ambit_variation_request q = { &g->s->system, g->s->initial, g->nby, g->by };
  g->failure = (ambit_failure) { 0 };
  return ambit_variation_build(&q, g->arena, &g->v, &g->failure);
}

static void assert_refused(stage *g, const char *part) {
  assert_int_equal(build(g), AMBIT_INVALID);
  if (!strstr(g->failure.message, part)) fail_msg("\"%s\" expected, got: %s", part, g->failure.message);
}

static void leaves_out_what_is_zero(void **state) {
  stage *g = *state; /* x' = -x, y' = p x, z' = z */
  ambit_expr p = unknown(g, 1, 2);
  add_state(g, "x", number(g, 1));
  add_state(g, "y", number(g, 2));
  add_state(g, "z", p);
  g->s->rate[0] = op(g, AMBIT_OP_NEG, g->s->state[0], 0);
  g->s->rate[1] = op(g, AMBIT_OP_MUL, p, g->s->state[0]);
  g->s->rate[2] = g->s->state[2];
  by_state(g, "x", 0);
  by_state(g, "y", 1);
  by_datum(g, "p", p);
  assert_int_equal(build(g), AMBIT_OK);
  static const bool built[3][3] = { { 1, 0, 0 }, { 1, 1, 1 }, { 0, 0, 1 } };
  size_t n = 3;
  for (size_t i = 0; i < 3; i++)
    for (size_t j = 0; j < 3; j++) {
      uint32_t at = g->v.place[i * 3 + j];
      assert_int_equal(at != AMBIT_VARIATION_ZERO, built[i][j]);
      n += built[i][j];
    }
  assert_int_equal(g->v.system.nx, n);
  assert_string_equal(g->v.system.name[g->v.place[1 * 3 + 2]], "d y/d p");
  assert_true(g->v.initial[g->v.place[2 * 3 + 2]] == number(g, 1)); /* z(0) = p */
  assert_true(g->v.initial[g->v.place[1 * 3 + 0]] == number(g, 0));
  for (size_t i = 0; i < 3; i++) assert_true(g->v.system.rate[i] == g->s->rate[i]);
}

static void gives_units(void **state) {
  stage *g = *state;
  ambit_expr p = unknown(g, 1, 2), q = unknown(g, 1, 2);
  add_state(g, "x", op(g, AMBIT_OP_ADD, p, q));
  g->s->unit[0] = "m";
  by_state(g, "x", 0);
  by_datum(g, "p", p);
  g->by[1].unit = "kg";
  by_datum(g, "q", q);
  assert_int_equal(build(g), AMBIT_OK);
  static const char *const unit[] = { "1", "m/(kg)", "m" };
  for (size_t j = 0; j < 3; j++) assert_string_equal(g->v.system.unit[g->v.place[j]], unit[j]);
}

/* -- right-hand sides of random systems against differences */

#define NX 3
#define NU 2

static ambit_expr random_rate(stage *g, ambit_random *r, const ambit_expr leaf[NX + NU + 1]) {
  const ambit_interval unit = { -1, 1 };
  ambit_expr sum = number(g, ambit_random_in(r, unit));
  for (int n = 0; n < 5; n++) {
    ambit_expr a = leaf[ambit_random_bits(r) % (NX + NU + 1)], b = leaf[ambit_random_bits(r) % (NX + NU + 1)];
    ambit_expr term = op(g, AMBIT_OP_MUL, a, b);
    if (n == 1) term = op(g, AMBIT_OP_SIN, term, 0);
    if (n == 2) term = op(g, AMBIT_OP_DIV, a, op(g, AMBIT_OP_ADD, number(g, 4), op(g, AMBIT_OP_SQR, b, 0)));
    if (n == 3) term = op(g, AMBIT_OP_EXP, a, 0);
    sum = op(g, AMBIT_OP_ADD, sum, op(g, AMBIT_OP_MUL, number(g, ambit_random_in(r, unit)), term));
  }
  return sum;
}

/* e[0..n) at the values of the leaves */
static void evaluate(
    stage *g, size_t n, const ambit_expr *e, size_t nin, const ambit_expr *in, const double *at, double *out) {
  const ambit_tape *t;
  ambit_interval slot[4096], x[64];
  assert_int_equal(ambit_tape_seal(g->s->graph, g->arena, n, e, nin, in, 0, 0, &t, &g->failure), AMBIT_OK);
  assert_true(t->nslot <= 4096 && nin <= 64);
  for (size_t i = 0; i < nin; i++) x[i] = (ambit_interval) { at[i], at[i] };
  ambit_hull(t, x, slot);
  for (size_t i = 0; i < n; i++) out[i] = ambit_interval_mid(slot[t->out[i]]);
}

/* S' of every column is the derivative of f along (S, dq): (f(x + h S, q + h) - f(x - h S, q - h)) / 2h. Column NX is
** by a datum, leaf number `datum`, which moves by `scale`. */
static void compare(stage *g, ambit_random *r, const ambit_expr leaf[NX + NU + 1], size_t datum, double scale) {
  const ambit_system *s = &g->v.system;
  const ambit_interval unit = { -1, 1 };
  ambit_expr in[64];
  double at[64], rate[64], up[NX], down[NX];
  size_t n = s->nx, nin = 0;
  for (size_t i = 0; i < n; i++) in[nin++] = s->state[i];
  for (size_t i = NX; i < NX + NU + 1; i++) in[nin++] = leaf[i];
  for (size_t i = 0; i < nin; i++) at[i] = ambit_random_in(r, unit);
  evaluate(g, n, s->rate, nin, in, at, rate);
  for (size_t j = 0; j < g->nby; j++) {
    const double h = 1e-5;
    double moved[2][NX + NU + 1];
    for (int side = 0; side < 2; side++) {
      double d = side ? -h : h;
      for (size_t i = 0; i < NX; i++) {
        uint32_t place = g->v.place[i * g->nby + j];
        moved[side][i] = at[i] + (place == AMBIT_VARIATION_ZERO ? 0 : d * at[place]);
      }
      for (size_t i = 0; i < NU + 1; i++) moved[side][NX + i] = at[n + i];
      if (j == NX) moved[side][datum] += d * scale;
    }
    evaluate(g, NX, g->s->rate, NX + NU + 1, leaf, moved[0], up);
    evaluate(g, NX, g->s->rate, NX + NU + 1, leaf, moved[1], down);
    for (size_t i = 0; i < NX; i++) {
      uint32_t place = g->v.place[i * g->nby + j];
      double truth = (up[i] - down[i]) / (2 * h);
      assert_true(fabs((place == AMBIT_VARIATION_ZERO ? 0 : rate[place]) - truth) < 1e-6 * (1 + fabs(truth)));
    }
  }
}

static void agrees_with_differences(void **state) {
  (void)state;
  ambit_random r = { 77 };
  for (int n = 0; n < 40; n++) {
    void *own;
    set_up(&own);
    stage *g = own;
    static const char *const name[] = { "x", "y", "z" };
    ambit_expr leaf[NX + NU + 1];
    for (size_t i = 0; i < NX; i++) leaf[i] = add_state(g, name[i], number(g, 1));
    for (size_t i = 0; i < NU; i++) leaf[NX + i] = unknown(g, -1, 1);
    leaf[NX + NU] = ambit_graph_time(g->s->graph);
    for (size_t i = 0; i < NX; i++) g->s->rate[i] = random_rate(g, &r, leaf);
    for (uint32_t i = 0; i < NX; i++) by_state(g, name[i], i);
    /* by one datum, or by four times the other: a quarter of the derivative by it */
    size_t which = (size_t)n % NU;
    by_datum(g, "a", which ? op(g, AMBIT_OP_MUL, number(g, 4), leaf[NX + 1]) : leaf[NX]);
    assert_int_equal(build(g), AMBIT_OK);
    compare(g, &r, leaf, NX + which, which ? 0.25 : 1);
    tear_down(&own);
  }
}

/* -- what is refused */

static void refuses_what_is_no_datum(void **state) {
  stage *g = *state;
  ambit_expr p = unknown(g, 1, 2), q = unknown(g, 1, 2);
  add_state(g, "x", p);
  by_datum(g, "a", number(g, 2));
  assert_refused(g, "`a` is not uncertain");
  g->by[0].datum = op(g, AMBIT_OP_MUL, p, q);
  assert_refused(g, "not one uncertain datum");
  g->by[0].datum = g->s->state[0];
  assert_refused(g, "not one uncertain datum");
  g->by[0].datum = op(g, AMBIT_OP_SQR, p, 0);
  assert_refused(g, "constant times one");
  g->s->rate[0] = op(g, AMBIT_OP_ABS, g->s->state[0], 0);
  g->by[0].datum = p;
  assert_refused(g, "right-hand side of state `x` has no derivative");
}

static void keeps_to_the_manifold(void **state) {
  stage *g = *state; /* x' = y, y' = -m x with the invariant x + y - p = 0 as far as this test is concerned */
  ambit_expr p = unknown(g, 1, 2), m = unknown(g, 1, 2);
  add_state(g, "x", number(g, 1));
  add_state(g, "y", number(g, 0));
  add_state(g, "free", number(g, 0));
  g->s->rate[0] = g->s->state[1];
  g->s->rate[1] = op(g, AMBIT_OP_MUL, m, g->s->state[0]);
  ambit_expr invariant = op(g, AMBIT_OP_SUB, op(g, AMBIT_OP_ADD, g->s->state[0], g->s->state[1]), p);
  static const char *const row[] = { "loop: row 1" };
  g->s->system.ninvariant = 1;
  g->s->system.invariant = &invariant;
  g->s->system.invariant_name = row;
  by_datum(g, "m", m);
  by_state(g, "free", 2);
  assert_int_equal(build(g), AMBIT_OK);
  assert_int_equal(g->v.system.ninvariant, 1);
  by_datum(g, "p", p);
  assert_refused(g, "`p` moves the start off the constraint `loop: row 1`");
  g->nby = 0;
  by_state(g, "x", 0);
  assert_refused(g, "`x` moves the start off");
  g->nby = 0;
  by_datum(g, "m", m);
  g->s->initial[0] = m; /* the start moves with the mass */
  assert_refused(g, "`m` moves the start off");
}

static void refuses_two_states_of_one_name(void **state) {
  stage *g = *state;
  add_state(g, "x", number(g, 1));
  add_state(g, "d x/d x", number(g, 1));
  by_state(g, "x", 0);
  assert_refused(g, "two states `d x/d x`");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(leaves_out_what_is_zero, set_up, tear_down),
    cmocka_unit_test_setup_teardown(gives_units, set_up, tear_down),
    cmocka_unit_test(agrees_with_differences),
    cmocka_unit_test_setup_teardown(refuses_what_is_no_datum, set_up, tear_down),
    cmocka_unit_test_setup_teardown(keeps_to_the_manifold, set_up, tear_down),
    cmocka_unit_test_setup_teardown(refuses_two_states_of_one_name, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
