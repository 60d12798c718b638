/* Invariants in the Lohner integrator: what they gain on systems with known manifolds, and that enclosures hold: closed
** forms, 300-bit series, published digits. */
#include "andrews_model.h"
#include "solver_track.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define BITS 300

/* the run of `end` seconds with the invariants, or without */
static track run_to(constrained *c, double end, int with, size_t noption, const ambit_option *option) {
  const double time[] = { 0, end };
  size_t k = c->m.system.ninvariant;
  if (!with) c->m.system.ninvariant = 0;
  track t = track_run(&c->m, 2, time, noption, option);
  c->m.system.ninvariant = k;
  return t;
}

static double last_width(const track *k, size_t i) {
  const track_record *r = &k->record[k->count - 1];
  return r->hi[i] - r->lo[i];
}

static double last_widest(const track *k) { return track_widest(k, &k->record[k->count - 1]); }

static size_t misses(const track *k, const constrained *c, double end, int samples) {
  const double time[] = { 0, end };
  return track_check(k, &c->m, 2, time, samples, 1);
}

/* -- unit quaternions */

/* q0 (cos, w/|w| sin)(|w| t / 2), q0 = (cos 0.4, sin 0.4, 0, 0), w = (0.3, -0.5, 0.8) */
static void turned(mpfr_t q[4], double t) {
  static const char *const w[] = { "0.3", "-0.5", "0.8" };
  mpfr_t c0, s0, c, s, r[3], x;
  mpfr_inits2(BITS, c0, s0, c, s, r[0], r[1], r[2], x, (mpfr_ptr)0);
  mpfr_set_str(x, "0.4", 10, MPFR_RNDN);
  mpfr_sin_cos(s0, c0, x, MPFR_RNDN);
  mpfr_set_str(x, "0.98", 10, MPFR_RNDN); /* |w|^2 */
  mpfr_sqrt(x, x, MPFR_RNDN);
  for (int i = 0; i < 3; i++) mpfr_set_str(r[i], w[i], 10, MPFR_RNDN), mpfr_div(r[i], r[i], x, MPFR_RNDN);
  mpfr_mul_d(x, x, t, MPFR_RNDN), mpfr_div_ui(x, x, 2, MPFR_RNDN);
  mpfr_sin_cos(s, c, x, MPFR_RNDN);
  for (int i = 0; i < 3; i++) mpfr_mul(r[i], r[i], s, MPFR_RNDN);
  mpfr_fmms(q[0], c0, c, s0, r[0], MPFR_RNDN);
  mpfr_fmma(q[1], c0, r[0], s0, c, MPFR_RNDN);
  mpfr_fmms(q[2], c0, r[1], s0, r[2], MPFR_RNDN);
  mpfr_fmma(q[3], c0, r[2], s0, r[1], MPFR_RNDN);
  mpfr_clears(c0, s0, c, s, r[0], r[1], r[2], x, (mpfr_ptr)0);
}

static void a_hundred_turns_stay_unit(void **unused) {
  (void)unused;
  static const double end = 634.7;
  constrained c;
  mpfr_t q[4];
  mpfr_inits2(BITS, q[0], q[1], q[2], q[3], (mpfr_ptr)0);
  model_quaternion(&c, 0, 0);
  track free = run_to(&c, end, 0, 0, NULL), bound = run_to(&c, end, 1, 0, NULL);
  assert_int_equal(bound.result.status, AMBIT_OK);
  for (size_t n = 0; n < bound.count; n++) {
    turned(q, bound.record[n].to);
    for (size_t i = 0; i < 4; i++) {
      assert_true(mpfr_cmp_d(q[i], bound.record[n].lo[i]) >= 0 && mpfr_cmp_d(q[i], bound.record[n].hi[i]) <= 0);
      assert_true(
          mpfr_cmp_d(q[i], bound.record[n].tube_lo[i]) >= 0 && mpfr_cmp_d(q[i], bound.record[n].tube_hi[i]) <= 0);
    }
  }
  assert_true(last_widest(&bound) < last_widest(&free) && last_widest(&bound) < 3e-12);
  assert_true(last_width(&bound, 0) < 0.5 * last_width(&free, 0));
  track_close(&free), track_close(&bound);
  model_close(&c.m);
  mpfr_clears(q[0], q[1], q[2], q[3], (mpfr_ptr)0);
}

static void varying_spin_from_uncertain_attitude(void **unused) {
  (void)unused;
  static const double spread[] = { 0, 1e-9, 0.05 };
  for (size_t n = 0; n < COUNT(spread); n++) {
    constrained c;
    model_quaternion(&c, 1, spread[n]);
    track free = run_to(&c, 7, 0, 0, NULL), bound = run_to(&c, 7, 1, 0, NULL);
    assert_int_equal(bound.result.status, AMBIT_OK);
    assert_true(last_widest(&bound) <= 1.01 * last_widest(&free) + 1e-14);
    if (misses(&bound, &c, 7, spread[n] > 0 ? 5 : 1)) fail_msg("spread %g", spread[n]);
    track_close(&free), track_close(&bound);
    model_close(&c.m);
  }
}

