/* The stiff integrator: it passes the kit of solvers in every configuration; bad options are refused by name. */
#include "solver_case.h"

static void passes_the_kit(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "tolerance", "1e-16" }, { "tolerance", "1e-12" }, { "nodes", "8" },
    { "nodes", "20" }, { "degree", "2" }, { "step_max", "0.05" } };
  solver_case c;
  case_open(&c, "stiff", "interval");
  c.kit.gives = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET;
  case_passes(&c, sizeof option / sizeof *option, option);
  case_close(&c);
}

static void bad_options_are_refused_by_name(void **unused) {
  (void)unused;
  static const case_option bad[] = { { "nodes", 3 }, { "nodes", 21 }, { "degree", -1 }, { "degree", 21 },
    { "tolerance", -1 }, { "tolerance", NAN }, { "step_max", 0 }, { "step_max", NAN }, { "step_min", -1 },
    { "width_max", -1 }, { "width_max", NAN } };
  solver_case c;
  case_open(&c, "stiff", "interval");
  case_refuses(&c, sizeof bad / sizeof *bad, bad);
  case_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(bad_options_are_refused_by_name),
  };
  return cmocka_run_group_tests_name("solver stiff", tests, NULL, NULL);
}
