/* Mechanisms: parts, names, connections; demand, memory, sums, loops; chains of any length. */
#include "mechanics/machine.h"
#include <math.h>
#include <sys/resource.h>

static int set_up(void **state) {
  machine *s = malloc(sizeof *s);
  *s = machine_open();
  *state = s;
  return 0;
}

static int tear_down(void **state) {
  machine_close(*state);
  free(*state);
  return 0;
}

static void expect_refusal(machine *s, uint32_t part, const char *message) {
  assert_int_equal(part, UINT32_MAX);
  assert_int_equal(s->failure.status, AMBIT_INVALID);
  if (!strstr(s->failure.message, message)) fail_msg("`%s` instead of `%s`", s->failure.message, message);
}

/* -- parts */

static void names(void **state) {
  machine *s = *state;
  const ambit_element *link = machine_element(s, "rigid_link");
  assert_string_equal(ambit_mechanism_part_name(s->mechanism, 0), "world");
  uint32_t a = machine_add(s, "rigid_link", NULL, AMBIT_WORLD, NULL),
           b = machine_add(s, "rigid_link", "arm", AMBIT_WORLD, NULL);
  assert_string_equal(ambit_mechanism_part_name(s->mechanism, a), "rigid_link1");
  assert_string_equal(ambit_mechanism_part_name(s->mechanism, b), "arm");
  machine_add(s, "rigid_link", "rigid_link2", AMBIT_WORLD, NULL);
  uint32_t c = machine_add(s, "rigid_link", NULL, AMBIT_WORLD, NULL);
  assert_string_equal(ambit_mechanism_part_name(s->mechanism, c), "rigid_link3");
  expect_refusal(s, machine_try(s, link, "rigid_link", "arm", AMBIT_WORLD, NULL),
      "the name is taken by the rigid_link `arm` (scene.lua:7)");
  expect_refusal(s, machine_try(s, link, "rigid_link", "", AMBIT_WORLD, NULL), "the name is empty");
  expect_refusal(s, machine_try(s, link, "rigid_link", "arm'", AMBIT_WORLD, NULL), "marks time derivatives");
  expect_refusal(s, machine_try(s, link, "rigid_link", "t", AMBIT_WORLD, NULL), "that is the time");
  expect_refusal(s, machine_try(s, link, "rigid_link", "a\nb", AMBIT_WORLD, NULL), "control character");
  char longest[200];
  memset(longest, 'a', sizeof longest);
  longest[199] = '\0';
  expect_refusal(s, machine_try(s, link, "rigid_link", longest, AMBIT_WORLD, NULL), "longer than");
  assert_int_equal(ambit_mechanism_count(s->mechanism), 5); /* nothing half added */
  for (int i = 0; i < 500; i++) machine_add(s, "rigid_link", NULL, AMBIT_WORLD, NULL);
  expect_refusal(s, machine_try(s, link, "rigid_link", "rigid_link77", AMBIT_WORLD, NULL), "taken");
}

static void connections(void **state) {
  machine *s = *state;
  const ambit_element *link = machine_element(s, "rigid_link"), *torque = machine_element(s, "joint_torque");
  ambit_frame hinge = machine_revolute(s, "hinge", AMBIT_WORLD, "0,0,1");
  expect_refusal(s, machine_try(s, link, "rigid_link", NULL, AMBIT_NOWHERE, NULL),
      "port `from` is not connected; it needs a frame");
  expect_refusal(
      s, machine_try(s, link, "rigid_link", NULL, (ambit_frame) { 9, 0 }, NULL), "part 9, which does not exist");
  expect_refusal(s, machine_try(s, link, "rigid_link", NULL, (ambit_frame) { hinge.part, 7 }, NULL),
      "port 7 of `hinge`, which has 3");
  expect_refusal(
      s, machine_try(s, link, "rigid_link", NULL, (ambit_frame) { hinge.part, 0 }, NULL), "itself to be connected");
  expect_refusal(s, machine_try(s, link, "rigid_link", NULL, (ambit_frame) { hinge.part, 2 }, NULL),
      "needs a frame, but `joint` of `hinge` is a joint");
  expect_refusal(
      s, machine_try(s, torque, "joint_torque", NULL, hinge, NULL), "needs a joint, but `to` of `hinge` is a frame");
  const ambit_element *mass = machine_element(s, "point_mass");
  expect_refusal(
      s, machine_try(s, mass, "point_mass", NULL, hinge, NULL), "point_mass `point_mass1` (scene.lua:7) needs `mass`");
  expect_refusal(s, machine_try(s, mass, "point_mass", NULL, hinge, MACHINE_DATA(machine_expr("mass", AMBIT_NO_EXPR))),
      "is no expression");
}

