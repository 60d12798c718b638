/* The joints of quaternion.h, gear.h and play.h pass the conformance kit. */
#include <ambit/registry.h>
#include "kit/element_kit.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <cmocka.h>

static void conforms(const char *name, bool powers) {
  ambit_failure f = { 0 };
  const ambit_element *e;
  ambit_registry *r = ambit_registry_open(NULL);
  if (ambit_registry_element(r, name, &e, &f) != AMBIT_OK) fail_msg("%s", f.message);
  for (uint64_t seed = 1; seed <= 3; seed++) {
    element_kit_report report = element_kit_run(e, name, seed);
    if (report.failures) fail_msg("%s", report.first);
    assert_true(report.stages >= 2 && report.declined > 0);
    assert_int_equal(report.powers > 0, powers);
  }
  ambit_registry_close(r);
}

static void quaternions(void **state) {
  (void)state;
  conforms("spherical_quaternion", true);
  conforms("free_quaternion", true);
}

static void gears(void **state) {
  (void)state;
  conforms("gear", true);
  conforms("rack_and_pinion", true);
}

static void play(void **state) {
  (void)state;
  conforms("sloppy_joint", false);
  conforms("sloppy_prismatic", false);
  conforms("sloppy_spherical", false);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(quaternions),
    cmocka_unit_test(gears),
    cmocka_unit_test(play),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
