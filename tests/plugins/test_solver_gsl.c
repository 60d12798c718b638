/* The steppers of GSL: every method passes the kit of solvers; bad options and failures are explained. */
#include "host/params.h"
#include "solver_case.h"

typedef struct method {
  const char *name;
  int weak;     /* of low order, or loose: tolerances that it can afford */
  int implicit; /* GSL's own LU decomposition, from 2.6 on, allocates at every call */
} method;

static void every_method_passes_the_kit(void **unused) {
  (void)unused;
  static const method methods[] = { { "rk2", 1, 0 }, { "rk4", 0, 0 }, { "rkf45", 0, 0 }, { "rkck", 0, 0 },
    { "rk8pd", 0, 0 }, { "rk2imp", 1, 1 }, { "rk4imp", 0, 1 }, { "bsimp", 0, 1 }, { "msadams", 1, 0 },
    { "msbdf", 1, 1 } };
  solver_case c;
  case_open(&c, "gsl", "real");
  assert_int_equal(c.kit.plugin->needs_rigorous, 0);
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    const method *m = &methods[i];
    const ambit_option option[] = { { "method", m->name }, { "relative", m->weak ? "1e-7" : "1e-10" },
      { "absolute", m->weak ? "1e-8" : "1e-12" } };
    c.kit.noption = 3, c.kit.option = option;
    c.kit.tolerance = m->weak ? 1e-3 : 1e-6;
    if (m->implicit)
      c.kit.allocations = NULL;
    else
      c.kit.allocations = SOLVER_ALLOCATIONS;
    size_t findings = solver_kit_run(&c.kit, NULL);
    if (findings) fail_msg("method %s: %zu findings", m->name, findings);
  }
  case_close(&c);
}

/* the kit notices a curve that is off: too little accuracy for the tolerance asked */
static void the_kit_has_teeth(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "gsl", "real");
  const ambit_option option[] = { { "method", "rk2" }, { "relative", "1e-2" }, { "absolute", "1e-2" } };
  c.kit.noption = 3, c.kit.option = option, c.kit.tolerance = 1e-9, c.kit.finding = case_hide;
  assert_true(solver_kit_run(&c.kit, NULL) > 5);
  case_close(&c);
}

static void longest_step_is_kept(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "gsl", "real");
  assert_int_equal(case_findings(&c, "step_max", "0.01"), 0);
  case_close(&c);
}

static ambit_status try_option(const solver_case *c, size_t i, double value, char *message) {
  double option[8];
  ambit_scope *scope;
  void *self = NULL;
  const double time[] = { 0, 1 };
  const ambit_problem problem = { .size = sizeof problem, .ntime = 2, .time = time, .arithmetic = c->kit.arithmetic };
  assert_int_equal(ambit_params_resolve(c->kit.plugin->param, "gsl", 0, NULL, option, NULL), AMBIT_OK);
  option[i] = value;
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  ambit_status status = c->kit.plugin->open(&scope->host, &problem, option, &self);
  snprintf(message, AMBIT_MESSAGE_MAX, "%s", scope->failure.message);
  ambit_scope_close(scope);
  return status;
}

static void bad_options_are_refused_by_name(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "gsl", "real");
  static const struct {
    size_t option;
    double value;
  } bad[] = { { 1, -1 }, { 1, NAN }, { 2, INFINITY }, { 3, 0 }, { 3, NAN }, { 4, 0 }, { 4, NAN } };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    char message[AMBIT_MESSAGE_MAX];
    assert_int_equal(try_option(&c, bad[i].option, bad[i].value, message), AMBIT_INVALID);
    assert_non_null(strstr(message, c.kit.plugin->param[bad[i].option].name));
  }
  case_close(&c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_method_passes_the_kit),
    cmocka_unit_test(the_kit_has_teeth),
    cmocka_unit_test(longest_step_is_kept),
    cmocka_unit_test(bad_options_are_refused_by_name),
  };
  return cmocka_run_group_tests_name("solver gsl", tests, NULL, NULL);
}