static ambit_status nothing(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  (void)b, (void)port, (void)quantity, (void)out;
  return AMBIT_UNABLE;
}

static void fallbacks(void **state) {
  machine *s = *state;
  static const ambit_param good[] = { { "a", "1", "axis", "-y", "an axis" }, { "b", "1", "axis", "1,2,3", "an axis" },
    { "c", "m", "3", "0.1,0,pi", "a vector" }, { "d", "1", "flag", "true", "a flag" },
    { "e", "1", "one|two|three", "three", "a choice" }, { "f", "1", "", "", "may be absent" }, { 0 } };
  ambit_element e = { sizeof e, 0, NULL, good, nothing, NULL };
  assert_int_not_equal(machine_try(s, &e, "test", NULL, AMBIT_NOWHERE, NULL), UINT32_MAX);
  static const char *const bad[][2] = { { "axis", "w" }, { "3", "1,2" }, { "3", "1,2,3,4" }, { "", "one" },
    { "flag", "perhaps" }, { "one|two", "three" } };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    const ambit_param param[] = { { "a", "1", bad[i][0], bad[i][1], "bad" }, { 0 } };
    ambit_element wrong = { sizeof e, 0, NULL, param, nothing, NULL };
    expect_refusal(s, machine_try(s, &wrong, "test", NULL, AMBIT_NOWHERE, NULL), "is not of its shape");
  }
  static const ambit_port ports[] = { { "a", 7, AMBIT_ROLE_IN, 0, 0, "no kind" },
    { "a", AMBIT_PORT_FRAME, 7, 0, 0, "no role" }, { "a", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, 0, 0, "no dof" },
    { "a", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, 99, 0, "many dof" },
    { NULL, AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "no name" } };
  for (size_t i = 0; i < sizeof ports / sizeof *ports; i++) {
    ambit_element wrong = { sizeof e, 1, &ports[i], NULL, nothing, NULL };
    expect_refusal(s, machine_try(s, &wrong, "test", NULL, AMBIT_WORLD, NULL), "not declared properly");
  }
}

/* -- demand */

static void only_what_is_asked_for(void **state) {
  machine *s = *state;
  machine_gravity(s, "0,-9.81,0");
  ambit_frame hinge = machine_revolute(s, "hinge", AMBIT_WORLD, "0,0,1"), tip = machine_link(s, hinge, "1,0,0");
  machine_mass(s, tip, "1");
  size_t pulled, all;
  ambit_mechanism_pulled(s->mechanism, &pulled, &all);
  assert_int_equal(pulled, 0);
  assert_int_equal(all, 5 * 6 + 3 + 0 + (1 + 3 + 4) + (1 + 3) + 1); /* 6 of each part as a whole */
  const ambit_expr *pose = machine_pull(s, tip, AMBIT_POSE);
  ambit_mechanism_pulled(s->mechanism, &pulled, &all);
  assert_int_equal(pulled, 3);                              /* poses of world, hinge, tip */
  assert_ptr_equal(machine_pull(s, tip, AMBIT_POSE), pose); /* remembered */
  ambit_mechanism_pulled(s->mechanism, &pulled, &all);
  assert_int_equal(pulled, 3);
  machine_pull(s, tip, AMBIT_TWIST);
  ambit_mechanism_pulled(s->mechanism, &pulled, &all);
  assert_int_equal(pulled, 6);
}

