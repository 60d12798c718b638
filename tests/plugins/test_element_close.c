/* Elements that close loops: the virtual power of their wrenches is that of their rows, the rows vanish where the joint
** that they are named after could be, and say everything it says there.
*/
#include "mechanics/balance.h"
#include "mechanics/constraints.h"
#include "mechanics/loop_point.h"
#include "mechanics/machine.h"
#include "mechanics/partition.h"
#include "num/random.h"
#include <math.h>

typedef struct kind {
  const char *name;
  size_t rows;
  const char *joint;         /* which fulfils it; NULL: see `fixed` */
  const char *joint_axis[2]; /* parameters of the joint */
  const char *axis[2];       /* parameters of the closure */
  bool skew;                 /* the axes may point anywhere */
} kind;

static const kind kinds[] = {
  { "close_point", 3, "spherical", { NULL }, { NULL }, false },
  { "close_revolute", 5, "revolute", { "axis" }, { "axis" }, true },
  { "close_cylindrical", 4, "cylindrical", { "axis" }, { "axis" }, true },
  { "close_prismatic", 5, "prismatic", { "axis" }, { "axis" }, true },
  { "close_universal", 4, "universal", { "first", "second" }, { "first", "second" }, false },
  { "close_planar", 3, "planar", { NULL }, { "normal" }, false },
  { "close_weld", 6, "weld", { NULL }, { NULL }, false },
  { "close_pin", 2, "revolute", { "axis" }, { "normal" }, true },
  { "point_on_line", 2, "cylindrical", { "axis" }, { "axis" }, true },
  { "point_on_plane", 1, "planar", { NULL }, { "normal" }, false },
};

#define KINDS (sizeof kinds / sizeof *kinds)

/* A part with two connections. */
static uint32_t join(
    machine *s, const char *type, const char *name, ambit_frame a, ambit_frame b, const machine_datum *data) {
  const ambit_element *e = machine_element(s, type);
  const ambit_expr *param[MACHINE_PARAMS] = { 0 };
  ambit_frame connection[MACHINE_PARAMS] = { a, b };
  uint32_t part = UINT32_MAX;
  for (const machine_datum *d = data; d && d->name; d++) {
    size_t i = 0;
    while (e->param[i].name && strcmp(e->param[i].name, d->name) != 0) i++;
    if (!e->param[i].name) fail_msg("no parameter `%s`", d->name);
    param[i] = d->e;
  }
  ambit_part_spec spec = { e, type, name, "scene.lua:7", param, connection, NULL };
  ambit_failure_clear(&s->failure);
  return ambit_mechanism_add(s->mechanism, &spec, &part, &s->failure) == AMBIT_OK ? part : UINT32_MAX;
}

static ambit_frame floating(machine *s, const char *name) {
  return machine_frame(machine_add(s, "free", name, AMBIT_WORLD, NULL));
}

static const char *axis_text(ambit_random *r, bool skew, size_t i, char out[96]) {
  double v[3];
  for (int k = 0; k < 3; k++) v[k] = ambit_random_in(r, (ambit_interval) { -1, 1 });
  snprintf(out, 96, "%.9f,%.9f,%.9f", v[0], v[1], v[2]);
  if (!skew) snprintf(out, 96, "%s", i == 0 ? "1,0,0" : "0,1,0");
  return out;
}

/* Enclosures of the difference at random configurations contain 0 and are narrow. */
static void expect_equal(machine *s, ambit_random *r, ambit_expr x, ambit_expr y, const char *what) {
  ambit_expr e = ambit_graph_op(s->graph, AMBIT_OP_SUB, x, y), leaf[64];
  size_t n = ambit_graph_leaves(s->graph, 1, &e, 64, leaf);
  assert_true(n <= 64);
  for (int draw = 0; draw < 4; draw++) {
    double value[64];
    ambit_interval out;
    for (size_t i = 0; i < n; i++) value[i] = ambit_random_in(r, (ambit_interval) { -2, 2 });
    machine_values(s, 1, &e, n, leaf, value, &out);
    if (!(out.lo <= 0 && out.hi >= 0 && out.hi - out.lo < 1e-11)) fail_msg("%s: [%g, %g]", what, out.lo, out.hi);
  }
}

/* dr_i/dlambda_k = d(dg_k/dt)/du_i for both floating frames; the multipliers act on nothing else. */
static void check_power(machine *s, ambit_random *r, const char *what) {
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_constraints c;
  ambit_variables v;
  ambit_expr balance[16];
  ambit_multiplier lambda[16];
  if (ambit_constraints_build(s->mechanism, arena, &c, &f) != AMBIT_OK) fail_msg("%s", f.message);
  if (ambit_variables_read(s->mechanism, arena, &v, &f) != AMBIT_OK) fail_msg("%s", f.message);
  assert_true(v.n <= 16);
  if (ambit_balances_pull(s->mechanism, &v, balance, &f) != AMBIT_OK) fail_msg("%s", f.message);
  size_t nl = ambit_mechanism_multipliers(s->mechanism, 16, lambda);
  assert_int_equal(nl, c.n);
  for (size_t k = 0; k < nl; k++) {
    assert_int_equal(lambda[k].index, c.row[k].index);
    for (size_t i = 0; i < v.n; i++)
      expect_equal(
          s, r, ambit_graph_derivative(s->graph, balance[i], lambda[k].lambda, &f), c.velocity[k * c.nu + i], what);
  }
  ambit_arena_close(arena);
}

