/* The stiff integrator on published problems: reference digits are inside narrow enclosures, a changed datum excludes
** them, tests/bench/stiff.c measures; and random stiff systems, record by record, against 300-bit series. */
#include "kit/stiff_models.h"
#include "num/random.h"
#include "solver_track.h"

static track run_stiff(const model *m, size_t ntime, const double *time, size_t noption, const ambit_option *option) {
  track k = { .sink = { sizeof(ambit_sink), track_emit, NULL } };
  ambit_failure f = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  k.record = malloc(TRACK_RECORDS * sizeof *k.record);
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "stiff",
    .nsolver_option = noption,
    .solver_option = option,
    .initial = m->initial,
    .ntime = ntime,
    .time = time,
    .sink = &k.sink };
  if (!k.record || ambit_simulate(&q, &k.result, NULL, &f) != AMBIT_OK) fail_msg("%s%s", m->failure.message, f.message);
  ambit_registry_close(registry);
  return k;
}

/* -- published digits */

#define DIGITS 8

/* [lo, hi] of all states at the end, which must be reached; returns the relative width */
static double solve(const model *m, double end, double *lo, double *hi) {
  const double time[] = { 0, end };
  track k = run_stiff(m, 2, time, 0, NULL);
  if (k.result.status != AMBIT_OK) fail_msg("t = %g: %s", k.result.t_reached, k.result.reason);
  const track_record *r = track_at(&k, end);
  double widest = 0;
  for (size_t i = 0; i < k.nx; i++) {
    lo[i] = r->lo[i], hi[i] = r->hi[i];
    widest = fmax(widest, (hi[i] - lo[i]) / fmax(fabs(lo[i]), fabs(hi[i])));
  }
  track_close(&k);
  return widest;
}

/* is the decimal within? judged in 300 bits */
static int inside(const char *digits, double lo, double hi, double slack) {
  mpfr_t x, y;
  mpfr_init2(x, 300), mpfr_init2(y, 300);
  mpfr_set_str(x, digits, 10, MPFR_RNDN);
  mpfr_mul_d(y, x, slack, MPFR_RNDN);
  mpfr_abs(y, y, MPFR_RNDN);
  mpfr_add(x, x, y, MPFR_RNDN);
  int above = mpfr_cmp_d(x, lo) >= 0;
  mpfr_mul_2ui(y, y, 1, MPFR_RNDN);
  mpfr_sub(x, x, y, MPFR_RNDN);
  int below = mpfr_cmp_d(x, hi) <= 0;
  mpfr_clear(x), mpfr_clear(y);
  return above && below;
}

static void check_digits(model *m, double end, double width, double slack, size_t n, const char *const *digits) {
  double lo[DIGITS], hi[DIGITS];
  double widest = solve(m, end, lo, hi);
  if (!(widest <= width)) fail_msg("relative width %g at t = %g, more than %g", widest, end, width);
  for (size_t i = 0; i < n; i++)
    if (!inside(digits[i], lo[i], hi[i], slack))
      fail_msg("%s at t = %g: %s is not in [%.17g, %.17g]", m->name[i], end, digits[i], lo[i], hi[i]);
  model_close(m);
}

static const char *const van_der_pol_digits[] = { "1.7061677321704650084765", "-8.9280970102481654777515e-04" };

static void van_der_pol(void **unused) {
  (void)unused;
  static const char *const scaled[] = { "1.7061677321704650084768", "-0.89280970102481654777887" };
  model m;
  model_relaxation(&m, "1000");
  check_digits(&m, 2000, 2e-8, 1e-20, 2, van_der_pol_digits);
  model_scaled_relaxation(&m, "1e-6");
  check_digits(&m, 2, 2e-8, 1e-20, 2, scaled);
}