static void unknowns_are_made_once(void **state) {
  machine *s = *state;
  machine_datum data[] = { machine_text(s, "angle", "0.5"), machine_text(s, "play", "0.002"), machine_end };
  ambit_frame pin = machine_frame(machine_add(s, "sloppy_joint", "pin", AMBIT_WORLD, data));
  ambit_expr first = machine_pull(s, pin, AMBIT_POSE)[9];
  machine_mass(s, machine_link(s, pin, "1,0,0"), "1"); /* adding parts does not change what was made without sums */
  assert_int_equal(machine_pull(s, pin, AMBIT_POSE)[9], first);
  assert_int_equal(ambit_graph_leaves(s->graph, 1, &first, 0, NULL), 1);
}

static void sums_follow_added_parts(void **state) {
  machine *s = *state;
  ambit_frame hinge = machine_revolute(s, "hinge", AMBIT_WORLD, "0,0,1"), tip = machine_link(s, hinge, "2,0,0");
  const ambit_expr *field = machine_pull(s, AMBIT_NOWHERE, AMBIT_FIELD), *wrench = machine_pull(s, hinge, AMBIT_WRENCH);
  for (int i = 0; i < 3; i++) assert_int_equal(field[i], 0);
  for (int i = 0; i < 6; i++) assert_int_equal(wrench[i], 0);
  assert_int_equal(machine_pull(s, tip, AMBIT_ACCEL)[4],
      ambit_graph_op(s->graph, AMBIT_OP_MUL, machine_number(s, 2), machine_symbol(s, "hinge''")));
  machine_gravity(s, "0,-8,0");
  machine_gravity(s, "0,-2,0");
  machine_mass(s, tip, "3");
  machine_mass(s, tip, "1");
  assert_int_equal(machine_pull(s, AMBIT_NOWHERE, AMBIT_FIELD)[1], machine_number(s, -10));
  ambit_expr torque = machine_pull(s, hinge, AMBIT_WRENCH)[2]; /* at rest: -(3 + 1) 2 10 cos(hinge) */
  ambit_expr leaf[] = { machine_symbol(s, "hinge"), machine_symbol(s, "hinge'"), machine_symbol(s, "hinge''") };
  ambit_interval x;
  machine_values(s, 1, &torque, 3, leaf, (const double[]) { 0, 0, 0 }, &x);
  assert_true(x.lo == -80 && x.hi == -80);
  assert_int_equal(field[1], 0); /* old answers stay readable */
}

static void coordinates_in_the_order_of_parts(void **state) {
  machine *s = *state;
  ambit_frame a = machine_revolute(s, "a", AMBIT_WORLD, "0,0,1");
  machine_add(s, "revolute", "given", a, MACHINE_DATA(machine_text(s, "angle", "1")));
  ambit_frame b = machine_frame(machine_add(s, "prismatic", "b", a, NULL));
  machine_pull(s, (ambit_frame) { b.part, 2 }, AMBIT_COORDINATE); /* asked for first */
  ambit_coordinate c[4];
  assert_int_equal(ambit_mechanism_coordinates(s->mechanism, 4, c), 2);
  assert_string_equal(c[0].name, "a");
  assert_string_equal(c[0].unit, "rad");
  assert_string_equal(c[1].name, "b");
  assert_string_equal(c[1].unit, "m");
  ambit_speed u[4];
  assert_int_equal(ambit_mechanism_speeds(s->mechanism, 4, u), 2);
  assert_string_equal(u[1].name, "b'");
  assert_int_equal(u[1].u, c[1].rate);
  assert_int_equal(u[1].du, machine_symbol(s, "b''"));
  assert_string_equal(ambit_graph_node(s->graph, u[1].du)->unit, "m/s^2");
  assert_int_equal(ambit_mechanism_coordinates(s->mechanism, 1, c), 2);
}

