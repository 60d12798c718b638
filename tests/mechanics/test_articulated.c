/* The articulated-body form against the mass matrix on trees of all kinds of joints, forward against inverse dynamics,
** the balance of energy, linear growth, and what is refused.
*/
#include "graph/tape.h"
#include "kit/robot_models.h"
#include "mechanics/forward.h"
#include "graph/hull.h"
#include <ambit/dynamics.h>
#include "num/random.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

#define VALUES_MAX 128

static void check(ambit_status status, const ambit_failure *f) {
  if (status != AMBIT_OK) fail_msg("%s", f->message);
}

static ambit_forward forward_of(robot *r, uint32_t form, ambit_arena *arena) {
  ambit_forward forward;
  ambit_failure f = { 0 };
  check(ambit_forward_build(r->mechanism, form, true, arena, &forward, &f), &f);
  return forward;
}

/* Middles of the enclosures of e[0..n) with leaf[k] = value[k]. */
static void values(
    robot *r, size_t n, const ambit_expr *e, size_t nleaf, const ambit_expr *leaf, const double *value, double *out) {
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  check(ambit_tape_seal(r->graph, arena, n, e, nleaf, leaf, 0, 0, &tape, &f), &f);
  ambit_interval *in = ambit_arena_alloc(arena, (nleaf + 1) * sizeof *in);
  ambit_interval *slot = ambit_arena_alloc(arena, tape->nslot * sizeof *slot);
  for (size_t i = 0; i < nleaf; i++) in[i] = (ambit_interval) { value[i], value[i] };
  ambit_hull(tape, in, slot);
  for (size_t i = 0; i < n; i++) out[i] = ambit_interval_mid(slot[tape->out[i]]);
  ambit_arena_close(arena);
}

/* Everything that equations of motion may depend on, and random values: quaternions of length 1. */
typedef struct point {
  size_t n, force;
  ambit_expr leaf[VALUES_MAX];
  double value[VALUES_MAX];
} point;

static point random_point(robot *r, const ambit_forward *forward, ambit_random *random) {
  point p = { 0 };
  const ambit_variables *v = &forward->variables;
  double square = 0;
  for (size_t i = 0; i < v->ncoordinate; i++) p.leaf[p.n++] = v->coordinate[i].q;
  for (size_t i = 0; i < v->n; i++) p.leaf[p.n++] = v->u[i];
  p.force = p.n;
  for (size_t i = 0; i < v->n; i++) p.leaf[p.n++] = forward->force[i];
  p.leaf[p.n++] = ambit_graph_time(r->graph);
  for (size_t i = 0; i < p.n; i++) p.value[i] = ambit_random_in(random, (ambit_interval) { -1.2, 1.2 });
  for (size_t i = 0; i < v->ncoordinate; i++) {
    uint32_t part = v->coordinate[i].part;
    if (v->coordinate[i].rate == v->u[0] || strncmp(v->coordinate[i].name, "ball", 4) != 0) continue;
    if (v->coordinate[i].index == 0) square = 0;
    square += p.value[i] * p.value[i];
    for (size_t k = i + 1 - 4; v->coordinate[i].index == 3 && k <= i; k++)
      if (v->coordinate[k].part == part) p.value[k] /= sqrt(square);
  }
  return p;
}

static void expect_equal(size_t n, const double *x, const double *y, double tolerance) {
  double size = 1;
  for (size_t i = 0; i < n; i++) size = fmax(size, fabs(x[i]));
  for (size_t i = 0; i < n; i++)
    if (!(fabs(x[i] - y[i]) <= tolerance * size)) fail_msg("%zu: %.17g is not %.17g", i, x[i], y[i]);
}

/* -- mechanisms */

static ambit_frame body(robot *r, ambit_frame at) {
  robot_add(r, "rigid_body", NULL, at,
      ROBOT_DATA("mass", "1.3", "centre", "0.1,0.2,-0.3", "inertia", "0.3,0.01,0.02,0.01,0.4,-0.03,0.02,-0.03,0.35"));
  return at;
}

static ambit_frame arm(robot *r, ambit_frame at) { return robot_link(r, at, "0.3,-0.2,0.5", "0.3,0.2,0.7", "1.1"); }

