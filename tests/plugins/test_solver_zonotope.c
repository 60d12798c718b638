/* The zonotope integrator: it passes the kit of solvers in every configuration, and refuses options out of range. */
#include "solver_case.h"

static void passes_the_kit(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "time_order", "0" }, { "time_order", "4" }, { "time_order", "24" },
    { "generators", "2" }, { "generators", "200" }, { "tolerance", "1e-300" }, { "tolerance", "1e-6" },
    { "step_max", "0.02" } };
  solver_case c;
  case_open(&c, "zonotope", "interval");
  case_passes(&c, sizeof option / sizeof *option, option);
  case_close(&c);
}

static void bad_options_are_refused_by_name(void **unused) {
  (void)unused;
  static const case_option bad[] = { { "time_order", -1 }, { "time_order", 2 }, { "time_order", 41 },
    { "time_order", NAN }, { "generators", -1 }, { "generators", 1 }, { "generators", NAN }, { "tolerance", -1 },
    { "tolerance", NAN }, { "step_max", 0 }, { "step_max", NAN }, { "step_min", -1 }, { "step_min", NAN },
    { "width_max", -1 }, { "width_max", NAN } };
  solver_case c;
  case_open(&c, "zonotope", "interval");
  case_refuses(&c, sizeof bad / sizeof *bad, bad);
  case_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(bad_options_are_refused_by_name),
  };
  return cmocka_run_group_tests_name("solver zonotope", tests, NULL, NULL);
}