static void given_motion(void **state) {
  machine *s = *state;
  ambit_expr t = ambit_graph_time(s->graph), square = ambit_graph_op(s->graph, AMBIT_OP_SQR, t, t);
  uint32_t joint = machine_add(s, "revolute", "drive", AMBIT_WORLD, MACHINE_DATA(machine_expr("angle", square)));
  assert_int_equal(machine_pull(s, (ambit_frame) { joint, 2 }, AMBIT_COORDINATE)[0], square);
  assert_int_equal(machine_pull(s, (ambit_frame) { joint, 2 }, AMBIT_RATE2)[0], machine_number(s, 2));
  assert_int_equal(machine_pull(s, machine_frame(joint), AMBIT_ACCEL)[2], machine_number(s, 2));
  assert_int_equal(ambit_mechanism_coordinates(s->mechanism, 0, NULL), 0);
  machine_revolute(s, "free", AMBIT_WORLD, "0,0,1");
  assert_int_equal(ambit_mechanism_coordinates(s->mechanism, 0, NULL), 1);
  ambit_expr beyond = machine_symbol(s, "free'");
  uint32_t bad = machine_add(s, "revolute", "follower", AMBIT_WORLD, MACHINE_DATA(machine_expr("angle", beyond)));
  assert_null(ambit_mechanism_pull(s->mechanism, (ambit_frame) { bad, 2 }, AMBIT_RATE2, &s->failure));
  assert_non_null(strstr(s->failure.message, "revolute `follower` (scene.lua:7)"));
  assert_non_null(strstr(s->failure.message, "time derivative of `free'`"));
}

/* -- refusals */

static void expect_no(machine *s, ambit_frame at, uint32_t quantity, const char *message) {
  ambit_failure_clear(&s->failure);
  assert_null(ambit_mechanism_pull(s->mechanism, at, quantity, &s->failure));
  if (!strstr(s->failure.message, message)) fail_msg("`%s` instead of `%s`", s->failure.message, message);
}

static void refusals_name_the_part(void **state) {
  machine *s = *state;
  machine_datum data[] = { machine_text(s, "angle", "0.5"), machine_text(s, "play", "0.002"), machine_end };
  ambit_frame pin = machine_frame(machine_add(s, "sloppy_joint", "pin", AMBIT_WORLD, data)),
              tip = machine_link(s, pin, "1,0,0");
  expect_no(s, tip, AMBIT_TWIST, "sloppy_joint `pin` (scene.lua:7): the play may jump");
  expect_no(s, tip, AMBIT_WRENCH + 100, "has no unknown quantity");
  expect_no(s, (ambit_frame) { 99, 0 }, AMBIT_POSE, "no port 0 of part 99");
  expect_no(s, (ambit_frame) { tip.part, 0 }, AMBIT_WRENCH, "could be asked for");
  expect_no(s, AMBIT_NOWHERE, AMBIT_POSE, "as a whole has no pose");
  machine_text_of(s, machine_pull(s, tip, AMBIT_POSE)[0], (char[256]) { 0 }); /* a refusal does no harm */
  ambit_expr t = ambit_graph_time(s->graph);
  ambit_frame moving = machine_frame(machine_add(
      s, "rigid_link", "stretch", AMBIT_WORLD, (const machine_datum[]) { { "offset", 3, { t, 0, 0 } }, machine_end }));
  machine_pull(s, moving, AMBIT_POSE);
  expect_no(s, moving, AMBIT_TWIST, "`offset` moves in time");
  ambit_frame none =
      machine_frame(machine_add(s, "revolute", "aimless", AMBIT_WORLD, MACHINE_DATA(machine_text(s, "axis", "0,0,0"))));
  expect_no(s, none, AMBIT_POSE, "revolute `aimless` (scene.lua:7): the axis is zero");
}

