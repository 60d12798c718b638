/* ValEncIA-IVP: it passes the kit of solvers in every configuration and over every arithmetic that it lists, and the
** kit would notice if the defect were too small. */
#include "solver_case.h"
#include <ambit/jet.h>

static const char *const fitting[] = { "interval", "affine", "taylor_model", "gradient", "mpfr" };

static void passes_the_kit_over_every_arithmetic(void **unused) {
  (void)unused;
  for (size_t i = 0; i < sizeof fitting / sizeof *fitting; i++) {
    solver_case c;
    case_open(&c, "valencia", fitting[i]);
    assert_int_equal(c.kit.plugin->needs_rigorous, 1);
    c.kit.gives = AMBIT_WISH_DENSE | AMBIT_WISH_SET;
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
  for (size_t i = 0; i < sizeof option / sizeof *option; i++) {
    size_t findings = case_findings(&c, option[i].name, option[i].text);
    if (findings) fail_msg("%s = %s: %zu findings", option[i].name, option[i].text, findings);
  }
  case_close(&c);
}

/* -- teeth: a series service that lies */

static const void *(*kernel_service)(const ambit_host *h, const char *id);
static ambit_jet_service truthful, lying;

static const void *lie(const ambit_host *h, const char *id) {
  return strcmp(id, AMBIT_JET_SERVICE) == 0 ? &lying : kernel_service(h, id);
}

/* the right-hand side a millionth off */
static void wrong_get(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  truthful.get(jet, slot, k, mid, rad, dmid, drad);
  *mid *= 1 + 1e-6;
}

static void the_kit_has_teeth(void **unused) {
  (void)unused;
  solver_case c;
  ambit_lease *lease;
  case_open(&c, "valencia", "interval");
  assert_int_equal(ambit_lease_open(&lease, NULL, NULL), AMBIT_OK);
  kernel_service = lease->host.service;
  truthful = *(const ambit_jet_service *)kernel_service(&lease->host, AMBIT_JET_SERVICE);
  ambit_lease_close(lease);
  c.kit.service = lie;
  lying = truthful;
  assert_int_equal(case_findings(&c, "tolerance", "1e-9"), 0);
  c.kit.finding = case_hide;
  lying.get = wrong_get;
  /* the curve is right, the defect of a wrong right-hand side is not: what is proved is about another problem */
  assert_true(case_findings(&c, "step_max", "0.05") > 0);
  case_close(&c);
}

/* -- options */

static ambit_status try_option(const solver_case *c, size_t i, double value, char *message) {
  double option[16];
  ambit_lease *lease;
  void *self = NULL;
  const ambit_problem problem = { .size = sizeof problem };
  assert_int_equal(ambit_params_resolve(c->kit.plugin->param, "valencia", 0, NULL, option, NULL), AMBIT_OK);
  option[i] = value;
  assert_int_equal(ambit_lease_open(&lease, NULL, NULL), AMBIT_OK);
  ambit_status status = c->kit.plugin->open(&lease->host, &problem, option, &self);
  snprintf(message, AMBIT_MESSAGE_MAX, "%s", lease->failure.message);
  ambit_lease_close(lease);
  return status;
}

static void bad_options_are_refused_by_name(void **unused) {
  (void)unused;
  static const struct {
    const char *name;
    double value;
  } bad[] = { { "order", 3 }, { "order", 21 }, { "degree", 17 }, { "degree", -1 }, { "tolerance", -1 },
    { "tolerance", NAN }, { "step_max", 0 }, { "step_max", NAN }, { "step_min", -1 }, { "width_max", 0 },
    { "width_max", NAN } };
  solver_case c;
  case_open(&c, "valencia", "interval");
  const ambit_param *param = c.kit.plugin->param;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    size_t at = 0;
    char message[AMBIT_MESSAGE_MAX];
    while (strcmp(param[at].name, bad[i].name) != 0) at++;
    assert_int_equal(try_option(&c, at, bad[i].value, message), AMBIT_INVALID);
    if (!strstr(message, bad[i].name)) fail_msg("`%s` is not named by: %s", bad[i].name, message);
  }
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
