/* valencia where Taylor methods stop: right-hand sides with kinks and such as are only continuous, against closed forms
** piece by piece; and stiff or oscillating ones with every kind of exponential enclosure. */
#include "kit/reference_models.h"
#include <ambit/simulate.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static expr op(model *m, uint32_t o, expr a, expr b) { return ambit_graph_op(m->graph, o, a, b); }
static expr negative(model *m, expr a) { return sub(m, number(m, 0), a); }

typedef struct check {
  ambit_sink sink; /* first */
  void (*truth)(double t, double u, double *x);
  double u_lo, u_hi, slack, width; /* width: at the end, widest state */
  size_t steps, misses;
} check;

static size_t misses_at(const check *c, double t, const double *lo, const double *hi, uint32_t nx) {
  size_t misses = 0;
  for (int k = 0; k <= 8; k++) {
    double x[MODEL_STATES];
    c->truth(t, c->u_lo + k / 8.0 * (c->u_hi - c->u_lo), x);
    for (uint32_t i = 0; i < nx; i++) {
      double slack = c->slack * (1 + fabs(x[i])); /* the closed form is rounded */
      misses += !(lo[i] <= x[i] + slack && x[i] - slack <= hi[i]);
    }
  }
  return misses;
}

static int32_t watch(ambit_sink *sink, const ambit_record *r) {
  check *c = (check *)(void *)sink;
  c->steps++, c->width = 0;
  c->misses += misses_at(c, r->t_to, r->lo, r->hi, r->nx);
  for (int k = 0; k <= 4; k++)
    c->misses += misses_at(c, r->t_from + k / 4.0 * (r->t_to - r->t_from), r->tube_lo, r->tube_hi, r->nx);
  for (uint32_t i = 0; i < r->nx; i++) c->width = fmax(c->width, r->hi[i] - r->lo[i]);
  return 0;
}

static ambit_simulate_result run(
    model *m, check *c, double from, double to, const char *arithmetic, const ambit_option *option) {
  double time[] = { from, to };
  ambit_simulate_result result;
  ambit_failure f = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  c->sink = (ambit_sink) { sizeof(ambit_sink), watch, NULL };
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "valencia",
    .arithmetic = arithmetic,
    .nsolver_option = option ? 1 : 0,
    .solver_option = option,
    .initial = m->initial,
    .ntime = 2,
    .time = time,
    .sink = &c->sink };
  if (ambit_simulate(&q, &result, NULL, &f) != AMBIT_OK) fail_msg("%s%s", m->failure.message, f.message);
  ambit_registry_close(registry);
  return result;
}

static const char *const fitting[] = { "interval", "affine", "taylor_model", "gradient", "mpfr" };
#define FITTING (sizeof fitting / sizeof *fitting)
#define WITH_FUNCTIONS (FITTING - 1) /* MPFR allocates memory for sines and exponentials, even in a run */

/* -- x' = -|x| : e^-t x0 above 0, e^t x0 below */

static void build_abs(model *m, double lo, double hi) {
  static const char *const name[] = { "x" };
  model_open(m, 1, name);
  m->rate[0] = negative(m, op(m, AMBIT_OP_ABS, m->state[0], m->state[0]));
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { lo, hi });
}

static void truth_abs(double t, double u, double *x) { x[0] = u > 0 ? u * exp(-t) : u * exp(t); }

static void absolute_value(void **unused) {
  (void)unused;
  static const double box[][2] = { { 1, 2 }, { -2, -1 }, { -0.5, 1 }, { -1e-9, 1e-9 } };
  for (size_t a = 0; a < FITTING; a++)
    for (size_t b = 0; b < 4; b++) {
      model m;
      build_abs(&m, box[b][0], box[b][1]);
      check c = { .truth = truth_abs, .u_lo = box[b][0], .u_hi = box[b][1], .slack = 1e-14 };
      ambit_simulate_result r = run(&m, &c, 0, 1, fitting[a], NULL);
      if (r.status != AMBIT_OK || c.misses)
        fail_msg("%s, box %zu: %zu misses, t = %g, %s", fitting[a], b, c.misses, r.t_reached, r.reason);
      double x[2], y[2];
      truth_abs(1, box[b][0], x), truth_abs(1, box[b][1], y);
      assert_true(c.width < (b < 2 ? 1.05 : 3) * (y[0] - x[0]));
      model_close(&m);
    }
}

/* -- a contact spring: x'' = k max(0, -x) - 1 from rest at x0 > 0: falls, half a turn, rises; periodic */

#define STIFFNESS 100.0