static void impossible_bodies(void **state) {
  machine *s = *state;
  static const struct {
    const char *mass, *inertia, *message;
  } body[] = {
    { "-1", "1,0,0, 0,1,0, 0,0,1", "the mass is negative: -1 kg" },
    { "1", "1,0.5,0, 0,1,0, 0,0,1", "the inertia is not symmetric: row 1, column 2 is 0.5, row 2, column 1 is 0" },
    { "1", "1,0,0, 0,1,0, 0,0,3", "no body has this inertia" },
    { "1", "-1,0,0, 0,-1,0, 0,0,-1", "no body has this inertia" },
    { "1", "1,0.9,0, 0.9,1,0, 0,0,1", "no body has this inertia" },
    { "1", "1,0,0, 0,0.1,0, 0,0,0.1", "no body has this inertia" },
    { "1", "1,0.5,0.5, 0.5,1,-0.5, 0.5,-0.5,1", NULL }, /* a thin rod along (1, -1, -1) */
    { "1", "0.1,0,0, 0,0.7,0, 0,0,0.8", NULL },         /* a flat plate, to the last digit */
    { "1", "0,0,0, 0,1,0, 0,0,1", NULL },               /* a thin rod */
    { "1", "0,0,0, 0,0,0, 0,0,0", NULL },               /* a point */
    { "0", "1,0,0, 0,1,0, 0,0,1", "the mass is zero: expected above 0 kg" },
  };
  const ambit_element *rigid_body = machine_element(s, "rigid_body");
  ambit_frame hinge = machine_revolute(s, "hinge", AMBIT_WORLD, "0,0,1");
  for (size_t i = 0; i < sizeof body / sizeof *body; i++) {
    machine_datum data[] = { machine_text(s, "mass", body[i].mass), machine_text(s, "inertia", body[i].inertia),
      machine_end };
    ambit_frame at = machine_link(s, hinge, "1,0,0");
    uint32_t part = machine_try(s, rigid_body, "rigid_body", NULL, at, data);
    if (body[i].message) {
      expect_refusal(s, part, body[i].message);
      assert_non_null(strstr(s->failure.message, "rigid_body `rigid_body"));
      assert_non_null(strstr(s->failure.message, "scene.lua:7"));
    } else {
      assert_int_not_equal(part, UINT32_MAX);
    }
    machine_pull(s, at, AMBIT_WRENCH); /* a refused part has left nothing behind */
  }
  machine_datum both[] = { machine_text(s, "torque", "1"), machine_text(s, "force", "1"), machine_end };
  uint32_t drive = machine_try(
      s, machine_element(s, "joint_torque"), "joint_torque", "drive", (ambit_frame) { hinge.part, 2 }, both);
  expect_refusal(s, drive, "either `torque` (N m) or `force` (N)");
}

/* -- loops: elements that need each other */

static ambit_status pushed(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port == 1 && quantity == AMBIT_ACCEL) { /* an acceleration from the force, as of a body without inertia */
    const ambit_expr *wrench = b->get(b, 1, AMBIT_WRENCH);
    for (int i = 0; wrench && i < 6; i++) out[i] = wrench[i];
    return wrench ? AMBIT_OK : AMBIT_INVALID;
  }
  return AMBIT_UNABLE;
}

static const ambit_port pushed_port[] = { { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "" },
  { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "" } };
static const ambit_element pushed_element = { sizeof pushed_element, 2, pushed_port, NULL, pushed, NULL };

static void loops_are_named(void **state) {
  machine *s = *state;
  uint32_t a = machine_try(s, &pushed_element, "pushed", "a", AMBIT_WORLD, NULL);
  machine_add(s, "point_mass", "b", machine_frame(a), MACHINE_DATA(machine_text(s, "mass", "1")));
  expect_no(
      s, machine_frame(a), AMBIT_ACCEL, "a loop of elements: a -> b -> a (the acceleration of `a` waits for itself)");
  expect_no(s, machine_frame(a), AMBIT_ACCEL, "a -> b -> a"); /* again: nothing is left half done */
}

