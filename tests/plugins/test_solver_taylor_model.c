/* The Taylor-model integrator: it passes the kit of solvers in every configuration and over any arithmetic, the kit
** would notice if a remainder were missing, and threads change nothing. */
#include "solver_lies.h"

static void passes_the_kit(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "order", "0" }, { "order", "1" }, { "order", "5" }, { "order", "31" },
    { "time_order", "4" }, { "time_order", "40" }, { "jacobian_order", "3" }, { "jacobian_order", "20" },
    { "tolerance", "1e-300" }, { "tolerance", "1e-6" }, { "split_tolerance", "1e-15" }, { "pieces_max", "1" },
    { "pieces_max", "3" }, { "outputs", "7" }, { "step_max", "0.02" } };
  solver_case c;
  case_open(&c, "taylor_model", "interval");
  case_passes(&c, sizeof option / sizeof *option, option);
  case_close(&c);
}

/* an arithmetic that offers no series of its own gets the kernel's */
static void passes_over_general_series(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "taylor_model", "interval");
  c.arithmetic.full.jets = NULL;
  assert_int_equal(case_findings(&c, NULL, NULL), 0);
  case_close(&c);
}

/* -- teeth: series services that lie */

/* remainders a million times too small */
static ambit_status small_tail(ambit_jet *jet, uint32_t K, double h, const double *tail_in, const double *dtail_in,
    double *tail_out, double *dtail_out) {
  ambit_status status = truthful.tail(jet, K, h, tail_in, dtail_in, tail_out, dtail_out);
  tail_out[0] *= 1e-6;
  return status;
}

/* slopes that are a third of what they are */
static void small_get(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  truthful.get(jet, slot, k, mid, rad, dmid, drad);
  if (dmid && k) dmid[0] *= 0.3;
}

static void the_kit_has_teeth(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "taylor_model", "interval");
  lies(&c);
  assert_int_equal(case_findings(&c, NULL, NULL), 0);
  c.kit.finding = case_hide;
  lying.tail = small_tail;
  assert_true(case_findings(&c, NULL, NULL) > 10);
  lying = truthful;
  lying.get = small_get;
  assert_true(case_findings(&c, NULL, NULL) > 10);
  case_close(&c);
}

/* -- options */

static void bad_options_are_refused_by_name(void **unused) {
  (void)unused;
  static const case_option bad[] = { { "order", -1 }, { "order", 32 }, { "order", NAN }, { "time_order", 3 },
    { "time_order", 41 }, { "jacobian_order", 2 }, { "jacobian_order", 21 }, { "tolerance", -1 }, { "tolerance", NAN },
    { "split_tolerance", -1 }, { "split_tolerance", NAN }, { "pieces_max", -1 }, { "pieces_max", 1e9 },
    { "outputs", 0 }, { "outputs", NAN }, { "step_max", 0 }, { "step_max", NAN }, { "step_min", -1 },
    { "width_max", -1 }, { "width_max", NAN } };
  solver_case c;
  case_open(&c, "taylor_model", "interval");
  case_refuses(&c, sizeof bad / sizeof *bad, bad);
  case_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(passes_over_general_series),
    cmocka_unit_test(the_kit_has_teeth),
    cmocka_unit_test(bad_options_are_refused_by_name),
  };
  return cmocka_run_group_tests_name("solver taylor_model", tests, NULL, NULL);
}
