/* Every element plugin passes the conformance kit, and the kit finds elements that do not keep the contract. */
#include <ambit/registry.h>
#include "kit/element_kit.h"
#include <ambit/spatial.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static element_kit_report run_plugin(const char *name, uint64_t seed) {
  ambit_failure f = { 0 };
  const ambit_element *e;
  ambit_registry *r = ambit_registry_open(NULL);
  if (ambit_registry_element(r, name, &e, &f) != AMBIT_OK) fail_msg("%s", f.message);
  element_kit_report report = element_kit_run(e, name, seed);
  ambit_registry_close(r);
  if (report.failures) fail_msg("%s", report.first);
  return report;
}

static void all_plugins_conform(void **state) {
  (void)state;
  static const struct {
    const char *name;
    bool frames, powers, reactions; /* has OUT frames; balances of power, of momentum are closed */
  } element[] = { { "ground", true, true, false }, { "frame", true, true, true }, { "rigid_link", true, true, true },
    { "revolute", true, true, true }, { "prismatic", true, true, true }, { "sloppy_joint", true, false, false },
    { "rigid_body", false, true, true }, { "point_mass", false, true, true }, { "gravity", false, true, false },
    { "joint_torque", false, true, false }, { "weld", true, true, true }, { "cylindrical", true, true, true },
    { "universal", true, true, true }, { "planar", true, true, true }, { "screw", true, true, true },
    { "spherical", true, true, true }, { "free", true, true, true }, { "joint_spring", false, true, false },
    { "joint_damper", false, true, false }, { "joint_friction", false, true, false },
    { "spring_damper", false, true, true }, { "force_law", false, true, true }, { "bushing", false, true, true },
    { "applied_force", false, true, false }, { "applied_torque", false, true, false } };
  for (size_t i = 0; i < sizeof element / sizeof *element; i++)
    for (uint64_t seed = 1; seed <= 3; seed++) {
      element_kit_report r = run_plugin(element[i].name, seed);
      assert_true(r.stages >= 2 && r.declined > 0);
      assert_int_equal(r.powers > 0, element[i].powers);
      assert_int_equal(r.reactions > 0, element[i].reactions);
      if (element[i].frames) assert_true(r.compared > 50);
    }
}

/* AMBIT_ELEMENTS: the names of all, separated by blanks */
static void so_do_all_others(void **state) {
  (void)state;
  char name[64];
  unsigned count = 0;
  for (const char *at = AMBIT_ELEMENTS; *at; count++) {
    size_t length = strcspn(at, " ");
    snprintf(name, sizeof name, "%.*s", (int)length, at);
    run_plugin(name, 7);
    at += length + (at[length] == ' ');
  }
  assert_true(count >= 25);
}

/* -- the kit finds mistakes: a good element, with one of them */

static const ambit_element *good; /* what `mistaken` wraps */
enum {
  NONE,
  TWIST_SIGN,
  NO_CORIOLIS,
  TORQUE_LOST,
  NOT_TURNED,
  HALF_WRITTEN,
  SILENT,
  GREEDY,
  RATE_WRONG,
  POWER_SIGN,
  POWER_LOST,
  ENERGY_WRONG,
  EFFORT_SIGN,
  MOMENTUM_WRONG,
  MASS_LOST,
  TOO_MUCH_FORCE,
  COORDINATE_RATE_WRONG
};
static int mistake;

static ambit_status mistaken(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (mistake == SILENT && quantity == AMBIT_TWIST) return AMBIT_BROKEN;
  if (mistake == GREEDY && quantity > 32) return AMBIT_OK;
  ambit_status status = good->express(b, port, quantity, out);
  if (status != AMBIT_OK) return status;
  if (mistake == TWIST_SIGN && quantity == AMBIT_TWIST) out[3] = ambit_negate(b, out[3]);
  if (mistake == TORQUE_LOST && quantity == AMBIT_WRENCH) out[0] = out[1] = out[2] = 0;
  if (mistake == NOT_TURNED && quantity == AMBIT_POSE)
    for (int i = 0; i < 9; i++) out[i] = 1; /* node 1 is the constant 1 */
  if (mistake == HALF_WRITTEN && quantity == AMBIT_ACCEL) out[5] = UINT32_MAX;
  if (mistake == RATE_WRONG && quantity == AMBIT_RATE2) out[0] = ambit_multiply(b, out[0], b->num(b, "2"));
  if (mistake == POWER_SIGN && quantity == AMBIT_POWER) out[0] = ambit_negate(b, out[0]);
  if (mistake == POWER_LOST && quantity == AMBIT_POWER) out[0] = 0;
  if (mistake == ENERGY_WRONG && quantity == AMBIT_ENERGY) out[1] = ambit_multiply(b, b->num(b, "2"), out[1]);
  if (mistake == EFFORT_SIGN && quantity == AMBIT_EFFORT) out[0] = ambit_negate(b, out[0]);
  if (mistake == MOMENTUM_WRONG && quantity == AMBIT_MOMENTUM) out[0] = ambit_negate(b, out[0]);
  if (mistake == MASS_LOST && quantity == AMBIT_MASS) return AMBIT_UNABLE;
  if (mistake == TOO_MUCH_FORCE && quantity == AMBIT_WRENCH)
    for (int i = 0; i < 6; i++) out[i] = ambit_multiply(b, b->num(b, "2"), out[i]);
  if (mistake == COORDINATE_RATE_WRONG && quantity == AMBIT_COORDINATE_RATE) out[0] = ambit_negate(b, out[0]);
  if (mistake == NO_CORIOLIS && quantity == AMBIT_ACCEL) {
    const ambit_expr *from = b->get(b, 0, AMBIT_ACCEL);
    if (!from) return AMBIT_INVALID;
    for (int i = 3; i < 6; i++) out[i] = from[i];
  }
  return AMBIT_OK;
}