/* -- a pendulum in Cartesian coordinates: unstable off its manifold */

static void pendulum_on_its_circle(void **unused) {
  (void)unused;
  constrained c;
  model_cartesian_pendulum(&c, 0);
  track free = run_to(&c, 30, 0, 0, NULL), bound = run_to(&c, 30, 1, 0, NULL);
  assert_int_equal(bound.result.status, AMBIT_OK);
  assert_true(last_widest(&bound) < 0.02 * last_widest(&free) && last_widest(&bound) < 5e-11);
  assert_int_equal(misses(&bound, &c, 30, 1), 0);
  track_close(&free), track_close(&bound);
  model_close(&c.m);
}

static void an_uncertain_pendulum_is_followed_farther(void **unused) {
  (void)unused;
  static const double spread[] = { 1e-3, 2e-2 }, farther[] = { 1.5, 1.25 };
  for (size_t n = 0; n < COUNT(spread); n++) {
    constrained c;
    model_cartesian_pendulum(&c, spread[n]);
    track free = run_to(&c, 30, 0, 0, NULL), bound = run_to(&c, 30, 1, 0, NULL);
    assert_true(bound.result.t_reached > farther[n] * free.result.t_reached);
    assert_int_equal(misses(&bound, &c, 30, 4), 0);
    track_close(&free), track_close(&bound);
    model_close(&c.m);
  }
}

/* -- first integrals that depend on the uncertain data */

static void energy_of_uncertain_data(void **unused) {
  (void)unused;
  constrained c;
  model_energy_oscillator(&c, 0.1);
  track free = run_to(&c, 50, 0, 0, NULL), bound = run_to(&c, 50, 1, 0, NULL);
  assert_int_equal(bound.result.status, AMBIT_OK);
  assert_true(last_widest(&bound) <= 1.01 * last_widest(&free));
  assert_int_equal(misses(&bound, &c, 50, 8), 0);
  track_close(&free), track_close(&bound);
  model_close(&c.m);
}

static void kepler_with_its_integrals(void **unused) {
  (void)unused;
  constrained c;
  model_kepler(&c, 0);
  track free = run_to(&c, 30, 0, 0, NULL), bound = run_to(&c, 30, 1, 0, NULL);
  assert_int_equal(bound.result.status, AMBIT_OK);
  assert_true(last_widest(&bound) < 0.1 * last_widest(&free));
  assert_int_equal(misses(&bound, &c, 30, 1), 0);
  track_close(&free), track_close(&bound);
  model_close(&c.m);
  model_kepler(&c, 0.001);
  track wide = run_to(&c, 5, 1, 0, NULL);
  assert_int_equal(wide.result.status, AMBIT_OK);
  assert_int_equal(misses(&wide, &c, 5, 4), 0);
  track_close(&wide);
  model_close(&c.m);
}

/* -- a four-bar linkage: crank 1, coupler L, rocker 3, ground 3.5, in three angles */

/* the rocker's and the coupler's angle, at most some ulps off */
static void four_bar(double a, double L, double *b, double *phi) {
  double x = 3.5 - cos(a), y = -sin(a), d = hypot(x, y);
  *b = atan2(y, x) + acos((L * L - d * d - 9) / (6 * d));
  *phi = atan2(y + 3 * sin(*b), x + 3 * cos(*b));
}

static void model_four_bar(constrained *c) {
  static const char *const name[] = { "a", "phi", "b" };
  double nominal[2];
  constrained_open(c, 3, name);
  model *m = &c->m;
  expr a = m->state[0], phi = m->state[1], b = m->state[2], L = unknown(m, "L", 2.997, 3.003), r = number(m, 3);
  m->rate[0] = number(m, 1);
  m->rate[1] = negative(m, divide(m, sine(m, sub(m, b, a)), mul(m, L, sine(m, sub(m, b, phi)))));
  m->rate[2] = divide(m, sine(m, sub(m, phi, a)), mul(m, r, sine(m, sub(m, phi, b))));
  four_bar(1, 3, &nominal[1], &nominal[0]);
  m->initial[0] = number(m, 1);
  for (size_t i = 0; i < 2; i++) m->initial[1 + i] = unknown(m, name[1 + i], nominal[i] - 0.005, nominal[i] + 0.005);
  expr x = sub(m, add(m, cosine(m, a), mul(m, L, cosine(m, phi))), mul(m, r, cosine(m, b)));
  constrained_add(c, "loop: x", sub(m, x, number(m, 3.5)));
  constrained_add(c, "loop: y", sub(m, add(m, sine(m, a), mul(m, L, sine(m, phi))), mul(m, r, sine(m, b))));
}

