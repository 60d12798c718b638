/* The stiff integrator: it passes the kit of solvers in every configuration; bad options are refused by name. */
#include "solver_case.h"

static void passes_the_kit(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "tolerance", "1e-16" }, { "tolerance", "1e-12" }, { "nodes", "8" },
    { "nodes", "20" }, { "degree", "2" }, { "step_max", "0.05" } };
  solver_case c;
  case_open(&c, "stiff", "interval");
  assert_int_equal(c.kit.plugin->needs_rigorous, 1);
  c.kit.gives = AMBIT_WISH_DENSE | AMBIT_WISH_SET;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++) {
    size_t findings = case_findings(&c, option[i].name, option[i].text);
    if (findings) fail_msg("%s = %s: %zu findings", option[i].name, option[i].text, findings);
  }
  case_close(&c);
}

static ambit_status try_option(const solver_case *c, size_t i, double value, char *message) {
  double option[16];
  ambit_lease *lease;
  void *self = NULL;
  const ambit_problem problem = { .size = sizeof problem };
  assert_int_equal(ambit_params_resolve(c->kit.plugin->param, "stiff", 0, NULL, option, NULL), AMBIT_OK);
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
  } bad[] = { { "nodes", 3 }, { "nodes", 21 }, { "degree", -1 }, { "degree", 21 }, { "tolerance", -1 },
    { "tolerance", NAN }, { "step_max", 0 }, { "step_max", NAN }, { "step_min", -1 }, { "width_max", 0 },
    { "width_max", NAN } };
  solver_case c;
  case_open(&c, "stiff", "interval");
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
    cmocka_unit_test(passes_the_kit),
    cmocka_unit_test(bad_options_are_refused_by_name),
  };
  return cmocka_run_group_tests_name("solver stiff", tests, NULL, NULL);
}