static void the_kit_finds(const char *name, int what, const char *message) {
  ambit_failure f = { 0 };
  ambit_registry *r = ambit_registry_open(NULL);
  if (ambit_registry_element(r, name, &good, &f) != AMBIT_OK) fail_msg("%s", f.message);
  ambit_element e = *good;
  e.express = mistaken;
  mistake = what;
  element_kit_report report = element_kit_run(&e, name, 5);
  ambit_registry_close(r);
  if (what == NONE ? report.failures : !strstr(report.first, message))
    fail_msg("`%s` instead of `%s`", report.first, message);
}

static void the_kit_finds_mistakes(void **state) {
  (void)state;
  the_kit_finds("prismatic", NONE, "");
  the_kit_finds("revolute", TWIST_SIGN, "velocity is wrong");
  the_kit_finds("prismatic", NO_CORIOLIS, "proper acceleration is wrong");
  the_kit_finds("rigid_link", TORQUE_LOST, "power is wrong");
  the_kit_finds("rigid_body", TORQUE_LOST, "power is wrong");
  the_kit_finds("sloppy_joint", NOT_TURNED, "orthonormal axes is wrong");
  the_kit_finds("revolute", HALF_WRITTEN, "not every component was written");
  the_kit_finds("revolute", SILENT, "broken");
  the_kit_finds("point_mass", GREEDY, "is not declined");
  the_kit_finds("revolute", RATE_WRONG, "second rate is wrong");
  the_kit_finds("spring_damper", NONE, "");
  the_kit_finds("joint_damper", POWER_SIGN, "power is wrong");
  the_kit_finds("joint_torque", POWER_LOST, "power is wrong");
  the_kit_finds("revolute", POWER_LOST, "power is wrong"); /* of the drive */
  the_kit_finds("applied_force", POWER_LOST, "power is wrong");
  the_kit_finds("spring_damper", ENERGY_WRONG, "power is wrong");
  the_kit_finds("joint_spring", EFFORT_SIGN, "power is wrong");
  the_kit_finds("bushing", TOO_MUCH_FORCE, "power is wrong");
  the_kit_finds(
      "close_distance", TOO_MUCH_FORCE, "power is wrong"); /* virtual power: multipliers times the rates of g */
  the_kit_finds("close_distance", POWER_LOST, "power is wrong");
  the_kit_finds("rigid_body", MOMENTUM_WRONG, "action and reaction (moment) is wrong");
  the_kit_finds("point_mass", MASS_LOST, "no mass");
  the_kit_finds("spherical_quaternion", NONE, "");
  the_kit_finds("spherical_quaternion", COORDINATE_RATE_WRONG, "is wrong");
}

/* A force that nothing bears, with its power told honestly: only Newton's third law is broken. */
static ambit_status express_hook(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  bool power = port == AMBIT_NO_PORT && quantity == AMBIT_POWER;
  if (!power && !(port == 1 && quantity == AMBIT_WRENCH)) return AMBIT_UNABLE;
  const ambit_expr *twist = power ? b->get(b, 1, AMBIT_TWIST) : NULL;
  if (power && !twist) return AMBIT_INVALID;
  for (int i = 0; i < 6 && !power; i++) out[i] = i == 5 ? b->num(b, "1") : 0;
  if (power) out[0] = twist[5];
  return AMBIT_OK;
}

static void the_kit_finds_a_lost_reaction(void **state) {
  (void)state;
  static const ambit_port port[] = { { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "one frame" },
    { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the other frame" } };
  ambit_element e = { .size = sizeof e, .nport = 2, .port = port, .express = express_hook };
  element_kit_report report = element_kit_run(&e, "hook", 1);
  assert_non_null(strstr(report.first, "hook: action and reaction"));
}

static void the_kit_finds_bad_descriptions(void **state) {
  (void)state;
  static const ambit_param wordless[] = { { "mass", "kg", "", NULL, "" }, { 0 } },
                           unitless[] = { { "mass", "kilo", "", NULL, "its mass" }, { 0 } },
                           shapeless[] = { { "mass", "kg", "round", NULL, "its mass" }, { 0 } };
  static const ambit_param *const params[] = { wordless, unitless, shapeless };
  static const char *const message[] = { "no sentence", "unknown unit", "no known shape" };
  ambit_failure f = { 0 };
  ambit_registry *r = ambit_registry_open(NULL);
  if (ambit_registry_element(r, "point_mass", &good, &f) != AMBIT_OK) fail_msg("%s", f.message);
  for (int i = 0; i < 3; i++) {
    ambit_element e = *good;
    e.param = params[i];
    element_kit_report report = element_kit_run(&e, "point_mass", 1);
    assert_non_null(strstr(report.first, message[i]));
  }
  ambit_registry_close(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(all_plugins_conform),
    cmocka_unit_test(so_do_all_others),
    cmocka_unit_test(the_kit_finds_mistakes),
    cmocka_unit_test(the_kit_finds_a_lost_reaction),
    cmocka_unit_test(the_kit_finds_bad_descriptions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
