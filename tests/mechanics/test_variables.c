/* test_variables.c -- coordinates, speeds and multipliers of a mechanism: their names, units and time derivatives. The
** elements are made here: a ring whose point on a circle has two coordinates (c, s) and one speed w, c' = -s w,
** s' = c w, and a bar with two constraint rows.
*/
#include "mechanics/machine.h"

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

static ambit_status express_ring(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_expr c = b->state(b, 0, 0, "1"), s = b->state(b, 1, 0, "1");
  if (port == 1 && quantity == AMBIT_RESIDUAL) {
    ambit_expr square = b->op(b, AMBIT_OP_MUL, c, s);
    out[0] = b->diff_time(b, square);
    return AMBIT_OK;
  }
  if (port != 0) return AMBIT_UNABLE;
  switch (quantity) {
  case AMBIT_COORDINATE: out[0] = c, out[1] = s; return AMBIT_OK;
  case AMBIT_RATE: out[0] = b->speed(b, 0, 1, "rad/s"); return AMBIT_OK;
  case AMBIT_RATE2: out[0] = b->speed(b, 0, 2, "rad/s"); return AMBIT_OK;
  case AMBIT_COORDINATE_RATE: {
    ambit_expr w = b->speed(b, 0, 1, "rad/s"), cw = b->op(b, AMBIT_OP_MUL, c, w), sw = b->op(b, AMBIT_OP_MUL, s, w);
    out[0] = b->op(b, AMBIT_OP_NEG, sw, sw), out[1] = cw;
    return AMBIT_OK;
  }
  case AMBIT_BALANCE: out[0] = b->state(b, 0, 1, "1"); return AMBIT_OK; /* not its derivative: refused */
  default: return AMBIT_UNABLE;
  }
}

static const ambit_port ring_ports[] = { { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, AMBIT_DOF(1, 2), 0, "" },
  { "circle", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, 1, 0, "" } };
static const ambit_element ring = { .size = sizeof ring, .nport = 2, .port = ring_ports, .express = express_ring };

static ambit_status express_bar(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port == 0 && quantity == AMBIT_RESIDUAL) {
    out[0] = out[1] = b->multiplier(b, 1, "N");
    return AMBIT_OK;
  }
  if (port != AMBIT_NO_PORT || quantity != AMBIT_POWER) return AMBIT_UNABLE;
  out[0] = b->num(b, "2.5");
  return AMBIT_OK;
}

static const ambit_port bar_ports[] = { { "close", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, 2, 0, "" } };
static const ambit_element bar = { .size = sizeof bar, .nport = 1, .port = bar_ports, .express = express_bar };

static uint32_t put(machine *s, const ambit_element *e, const char *name) {
  uint32_t part = machine_try(s, e, "own", name, AMBIT_WORLD, NULL);
  if (part == UINT32_MAX) fail_msg("%s", s->failure.message);
  return part;
}

static void speeds_of_their_own(void **state) {
  machine *s = *state;
  uint32_t part = put(s, &ring, "ring");
  machine_revolute(s, "hinge", AMBIT_WORLD, "0,0,1");
  ambit_coordinate c[4];
  ambit_speed u[4];
  char text[256];
  assert_int_equal(ambit_mechanism_coordinates(s->mechanism, 4, c), 3);
  assert_int_equal(ambit_mechanism_speeds(s->mechanism, 4, u), 2);
  assert_string_equal(c[0].name, "ring.1");
  assert_string_equal(c[1].name, "ring.2");
  assert_string_equal(c[2].name, "hinge");
  assert_string_equal(u[0].name, "ring'.1");
  assert_string_equal(u[0].unit, "rad/s");
  assert_string_equal(u[1].name, "hinge'");
  assert_int_equal(u[0].coordinate, AMBIT_NO_EXPR);
  assert_int_equal(u[1].coordinate, c[2].q);
  assert_int_equal(c[2].rate, u[1].u);
  assert_string_equal(ambit_graph_node(s->graph, u[0].du)->text, "ring''.1");
  assert_string_equal(ambit_graph_node(s->graph, u[0].du)->unit, "rad/s/s");
  assert_int_equal(c[1].rate, ambit_graph_op(s->graph, AMBIT_OP_MUL, c[0].q, u[0].u));
  /* d(c s)/dt = w (c^2 - s^2) */
  double x[] = { 3, 2, 5 };
  ambit_expr leaf[] = { c[0].q, c[1].q, u[0].u };
  ambit_interval rate;
  machine_values(s, 1, machine_pull(s, (ambit_frame) { part, 1 }, AMBIT_RESIDUAL), 3, leaf, x, &rate);
  assert_true(rate.lo == 25 && rate.hi == 25);
  assert_null(ambit_mechanism_pull(s->mechanism, (ambit_frame) { part, 0 }, AMBIT_BALANCE, &s->failure));
  assert_non_null(strstr(s->failure.message, "own `ring` (scene.lua:7): it asks for coordinate 0, derivative 1"));
  machine_text_of(s, c[0].rate, text);
  assert_non_null(strstr(text, "ring'.1"));
}

static void multipliers_and_power(void **state) {
  machine *s = *state;
  ambit_multiplier one[3];
  uint32_t a = put(s, &bar, "a");
  put(s, &bar, "b");
  assert_int_equal(ambit_mechanism_multipliers(s->mechanism, 3, one), 0); /* nobody has pulled them */
  const ambit_expr *g = machine_pull(s, (ambit_frame) { a, 0 }, AMBIT_RESIDUAL);
  assert_int_equal(ambit_mechanism_multipliers(s->mechanism, 3, one), 1);
  assert_string_equal(one[0].name, "lambda_a.2");
  assert_int_equal(one[0].lambda, g[0]);
  assert_int_equal(one[0].index, 1);
  assert_string_equal(ambit_graph_node(s->graph, one[0].lambda)->unit, "N");
  assert_int_equal(machine_pull(s, AMBIT_NOWHERE, AMBIT_POWER)[0], machine_number(s, 5));
  put(s, &bar, "c"); /* a sum that was pulled follows */
  assert_int_equal(machine_pull(s, AMBIT_NOWHERE, AMBIT_POWER)[0], machine_number(s, 7.5));
}

static void bad_ports_are_refused(void **state) {
  machine *s = *state;
  static const ambit_port bad[] = { { "a", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_IN, 1, 0, "given" },
    { "a", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, 0, 0, "no row" },
    { "a", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, AMBIT_DOF(1, 2), 0, "rows and coordinates" },
    { "a", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, AMBIT_DOF(3, 2), 0, "fewer coordinates" },
    { "a", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, AMBIT_DOF(3, 13), 0, "many coordinates" } };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ambit_element e = { .size = sizeof e, .nport = 1, .port = &bad[i], .express = express_bar };
    assert_int_equal(machine_try(s, &e, "bad", NULL, AMBIT_WORLD, NULL), UINT32_MAX);
    assert_non_null(strstr(s->failure.message, "not declared properly"));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(speeds_of_their_own, set_up, tear_down),
    cmocka_unit_test_setup_teardown(multipliers_and_power, set_up, tear_down),
    cmocka_unit_test_setup_teardown(bad_ports_are_refused, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