/* A part whose only parameter is one expression. */
static ambit_frame driven(robot *r, const char *type, const char *name, ambit_frame at, const char *key, ambit_expr e) {
  const ambit_element *element = NULL;
  ambit_failure f = { 0 };
  const ambit_expr *param[8] = { 0 };
  ambit_frame connection[4] = { at, at, at, at };
  uint32_t part = 0, i = 0;
  check(ambit_registry_element(r->registry, type, &element, &f), &f);
  while (strcmp(element->param[i].name, key) != 0) i++;
  param[i] = &e;
  ambit_part_spec spec = { element, type, name, "test", param, connection, NULL };
  check(ambit_mechanism_add(r->mechanism, &spec, &part, &f), &f);
  return (ambit_frame) { part, 1 };
}

static ambit_frame joint_of(ambit_frame moved) { return (ambit_frame) { moved.part, 2 }; }

/* A branching tree with springs, dampers, a rotor, a joint that turns in time and one that nothing holds. */
static robot tree(void) {
  robot r = robot_open("tree");
  robot_add(&r, "gravity", NULL, AMBIT_WORLD, ROBOT_DATA("field", "1,-9.81,2"));
  ambit_expr t = ambit_graph_time(r.graph);
  ambit_frame base = robot_link(&r, AMBIT_WORLD, "1,2,3", "1,1,0", "0.4");
  base = driven(&r, "revolute", "motor", base, "angle", ambit_graph_op(r.graph, AMBIT_OP_SQR, t, t));
  ambit_frame hip = body(&r, robot_joint(&r, "revolute", "hip", arm(&r, base), "0.6,0.8,0"));
  ambit_frame knee = body(&r, robot_joint(&r, "prismatic", "knee", arm(&r, hip), "1,2,2"));
  ambit_frame foot = body(&r, arm(&r, (ambit_frame) { robot_add(&r, "universal", "foot", arm(&r, knee), NULL), 1 }));
  ambit_frame arm2 = body(&r, robot_joint(&r, "cylindrical", "sleeve", arm(&r, hip), "0,1,0"));
  ambit_frame ball = { robot_add(&r, "spherical", "socket", arm(&r, arm2), NULL), 1 };
  body(&r, arm(&r, ball));
  ambit_frame screw = { robot_add(&r, "screw", "screw", arm(&r, hip), ROBOT_DATA("pitch", "0.2")), 1 };
  body(&r, screw);
  body(&r, (ambit_frame) { robot_add(&r, "free", "float", AMBIT_WORLD, NULL), 1 });
  robot_add(&r, "armature", NULL, joint_of(hip), ROBOT_DATA("inertia", "0.7"));
  robot_add(&r, "armature", NULL, joint_of(knee), ROBOT_DATA("mass", "0.2"));
  ambit_expr s = ambit_graph_symbol(r.graph, "knee", "m");
  driven(&r, "joint_torque", NULL, joint_of(knee), "force", ambit_graph_op(r.graph, AMBIT_OP_MUL, t, s));
  arm(&r, foot);
  return r;
}

static robot quaternions(void) {
  robot r = robot_open("quaternions");
  robot_add(&r, "gravity", NULL, AMBIT_WORLD, ROBOT_DATA("field", "1,-9.81,2"));
  ambit_frame at = { robot_add(&r, "free_quaternion", "ball1", AMBIT_WORLD, NULL), 1 };
  at = arm(&r, body(&r, at));
  at = body(&r, (ambit_frame) { robot_add(&r, "spherical_quaternion", "ball2", at, NULL), 1 });
  body(&r, arm(&r, robot_joint(&r, "revolute", "hinge", at, "0,0,1")));
  return r;
}

static robot ur5(void) { return robot_ur5(); }
static robot puma560(void) { return robot_puma560(); }
static robot plane(void) { return robot_chain(7, 0); }
static robot space(void) { return robot_chain(5, 1); }

static robot (*const mechanisms[])(void) = { tree, ur5, puma560, plane, space };
#define MECHANISMS (sizeof mechanisms / sizeof *mechanisms)

/* -- identities */

static void expect_same_forms(robot r) {
  ambit_arena *arena = ambit_arena_open();
  ambit_random random = { 7 };
  ambit_forward a = forward_of(&r, AMBIT_FORM_ARTICULATED, arena), b = forward_of(&r, AMBIT_FORM_MASS_MATRIX, arena);
  assert_int_equal(a.form, AMBIT_FORM_ARTICULATED);
  assert_int_equal(b.form, AMBIT_FORM_MASS_MATRIX);
  for (int round = 0; round < 5; round++) {
    point p = random_point(&r, &a, &random);
    double x[32], y[32];
    values(&r, a.variables.n, a.du, p.n, p.leaf, p.value, x);
    values(&r, b.variables.n, b.du, p.n, p.leaf, p.value, y);
    expect_equal(a.variables.n, x, y, 1e-9);
  }
  ambit_arena_close(arena);
  robot_close(&r);
}