/* Assembled for any length within its tolerance: a box; the loop knows that one length belongs to one position. */
static void a_four_bar_remembers_its_length(void **unused) {
  (void)unused;
  constrained c;
  model_four_bar(&c);
  track free = run_to(&c, 6, 0, 0, NULL), bound = run_to(&c, 6, 1, 0, NULL);
  assert_int_equal(bound.result.status, AMBIT_OK);
  double least = INFINITY, most = -INFINITY;
  for (int i = 0; i <= 60; i++)
    for (size_t n = 0; n < bound.count; n++) {
      const track_record *r = &bound.record[n];
      double b, phi;
      four_bar(1 + r->to, 2.997 + 0.0001 * i, &b, &phi);
      assert_true(r->lo[1] <= phi && phi <= r->hi[1] && r->lo[2] <= b && b <= r->hi[2]);
      if (n + 1 == bound.count) least = fmin(least, b), most = fmax(most, b);
    }
  assert_true(last_width(&bound, 2) < 1.1 * (most - least));
  assert_true(last_width(&free, 2) > 4 * (most - least));
  track_close(&free), track_close(&bound);
  model_close(&c.m);
}

/* -- Andrews' squeezer */

/* IVP Test Set at t = 0.03, good to 9 or 10 digits */
static const double published[] = { 0.1581077119629904e2, -0.1575637105984298e2, 0.4082224013073101e-1,
  -0.5347301163226948e0, 0.5244099658805304e0, 0.5347301163226948e0, 0.1048080741042263e1, 0.1139920302151208e4 };

static void andrews_squeezer_to_the_published_digits(void **unused) {
  (void)unused;
  constrained c;
  model_andrews(&c);
  track k = run_to(&c, 0.03, 1, 0, NULL);
  if (k.result.status != AMBIT_OK) fail_msg("%s%s", c.m.failure.message, k.result.reason);
  const track_record *r = &k.record[k.count - 1];
  for (size_t i = 0; i < 8; i++) {
    double size = fmax(fabs(r->lo[i]), fabs(r->hi[i])), off = fmax(r->hi[i] - published[i], published[i] - r->lo[i]);
    if (!(r->hi[i] - r->lo[i] < 2e-11 * size)) fail_msg("%s: %g wide", c.m.name[i], r->hi[i] - r->lo[i]);
    if (!(off < 1e-9 * size)) fail_msg("%s: %g off", c.m.name[i], off);
  }
  assert_true(k.count < 200);
  track_close(&k);
  track start = run_to(&c, 0.008, 1, 0, NULL);
  assert_int_equal(start.result.status, AMBIT_OK);
  assert_int_equal(misses(&start, &c, 0.008, 1), 0);
  track_close(&start);
  model_close(&c.m);
}

/* coordinates of an assembled mechanism, proved each for itself: the loops tie them together again */
static void assembled_boxes_become_one_curve(void **unused) {
  (void)unused;
  static const double at[] = { -0.06171389001427645, 0, 0.4552798191630704, 0.2226683901658859, 0.4873649795438426,
    -0.2226683901658859, 1.2305474445498212, 0 };
  constrained c;
  model_andrews(&c);
  for (size_t i = 0; i < 8; i++) c.m.initial[i] = unknown(&c.m, c.m.name[i], at[i] - 1e-9, at[i] + 1e-9);
  static const double time[] = { 0, 1e-6, 0.01 };
  track k = track_run(&c.m, COUNT(time), time, 0, NULL);
  assert_int_equal(k.result.status, AMBIT_OK);
  assert_true(k.count < 60);
  const track_record *r = track_at(&k, 1e-6);
  for (size_t i = GAMMA; i <= EPSILON; i++) assert_true(r->hi[i] - r->lo[i] < 1e-12); /* still where q' ~ 0 */
  assert_true(last_width(&k, DELTA) < 1e-9 && last_width(&k, BETA) < 1e-7);
  track_close(&k);
  model_close(&c.m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_hundred_turns_stay_unit),
    cmocka_unit_test(varying_spin_from_uncertain_attitude),
    cmocka_unit_test(pendulum_on_its_circle),
    cmocka_unit_test(an_uncertain_pendulum_is_followed_farther),
    cmocka_unit_test(energy_of_uncertain_data),
    cmocka_unit_test(kepler_with_its_integrals),
    cmocka_unit_test(a_four_bar_remembers_its_length),
    cmocka_unit_test(andrews_squeezer_to_the_published_digits),
    cmocka_unit_test(assembled_boxes_become_one_curve),
  };
  return cmocka_run_group_tests_name("solver lohner invariants", tests, NULL, NULL);
}