/* the two scalings of mu = 1e5 agree, and the first jump is over */
static void van_der_pol_of_1e10(void **unused) {
  (void)unused;
  model m;
  double lo[2], hi[2], other_lo[2], other_hi[2];
  model_relaxation(&m, "100000");
  assert_true(solve(&m, 100000, lo, hi) < 1e-6);
  model_close(&m);
  model_scaled_relaxation(&m, "1e-10");
  assert_true(solve(&m, 1, other_lo, other_hi) < 1e-6);
  model_close(&m);
  assert_true(lo[0] <= other_hi[0] && other_lo[0] <= hi[0] && hi[0] < 0);
  assert_true(lo[1] * 1e5 <= other_hi[1] + 1e-12 && other_lo[1] <= hi[1] * 1e5 + 1e-12);
}

static void robertson(void **unused) {
  (void)unused;
  static const char *const at_40[] = { "0.7158270687194050904747445", "9.185534764557763902848e-06",
    "0.2841637457458303517616" };
  static const char *const at_1e11[] = { "2.0833401497012942e-08", "8.3333607703347834e-14", "0.99999997916651517" };
  model m;
  model_point_robertson(&m);
  check_digits(&m, 40, 1e-10, 1e-20, 3, at_40);
  model_point_robertson(&m);
  check_digits(&m, 1e11, 1e-8, 1e-16, 3, at_1e11); /* that many digits are known */
}

static void hires(void **unused) {
  (void)unused;
  static const char *const digits[] = { "7.371312573325667807277e-04", "1.442485726316184658188e-04",
    "5.888729740967575007484e-05", "1.175651343283149145506e-03", "2.386356198831330468821e-03",
    "6.238968252742795786648e-03", "2.849998395185768657930e-03", "2.850001604814231342070e-03" };
  model m;
  model_hires(&m);
  check_digits(&m, 321.8122, 1e-8, 1e-15, 8, digits); /* the end is 321.8122 as a double: 3e-17 beside the decimal */
}

static void oregonator(void **unused) {
  (void)unused;
  static const char *const digits[] = { "1.0008148703185227163", "1228.1785215498879837", "132.05549428465082877" };
  model m;
  model_oregonator(&m);
  check_digits(&m, 360, 1e-8, 1e-19, 3, digits);
}

/* y = A cos t + B sin t + C exp(-1000 t), A = 1e6/(1e6 + 1), B = 1000/(1e6 + 1), C = -A */
static void forced_decay(void **unused) {
  (void)unused;
  model m;
  double lo[1], hi[1];
  mpfr_t c, s, y;
  model_stiff_cosine(&m);
  assert_true(solve(&m, 2000, lo, hi) < 1e-9);
  model_close(&m);
  mpfr_init2(c, 300), mpfr_init2(s, 300), mpfr_init2(y, 300);
  mpfr_set_ui(y, 2000, MPFR_RNDN);
  mpfr_sin_cos(s, c, y, MPFR_RNDN);
  mpfr_mul_ui(c, c, 1000000, MPFR_RNDN);
  mpfr_mul_ui(s, s, 1000, MPFR_RNDN);
  mpfr_add(y, c, s, MPFR_RNDN);
  mpfr_div_ui(y, y, 1000001, MPFR_RNDN);
  assert_true(mpfr_cmp_d(y, lo[0]) >= 0 && mpfr_cmp_d(y, hi[0]) <= 0);
  mpfr_clear(c), mpfr_clear(s), mpfr_clear(y);
}

static void a_changed_datum_is_noticed(void **unused) {
  (void)unused;
  model m;
  double lo[2], hi[2];
  model_relaxation(&m, "1000.000001");
  solve(&m, 2000, lo, hi);
  model_close(&m);
  assert_false(inside(van_der_pol_digits[0], lo[0], hi[0], 1e-20));
  assert_false(inside(van_der_pol_digits[1], lo[1], hi[1], 1e-20));
}