static void both_forms_agree(void **state) {
  (void)state;
  for (size_t i = 0; i < MECHANISMS; i++) expect_same_forms(mechanisms[i]());
}

static void both_forms_agree_with_quaternions(void **state) {
  (void)state;
  expect_same_forms(quaternions());
}

/* forward (inverse (u')) = u' */
static void expect_inverse(robot r, uint32_t form) {
  ambit_arena *arena = ambit_arena_open();
  ambit_random random = { 11 };
  ambit_failure f = { 0 };
  ambit_list tau;
  ambit_forward forward = forward_of(&r, form, arena);
  check(ambit_inverse_dynamics(r.mechanism, arena, &tau, &f), &f);
  size_t n = forward.variables.n;
  assert_int_equal(tau.n, n);
  for (int round = 0; round < 3; round++) {
    point p = random_point(&r, &forward, &random);
    double du[32], force[32], got[32];
    point q = p;
    for (size_t i = 0; i < n; i++) {
      q.leaf[q.force + i] = forward.variables.du[i];
      du[i] = q.value[q.force + i] = ambit_random_in(&random, (ambit_interval) { -2, 2 });
    }
    values(&r, n, tau.e, q.n, q.leaf, q.value, force);
    memcpy(p.value + p.force, force, n * sizeof *force);
    values(&r, n, forward.du, p.n, p.leaf, p.value, got);
    expect_equal(n, du, got, 1e-9);
  }
  ambit_arena_close(arena);
  robot_close(&r);
}

static void inverse_undoes_forward(void **state) {
  (void)state;
  for (size_t i = 0; i < MECHANISMS; i++) {
    expect_inverse(mechanisms[i](), AMBIT_FORM_ARTICULATED);
    expect_inverse(mechanisms[i](), AMBIT_FORM_MASS_MATRIX);
  }
  expect_inverse(quaternions(), AMBIT_FORM_AUTO);
}

/* d(energy)/dt = power of drives + sum of tau u along the motion that the system writes */
static void expect_energy_balance(robot r) {
  ambit_arena *arena = ambit_arena_open();
  ambit_random random = { 13 };
  ambit_failure f = { 0 };
  ambit_forward forward = forward_of(&r, AMBIT_FORM_ARTICULATED, arena);
  ambit_system system;
  check(ambit_dynamics_states(r.graph, &forward.variables, arena, &system, &f), &f);
  ambit_expr *rate = ambit_expressions(arena, system.nx);
  for (size_t j = 0; j < forward.variables.ncoordinate; j++) rate[j] = forward.variables.coordinate[j].rate;
  memcpy(rate + forward.variables.ncoordinate, forward.du, forward.variables.n * sizeof *rate);
  const ambit_expr *energy = ambit_mechanism_pull(r.mechanism, AMBIT_NOWHERE, AMBIT_ENERGY, &f);
  const ambit_expr *power = ambit_mechanism_pull(r.mechanism, AMBIT_NOWHERE, AMBIT_POWER, &f);
  if (!energy || !power) fail_msg("%s", f.message);
  ambit_expr total = ambit_graph_op(r.graph, AMBIT_OP_ADD, energy[0], energy[1]), given = *power;
  ambit_expr pair[2] = { ambit_graph_time_derivative(r.graph, total, system.nx, system.state, rate, &f) };
  const ambit_variables *v = &forward.variables;
  check(ambit_graph_substitute(r.graph, 1, &given, v->n, v->du, forward.du, &f), &f);
  for (size_t i = 0; i < v->n; i++)
    given =
        ambit_graph_op(r.graph, AMBIT_OP_ADD, given, ambit_graph_op(r.graph, AMBIT_OP_MUL, forward.force[i], v->u[i]));
  pair[1] = given;
  for (int round = 0; round < 5; round++) {
    point p = random_point(&r, &forward, &random);
    double x[2];
    values(&r, 2, pair, p.n, p.leaf, p.value, x);
    expect_equal(1, &x[0], &x[1], 1e-8);
  }
  ambit_arena_close(arena);
  robot_close(&r);
}

