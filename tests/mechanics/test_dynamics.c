/* Equations of motion: closed forms, an independent Newton-Euler in doubles, energy, and what is refused. */
#include "mechanics/constrained.h"
#include "mechanics/machine.h"
#include "num/random.h"
#include <math.h>

typedef struct bench {
  machine machine; /* first */
  ambit_arena *arena;
} bench;

static int set_up(void **state) {
  bench *s = malloc(sizeof *s);
  *s = (bench) { machine_open(), ambit_arena_open() };
  *state = s;
  return 0;
}

static int tear_down(void **state) {
  bench *s = *state;
  machine_close(&s->machine);
  ambit_arena_close(s->arena);
  free(s);
  return 0;
}

static ambit_motion motion_of(bench *s) {
  ambit_motion motion;
  ambit_failure f = { 0 };
  if (ambit_motion_build(s->machine.mechanism, s->arena, &motion, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return motion;
}

static ambit_system system_of(bench *s) {
  ambit_system system;
  ambit_failure f = { 0 };
  if (ambit_constrained_system(s->machine.mechanism, AMBIT_FORM_AUTO, s->arena, &system, &f) != AMBIT_OK)
    fail_msg("%s", f.message);
  return system;
}

static void expect_text(machine *m, ambit_expr e, const char *expected) {
  char text[256];
  machine_text_of(m, e, text);
  assert_string_equal(text, expected);
}

static void expect_near(ambit_interval x, double expected, double tolerance) {
  if (!(x.lo <= expected + tolerance && x.hi >= expected - tolerance && x.hi - x.lo <= tolerance))
    fail_msg("[%.17g, %.17g] instead of %.17g", x.lo, x.hi, expected);
}

static void double_pendulum(bench *s) {
  machine *m = &s->machine;
  machine_gravity(m, "0,-9.81,0");
  ambit_frame elbow = machine_link(m, machine_revolute(m, "beta1", AMBIT_WORLD, "0,0,1"), "0,-1,0");
  ambit_frame hand = machine_link(m, machine_revolute(m, "beta2", elbow, "0,0,1"), "0,-1,0");
  machine_mass(m, elbow, "1");
  machine_mass(m, hand, "1");
}

/* M = [3 + 2c, 1 + c; 1 + c, 1]; the equations of Auer, Dötschel, Kersten, Rauh (ValEncIA-IVP, 2006), relative
** angles.
*/
static void double_pendulum_is_the_textbook_one(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  double_pendulum(s);
  ambit_motion motion = motion_of(s);
  assert_int_equal(motion.n, 2);
  expect_text(m, motion.mass[0], "3 + 2*cos(beta2)");
  expect_text(m, motion.mass[1], "1 + cos(beta2)");
  assert_int_equal(motion.mass[2], motion.mass[1]);
  expect_text(m, motion.mass[3], "1");
  ambit_random random = { 1 };
  ambit_system system = system_of(s);
  assert_int_equal(system.nx, 4);
  static const char *const name[] = { "beta1", "beta2", "beta1'", "beta2'" }, *const unit[] = { "rad", "rad", "rad/s",
    "rad/s" };
  for (int i = 0; i < 4; i++) {
    assert_string_equal(system.name[i], name[i]);
    assert_string_equal(system.unit[i], unit[i]);
    assert_true(ambit_graph_node(m->graph, system.rate[i])
                    ->total); /* the division is by 2 - cos^2, which is proved to be in [1, 2] */
  }
  for (int round = 0; round < 20; round++) {
    double x[4], f[2];
    ambit_interval rate[4];
    for (int i = 0; i < 4; i++) x[i] = ambit_random_in(&random, (ambit_interval) { -4, 4 });
    double c = cos(x[1]), sn = sin(x[1]), g = 9.81;
    f[0] = sn * x[3] * (2 * x[2] + x[3]) - g * (2 * sin(x[0]) + sin(x[0] + x[1]));
    f[1] = -sn * x[2] * x[2] - g * sin(x[0] + x[1]);
    double det = (3 + 2 * c) - (1 + c) * (1 + c);
    machine_values(m, 4, system.rate, 4, system.state, x, rate);
    expect_near(rate[0], x[2], 0);
    expect_near(rate[1], x[3], 0);
    expect_near(rate[2], (f[0] - (1 + c) * f[1]) / det, 1e-11);
    expect_near(rate[3], ((3 + 2 * c) * f[1] - (1 + c) * f[0]) / det, 1e-11);
  }
}

/* The size of what an integrator has to evaluate: a measure that must not grow unnoticed. */
static void double_pendulum_is_short(void **state) {
  bench *s = *state;
  double_pendulum(s);
  ambit_system system = system_of(s);
  assert_in_range(ambit_graph_size(s->machine.graph, 4, system.rate), 1, 34);
}

/* -- d/dt of the energy along the motion */

static ambit_expr energy_rate(bench *s, const ambit_system *system) {
  machine *m = &s->machine;
  ambit_failure f = { 0 };
  const ambit_expr *e = machine_pull(m, AMBIT_NOWHERE, AMBIT_ENERGY);
  ambit_expr total = ambit_graph_op(m->graph, AMBIT_OP_ADD, e[0], e[1]);
  ambit_expr rate = ambit_graph_time_derivative(m->graph, total, system->nx, system->state, system->rate, &f);
  if (rate == AMBIT_NO_EXPR) fail_msg("%s", f.message);
  return rate;
}

static void expect_energy_kept(bench *s, double tolerance) {
  ambit_random random = { 3 };
  ambit_system system = system_of(s);
  ambit_expr rate = energy_rate(s, &system);
  for (int round = 0; round < 20; round++) {
    double x[16];
    ambit_interval zero;
    for (size_t i = 0; i < system.nx; i++) x[i] = ambit_random_in(&random, (ambit_interval) { -2, 2 });
    machine_values(&s->machine, 1, &rate, system.nx, system.state, x, &zero);
    expect_near(zero, 0, tolerance);
  }
}

static void double_pendulum_keeps_its_energy(void **state) {
  double_pendulum(*state);
  expect_energy_kept(*state, 1e-10);
}

/* -- a chain in space against Newton and Euler in doubles */

typedef double vector[3];
typedef double matrix[3][3];

typedef struct body {
  vector axis, offset, centre;
  matrix inertia;
  double mass;
  bool slides;
} body;

enum { CHAIN = 4 };

static void cross(const vector a, const vector b, vector r) {
  for (int i = 0; i < 3; i++) r[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void apply(matrix m, const vector v, vector r) {
  for (int i = 0; i < 3; i++) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

static void apply_transposed(matrix m, const vector v, vector r) {
  for (int i = 0; i < 3; i++) r[i] = m[0][i] * v[0] + m[1][i] * v[1] + m[2][i] * v[2];
}

static void add_to(vector r, double s, const vector v) {
  for (int i = 0; i < 3; i++) r[i] += s * v[i];
}

static double inner(const vector a, const vector b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* exp of the axis by its series: no Rodrigues */
static void rotation(const vector n, double angle, matrix r) {
  matrix k = { { 0, -n[2], n[1] }, { n[2], 0, -n[0] }, { -n[1], n[0], 0 } },
         term = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  memcpy(r, term, sizeof term);
  for (int order = 1; order < 40; order++) {
    matrix next = { { 0 } };
    for (int i = 0; i < 9; i++)
      for (int j = 0; j < 3; j++) next[i / 3][i % 3] += term[i / 3][j] * k[j][i % 3] * angle / order;
    memcpy(term, next, sizeof term);
    for (int i = 0; i < 9; i++) r[i / 3][i % 3] += term[i / 3][i % 3];
  }
}

/* Everything in world axes, velocities of points by adding up joint by joint; joint forces as moments of all outer
** bodies' inertia forces.
*/
static void newton_euler(body *b, const double *q, const double *qd, const double *qdd, const vector g, double *tau) {
  matrix turn[CHAIN];
  vector axis[CHAIN], joint[CHAIN], force[CHAIN], torque[CHAIN], place[CHAIN];
  matrix r = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  vector at = { 0 }, v = { 0 }, a = { -g[0], -g[1], -g[2] }, w = { 0 }, alpha = { 0 }, t, u;
  for (int k = 0; k < CHAIN; k++) {
    matrix local, product = { { 0 } };
    apply(r, b[k].axis, axis[k]);
    memcpy(joint[k], at, sizeof at);
    if (b[k].slides) { /* the frame is carried along by s n */
      vector s = { q[k] * axis[k][0], q[k] * axis[k][1], q[k] * axis[k][2] };
      cross(w, s, t), cross(w, t, u), add_to(a, 1, u), cross(alpha, s, u), add_to(a, 1, u);
      add_to(v, 1, t);
      cross(w, axis[k], t), add_to(a, 2 * qd[k], t), add_to(a, qdd[k], axis[k]), add_to(v, qd[k], axis[k]);
      add_to(at, 1, s);
    } else {
      cross(w, axis[k], t), add_to(alpha, qd[k], t), add_to(alpha, qdd[k], axis[k]), add_to(w, qd[k], axis[k]);
      rotation(b[k].axis, q[k], local);
      for (int i = 0; i < 9; i++)
        for (int j = 0; j < 3; j++) product[i / 3][i % 3] += r[i / 3][j] * local[j][i % 3];
      memcpy(r, product, sizeof r);
    }
    memcpy(turn[k], r, sizeof r);
    vector c, p, spin, local_w, local_alpha, moment, rate;
    apply(r, b[k].centre, c);
    for (int i = 0; i < 3; i++) place[k][i] = at[i] + c[i], p[i] = a[i];
    cross(alpha, c, t), add_to(p, 1, t), cross(w, c, t), cross(w, t, u), add_to(p, 1, u);
    for (int i = 0; i < 3; i++) force[k][i] = -b[k].mass * p[i];
    apply_transposed(r, w, local_w), apply_transposed(r, alpha, local_alpha);
    apply(b[k].inertia, local_w, moment), apply(b[k].inertia, local_alpha, rate), cross(local_w, moment, spin);
    for (int i = 0; i < 3; i++) rate[i] = -(rate[i] + spin[i]);
    apply(r, rate, torque[k]);
    vector offset; /* to the next joint */
    apply(r, b[k].offset, offset);
    cross(alpha, offset, t), add_to(a, 1, t), cross(w, offset, t), cross(w, t, u), add_to(a, 1, u), add_to(v, 1, t),
        add_to(at, 1, offset);
  }
  for (int k = 0; k < CHAIN; k++) {
    tau[k] = 0;
    for (int i = k; i < CHAIN; i++) {
      vector arm = { place[i][0] - joint[k][0], place[i][1] - joint[k][1], place[i][2] - joint[k][2] }, moment;
      cross(arm, force[i], moment);
      add_to(moment, 1, torque[i]);
      tau[k] += inner(axis[k], b[k].slides ? force[i] : moment);
    }
  }
}

static void random_body(ambit_random *random, int k, body *b) {
  static const vector axes[CHAIN] = { { 0, 0, 1 }, { 0.6, 0.8, 0 }, { 0, -1, 0 }, { 2.0 / 3, 1.0 / 3, -2.0 / 3 } };
  double s[9] = { 0 }, root[9];
  memcpy(b->axis, axes[k], sizeof b->axis);
  b->slides = k == 2;
  b->mass = ambit_random_in(random, (ambit_interval) { 0.5, 2 });
  for (int i = 0; i < 3; i++) b->offset[i] = ambit_random_in(random, (ambit_interval) { -1, 1 });
  for (int i = 0; i < 3; i++) b->centre[i] = ambit_random_in(random, (ambit_interval) { -1, 1 });
  for (int i = 0; i < 9; i++) root[i] = ambit_random_in(random, (ambit_interval) { -1, 1 });
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 3; j++) s[i] += root[3 * (i / 3) + j] * root[3 * (i % 3) + j];
  for (int i = 0; i < 9; i++) b->inertia[i / 3][i % 3] = (i % 4 == 0 ? s[0] + s[4] + s[8] : 0) - s[i];
}

static void add_body(machine *m, const body *b, int k, ambit_frame *at) {
  char name[8];
  snprintf(name, sizeof name, "q%d", k);
  static const double scale[CHAIN] = { 1, 5, 2, 3 }; /* the element normalises */
  vector axis = { scale[k] * b->axis[0], scale[k] * b->axis[1], scale[k] * b->axis[2] };
  machine_datum joint[] = { machine_doubles(m, "axis", 3, axis), machine_end };
  ambit_frame carried = machine_frame(machine_add(m, b->slides ? "prismatic" : "revolute", name, *at, joint));
  machine_datum data[] = { machine_doubles(m, "mass", 1, &b->mass), machine_doubles(m, "centre", 3, b->centre),
    machine_doubles(m, "inertia", 9, b->inertia[0]), machine_end };
  machine_add(m, "rigid_body", NULL, carried, data);
  machine_datum offset[] = { machine_doubles(m, "offset", 3, b->offset), machine_end };
  *at = machine_frame(machine_add(m, "rigid_link", NULL, carried, offset));
}

static void build_chain(bench *s, uint64_t seed, body *b, vector g) {
  ambit_random random = { seed };
  ambit_frame at = AMBIT_WORLD;
  for (int i = 0; i < 3; i++) g[i] = ambit_random_in(&random, (ambit_interval) { -10, 10 });
  machine_datum field[] = { machine_doubles(&s->machine, "field", 3, g), machine_end };
  machine_add(&s->machine, "gravity", NULL, AMBIT_WORLD, field);
  for (int k = 0; k < CHAIN; k++) {
    random_body(&random, k, &b[k]);
    add_body(&s->machine, &b[k], k, &at);
  }
}

/* r(q, q', q'') of the kernel is h - M q''; of the other it is what the inertia forces leave over. And M times the
** solved q'' is h.
*/
static void spatial_chain_obeys_newton_and_euler(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  body b[CHAIN];
  vector g;
  build_chain(s, 11, b, g);
  ambit_motion motion = motion_of(s);
  ambit_expr leaf[2 * CHAIN], value[CHAIN * CHAIN + 2 * CHAIN], qdd[CHAIN];
  ambit_failure f = { 0 };
  assert_int_equal(motion.n, CHAIN);
  if (ambit_motion_accelerations(m->graph, &motion, NULL, qdd, &f) != AMBIT_OK) fail_msg("%s", f.message);
  memcpy(value, motion.mass, CHAIN * CHAIN * sizeof *value);
  memcpy(value + CHAIN * CHAIN, motion.force, CHAIN * sizeof *value);
  memcpy(value + CHAIN * CHAIN + CHAIN, qdd, CHAIN * sizeof *value);
  for (int k = 0; k < CHAIN; k++)
    leaf[k] = motion.variables.coordinate[k].q, leaf[CHAIN + k] = motion.variables.coordinate[k].rate;
  ambit_random random = { 5 };
  for (int round = 0; round < 10; round++) {
    double x[2 * CHAIN], unit[CHAIN], tau[CHAIN], h[CHAIN], solved[CHAIN];
    ambit_interval out[CHAIN * CHAIN + 2 * CHAIN];
    for (int i = 0; i < 2 * CHAIN; i++) x[i] = ambit_random_in(&random, (ambit_interval) { -2, 2 });
    machine_values(m, CHAIN * CHAIN + 2 * CHAIN, value, 2 * CHAIN, leaf, x, out);
    memset(unit, 0, sizeof unit);
    newton_euler(b, x, x + CHAIN, unit, g, h);
    for (int i = 0; i < CHAIN; i++) {
      expect_near(out[CHAIN * CHAIN + i], h[i], 1e-9);
      memset(unit, 0, sizeof unit);
      unit[i] = 1;
      newton_euler(b, x, x + CHAIN, unit, g, tau);
      for (int j = 0; j < CHAIN; j++) expect_near(out[j * CHAIN + i], h[j] - tau[j], 1e-9);
      solved[i] = ambit_interval_mid(out[CHAIN * CHAIN + CHAIN + i]);
    }
    newton_euler(b, x, x + CHAIN, solved, g, tau);
    for (int i = 0; i < CHAIN; i++) assert_true(fabs(tau[i]) < 1e-8);
  }
}

static void spatial_chain_keeps_its_energy(void **state) {
  body b[CHAIN];
  vector g;
  build_chain(*state, 12, b, g);
  expect_energy_kept(*state, 1e-7);
}

/* -- what drives */

/* A torque law of coordinate, rate and time: q'' = (-k q - d q' + sin t) / J. */
static void torque_laws(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  ambit_graph *g = m->graph;
  ambit_frame wheel = machine_revolute(m, "q", AMBIT_WORLD, "0,0,1");
  machine_datum data[] = { machine_text(m, "mass", "1"), machine_text(m, "inertia", "1,0,0, 0,1,0, 0,0,0.5"),
    machine_end };
  machine_add(m, "rigid_body", NULL, wheel, data);
  ambit_expr t = ambit_graph_time(g), q = machine_symbol(m, "q"), qd = machine_symbol(m, "q'");
  ambit_expr spring = ambit_graph_op(g, AMBIT_OP_MUL, machine_number(m, -3), q),
             damper = ambit_graph_op(g, AMBIT_OP_MUL, machine_number(m, -2), qd);
  ambit_frame joint = { wheel.part, 2 };
  machine_add(m, "joint_torque", NULL, joint,
      MACHINE_DATA(machine_expr("torque", ambit_graph_op(g, AMBIT_OP_ADD, spring, damper))));
  machine_add(
      m, "joint_torque", NULL, joint, MACHINE_DATA(machine_expr("torque", ambit_graph_op(g, AMBIT_OP_SIN, t, t))));
  ambit_system system = system_of(s);
  ambit_expr leaf[] = { q, qd, t };
  ambit_interval x;
  machine_values(m, 1, &system.rate[1], 3, leaf, (const double[]) { 0.3, -0.7, 1.1 }, &x);
  expect_near(x, 2 * (-0.9 + 1.4 + sin(1.1)), 1e-14);
}

/* A slider driven by a force along a slope of 3 in 5, on a rail that a given motion lifts: s'' = F/m - 3/5 (g + a). */
static void given_motion_accelerates(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  machine_gravity(m, "0,-10,0");
  ambit_expr t = ambit_graph_time(m->graph), lift = ambit_graph_op(m->graph, AMBIT_OP_SQR, t, t);
  machine_datum data[] = { machine_text(m, "axis", "0,1,0"), machine_expr("displacement", lift), machine_end };
  ambit_frame rail = machine_frame(machine_add(m, "prismatic", "lift", AMBIT_WORLD, data));
  ambit_frame slider =
      machine_frame(machine_add(m, "prismatic", "s", rail, MACHINE_DATA(machine_text(m, "axis", "4,3,0"))));
  machine_mass(m, slider, "2");
  machine_add(m, "joint_torque", NULL, (ambit_frame) { slider.part, 2 }, MACHINE_DATA(machine_text(m, "force", "7")));
  ambit_system system = system_of(s);
  ambit_interval x;
  machine_values(m, 1, &system.rate[1], 0, NULL, NULL, &x);
  expect_near(x, 3.5 - (10 + 2) * 0.6, 1e-14);
  assert_int_equal(system.nx, 2);
}

/* A gear: the second wheel turns by -2 q. Its inertia is felt four times: (J1 + 4 J2) q'' = torque on 1 - 2 torque on
** 2.
*/
static void gears_share_forces(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  ambit_frame first = machine_revolute(m, "q", AMBIT_WORLD, "0,0,1");
  ambit_coordinate c;
  assert_int_equal(ambit_mechanism_coordinates(m->mechanism, 1, &c), 1);
  ambit_expr twice = ambit_graph_op(m->graph, AMBIT_OP_MUL, machine_number(m, -2), c.q);
  ambit_frame second =
      machine_frame(machine_add(m, "revolute", "gear", AMBIT_WORLD, MACHINE_DATA(machine_expr("angle", twice))));
  machine_datum one[] = { machine_text(m, "mass", "1"), machine_text(m, "inertia", "5,0,0, 0,5,0, 0,0,3"),
    machine_end };
  machine_datum two[] = { machine_text(m, "mass", "1"), machine_text(m, "inertia", "5,0,0, 0,5,0, 0,0,0.5"),
    machine_end };
  machine_add(m, "rigid_body", NULL, first, one);
  machine_add(m, "rigid_body", NULL, second, two);
  machine_add(m, "joint_torque", NULL, (ambit_frame) { first.part, 2 }, MACHINE_DATA(machine_text(m, "torque", "11")));
  machine_add(m, "joint_torque", NULL, (ambit_frame) { second.part, 2 }, MACHINE_DATA(machine_text(m, "torque", "3")));
  ambit_motion motion = motion_of(s);
  expect_text(m, motion.mass[0], "5");
  expect_text(m, motion.force[0], "5");
  assert_int_equal(system_of(s).rate[1], machine_number(m, 1));
}

/* Uncertain masses are one unknown each, wherever they occur. */
static void uncertain_masses(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  machine_gravity(m, "0,-10,0");
  ambit_expr mass = ambit_graph_unknown(m->graph, "m", (ambit_interval) { 1, 2 });
  ambit_frame bob = machine_link(m, machine_revolute(m, "q", AMBIT_WORLD, "0,0,1"), "0,-1,0");
  machine_add(m, "point_mass", NULL, bob, MACHINE_DATA(machine_expr("mass", mass)));
  ambit_system system = system_of(s);
  char text[256];
  machine_text_of(m, system.rate[1], text);
  assert_string_equal(text, "-10*sin(q)"); /* m / m: the period does not depend on the mass */
}

/* -- what is refused */

static void expect_no_dynamics(bench *s, const char *message) {
  ambit_system system;
  ambit_failure f = { 0 };
  assert_int_equal(
      ambit_constrained_system(s->machine.mechanism, AMBIT_FORM_AUTO, s->arena, &system, &f), AMBIT_INVALID);
  if (!strstr(f.message, message)) fail_msg("`%s` instead of `%s`", f.message, message);
}

static void no_coordinates(void **state) {
  bench *s = *state;
  machine_mass(&s->machine, machine_link(&s->machine, AMBIT_WORLD, "1,0,0"), "1");
  expect_no_dynamics(s, "no coordinates");
}

static void no_mass(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  ambit_frame arm = machine_link(m, machine_revolute(m, "shoulder", AMBIT_WORLD, "0,0,1"), "1,0,0");
  machine_mass(m, arm, "1");
  machine_revolute(m, "wrist", arm, "0,0,1");
  expect_no_dynamics(s, "joint `wrist` moves no mass");
}

/* Two hinges in one place: only the sum of their angles moves the mass. */
static void singular_mass(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  ambit_frame twice = machine_revolute(m, "second", machine_revolute(m, "first", AMBIT_WORLD, "0,0,1"), "0,0,1");
  machine_mass(m, machine_link(m, twice, "1,0,0"), "1");
  expect_no_dynamics(s, "singular in every position: joint `first`");
}

/* The same with data that are no doubles: 0 is not known exactly, but cannot be excluded. */
static void singular_up_to_rounding(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  ambit_frame twice = machine_revolute(m, "second", machine_revolute(m, "first", AMBIT_WORLD, "1,2,4"), "1,2,4");
  machine_mass(m, machine_link(m, twice, "0.1,0.3,0"), "0.7");
  expect_no_dynamics(s, "singular");
}

static void negative_masses(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  ambit_frame at = machine_link(m, machine_revolute(m, "q", AMBIT_WORLD, "0,0,1"), "1,0,0");
  machine_datum mass[] = { machine_text(m, "mass", "-1"), machine_end };
  assert_int_equal(machine_try(m, machine_element(m, "point_mass"), "point_mass", NULL, at, mass), UINT32_MAX);
  assert_non_null(strstr(m->failure.message, "point_mass `point_mass1` (scene.lua:7): the mass is negative"));
}

static void not_affine(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  ambit_frame wheel = machine_revolute(m, "q", AMBIT_WORLD, "0,0,1");
  machine_mass(m, machine_link(m, wheel, "1,0,0"), "1");
  ambit_expr qdd = machine_symbol(m, "q''"), square = ambit_graph_op(m->graph, AMBIT_OP_SQR, qdd, qdd);
  machine_add(m, "joint_torque", NULL, (ambit_frame) { wheel.part, 2 }, MACHINE_DATA(machine_expr("torque", square)));
  expect_no_dynamics(s, "not linear in the acceleration of `q`");
}

static void play_has_no_dynamics(void **state) {
  bench *s = *state;
  machine *m = &s->machine;
  machine_datum data[] = { machine_text(m, "angle", "0"), machine_text(m, "play", "0.1"), machine_end };
  ambit_frame pin =
      machine_frame(machine_add(m, "sloppy_joint", "pin", machine_revolute(m, "q", AMBIT_WORLD, "0,0,1"), data));
  machine_mass(m, pin, "1");
  expect_no_dynamics(s, "sloppy_joint `pin` (scene.lua:7): the play may jump");
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
  const struct CMUnitTest tests[] = {
    CASE(double_pendulum_is_the_textbook_one),
    CASE(double_pendulum_is_short),
    CASE(double_pendulum_keeps_its_energy),
    CASE(spatial_chain_obeys_newton_and_euler),
    CASE(spatial_chain_keeps_its_energy),
    CASE(torque_laws),
    CASE(given_motion_accelerates),
    CASE(gears_share_forces),
    CASE(uncertain_masses),
    CASE(no_coordinates),
    CASE(no_mass),
    CASE(singular_mass),
    CASE(singular_up_to_rounding),
    CASE(negative_masses),
    CASE(not_affine),
    CASE(play_has_no_dynamics),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