static void finite_escape(void **unused) {
  (void)unused;
  const double time[] = { 0, 2 };
  model m;
  model_escape(&m);
  track k = run_stiff(&m, 2, time, 0, NULL);
  assert_int_equal(k.result.status, AMBIT_UNABLE);
  assert_true(k.result.t_reached > 0.999 && k.result.t_reached < 1);
  assert_true(strlen(k.result.reason) > 20);
  track_close(&k);
  model_close(&m);
}

/* -- random systems, every record against 300 bits */

static double pick(uint64_t *random, double lo, double hi) {
  return ldexp(rint(ldexp(oracle_uniform(random, lo, hi), 20)), -20);
}

/* x_i' = -rate_i (x_i - coupling) + a quadratic term; rates from 1 to 3000 */
static void random_system(model *m, uint64_t *random, size_t n, int nonlinear, const char *spread) {
  static const char *const name[] = { "a", "b", "c", "d", "e", "f" };
  static const char *const unknown[] = { "ua", "ub", "uc", "ud", "ue", "uf" };
  model_open(m, n, name);
  for (size_t i = 0; i < n; i++) {
    expr sum = mul(m, number(m, -pick(random, 1, 2) * pow(10, floor(3.4 * (double)i / (double)n))), m->state[i]);
    for (size_t j = 0; j < n; j++)
      if (j != i) sum = add(m, sum, mul(m, number(m, pick(random, -2, 2)), m->state[j]));
    if (nonlinear) {
      expr product = mul(m, m->state[i], m->state[(i + 1) % n]);
      sum = add(m, sum, mul(m, number(m, pick(random, -1, 1)), product));
      sum = add(m, sum, sine(m, m->state[(i + 2) % n]));
    }
    m->rate[i] = sum;
    m->initial[i] = number(m, pick(random, -1, 1));
    if (spread) {
      expr xi = ambit_graph_unknown(m->graph, unknown[i], (ambit_interval) { -1, 1 });
      m->initial[i] = add(m, m->initial[i], mul(m, decimal(m, spread), xi));
    }
  }
}

static void check_random(size_t n, int nonlinear, const char *spread, uint64_t seed, int samples) {
  const double time[] = { 0, 0.125, 1 };
  uint64_t random = seed;
  model m;
  random_system(&m, &random, n, nonlinear, spread);
  track k = run_stiff(&m, 3, time, 0, NULL);
  if (k.result.status != AMBIT_OK) fail_msg("seed %u: %s", (unsigned)seed, k.result.reason);
  size_t misses = track_check(&k, &m, 3, time, samples, 1);
  if (misses) fail_msg("%zu states, seed %u: %zu misses", n, (unsigned)seed, misses);
  if (!spread) assert_true(track_widest(&k, track_at(&k, 1)) < 1e-11);
  /* a spoilt enclosure is noticed */
  if (!spread) {
    for (size_t r = 0; r < k.count; r++) k.record[r].lo[0] += 3 * (k.record[r].hi[0] - k.record[r].lo[0]);
    for (size_t r = 0; r < k.count; r++) k.record[r].hi[0] = fmax(k.record[r].hi[0], k.record[r].lo[0]);
    assert_true(track_check(&k, &m, 3, time, 1, 0) > 0);
  }
  track_close(&k);
  model_close(&m);
}

static void random_linear(void **unused) {
  (void)unused;
  for (uint64_t seed = 1; seed <= 8; seed++) check_random(1 + seed % 5, 0, NULL, seed, 1);
}

static void random_nonlinear(void **unused) {
  (void)unused;
  for (uint64_t seed = 11; seed <= 18; seed++) check_random(1 + seed % 5, 1, NULL, seed, 1);
}

static void random_sets(void **unused) {
  (void)unused;
  for (uint64_t seed = 21; seed <= 24; seed++) check_random(2 + seed % 2, 1, "1e-3", seed, 5);
}