static void energy_changes_by_the_power(void **state) {
  (void)state;
  for (size_t i = 0; i < MECHANISMS; i++) expect_energy_balance(mechanisms[i]());
  expect_energy_balance(quaternions());
}

/* -- size */

static void expect_linear(int spatial) {
  size_t operations[3], nodes[3];
  for (int k = 0; k < 3; k++) {
    ambit_arena *arena = ambit_arena_open();
    robot r = robot_chain(100 * (k + 1), spatial);
    ambit_forward forward = forward_of(&r, AMBIT_FORM_AUTO, arena);
    assert_int_equal(forward.form, AMBIT_FORM_ARTICULATED);
    operations[k] = ambit_graph_size(r.graph, forward.variables.n, forward.du);
    nodes[k] = ambit_graph_count(r.graph);
    robot_close(&r);
    ambit_arena_close(arena);
  }
  for (int k = 0; k < 2; k++) {
    const size_t *n = k ? nodes : operations;
    double first = (double)(n[1] - n[0]), second = (double)(n[2] - n[1]);
    if (!(fabs(second / first - 1) < 0.05)) fail_msg("%zu, %zu, %zu", n[0], n[1], n[2]);
  }
}

static void chains_grow_linearly(void **state) {
  (void)state;
  expect_linear(0);
  expect_linear(1);
}

/* -- choice and refusals */

static void expect_refusal(robot *r, uint32_t form, const char *message) {
  ambit_arena *arena = ambit_arena_open();
  ambit_forward forward;
  ambit_failure f = { 0 };
  assert_int_equal(ambit_forward_build(r->mechanism, form, true, arena, &forward, &f), AMBIT_INVALID);
  if (!strstr(f.message, message)) fail_msg("`%s` instead of `%s`", f.message, message);
  ambit_arena_close(arena);
}

static uint32_t chosen(robot *r) {
  ambit_arena *arena = ambit_arena_open();
  uint32_t form = forward_of(r, AMBIT_FORM_AUTO, arena).form;
  ambit_arena_close(arena);
  return form;
}

static void the_shorter_form_is_chosen(void **state) {
  (void)state;
  static const struct {
    int n, spatial;
    uint32_t form;
  } cases[] = { { 2, 0, AMBIT_FORM_MASS_MATRIX }, { 6, 0, AMBIT_FORM_ARTICULATED }, { 3, 1, AMBIT_FORM_MASS_MATRIX },
    { 16, 1, AMBIT_FORM_ARTICULATED } };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    robot r = robot_chain(cases[i].n, cases[i].spatial);
    assert_int_equal(chosen(&r), cases[i].form);
    robot_close(&r);
  }
}

/* Three hinges, the last of which carries nothing but a wheel that turns with the first. */
static void followers_need_the_mass_matrix(void **state) {
  (void)state;
  robot r = robot_chain(3, 1);
  ambit_frame last = robot_joint(&r, "revolute", "extra", AMBIT_WORLD, "0,0,1");
  body(&r, last);
  body(&r, driven(&r, "revolute", "follower", AMBIT_WORLD, "angle", ambit_graph_symbol(r.graph, "extra", "rad")));
  expect_refusal(&r, AMBIT_FORM_ARTICULATED, "revolute `follower` (test): it follows other joints");
  assert_int_equal(chosen(&r), AMBIT_FORM_MASS_MATRIX);
  robot_close(&r);
}

static void add_law(robot *r, const char *joint, const char *acceleration, double factor) {
  uint32_t part = 0;
  while (strcmp(ambit_mechanism_part_name(r->mechanism, part), joint) != 0) part++;
  ambit_expr law = ambit_graph_op(
      r->graph, AMBIT_OP_MUL, ambit_graph_number(r->graph, factor), ambit_graph_symbol(r->graph, acceleration, "1"));
  driven(r, "joint_torque", NULL, (ambit_frame) { part, 2 }, "torque", law);
}

