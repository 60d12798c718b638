/* valencia on the paper's double pendulum, and on random systems with and without kinks, against sampled Runge-Kutta
** solutions in long double. */
#include "kit/reference_models.h"
#include <ambit/simulate.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define INSTANTS 9
#define SAMPLES 9
typedef long double real;

typedef struct check {
  ambit_sink sink; /* first */
  size_t nx, next, steps;
  double time[INSTANTS], lo[INSTANTS][4], hi[INSTANTS][4];
} check;

static int32_t watch(ambit_sink *sink, const ambit_record *r) {
  check *c = (check *)(void *)sink;
  c->steps++;
  if (c->next == INSTANTS || r->t_to != c->time[c->next]) return 0;
  memcpy(c->lo[c->next], r->lo, r->nx * sizeof(double));
  memcpy(c->hi[c->next++], r->hi, r->nx * sizeof(double));
  return 0;
}

static ambit_simulate_result run(model *m, check *c, double until, const char *arithmetic, const char *order) {
  ambit_simulate_result result;
  ambit_failure f = { 0 };
  ambit_option option = { "order", order };
  ambit_registry *registry = ambit_registry_open(NULL);
  *c = (check) { .sink = { sizeof(ambit_sink), watch, NULL }, .nx = m->system.nx, .next = 1 };
  for (int k = 0; k < INSTANTS; k++) c->time[k] = until * k / (INSTANTS - 1);
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "valencia",
    .arithmetic = arithmetic,
    .narithmetic_option = order ? 1 : 0,
    .arithmetic_option = &option,
    .initial = m->initial,
    .ntime = INSTANTS,
    .time = c->time,
    .sink = &c->sink };
  if (ambit_simulate(&q, &result, NULL, &f) != AMBIT_OK) fail_msg("%s%s", m->failure.message, f.message);
  ambit_registry_close(registry);
  return result;
}

/* -- Runge-Kutta of order 4 */

typedef struct oracle {
  size_t nx;
  void (*rate)(const void *self, const real *x, real *f);
  const void *self;
} oracle;

static void advance(const oracle *o, real *x, real h, int steps) {
  real k[4][4], y[4];
  static const real at[] = { 0, 0.5L, 0.5L, 1 };
  for (int s = 0; s < steps; s++) {
    for (int j = 0; j < 4; j++) {
      for (size_t i = 0; i < o->nx; i++) y[i] = x[i] + (j ? at[j] * h * k[j - 1][i] : 0);
      o->rate(o->self, y, k[j]);
    }
    for (size_t i = 0; i < o->nx; i++) x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
  }
}

/* misses of one sample's solution; widens [lo, hi], the sampled range at each instant */
static size_t judge(const oracle *o, const check *c, real *x, int steps, double slack, double lo[][4], double hi[][4]) {
  size_t misses = 0;
  for (size_t k = 1; k < c->next; k++) {
    advance(o, x, ((real)c->time[k] - c->time[k - 1]) / steps, steps);
    for (size_t i = 0; i < c->nx; i++) {
      misses += !(c->lo[k][i] <= x[i] + slack && x[i] - slack <= c->hi[k][i]);
      lo[k][i] = fmin(lo[k][i], (double)x[i]), hi[k][i] = fmax(hi[k][i], (double)x[i]);
    }
  }
  return misses;
}

static void reset(double lo[][4], double hi[][4]) {
  for (int k = 0; k < INSTANTS; k++)
    for (int i = 0; i < 4; i++) lo[k][i] = INFINITY, hi[k][i] = -INFINITY;
}

/* -- the double pendulum: equations 23 to 25 of the paper, solved for the accelerations */

static void pendulum(const void *self, const real *x, real *f) {
  (void)self;
  const real g = 9.81L;
  real s = sinl(x[1]), c = cosl(x[1]), out = x[2] + x[3];
  real r1 = s * out * out - 2 * g * sinl(x[0]), r2 = -g * sinl(x[0] + x[1]) - s * x[2] * x[2], d = 1 + s * s;
  f[0] = x[2], f[1] = x[3], f[2] = (r1 - c * r2) / d;
  f[3] = (2 * r2 - c * r1) / d - f[2];
}

/* Until where the paper's mean-value rule carries intervals (.5705), and the samples are inside. */
static void double_pendulum_over_intervals(void **unused) {
  (void)unused;
  model m;
  check c;
  double lo[INSTANTS][4], hi[INSTANTS][4];
  const oracle o = { 4, pendulum, NULL };
  model_wide_double_pendulum(&m);
  ambit_simulate_result r = run(&m, &c, 0.5705, "interval", NULL);
  if (r.status != AMBIT_OK) fail_msg("%s", r.reason);
  reset(lo, hi);
  for (int k = 0; k < SAMPLES; k++) {
    const real pi = acosl(-1);
    real x[4] = { 3 * pi / 4 * (1 + 0.01L * (2 * k - SAMPLES + 1) / (SAMPLES - 1)), -11 * pi / 20, 0.43L, 0.67L };
    assert_int_equal(judge(&o, &c, x, 500, 1e-11, lo, hi), 0);
  }
  model_close(&m);
}

