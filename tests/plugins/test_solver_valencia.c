/* ValEncIA-IVP: it passes the kit of solvers in every configuration and over every arithmetic that it lists, and the
** kit would notice if the defect were too small. */
#include "solver_lies.h"

static const char *const fitting[] = { "interval", "affine", "taylor_model", "gradient", "mpfr" };

static void passes_the_kit_over_every_arithmetic(void **unused) {
  (void)unused;
  for (size_t i = 0; i < sizeof fitting / sizeof *fitting; i++) {
    solver_case c;
    case_open(&c, "valencia", fitting[i]);
    assert_int_equal(c.kit.plugin->needs_rigorous, 1);
    c.kit.gives = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET;
    size_t findings = case_findings(&c, NULL, NULL);
    if (findings) fail_msg("over %s: %zu findings", fitting[i], findings);
    case_close(&c);
  }
}

static void passes_with_every_option(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "order", "4" }, { "order", "20" }, { "degree", "1" }, { "degree", "3" },
    { "tolerance", "1e-6" }, { "tolerance", "1e-300" }, { "exponential", "off" }, { "exponential", "on" },
    { "step_max", "0.01" } };
  solver_case c;
  case_open(&c, "valencia", "interval");
  case_passes(&c, sizeof option / sizeof *option, option);
  case_close(&c);
}

/* -- teeth: a series service that lies */

/* the right-hand side a millionth off */
static void wrong_get(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  truthful.get(jet, slot, k, mid, rad, dmid, drad);
  *mid *= 1 + 1e-6;
}

static void the_kit_has_teeth(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "valencia", "interval");
  lies(&c);
  assert_int_equal(case_findings(&c, "tolerance", "1e-9"), 0);
  c.kit.finding = case_hide;
  lying.get = wrong_get;
  /* the curve is right, the defect of a wrong right-hand side is not: what is proved is about another problem */
  assert_true(case_findings(&c, "step_max", "0.05") > 0);
  case_close(&c);
}

/* -- options */

static void bad_options_are_refused_by_name(void **unused) {
  (void)unused;
  static const case_option bad[] = { { "order", 3 }, { "order", 21 }, { "degree", 17 }, { "degree", -1 },
    { "tolerance", -1 }, { "tolerance", NAN }, { "step_max", 0 }, { "step_max", NAN }, { "step_min", -1 },
    { "width_max", -1 }, { "width_max", NAN } };
  solver_case c;
  case_open(&c, "valencia", "interval");
  case_refuses(&c, sizeof bad / sizeof *bad, bad);
  case_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit_over_every_arithmetic),
    cmocka_unit_test(passes_with_every_option),
    cmocka_unit_test(the_kit_has_teeth),
    cmocka_unit_test(bad_options_are_refused_by_name),
  };
  return cmocka_run_group_tests_name("solver valencia", tests, NULL, NULL);
}
