/* The Lohner integrator: it passes the kit of solvers in every configuration and over any arithmetic, and the kit
** would notice if the remainder were missing. */
#include "solver_lies.h"
#include "kit/reference_models.h"
#include <ambit/simulate.h>

static void passes_the_kit(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "set", "auto" }, { "set", "qr" }, { "history", "0" }, { "history", "1" },
    { "history", "3" }, { "pieces", "1" }, { "pieces", "16" }, { "order", "4" }, { "order", "60" },
    { "jacobian_order", "3" }, { "tolerance", "1e-300" }, { "tolerance", "1e-9" }, { "step_max", "0.01" },
    { "step", "taylor" }, { "step", "hermite_obreschkoff" } };
  solver_case c;
  case_open(&c, "lohner", "interval");
  c.kit.gives = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET;
  case_passes(&c, sizeof option / sizeof *option, option);
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
  case_open(&c, "lohner", "interval");
  lies(&c);
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
  assert_int_equal(solver_kit_run(&c.kit, NULL), 0);
  lying.get = no_error_get;
  assert_true(solver_kit_run(&c.kit, NULL) > 0);
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

/* tests/bench/lohner.c makes a million of them */
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
    .extras = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET,
    .sink = &c.sink };
  assert_int_equal(ambit_simulate(&q, &result, NULL, &m.failure), AMBIT_OK);
  assert_int_equal(result.status, AMBIT_OK);
  assert_true(c.records >= 20480);
  assert_int_equal(c.first, c.last);
  ambit_registry_close(registry);
  model_close(&m);
}

/* -- options */

static void bad_options_are_refused_by_name(void **unused) {
  (void)unused;
  static const case_option bad[] = { { "order", 3 }, { "order", 61 }, { "jacobian_order", 2 }, { "jacobian_order", 99 },
    { "tolerance", -1 }, { "tolerance", NAN }, { "history", -1 }, { "history", 1e9 }, { "pieces", 0 }, { "pieces", 17 },
    { "step_max", 0 }, { "step_max", NAN }, { "step_min", -1 }, { "width_max", -1 }, { "width_max", NAN } };
  solver_case c;
  case_open(&c, "lohner", "interval");
  case_refuses(&c, sizeof bad / sizeof *bad, bad);
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