/* A law like an inertia, -0.5 q1'', is taken by the mass matrix alone; one that M does not stay symmetric with by
** none. */
static void laws_of_accelerations(void **state) {
  (void)state;
  robot r = robot_chain(3, 1);
  add_law(&r, "q1", "q1''", -0.5);
  add_law(&r, "q1", "q3''", -0.25);
  add_law(&r, "q3", "q1''", -0.25);
  expect_refusal(&r, AMBIT_FORM_ARTICULATED, "its data depend on accelerations");
  assert_int_equal(chosen(&r), AMBIT_FORM_MASS_MATRIX);
  add_law(&r, "q3", "q2''", 0.125);
  expect_refusal(&r, AMBIT_FORM_AUTO, "the acceleration of joint `q2` does not act on `q3` as that of `q3` on it");
  robot_close(&r);
}

static void masses_are_missed(void **state) {
  (void)state;
  static const uint32_t form[] = { AMBIT_FORM_MASS_MATRIX, AMBIT_FORM_ARTICULATED, AMBIT_FORM_AUTO };
  robot r = robot_chain(3, 1), twice = robot_open("twice");
  robot_joint(&r, "revolute", "idle", AMBIT_WORLD, "0,0,1");
  ambit_frame at = robot_joint(&twice, "revolute", "first", AMBIT_WORLD, "1,2,4");
  at = robot_joint(&twice, "revolute", "second", at, "1,2,4");
  at = robot_joint(&twice, "revolute", "third", body(&twice, at), "0,0,1");
  body(&twice, at);
  for (int k = 0; k < 3; k++) {
    expect_refusal(&r, form[k], "joint `idle` moves no mass: attach");
    expect_refusal(&twice, form[k], "singular in every position: joint `first`");
  }
  robot_close(&r);
  robot_close(&twice);
}

/* Each question has its answer where nothing moves. */
static void nothing_moves(void **state) {
  (void)state;
  robot r = robot_open("stone");
  ambit_arena *arena = ambit_arena_open();
  ambit_list list;
  ambit_motion motion;
  size_t n;
  const ambit_expr *h;
  body(&r, AMBIT_WORLD);
  ambit_failure f[5] = { 0 };
  ambit_motion_build(r.mechanism, arena, &motion, &f[0]);
  ambit_motion_force(r.mechanism, arena, &n, &h, &f[1]);
  ambit_inverse_dynamics(r.mechanism, arena, &list, &f[2]);
  ambit_gravity_torque(r.mechanism, arena, &list, &f[3]);
  ambit_jacobian(r.mechanism, AMBIT_WORLD, NULL, arena, &list, &f[4]);
  for (int i = 0; i < 5; i++)
    if (!strstr(f[i].message, "no coordinates")) fail_msg("%d: `%s`", i, f[i].message);
  expect_refusal(&r, AMBIT_FORM_ARTICULATED, "no coordinates");
  ambit_arena_close(arena);
  robot_close(&r);
}

/* What was pulled while the mechanism was cut is forgotten: quantities are what they were. */
static void a_cut_leaves_no_trace(void **state) {
  (void)state;
  robot r = robot_chain(3, 1);
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_frame tip = { ambit_mechanism_count(r.mechanism) - 1, 1 };
  ambit_list list;
  size_t pulled[2], all;
  ambit_expr before[6];
  memcpy(before, ambit_mechanism_pull(r.mechanism, tip, AMBIT_ACCEL, &f), sizeof before);
  ambit_mechanism_pulled(r.mechanism, &pulled[0], &all);
  forward_of(&r, AMBIT_FORM_ARTICULATED, arena);
  check(ambit_gravity_torque(r.mechanism, arena, &list, &f), &f);
  robot_link(&r, tip, "1,0,0", "0,0,1", "0");
  assert_memory_equal(before, ambit_mechanism_pull(r.mechanism, tip, AMBIT_ACCEL, &f), sizeof before);
  ambit_mechanism_pulled(r.mechanism, &pulled[1], &all);
  assert_true(pulled[1] <= all);
  ambit_arena_close(arena);
  robot_close(&r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(both_forms_agree),
    cmocka_unit_test(both_forms_agree_with_quaternions),
    cmocka_unit_test(inverse_undoes_forward),
    cmocka_unit_test(energy_changes_by_the_power),
    cmocka_unit_test(chains_grow_linearly),
    cmocka_unit_test(the_shorter_form_is_chosen),
    cmocka_unit_test(followers_need_the_mass_matrix),
    cmocka_unit_test(laws_of_accelerations),
    cmocka_unit_test(masses_are_missed),
    cmocka_unit_test(nothing_moves),
    cmocka_unit_test(a_cut_leaves_no_trace),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