static void wrenches_have_the_power_of_the_rows(void **state) {
  (void)state;
  ambit_random r = { 11 };
  for (size_t k = 0; k < KINDS; k++)
    for (int round = 0; round < 2; round++) {
      char first[96], second[96];
      machine s = machine_open();
      ambit_frame a = floating(&s, "a"), b = floating(&s, "b");
      machine_datum data[3] = { { 0 } };
      bool skew = round == 1;
      if (kinds[k].axis[0]) data[0] = machine_text(&s, kinds[k].axis[0], axis_text(&r, skew, 0, first));
      if (kinds[k].axis[1]) data[1] = machine_text(&s, kinds[k].axis[1], axis_text(&r, skew, 1, second));
      uint32_t part = join(&s, kinds[k].name, "closure", a, b, data);
      if (part == UINT32_MAX) fail_msg("%s", s.failure.message);
      check_power(&s, &r, kinds[k].name);
      machine_close(&s);
    }
}

static void a_rod_has_the_power_of_its_row(void **state) {
  (void)state;
  ambit_random r = { 12 };
  machine s = machine_open();
  ambit_frame a = floating(&s, "a"), b = floating(&s, "b");
  ambit_expr t = ambit_graph_time(s.graph), two = machine_number(&s, 2);
  ambit_expr length = ambit_graph_op(s.graph, AMBIT_OP_ADD, two, ambit_graph_op(s.graph, AMBIT_OP_SIN, t, t));
  uint32_t part = join(&s, "close_distance", "rod", a, b, MACHINE_DATA(machine_expr("length", length)));
  if (part == UINT32_MAX) fail_msg("%s", s.failure.message);
  check_power(&s, &r, "close_distance");
  /* and what the drive puts in is what the row takes up at rest, force times rate of length where g vanishes */
  const ambit_expr *power = machine_pull(&s, AMBIT_NOWHERE, AMBIT_POWER);
  const ambit_expr *g = machine_pull(&s, (ambit_frame) { part, 2 }, AMBIT_RESIDUAL);
  ambit_failure f = { 0 };
  ambit_multiplier lambda;
  assert_int_equal(ambit_mechanism_multipliers(s.mechanism, 1, &lambda), 1);
  ambit_expr lost = ambit_graph_derivative(s.graph, *g, t, &f);
  lost = ambit_graph_op(s.graph, AMBIT_OP_MUL, lost, lambda.lambda);
  expect_equal(&s, &r, *power, ambit_graph_op(s.graph, AMBIT_OP_NEG, lost, lost), "power");
  machine_close(&s);
}

/* The joint itself between the frames: every row vanishes wherever it goes. */
static void rows_vanish_for_their_joint(void **state) {
  (void)state;
  ambit_random r = { 13 };
  for (size_t k = 0; k < KINDS; k++) {
    const kind *kind = &kinds[k];
    machine s = machine_open();
    machine_datum joint[3] = { { 0 } }, closure[3] = { { 0 } };
    for (size_t i = 0; i < 2; i++) {
      char text[96];
      axis_text(&r, kind->skew, i, text);
      if (strcmp(kind->joint, "planar") == 0) snprintf(text, sizeof text, "0,0,1");
      if (kind->joint_axis[i]) joint[i] = machine_text(&s, kind->joint_axis[i], text);
      if (kind->axis[i]) closure[i] = machine_text(&s, kind->axis[i], text);
    }
    ambit_frame a = floating(&s, "a");
    ambit_frame b = machine_frame(machine_add(&s, kind->joint, "joint", a, joint));
    uint32_t part = join(&s, kind->name, "closure", a, b, closure);
    if (part == UINT32_MAX) fail_msg("%s", s.failure.message);
    const ambit_element *e = machine_element(&s, kind->name);
    assert_int_equal(e->port[2].dof, kind->rows);
    const ambit_expr *g = machine_pull(&s, (ambit_frame) { part, 2 }, AMBIT_RESIDUAL);
    for (size_t i = 0; i < kind->rows; i++) expect_equal(&s, &r, g[i], 0, kind->name);
    machine_close(&s);
  }
}