static void build_contact(model *m, double lo, double hi) {
  static const char *const name[] = { "x", "v" };
  model_open(m, 2, name);
  expr depth = op(m, AMBIT_OP_MAX, number(m, 0), negative(m, m->state[0]));
  m->rate[0] = m->state[1], m->rate[1] = sub(m, mul(m, number(m, STIFFNESS), depth), number(m, 1));
  m->initial[0] = lo < hi ? ambit_graph_unknown(m->graph, "x0", (ambit_interval) { lo, hi }) : number(m, lo);
  m->initial[1] = number(m, 0);
}

static void truth_contact(double t, double u, double *x) {
  double fall = sqrt(2 * u), w = sqrt(STIFFNESS), v = fall; /* hits x = 0 at -v after `fall` */
  /* inside: x = A (cos wt - 1) - (v / w) sin wt, A = 1/k + ..., until x = 0 again */
  double a = 1 / STIFFNESS, phase = atan2(v / w, a), inside = (2 * M_PI - 2 * phase) / w;
  double period = 2 * fall + inside, s = fmod(t, period);
  if (s <= fall)
    x[0] = u - s * s / 2, x[1] = -s;
  else if (s <= fall + inside) {
    double q = w * (s - fall);
    x[0] = -a + a * cos(q) - v / w * sin(q), x[1] = -a * w * sin(q) - v * cos(q);
  } else {
    double q = s - fall - inside;
    x[0] = v * q - q * q / 2, x[1] = v - q;
  }
}

static void contact_spring(void **unused) {
  (void)unused;
  for (size_t a = 0; a < FITTING; a++) {
    model m;
    build_contact(&m, 1, 1);
    check c = { .truth = truth_contact, .u_lo = 1, .u_hi = 1, .slack = 1e-12 };
    ambit_simulate_result r = run(&m, &c, 0, a ? 2 : 10, fitting[a], NULL);
    if (r.status != AMBIT_OK || c.misses || !(c.width < 1e-3))
      fail_msg("%s: %zu misses, width %g, t = %g, %s", fitting[a], c.misses, c.width, r.t_reached, r.reason);
    model_close(&m);
  }
  model m;
  build_contact(&m, 0.99, 1.01);
  check c = { .truth = truth_contact, .u_lo = 0.99, .u_hi = 1.01, .slack = 1e-12 };
  ambit_simulate_result r = run(&m, &c, 0, 2, NULL, NULL);
  if (r.status != AMBIT_OK || c.misses || !(c.width < 2))
    fail_msg("uncertain: %zu misses, width %g, t = %g, %s", c.misses, c.width, r.t_reached, r.reason);
  model_close(&m);
}

/* -- friction that saturates: v' = -max(-1, min(1, 10 v)): constant deceleration, then decay from v = 0.1 */

static void build_friction(model *m) {
  static const char *const name[] = { "v" };
  model_open(m, 1, name);
  expr inner = op(m, AMBIT_OP_MIN, number(m, 1), mul(m, number(m, 10), m->state[0]));
  m->rate[0] = negative(m, op(m, AMBIT_OP_MAX, number(m, -1), inner));
  m->initial[0] = ambit_graph_unknown(m->graph, "v0", (ambit_interval) { 0.9, 1.1 });
}

static void truth_friction(double t, double u, double *x) {
  double until = u - 0.1;
  x[0] = t < until ? u - t : 0.1 * exp(-10 * (t - until));
}

static void saturated_friction(void **unused) {
  (void)unused;
  for (size_t a = 0; a < FITTING; a++) {
    model m;
    build_friction(&m);
    check c = { .truth = truth_friction, .u_lo = 0.9, .u_hi = 1.1, .slack = 1e-14 };
    ambit_simulate_result r = run(&m, &c, 0, 3, fitting[a], NULL);
    if (r.status != AMBIT_OK || c.misses || !(c.width < 0.05))
      fail_msg("%s: %zu misses, width %g, t = %g, %s", fitting[a], c.misses, c.width, r.t_reached, r.reason);
    model_close(&m);
  }
}

/* -- x' = sqrt |x| from 0: every (t - u)^2 / 4 after u, and 0 */

static void truth_root(double t, double u, double *x) { x[0] = t > u ? (t - u) * (t - u) / 4 : 0; }

