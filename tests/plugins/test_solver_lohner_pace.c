/* How long steps of lohner are: runs over wide sets that slow down end soon, others do not end for it, and data are not
** blurred where the flow is linear. */
#include "solver_case.h"
#include "kit/reference_models.h"
#include <ambit/simulate.h>
#include <math.h>

typedef struct pacer {
  ambit_sink sink; /* first */
  double stop, t, width;
} pacer;

static int32_t pass(ambit_sink *sink, const ambit_record *r) {
  pacer *p = (pacer *)(void *)sink;
  p->t = r->t_to;
  p->width = 0;
  for (uint32_t i = 0; i < r->nx; i++) p->width = fmax(p->width, r->hi[i] - r->lo[i]);
  return p->t > p->stop;
}

static ambit_simulate_result paced(model *m, pacer *p, double to, const char *step_min) {
  const double time[] = { 0, to };
  const ambit_option option = { "step_min", step_min };
  ambit_simulate_result result = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  p->sink = (ambit_sink) { sizeof(ambit_sink), pass, NULL };
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "lohner",
    .nsolver_option = 1,
    .solver_option = &option,
    .initial = m->initial,
    .ntime = 2,
    .time = time,
    .sink = &p->sink };
  ambit_status status = ambit_simulate(&q, &result, NULL, &m->failure);
  if (status != AMBIT_OK) fail_msg("%s", m->failure.message);
  ambit_registry_close(registry);
  return result;
}

/* a pendulum with smooth friction, x0 = 1 +- 0.03 */
static void model_friction(model *m) {
  static const char *const name[] = { "x", "v" };
  model_open(m, 2, name);
  expr fast = divide(m, m->state[1], decimal(m, "0.002"));
  expr friction = mul(m, decimal(m, "-0.5"), ambit_graph_op(m->graph, AMBIT_OP_TANH, fast, fast));
  m->rate[0] = m->state[1];
  m->rate[1] = sub(m, friction, mul(m, decimal(m, "9.81"), sine(m, m->state[0])));
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { 0.97, 1.03 });
  m->initial[1] = number(m, 0);
}

static void creeping_ends(void **unused) {
  (void)unused;
  model m;
  pacer p = { .stop = INFINITY };
  model_friction(&m);
  ambit_simulate_result result = paced(&m, &p, 10, "0");
  assert_int_equal(result.status, AMBIT_UNABLE);
  assert_true(result.steps <= 4096 && p.t > 1.4);
  assert_non_null(strstr(result.reason, "out of reach"));
  assert_non_null(strstr(result.reason, "`step_min`"));
  p.stop = p.t + 0.01;
  result = paced(&m, &p, 10, "1e-11"); /* whoever gives it decides for himself */
  assert_int_equal(result.status, AMBIT_STOPPED);
  model_close(&m);
}

/* Van der Pol, mu = 20, a box: steps shrink twentyfold, and grow again */
static void relaxing_goes_on(void **unused) {
  (void)unused;
  static const char *const name[] = { "x", "y" };
  model m;
  pacer p = { .stop = INFINITY };
  model_open(&m, 2, name);
  expr damped = mul(&m, sub(&m, number(&m, 1), square(&m, m.state[0])), m.state[1]);
  m.rate[0] = m.state[1], m.rate[1] = sub(&m, mul(&m, number(&m, 20), damped), m.state[0]);
  m.initial[0] = ambit_graph_unknown(m.graph, "x0", (ambit_interval) { 1.9, 2.1 });
  m.initial[1] = ambit_graph_unknown(m.graph, "y0", (ambit_interval) { -0.1, 0.1 });
  ambit_simulate_result result = paced(&m, &p, 10, "0");
  assert_int_equal(result.status, AMBIT_OK);
  assert_true(result.steps > 1024); /* judged */
  model_close(&m);
}

/* x'' = -x: nothing is lost but what slopes lack */
static void linear_flows_keep_data(void **unused) {
  (void)unused;
  static const char *const name[] = { "x", "v" };
  model m;
  pacer p = { .stop = INFINITY };
  model_open(&m, 2, name);
  m.rate[0] = m.state[1], m.rate[1] = sub(&m, number(&m, 0), m.state[0]);
  m.initial[0] = ambit_graph_unknown(m.graph, "x0", (ambit_interval) { 1, 1 + 0x1p-13 });
  m.initial[1] = number(&m, 0);
  ambit_simulate_result result = paced(&m, &p, 30, "0");
  assert_int_equal(result.status, AMBIT_OK);
  double truth = fmax(fabs(cos(30)), fabs(sin(30)));
  assert_true(p.width >= truth * 0x1p-13 && p.width < truth * 0x1.008p-13);
  model_close(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(creeping_ends), cmocka_unit_test(relaxing_goes_on),
    cmocka_unit_test(linear_flows_keep_data) };
  return cmocka_run_group_tests_name("solver lohner pace", tests, NULL, NULL);
}