static void long_loops_are_named(void **state) {
  machine *s = *state;
  uint32_t a = machine_try(s, &pushed_element, "pushed", "first", AMBIT_WORLD, NULL);
  ambit_frame at = machine_frame(a);
  for (int i = 0; i < 1000; i++) at = machine_link(s, at, "1,0,0");
  machine_add(s, "point_mass", "last", at, MACHINE_DATA(machine_text(s, "mass", "1")));
  expect_no(s, machine_frame(a), AMBIT_ACCEL, "a loop of elements: ");
  assert_non_null(strstr(s->failure.message, " -> "));
}

/* -- an element that uses everything of ambit_build, and one that misuses it */

static ambit_status curious(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port == AMBIT_NO_PORT) return AMBIT_UNABLE;
  switch (quantity) {
  case AMBIT_POSE:
    return b->get(b, 0, AMBIT_POSE)
               ? AMBIT_OK
               : (b->fail)(b, AMBIT_INVALID, "nothing is connected"); /* cmocka has a macro fail() */
  case AMBIT_TWIST: return b->state(b, 5, 0, "m") == UINT32_MAX ? AMBIT_INVALID : AMBIT_OK;
  case AMBIT_ACCEL: return b->num(b, "one") == UINT32_MAX ? AMBIT_INVALID : AMBIT_OK;
  case AMBIT_WRENCH: return b->param(b, 3) ? AMBIT_OK : AMBIT_INVALID;
  case AMBIT_COORDINATE: out[0] = b->unknown(b, "1", "-1"); return AMBIT_INVALID;
  case AMBIT_RATE: return b->get(b, 7, AMBIT_POSE) ? AMBIT_OK : AMBIT_INVALID;
  case AMBIT_RATE2: return AMBIT_OK;
  default: return AMBIT_UNABLE;
  }
}

static void misuse_is_reported(void **state) {
  machine *s = *state;
  static const ambit_port port[] = { { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 1, "" },
    { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "" }, { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, 2, 0, "" } };
  static const ambit_element element = { sizeof element, 3, port, NULL, curious, NULL };
  uint32_t part = machine_try(s, &element, "curious", "odd", AMBIT_NOWHERE, NULL);
  ambit_frame to = { part, 1 }, joint = { part, 2 };
  expect_no(s, to, AMBIT_POSE, "curious `odd` (scene.lua:7): nothing is connected");
  expect_no(s, to, AMBIT_TWIST, "coordinate 5, derivative 0; it has 2");
  expect_no(s, to, AMBIT_ACCEL, "one");
  expect_no(s, joint, AMBIT_COORDINATE, "an empty or unbounded interval");
  expect_no(s, joint, AMBIT_RATE, "port 7, which has none");
  expect_no(s, joint, AMBIT_RATE2, "not every component was written");
  expect_no(s, joint, AMBIT_BALANCE, "has no balance");
  ambit_frame link = machine_link(s, to, "1,0,0");
  expect_no(s, link, AMBIT_POSE, "nothing is connected");
}

/* -- chains */

static void long_chains_need_little_stack(void **state) {
  machine *s = *state;
  struct rlimit limit;
  getrlimit(RLIMIT_STACK, &limit);
  assert_true(limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur <= 64u << 20); /* or this test proves nothing */
  enum { LINKS = 20000 };
  ambit_frame at = AMBIT_WORLD;
  machine_datum angle[] = { machine_text(s, "angle", "0.001"), machine_end };
  for (int i = 0; i < LINKS; i++)
    at = machine_link(s, machine_frame(machine_add(s, "revolute", NULL, at, angle)), "0.001,0,0");
  machine_mass(s, at, "1");
  machine_gravity(s, "0,0,-10");
  ambit_interval x[3];
  machine_values(s, 3, machine_pull(s, at, AMBIT_POSE) + 9, 0, NULL, NULL, x);
  double px = 0, py = 0;
  for (int i = 1; i <= LINKS; i++) px += 0.001 * cos(0.001 * i), py += 0.001 * sin(0.001 * i);
  assert_true(x[0].lo - 1e-9 <= px && px <= x[0].hi + 1e-9 && x[1].lo - 1e-9 <= py && py <= x[1].hi + 1e-9);
  assert_true(x[2].lo == 0 && x[2].hi == 0);
  const ambit_expr *weight =
      machine_pull(s, AMBIT_WORLD, AMBIT_WRENCH); /* all the way out for motion, and back for the force */
  assert_int_equal(weight[5], machine_number(s, -10));
  size_t pulled, all;
  ambit_mechanism_pulled(s->mechanism, &pulled, &all);
  assert_true(pulled <= 5 * (2 * LINKS + 3)); /* pose, twist, acceleration, wrench, field: each once */
}