static void all_solutions_of_a_root(void **unused) {
  (void)unused;
  static const char *const name[] = { "x" };
  model m;
  model_open(&m, 1, name);
  expr size = op(&m, AMBIT_OP_ABS, m.state[0], m.state[0]);
  m.rate[0] = op(&m, AMBIT_OP_SQRT, size, size);
  m.initial[0] = number(&m, 0);
  check c = { .truth = truth_root, .u_lo = 0, .u_hi = 2, .slack = 1e-15 };
  ambit_simulate_result r = run(&m, &c, 0, 1, NULL, NULL);
  assert_true(r.status == AMBIT_OK || r.status == AMBIT_UNABLE);
  assert_true(r.status == AMBIT_OK || r.reason[0]);
  assert_int_equal(c.misses, 0);
  assert_true(c.steps > 0 && c.width < 2);
  model_close(&m);
}

/* -- x' = max(sin x, sqrt max(0, x)): the root has no bounded slopes over 0, which the other operand must not hide */

static void truth_hidden_root(double t, double u, double *x) { x[0] = u > 0 ? pow(sqrt(u) + t / 2, 2) : u; }

static void unbounded_slopes_are_not_lost(void **unused) {
  (void)unused;
  static const char *const name[] = { "x" };
  for (size_t a = 0; a < WITH_FUNCTIONS; a++) {
    model m;
    model_open(&m, 1, name);
    expr positive = op(&m, AMBIT_OP_MAX, m.state[0], number(&m, 0));
    m.rate[0] = op(&m, AMBIT_OP_MAX, sine(&m, m.state[0]), op(&m, AMBIT_OP_SQRT, positive, positive));
    m.initial[0] = ambit_graph_unknown(m.graph, "x0", (ambit_interval) { -0.1, 0.1 });
    check c = { .truth = truth_hidden_root, .u_lo = -0.1, .u_hi = 0.1, .slack = 1e-14 };
    ambit_simulate_result r = run(&m, &c, 0, 0.5, fitting[a], NULL);
    if (r.status != AMBIT_OK || c.misses)
      fail_msg("%s: %zu misses, t = %g, %s", fitting[a], c.misses, r.t_reached, r.reason);
    model_close(&m);
  }
}

/* -- x' = -|x|, y' = x (2 - x) - y: y' grows with x, which an evaluation over all of x would not see */

static void truth_fed(double t, double u, double *x) {
  double e = exp(-t);
  truth_abs(t, u, x);
  x[1] = u > 0 ? u * u * (e * e - e) + 2 * u * t * e : (u / e - u * e) - u * u / 3 * (1 / (e * e) - e);
}

static void monotone_states_are_put_to_their_ends(void **unused) {
  (void)unused;
  static const char *const name[] = { "x", "y" };
  for (size_t a = 0; a < 2; a++) {
    model m;
    model_open(&m, 2, name);
    expr x = m.state[0];
    m.rate[0] = negative(&m, op(&m, AMBIT_OP_ABS, x, x));
    m.rate[1] = sub(&m, mul(&m, x, sub(&m, number(&m, 2), x)), m.state[1]);
    m.initial[0] = ambit_graph_unknown(m.graph, "x0", (ambit_interval) { -0.3, 0.5 });
    m.initial[1] = number(&m, 0);
    check c = { .truth = truth_fed, .u_lo = -0.3, .u_hi = 0.5, .slack = 1e-14 };
    ambit_simulate_result r = run(&m, &c, 0, 1, fitting[a], NULL);
    if (r.status != AMBIT_OK || c.misses || !(c.width < 2.5))
      fail_msg("%s: %zu misses, width %g, t = %g, %s", fitting[a], c.misses, c.width, r.t_reached, r.reason);
    model_close(&m);
  }
}

/* -- a run that ends at a kink says at which */

static void kinks_are_named(void **unused) {
  (void)unused;
  model m;
  build_contact(&m, 0.5, 1.5);
  check c = { .truth = truth_contact, .u_lo = 0.5, .u_hi = 1.5, .slack = 1e-12 };
  ambit_simulate_result r = run(&m, &c, 0, 4, NULL, NULL);
  assert_int_equal(r.status, AMBIT_UNABLE);
  assert_int_equal(c.misses, 0);
  if (!strstr(r.reason, "max(") || !strstr(r.reason, "kink")) fail_msg("no kink is named by: %s", r.reason);
  model_close(&m);
}

/* -- stiff and oscillating */

static void build_stiff(model *m) { /* x' = -1000 (x - cos t) */
  static const char *const name[] = { "x" };
  model_open(m, 1, name);
  m->rate[0] = mul(m, number(m, -1000), sub(m, m->state[0], cosine(m, ambit_graph_time(m->graph))));
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { 0, 2 });
}

