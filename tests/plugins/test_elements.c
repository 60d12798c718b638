/* Every element plugin passes the conformance kit, and the kit finds elements that do not keep the contract. */
#include "host/registry.h"
#include "kit/element_kit.h"
#include <ambit/spatial.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdarg.h>
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
    bool frames, powers;
  } element[] = { { "ground", true, true }, { "frame", true, true }, { "rigid_link", true, true },
    { "revolute", true, true }, { "prismatic", true, true }, { "sloppy_joint", true, false },
    { "rigid_body", false, true }, { "point_mass", false, true }, { "gravity", false, true },
    { "joint_torque", false, false }, { "weld", true, true }, { "cylindrical", true, true },
    { "universal", true, true }, { "planar", true, true }, { "screw", true, true }, { "spherical", true, true },
    { "free", true, true } };
  for (size_t i = 0; i < sizeof element / sizeof *element; i++)
    for (uint64_t seed = 1; seed <= 3; seed++) {
      element_kit_report r = run_plugin(element[i].name, seed);
      assert_true(r.stages >= 2 && r.declined > 0);
      assert_int_equal(r.powers > 0, element[i].powers);
      if (element[i].frames) assert_true(r.compared > 50);
    }
}

/* -- the kit finds mistakes: a good element, with one of them */

static const ambit_element *good; /* what `mistaken` wraps */
enum { NONE, TWIST_SIGN, NO_CORIOLIS, TORQUE_LOST, NOT_TURNED, HALF_WRITTEN, SILENT, GREEDY, RATE_WRONG };
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
    cmocka_unit_test(the_kit_finds_mistakes),
    cmocka_unit_test(the_kit_finds_bad_descriptions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