static void double_pendulum(void **unused) {
  (void)unused;
  model m;
  check c;
  double lo[INSTANTS][4], hi[INSTANTS][4];
  const oracle o = { 4, pendulum, NULL };
  model_wide_double_pendulum(&m);
  ambit_simulate_result r = run(&m, &c, 0.4, "taylor_model", "9");
  if (r.status != AMBIT_OK) fail_msg("%s", r.reason);
  reset(lo, hi);
  for (int k = 0; k < SAMPLES; k++) {
    const real pi = acosl(-1);
    real x[4] = { 3 * pi / 4 * (1 + 0.01L * (2 * k - SAMPLES + 1) / (SAMPLES - 1)), -11 * pi / 20, 0.43L, 0.67L };
    assert_int_equal(judge(&o, &c, x, 500, 1e-11, lo, hi), 0);
  }
  for (size_t i = 0; i < 4; i++) /* and no wider than 1 % more than the truth */
    assert_true(c.hi[INSTANTS - 1][i] - c.lo[INSTANTS - 1][i] < 1.01 * (hi[INSTANTS - 1][i] - lo[INSTANTS - 1][i]));
  model_close(&m);
}

/* -- random systems: x_i' = a_i x_j + b_i x_k x_l + c_i |x_j - d_i|, weak enough to stay bounded */

typedef struct random_system {
  double a[3], b[3], c[3], d[3];
  int j[3], k[3], l[3];
} random_system;

static void random_rate(const void *self, const real *x, real *f) {
  const random_system *s = self;
  for (int i = 0; i < 3; i++)
    f[i] = s->a[i] * x[s->j[i]] + s->b[i] * x[s->k[i]] * x[s->l[i]] + s->c[i] * fabsl(x[s->j[i]] - s->d[i]);
}

static double uniform(unsigned *seed, double lo, double hi) {
  *seed = *seed * 1664525u + 1013904223u;
  return lo + (hi - lo) * (*seed >> 8) / (double)(1u << 24);
}

static void build_random(model *m, random_system *s, unsigned *seed, int kinks) {
  static const char *const name[] = { "x", "y", "z" };
  model_open(m, 3, name);
  for (int i = 0; i < 3; i++) {
    s->a[i] = uniform(seed, -2, 1), s->b[i] = uniform(seed, -1, 1), s->c[i] = kinks ? uniform(seed, -1, 1) : 0;
    s->d[i] = uniform(seed, -0.5, 0.5);
    s->j[i] = (int)uniform(seed, 0, 2.999), s->k[i] = (int)uniform(seed, 0, 2.999),
    s->l[i] = (int)uniform(seed, 0, 2.999);
    const expr *x = m->state;
    expr gap = sub(m, x[s->j[i]], number(m, s->d[i])), size = ambit_graph_op(m->graph, AMBIT_OP_ABS, gap, gap);
    expr rest =
        add(m, mul(m, number(m, s->a[i]), x[s->j[i]]), mul(m, number(m, s->b[i]), mul(m, x[s->k[i]], x[s->l[i]])));
    m->rate[i] = kinks ? add(m, rest, mul(m, number(m, s->c[i]), size)) : rest;
  }
  expr u = ambit_graph_unknown(m->graph, "u", (ambit_interval) { -0.02, 0.02 });
  for (int i = 0; i < 3; i++) m->initial[i] = add(m, number(m, 0.5 - 0.5 * i), u);
}

static void random_systems(void **unused) {
  (void)unused;
  static const char *const arithmetic[] = { "interval", "affine", "gradient", "taylor_model" };
  unsigned seed = 7;
  for (int trial = 0; trial < 40; trial++) {
    model m;
    check c;
    random_system s;
    double lo[INSTANTS][4], hi[INSTANTS][4];
    const oracle o = { 3, random_rate, &s };
    int kinks = trial % 2;
    build_random(&m, &s, &seed, kinks);
    const char *name = arithmetic[trial / 2 % 4];
    ambit_simulate_result r = run(&m, &c, 1, name, strcmp(name, "taylor_model") == 0 ? "6" : NULL);
    if (r.status != AMBIT_OK) assert_true(r.status == AMBIT_UNABLE && r.reason[0]);
    reset(lo, hi);
    for (int k = 0; k < 5; k++) {
      real u = 0.01L * (k - 2), x[3] = { 0.5L + u, u, -0.5L + u };
      size_t misses = judge(&o, &c, x, 400, kinks ? 1e-7 : 1e-10, lo, hi);
      if (misses) fail_msg("trial %d over %s: %zu misses", trial, name, misses);
    }
    /* a solution from outside is noticed */
    real x[3] = { 0.6L, 0.1L, -0.4L };
    if (c.next == INSTANTS && !kinks) assert_true(judge(&o, &c, x, 400, 1e-10, lo, hi) > 0);
    model_close(&m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(double_pendulum),
    cmocka_unit_test(double_pendulum_over_intervals), cmocka_unit_test(random_systems) };
  return cmocka_run_group_tests_name("solver valencia, figures", tests, NULL, NULL);
}