static void truth_stiff(double t, double u, double *x) {
  double particular = (1e6 * cos(t) + 1e3 * sin(t)) / (1e6 + 1);
  x[0] = particular + (u - 1e6 / (1e6 + 1)) * exp(-1000 * t);
}

static void build_turn(model *m) { /* a decaying oscillation of frequency 50 */
  static const char *const name[] = { "x", "y" };
  model_open(m, 2, name);
  expr d = number(m, -0.5), w = number(m, 50);
  m->rate[0] = add(m, mul(m, d, m->state[0]), mul(m, w, m->state[1]));
  m->rate[1] = sub(m, mul(m, d, m->state[1]), mul(m, w, m->state[0]));
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { 0.9, 1.1 });
  m->initial[1] = number(m, 0);
}

static void truth_turn(double t, double u, double *x) {
  x[0] = u * exp(-0.5 * t) * cos(50 * t), x[1] = -u * exp(-0.5 * t) * sin(50 * t);
}

static void exponential_enclosures(void **unused) {
  (void)unused;
  static const char *const kind[] = { "auto", "on", "off" };
  size_t steps[3];
  for (size_t k = 0; k < 3; k++) {
    ambit_option option = { "exponential", kind[k] };
    model m;
    build_stiff(&m);
    check c = { .truth = truth_stiff, .u_lo = 0, .u_hi = 2, .slack = 1e-14 };
    ambit_simulate_result r = run(&m, &c, 0, 0.2, NULL, &option);
    if (r.status != AMBIT_OK || c.misses || !(c.width < 1e-9))
      fail_msg("stiff, %s: %zu misses, width %g, t = %g, %s", kind[k], c.misses, c.width, r.t_reached, r.reason);
    steps[k] = c.steps;
    model_close(&m);
    build_turn(&m);
    c = (check) { .truth = truth_turn, .u_lo = 0.9, .u_hi = 1.1, .slack = 1e-13 };
    r = run(&m, &c, 0, 2, NULL, &option);
    if (r.status != AMBIT_OK || c.misses || !(c.width < 0.21 * exp(-1)))
      fail_msg("turn, %s: %zu misses, width %g, t = %g, %s", kind[k], c.misses, c.width, r.t_reached, r.reason);
    model_close(&m);
  }
  assert_true(steps[0] < steps[2]); /* stiffness does not bound the step of the exponential enclosure */
}

/* -- x' = e^-x from 0: nothing but its motion gives the state a size */

static void truth_from_zero(double t, double u, double *x) {
  (void)u;
  x[0] = log1p(t);
}

static void starts_at_zero(void **unused) {
  (void)unused;
  static const char *const name[] = { "x" };
  for (size_t a = 0; a < WITH_FUNCTIONS; a++) {
    model m;
    model_open(&m, 1, name);
    expr down = negative(&m, m.state[0]);
    m.rate[0] = op(&m, AMBIT_OP_EXP, down, down);
    m.initial[0] = number(&m, 0);
    check c = { .truth = truth_from_zero, .slack = 1e-15 };
    ambit_simulate_result r = run(&m, &c, 0, 1, fitting[a], NULL);
    if (r.status != AMBIT_OK || c.misses || !(c.width < 1e-11))
      fail_msg("%s: %zu misses, width %g, t = %g, %s", fitting[a], c.misses, c.width, r.t_reached, r.reason);
    model_close(&m);
  }
}

/* a truth that is a little different is noticed */
static void wrong_stiff(double t, double u, double *x) {
  truth_stiff(t, u, x);
  x[0] += 1e-6;
}

static void checks_can_fail(void **unused) {
  (void)unused;
  model m;
  build_stiff(&m);
  check c = { .truth = wrong_stiff, .u_lo = 0, .u_hi = 2, .slack = 1e-14 };
  run(&m, &c, 0, 0.2, NULL, NULL);
  assert_true(c.misses > 0);
  model_close(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(absolute_value),
    cmocka_unit_test(contact_spring),
    cmocka_unit_test(saturated_friction),
    cmocka_unit_test(all_solutions_of_a_root),
    cmocka_unit_test(unbounded_slopes_are_not_lost),
    cmocka_unit_test(monotone_states_are_put_to_their_ends),
    cmocka_unit_test(kinks_are_named),
    cmocka_unit_test(exponential_enclosures),
    cmocka_unit_test(starts_at_zero),
    cmocka_unit_test(checks_can_fail),
  };
  return cmocka_run_group_tests_name("solver valencia, kinks and stiffness", tests, NULL, NULL);
}
