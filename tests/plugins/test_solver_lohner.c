/* The Lohner integrator: it passes the kit of solvers in every configuration and over any arithmetic, and the kit
** would notice if the remainder were missing. */
#include "solver_case.h"
#include "kit/reference_models.h"
#include "model/simulate.h"
#include <ambit/jet.h>

static void passes_the_kit(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "set", "auto" }, { "set", "qr" }, { "history", "0" }, { "history", "1" },
    { "history", "3" }, { "pieces", "1" }, { "pieces", "16" }, { "order", "4" }, { "order", "60" },
    { "jacobian_order", "3" }, { "tolerance", "1e-300" }, { "tolerance", "1e-9" }, { "step_max", "0.01" },
    { "step", "taylor" }, { "step", "hermite_obreschkoff" } };
  solver_case c;
  case_open(&c, "lohner", "interval");
  assert_int_equal(c.kit.plugin->needs_rigorous, 1);
  c.kit.gives = AMBIT_WISH_DENSE | AMBIT_WISH_SET;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++) {
    size_t findings = case_findings(&c, option[i].name, option[i].text);
    if (findings) fail_msg("%s = %s: %zu findings", option[i].name, option[i].text, findings);
  }
  case_close(&c);
}

/* an arithmetic that offers no series of its own gets the kernel's */
static void passes_over_general_series(void **unused) {
  (void)unused;
  solver_case c;
  case_open(&c, "lohner", "interval");
  c.arithmetic.full.jets = NULL;
  assert_int_equal(case_findings(&c, NULL, NULL), 0);
  case_close(&c);
}

/* -- teeth: series services that lie */

static const void *(*kernel_service)(const ambit_host *h, const char *id);
static ambit_jet_service truthful, lying;

static const void *lie(const ambit_host *h, const char *id) {
  return strcmp(id, AMBIT_JET_SERVICE) == 0 ? &lying : kernel_service(h, id);
}

/* remainders a million times too small */
static ambit_status small_tail(ambit_jet *jet, uint32_t K, double h, const double *tail_in, const double *dtail_in,
    double *tail_out, double *dtail_out) {
  ambit_status status = truthful.tail(jet, K, h, tail_in, dtail_in, tail_out, dtail_out);
  tail_out[0] *= 1e-6;
  return status;
}

/* slopes whose radii are dropped */
static void sharp_get(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  truthful.get(jet, slot, k, mid, rad, dmid, drad);
  if (drad) drad[0] = 0;
}

/* errors of the Hermite-Obreschkoff formula at r = 2 that are dropped: only they are of order 5 */
static void no_error_get(
    const ambit_jet *jet, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad) {
  truthful.get(jet, slot, k, mid, rad, dmid, drad);
  if (dmid && drad && k == 5) dmid[0] = drad[0] = 0;
}

static void the_kit_has_teeth(void **unused) {
  (void)unused;
  solver_case c;
  ambit_lease *lease;
  case_open(&c, "lohner", "interval");
  assert_int_equal(ambit_lease_open(&lease, NULL, NULL), AMBIT_OK);
  kernel_service = lease->host.service;
  truthful = *(const ambit_jet_service *)kernel_service(&lease->host, AMBIT_JET_SERVICE);
  ambit_lease_close(lease);
  c.kit.service = lie;
  lying = truthful;
  assert_int_equal(case_findings(&c, NULL, NULL), 0);
  c.kit.finding = case_hide;
  lying.tail = small_tail;
  assert_true(case_findings(&c, NULL, NULL) > 10);
  lying = truthful;
  lying.get = sharp_get;
  assert_true(case_findings(&c, NULL, NULL) > 10);
  static const ambit_option coarse[] = { { "step", "hermite_obreschkoff" }, { "jacobian_order", "4" } };
  c.kit.noption = 2, c.kit.option = coarse;
  lying = truthful;
  assert_int_equal(solver_kit_run(&c.kit), 0);
  lying.get = no_error_get;
  assert_true(solver_kit_run(&c.kit) > 0);
  case_close(&c);
}

/* -- long runs */

typedef struct counter {
  ambit_sink sink; /* first */
  size_t records, first, last;
} counter;

static int32_t count_record(ambit_sink *sink, const ambit_record *r) {
  counter *c = (counter *)(void *)sink;
  size_t (*allocations)(void) = SOLVER_ALLOCATIONS;
  (void)r;
  c->last = allocations ? allocations() : 0;
  if (c->records++ == 0) c->first = c->last;
  return 0;
}

/* bench/lohner.c makes a million of them */
static void many_steps_need_no_more_memory(void **unused) {
  (void)unused;
  static const double time[] = { 0, 20 };
  static const ambit_option option[] = { { "step_max", "0x1p-10" }, { "order", "8" } };
  counter c = { .sink = { sizeof(ambit_sink), count_record, NULL } };
  model m;
  model_pendulum(&m);
  ambit_simulate_result result = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  const ambit_simulate_request q = { .system = &m.system,
    .registry = registry,
    .solver = "lohner",
    .nsolver_option = 2,
    .solver_option = option,
    .initial = m.initial,
    .ntime = 2,
    .time = time,
    .wish = AMBIT_WISH_DENSE | AMBIT_WISH_SET,
    .sink = &c.sink };
  assert_int_equal(ambit_simulate(&q, &result, NULL, &m.failure), AMBIT_OK);
  assert_int_equal(result.status, AMBIT_OK);
  assert_true(c.records >= 20480);
  assert_int_equal(c.first, c.last);
  ambit_registry_close(registry);
  model_close(&m);
}

/* -- options */

static ambit_status try_option(const solver_case *c, size_t i, double value, char *message) {
  double option[16];
  ambit_lease *lease;
  void *self = NULL;
  const ambit_problem problem = { .size = sizeof problem };
  assert_int_equal(ambit_params_resolve(c->kit.plugin->param, "lohner", 0, NULL, option, NULL), AMBIT_OK);
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
  } bad[] = { { "order", 3 }, { "order", 61 }, { "jacobian_order", 2 }, { "jacobian_order", 99 }, { "tolerance", -1 },
    { "tolerance", NAN }, { "history", -1 }, { "history", 1e9 }, { "pieces", 0 }, { "pieces", 17 }, { "step_max", 0 },
    { "step_max", NAN }, { "step_min", -1 }, { "width_max", -1 }, { "width_max", NAN } };
  solver_case c;
  case_open(&c, "lohner", "interval");
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
    cmocka_unit_test(passes_over_general_series),
    cmocka_unit_test(the_kit_has_teeth),
    cmocka_unit_test(many_steps_need_no_more_memory),
    cmocka_unit_test(bad_options_are_refused_by_name),
  };
  return cmocka_run_group_tests_name("solver lohner", tests, NULL, NULL);
}