static void twenty_four_states(void **unused) {
  (void)unused;
  const double time[] = { 0, 0.01 };
  model m;
  model_heat(&m);
  track k = run_stiff(&m, 2, time, 0, NULL);
  if (k.result.status != AMBIT_OK) fail_msg("%s", k.result.reason);
  assert_int_equal(track_check(&k, &m, 2, time, 1, 1), 0);
  assert_true(track_widest(&k, track_at(&k, 0.01)) < 1e-12);
  track_close(&k);
  model_close(&m);
}

/* all functions that a series tape may have, around a slowly moving point */
static void build_functions(model *m) {
  static const char *const name[] = { "x", "y" };
  model_open(m, 2, name);
  ambit_graph *g = m->graph;
  const expr *s = m->state;
  expr x = add(m, s[0], number(m, 3)), y = add(m, s[1], number(m, 2)), t = ambit_graph_time(g);
  expr f = add(m, ambit_graph_op(g, AMBIT_OP_ATAN2, s[0], y), ambit_graph_op(g, AMBIT_OP_LOG, x, x));
  f = add(m, f, ambit_graph_op(g, AMBIT_OP_EXP, ambit_graph_op(g, AMBIT_OP_NEG, y, y), 0));
  f = add(m, f, mul(m, sine(m, t), divide(m, ambit_graph_op(g, AMBIT_OP_SQRT, x, x), y)));
  expr h = add(m, ambit_graph_op(g, AMBIT_OP_ATAN, x, x), ambit_graph_op(g, AMBIT_OP_TANH, s[1], s[1]));
  h = add(m, h, ambit_graph_op(g, AMBIT_OP_SINH, divide(m, s[0], x), 0));
  h = add(m, h, ambit_graph_op(g, AMBIT_OP_COSH, divide(m, s[1], y), 0));
  h = add(m, h, ambit_graph_op(g, AMBIT_OP_ASIN, mul(m, s[0], decimal(m, "0.5")), 0));
  h = add(m, h, ambit_graph_op(g, AMBIT_OP_ACOS, mul(m, s[1], decimal(m, "0.5")), 0));
  h = add(m, h, ambit_graph_op(g, AMBIT_OP_TAN, mul(m, s[0], decimal(m, "0.5")), 0));
  h = add(m, h, divide(m, mul(m, square(m, s[1]), s[1]), square(m, square(m, x))));
  m->rate[0] = add(m, mul(m, number(m, -200), s[0]), f);
  m->rate[1] = add(m, mul(m, number(m, -1), s[1]), mul(m, decimal(m, "0.3"), h));
  m->initial[0] = decimal(m, "0.1"), m->initial[1] = decimal(m, "-0.2");
}

static void functions_and_directions(void **unused) {
  (void)unused;
  static const double forwards[] = { 0, 0.5, 1 }, backwards[] = { 1, 0.999, 0.99 };
  const double *times[] = { forwards, backwards };
  for (int i = 0; i < 2; i++) {
    model m;
    build_functions(&m);
    track k = run_stiff(&m, 3, times[i], 0, NULL);
    if (k.result.status != AMBIT_OK) fail_msg("%s", k.result.reason);
    assert_int_equal(track_check(&k, &m, 3, times[i], 1, 1), 0);
    assert_true(track_widest(&k, track_at(&k, times[i][2])) < 1e-10);
    track_close(&k);
    model_close(&m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(van_der_pol),
    cmocka_unit_test(van_der_pol_of_1e10),
    cmocka_unit_test(robertson),
    cmocka_unit_test(hires),
    cmocka_unit_test(oregonator),
    cmocka_unit_test(forced_decay),
    cmocka_unit_test(a_changed_datum_is_noticed),
    cmocka_unit_test(finite_escape),
    cmocka_unit_test(random_linear),
    cmocka_unit_test(random_nonlinear),
    cmocka_unit_test(random_sets),
    cmocka_unit_test(twenty_four_states),
    cmocka_unit_test(functions_and_directions),
  };
  return cmocka_run_group_tests_name("solver stiff: figures", tests, NULL, NULL);
}