/* At an assembled position of two floating frames the rows are independent: as many as the joint takes freedoms. */
static void rows_are_independent(void **state) {
  (void)state;
  ambit_random r = { 14 };
  for (size_t k = 0; k < KINDS; k++)
    for (int round = 0; round < 3; round++) {
      ambit_failure f = { 0 };
      ambit_arena *arena = ambit_arena_open();
      machine s = machine_open();
      machine_datum data[3] = { { 0 } };
      for (size_t i = 0; i < 2; i++) {
        char text[96];
        if (kinds[k].axis[i]) data[i] = machine_text(&s, kinds[k].axis[i], axis_text(&r, round == 2, i, text));
      }
      ambit_frame a = floating(&s, "a"), b = floating(&s, "b");
      join(&s, kinds[k].name, "closure", a, b, data);
      ambit_constraints c;
      ambit_loop_point at;
      if (ambit_constraints_build(s.mechanism, arena, &c, &f) != AMBIT_OK) fail_msg("%s", f.message);
      assert_int_equal(c.n, kinds[k].rows);
      assert_int_equal(ambit_loop_point_open(&c, arena, &at, &f), AMBIT_OK);
      double q[12];
      for (int i = 0; i < 12; i++) q[i] = ambit_random_in(&r, (ambit_interval) { -0.7, 0.7 });
      assert_true(ambit_loop_point_close(&at, q, 0));
      for (size_t i = 0; i < c.n; i++) assert_true(fabs(at.g[i]) < 1e-11);
      assert_int_equal(ambit_partition_rank(arena, c.n, c.nu, at.velocity, &f), c.n);
      machine_close(&s);
      ambit_arena_close(arena);
    }
}

/* g of a rod is the excess of length to first order. */
static void a_rod_measures_length(void **state) {
  (void)state;
  machine s = machine_open();
  uint32_t slider = machine_add(&s, "prismatic", "s", AMBIT_WORLD, MACHINE_DATA(machine_text(&s, "axis", "1,2,2")));
  uint32_t part = join(
      &s, "close_distance", "rod", AMBIT_WORLD, machine_frame(slider), MACHINE_DATA(machine_text(&s, "length", "0.5")));
  const ambit_expr *g = machine_pull(&s, (ambit_frame) { part, 2 }, AMBIT_RESIDUAL);
  ambit_expr leaf = machine_symbol(&s, "s");
  const double x[3] = { 0.5, 0.5 + 1e-6, -0.5 }, expected[3] = { 0, 1e-6, 0 };
  for (int i = 0; i < 3; i++) {
    ambit_interval out;
    machine_values(&s, 1, g, 1, &leaf, &x[i], &out);
    assert_true(out.lo <= expected[i] + 2e-12 && out.hi >= expected[i] - 2e-12 && out.hi - out.lo < 1e-14);
  }
  machine_close(&s);
}

static void expect_refusal(machine *s, const char *type, const machine_datum *data, const char *part_of_message) {
  uint32_t part = join(s, type, "closure", AMBIT_WORLD, floating(s, "b"), data);
  ambit_failure f = s->failure;
  if (part != UINT32_MAX) {
    ambit_failure_clear(&f);
    assert_null(ambit_mechanism_pull(s->mechanism, (ambit_frame) { part, 2 }, AMBIT_RESIDUAL, &f));
  }
  if (!strstr(f.message, part_of_message) || !strstr(f.message, "closure")) fail_msg("%s", f.message);
}

static void bad_data_are_refused(void **state) {
  (void)state;
  machine s = machine_open();
  expect_refusal(&s, "close_distance", MACHINE_DATA(machine_text(&s, "length", "0")), "the length must be positive");
  machine_close(&s);
  s = machine_open();
  expect_refusal(&s, "close_distance", MACHINE_DATA(machine_text(&s, "length", "-2")), "at most -2 m");
  machine_close(&s);
  s = machine_open();
  machine_add(&s, "prismatic", "s", AMBIT_WORLD, NULL);
  ambit_mechanism_coordinates(s.mechanism, 0, NULL);
  expect_refusal(
      &s, "close_distance", MACHINE_DATA(machine_expr("length", machine_symbol(&s, "s"))), "depends on a coordinate");
  machine_close(&s);
  s = machine_open();
  expect_refusal(&s, "close_revolute", MACHINE_DATA(machine_text(&s, "axis", "0,0,0")), "the axis is zero");
  machine_close(&s);
  s = machine_open();
  machine_datum moving = machine_text(&s, "axis", "1,0,0");
  moving.e[1] = ambit_graph_time(s.graph);
  expect_refusal(&s, "close_cylindrical", MACHINE_DATA(moving), "`axis` moves in time");
  machine_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(wrenches_have_the_power_of_the_rows),
    cmocka_unit_test(a_rod_has_the_power_of_its_row),
    cmocka_unit_test(rows_vanish_for_their_joint),
    cmocka_unit_test(rows_are_independent),
    cmocka_unit_test(a_rod_measures_length),
    cmocka_unit_test(bad_data_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