/* -- the play of a joint */

static void play_costs_its_radius(void **state) {
  machine *s = *state;
  ambit_frame at = AMBIT_WORLD;
  machine_datum data[] = { machine_text(s, "angle", "0.7"), machine_text(s, "play", "0.25"),
    machine_text(s, "axis", "0,0,1"), machine_end };
  for (int i = 0; i < 3; i++) at = machine_frame(machine_add(s, "sloppy_joint", NULL, at, data));
  const ambit_expr *pose = machine_pull(s, at, AMBIT_POSE);
  ambit_interval x[3];
  machine_values(s, 3, pose + 9, 0, NULL, NULL, x);
  for (int i = 0; i < 2; i++) assert_true(x[i].lo == -0.75 && x[i].hi == 0.75);
  assert_int_equal(pose[11], 0);
  /* an oblique pin: the disc's projection on axis i is play sqrt(1 - n_i^2) */
  machine_datum oblique[] = { machine_text(s, "angle", "0.7"), machine_text(s, "play", "1"),
    machine_text(s, "axis", "2,-3,6"), machine_end };
  ambit_frame pin = machine_frame(machine_add(s, "sloppy_joint", NULL, AMBIT_WORLD, oblique));
  machine_values(s, 3, machine_pull(s, pin, AMBIT_POSE) + 9, 0, NULL, NULL, x);
  static const double n[3] = { 2.0 / 7, -3.0 / 7, 6.0 / 7 };
  for (int i = 0; i < 3; i++) {
    double half = sqrt(1 - n[i] * n[i]);
    assert_true(x[i].hi >= half * (1 - 1e-15) && x[i].hi <= half * (1 + 1e-14) && x[i].lo == -x[i].hi);
  }
}

/* -- axes */

static void axes_fold(void **state) {
  machine *s = *state;
  ambit_expr right = ambit_graph_op(s->graph, AMBIT_OP_MUL, machine_number(s, 0.5), ambit_graph_pi(s->graph));
  machine_datum data[] = { machine_text(s, "axis", "-2,0,0"), machine_expr("angle", right), machine_end };
  const ambit_expr *pose = machine_pull(s, machine_frame(machine_add(s, "frame", NULL, AMBIT_WORLD, data)), AMBIT_POSE);
  static const double expected[12] = { 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0 };
  for (int i = 0; i < 12; i++) assert_int_equal(pose[i], machine_number(s, expected[i]));
  uint32_t ground = machine_add(s, "ground", NULL, AMBIT_NOWHERE, MACHINE_DATA(machine_text(s, "position", "1,2,3")));
  const ambit_expr *fixed = machine_pull(s, (ambit_frame) { ground, 0 }, AMBIT_POSE);
  for (int i = 0; i < 3; i++) assert_int_equal(fixed[9 + i], machine_number(s, i + 1));
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
  const struct CMUnitTest tests[] = {
    CASE(names),
    CASE(connections),
    CASE(fallbacks),
    CASE(only_what_is_asked_for),
    CASE(unknowns_are_made_once),
    CASE(sums_follow_added_parts),
    CASE(coordinates_in_the_order_of_parts),
    CASE(given_motion),
    CASE(refusals_name_the_part),
    CASE(impossible_bodies),
    CASE(loops_are_named),
    CASE(long_loops_are_named),
    CASE(misuse_is_reported),
    CASE(long_chains_need_little_stack),
    CASE(play_costs_its_radius),
    CASE(axes_fold),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
