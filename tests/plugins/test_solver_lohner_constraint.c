/* Invariants in the Lohner integrator, the nasty side: random boxes around manifolds with random solutions on them;
** constraints that depend on others, say nothing, contradict the set, are undefined, badly scaled, or lose rank. */
#include "constrained_models.h"
#include "solver_track.h"

#define BITS 300
#define COUNT(array) (sizeof(array) / sizeof *(array))

static void set_box(constrained *c, size_t n, const double *at, double radius) {
  for (size_t i = 0; i < n; i++) c->m.initial[i] = unknown(&c->m, c->m.name[i], at[i] - radius, at[i] + radius);
}

/* -- random boxes: every solution that starts in the box and on the manifold is in all enclosures */

typedef struct sampler {
  size_t nx;
  void (*build)(constrained *c);
  void (*point)(uint64_t *random, double radius, const double *at, mpfr_t *x); /* on the manifold, near `at` */
  void (*centre)(uint64_t *random, double *at);
} sampler;

static void spin(constrained *c) { model_quaternion(c, 1, 0); }
static void swing(constrained *c) { model_cartesian_pendulum(c, 0); }

/* every other one along an axis, where a coordinate is normal to the manifold and the hull shows every miss */
static void any_unit(uint64_t *random, double *at) {
  double sum = 0;
  memset(at, 0, 4 * sizeof *at);
  at[oracle_random(random) % 4] = oracle_random(random) % 2 ? 1 : -1;
  if (oracle_random(random) % 2) return;
  for (int i = 0; i < 4; i++) at[i] = oracle_uniform(random, -1, 1), sum += at[i] * at[i];
  for (int i = 0; i < 4; i++) at[i] /= sqrt(sum);
}

static void near_unit(uint64_t *random, double radius, const double *at, mpfr_t *x) {
  mpfr_t sum;
  mpfr_init2(sum, SERIES_BITS);
  mpfr_set_zero(sum, 1);
  for (int i = 0; i < 4; i++) {
    double off = oracle_random(random) % 2 ? 0.999 * radius : oracle_uniform(random, -radius, radius);
    mpfr_set_d(x[i], at[i] + off, MPFR_RNDN);
    mpfr_fma(sum, x[i], x[i], sum, MPFR_RNDN);
  }
  mpfr_sqrt(sum, sum, MPFR_RNDN);
  for (int i = 0; i < 4; i++) mpfr_div(x[i], x[i], sum, MPFR_RNDN);
  mpfr_clear(sum);
}

static void any_swing(uint64_t *random, double *at) {
  double a = oracle_uniform(random, -3, 3), w = oracle_uniform(random, -2, 2);
  if (oracle_random(random) % 2) a = 0;
  at[0] = cos(a), at[1] = sin(a), at[2] = -w * at[1], at[3] = w * at[0];
}

static void near_swing(uint64_t *random, double radius, const double *at, mpfr_t *x) {
  mpfr_t a, w;
  mpfr_inits2(SERIES_BITS, a, w, (mpfr_ptr)0);
  mpfr_set_d(a, atan2(at[1], at[0]) + 0.9 * oracle_uniform(random, -radius, radius), MPFR_RNDN);
  mpfr_set_d(w, at[3] * at[0] - at[2] * at[1] + 0.9 * oracle_uniform(random, -radius, radius), MPFR_RNDN);
  mpfr_sin_cos(x[1], x[0], a, MPFR_RNDN);
  mpfr_mul(x[2], w, x[1], MPFR_RNDN), mpfr_neg(x[2], x[2], MPFR_RNDN);
  mpfr_mul(x[3], w, x[0], MPFR_RNDN);
  mpfr_clears(a, w, (mpfr_ptr)0);
}

static int is_inside(size_t n, mpfr_t *x, const double *at, double radius) {
  for (size_t i = 0; i < n; i++)
    if (mpfr_cmp_d(x[i], at[i] - radius) < 0 || mpfr_cmp_d(x[i], at[i] + radius) > 0) return 0;
  return 1;
}

/* misses of up to `samples` solutions, and how many there were */
static size_t follow_samples(const sampler *s, const track *k, const constrained *c, uint64_t *random, const double *at,
    double radius, const double *time, size_t samples, size_t *followed) {
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_problem p;
  solution_oracle o;
  size_t misses = 0;
  const ambit_problem_request q = { .system = &c->m.system,
    .initial = c->m.initial,
    .ntime = 2,
    .time = time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL,
    .seal = AMBIT_SEAL_KEEP };
  if (ambit_problem_build(&q, arena, &p, &f) != AMBIT_OK) fail_msg("%s", f.message);
  solution_open(&o, &p);
  mpfr_t x[4];
  mpfr_inits2(SERIES_BITS, x[0], x[1], x[2], x[3], (mpfr_ptr)0);
  for (size_t n = 0; n < samples; n++) {
    s->point(random, radius, at, x);
    if (!is_inside(s->nx, x, at, radius)) continue;
    for (uint32_t i = 0; i < s->nx; i++) mpfr_set(*solution_state(&o, i), x[i], MPFR_RNDN);
    mpfr_set_d(o.t, time[0], MPFR_RNDN);
    misses += track_follow(k, &o, 1);
    ++*followed;
  }
  mpfr_clears(x[0], x[1], x[2], x[3], (mpfr_ptr)0);
  solution_close(&o);
  ambit_arena_close(arena);
  return misses;
}

static void random_boxes_keep_their_solutions(void **unused) {
  (void)unused;
  static const sampler list[] = { { 4, spin, near_unit, any_unit }, { 4, swing, near_swing, any_swing } };
  static const ambit_option option[] = { { "set", "auto" }, { "set", "qr" }, { "pieces", "1" }, { "history", "4" } };
  uint64_t random = 4242;
  size_t followed = 0;
  for (int n = 0; n < 32; n++) {
    const sampler *s = &list[n % 2];
    double at[4], radius = exp2(oracle_uniform(&random, n % 4 ? -6 : -46, -2)), time[] = { 0, n % 3 ? 0.4 : -1e-3 };
    constrained c;
    s->build(&c);
    s->centre(&random, at);
    set_box(&c, s->nx, at, radius);
    track k = track_run(&c.m, 2, time, 1, &option[(size_t)n / 2 % COUNT(option)]);
    if (k.result.status == AMBIT_DOMAIN) fail_msg("%s", k.result.reason);
    if (follow_samples(s, &k, &c, &random, at, radius, time, 4, &followed)) fail_msg("box %d, radius %g", n, radius);
    track_close(&k);
    model_close(&c.m);
  }
  assert_true(followed > 60);
}

/* -- boxes and uncertain data of the constraint itself */

static void a_box_is_cut_at_once(void **unused) {
  (void)unused;
  static const double at[] = { 1, 0, 0, 0 }, time[] = { 0, 1e-9 }, radius[] = { 1e-2, 1e-5, 1e-8 };
  for (size_t n = 0; n < COUNT(radius); n++) {
    constrained c;
    model_quaternion(&c, 0, 0);
    set_box(&c, 4, at, radius[n]);
    track k = track_run(&c.m, 2, time, 0, NULL);
    assert_int_equal(k.result.status, AMBIT_OK);
    const track_record *r = &k.record[k.count - 1];
    assert_true(r->hi[0] - r->lo[0] < 4.2 * radius[n] * radius[n] + 1e-15);
    for (size_t i = 1; i < 4; i++) assert_true(r->hi[i] - r->lo[i] < 2.001 * radius[n]);
    track_close(&k);
    model_close(&c.m);
  }
}

/* (x, y) on a circle of uncertain radius L, turning with it: x' = -y, y' = x; the box does not know L, the constraint
** does. x(t) = L cos t, and L stays the same number. */
static void data_of_the_constraint_stay_correlated(void **unused) {
  (void)unused;
  static const char *const name[] = { "x", "y" };
  const double time[] = { 0, 1 };
  constrained c;
  constrained_open(&c, 2, name);
  model *m = &c.m;
  expr L = unknown(m, "L", 0.99, 1.01), slack = unknown(m, "slack", 0.98, 1.02);
  m->rate[0] = mul(m, L, negative(m, m->state[1])), m->rate[1] = mul(m, L, m->state[0]);
  m->initial[0] = slack, m->initial[1] = number(m, 0);
  constrained_add(&c, "circle", sub(m, sum_of_squares(m, 2, m->state), square(m, L)));
  track k = track_run(m, 2, time, 0, NULL);
  assert_int_equal(k.result.status, AMBIT_OK);
  const track_record *r = &k.record[k.count - 1];
  double least = INFINITY, most = -INFINITY;
  for (int i = 0; i <= 100; i++) { /* x = L cos(L t) */
    double l = 0.99 + 0.0002 * i, x = l * cos(l);
    least = fmin(least, x), most = fmax(most, x);
    assert_true(r->lo[0] <= x && x <= r->hi[0] && r->lo[1] <= l * sin(l) && l * sin(l) <= r->hi[1]);
  }
  assert_true(r->hi[0] - r->lo[0] < 1.25 * (most - least)); /* 4.9 times that without the constraint */
  track_close(&k);
  model_close(m);
}

/* a x + b y = 0 in a box that is very long in x: what is left is the segment |x| <= |b/a|, and no ulp less */
static void cuts_are_rounded_outward(void **unused) {
  (void)unused;
  static const char *const name[] = { "x", "y" };
  const double time[] = { 0, 1 };
  uint64_t random = 31;
  mpfr_t end;
  mpfr_init2(end, BITS);
  for (int n = 0; n < 200; n++) {
    double a = oracle_uniform(&random, 1, 2), b = oracle_uniform(&random, 0.1, 2), far = exp2(10 + n % 40);
    constrained c;
    constrained_open(&c, 2, name);
    model *m = &c.m;
    m->rate[0] = m->rate[1] = number(m, 0);
    m->initial[0] = unknown(m, "x", -far, far), m->initial[1] = unknown(m, "y", -1, 1);
    constrained_add(
        &c, "line", add(m, mul(m, number(m, n % 2 ? a : -a), m->state[0]), mul(m, number(m, b), m->state[1])));
    track k = track_run(m, 2, time, 0, NULL);
    if (k.result.status != AMBIT_OK) fail_msg("%s", k.result.reason);
    const track_record *r = &k.record[k.count - 1];
    mpfr_set_d(end, b, MPFR_RNDN), mpfr_div_d(end, end, a, MPFR_RNDN);
    assert_true(mpfr_cmp_d(end, r->hi[0]) <= 0 && r->lo[0] == -r->hi[0] && r->hi[0] < b / a + 5 / far + 1e-15 * far);
    track_close(&k);
    model_close(m);
  }
  mpfr_clear(end);
}

/* -- constraints that are no help */

static void compare_widths(constrained *c, const char *what, double factor) {
  const double time[] = { 0, 10 };
  size_t k = c->m.system.ninvariant;
  c->m.system.ninvariant = 1;
  track one = track_run(&c->m, 2, time, 0, NULL);
  c->m.system.ninvariant = k;
  track all = track_run(&c->m, 2, time, 0, NULL);
  if (all.result.status != AMBIT_OK) fail_msg("%s: %s", what, all.result.reason);
  double a = track_widest(&one, &one.record[one.count - 1]), b = track_widest(&all, &all.record[all.count - 1]);
  if (!(b <= factor * a)) fail_msg("%s: %g instead of %g", what, b, a);
  assert_int_equal(track_check(&all, &c->m, 2, time, 3, 1), 0);
  track_close(&one), track_close(&all);
  model_close(&c->m);
}

static void dependent_and_empty_constraints_do_no_harm(void **unused) {
  (void)unused;
  for (int n = 0; n < 2; n++) {
    constrained c;
    model_quaternion(&c, 1, n ? 1e-6 : 0);
    model *m = &c.m;
    expr norm = c.invariant[0];
    constrained_add(&c, "zero", number(m, 0));
    constrained_add(&c, "zero that is not seen",
        sub(m, mul(m, m->state[0], sine(m, m->state[1])), mul(m, sine(m, m->state[1]), m->state[0])));
    constrained_add(&c, "norm again", norm);
    constrained_add(&c, "twice the norm", mul(m, number(m, 2), norm));
    constrained_add(&c, "its square", square(m, norm)); /* no slope on the manifold */
    compare_widths(&c, "dependent", 1.05);
  }
}

static void scales_do_not_matter(void **unused) {
  (void)unused;
  static const double scale[] = { 1e9, 1e-9, 0x1p-500, 0x1p500 };
  for (size_t n = 0; n < COUNT(scale); n++) {
    constrained c;
    model_cartesian_pendulum(&c, 0);
    model *m = &c.m;
    const expr plain[] = { c.invariant[0], c.invariant[1] };
    const double time[] = { 0, 10 };
    track one = track_run(m, 2, time, 0, NULL);
    c.invariant[0] = mul(m, number(m, scale[n]), plain[0]);
    c.invariant[1] = mul(m, number(m, 1 / scale[n]), plain[1]);
    track other = track_run(m, 2, time, 0, NULL);
    double a = track_widest(&one, &one.record[one.count - 1]), b = track_widest(&other, &other.record[other.count - 1]);
    if (!(b < 1.1 * a)) fail_msg("scale %g: %g instead of %g", scale[n], b, a);
    track_close(&one), track_close(&other);
    model_close(m);
  }
}

/* states in units that differ by 18 orders of magnitude */
static void units_do_not_matter(void **unused) {
  (void)unused;
  static const char *const name[] = { "X", "Y" };
  const double big = 1e9, time[] = { 0, 50 };
  double width[2][2];
  for (int n = 0; n < 2; n++) {
    double unit = n ? big : 1;
    constrained c;
    constrained_open(&c, 2, name);
    model *m = &c.m;
    expr x = divide(m, m->state[0], number(m, unit)), y = mul(m, m->state[1], number(m, unit));
    expr w = add(m, number(m, 1), mul(m, number(m, 0.5), mul(m, x, y)));
    m->rate[0] = mul(m, number(m, unit), mul(m, w, negative(m, y)));
    m->rate[1] = divide(m, mul(m, w, x), number(m, unit));
    m->initial[0] = mul(m, number(m, unit), decimal(m, "0.6"));
    m->initial[1] = divide(m, decimal(m, "0.8"), number(m, unit));
    constrained_add(&c, "circle", sub(m, add(m, square(m, x), square(m, y)), number(m, 1)));
    track k = track_run(m, 2, time, 0, NULL);
    if (k.result.status != AMBIT_OK) fail_msg("unit %g: %s", unit, k.result.reason);
    const track_record *r = &k.record[k.count - 1];
    width[n][0] = (r->hi[0] - r->lo[0]) / unit, width[n][1] = (r->hi[1] - r->lo[1]) * unit;
    track_close(&k);
    model_close(m);
  }
  for (int i = 0; i < 2; i++) assert_true(width[1][i] < 2 * width[0][i] + 1e-15);
}

/* not defined on half of the orbit: not used there, and nothing is lost */
static void undefined_constraints_are_left_out(void **unused) {
  (void)unused;
  static const double time[] = { 0, 10 };
  constrained c;
  model_energy_oscillator(&c, 0.01);
  model *m = &c.m;
  c.invariant[0] = mul(m, c.invariant[0], root(m, m->state[0]));
  track k = track_run(m, 2, time, 0, NULL);
  assert_int_equal(k.result.status, AMBIT_OK);
  assert_int_equal(track_check(&k, m, 2, time, 5, 1), 0);
  track_close(&k);
  model_close(m);
}

/* -- contradictions */

static void a_set_off_the_manifold_is_refused_by_name(void **unused) {
  (void)unused;
  static const double time[] = { 0, 1 }, off[] = { 1e-1, 1e-6, 1e-12 };
  for (size_t n = 0; n < COUNT(off); n++) {
    constrained c;
    model_quaternion(&c, 0, 0);
    c.m.initial[0] = number(&c.m, 1 + off[n]), c.m.initial[1] = number(&c.m, 0);
    track k = track_run(&c.m, 2, time, 0, NULL);
    assert_int_equal(k.result.status, AMBIT_DOMAIN);
    assert_int_equal(k.count, 0);
    if (!strstr(k.result.reason, "`spin: norm`") || !strstr(k.result.reason, "initial set"))
      fail_msg("%s", k.result.reason);
    track_close(&k);
    model_close(&c.m);
  }
}

/* x stays 1 at the start only */
static void a_false_invariant_is_found_out(void **unused) {
  (void)unused;
  static const double time[] = { 0, 1 };
  constrained c;
  model_energy_oscillator(&c, 0);
  model *m = &c.m;
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0);
  c.invariant[0] = sub(m, m->state[0], number(m, 1)), c.name[0] = "wall";
  track k = track_run(m, 2, time, 0, NULL);
  assert_int_equal(k.result.status, AMBIT_UNABLE);
  assert_string_equal(k.result.code, AMBIT_CODE_UNABLE_CONSTRAINT);
  if (!strstr(k.result.reason, "`wall`") || !strstr(k.result.reason, "t = ")) fail_msg("%s", k.result.reason);
  track_close(&k);
  model_close(m);
}

/* -- rank */

/* A parallelogram of bars 1, 2, 1 on ground 2, crank a' = -1: its loop loses rank when it lies flat, at t = 1. */
static void a_flat_parallelogram_is_named(void **unused) {
  (void)unused;
  static const char *const name[] = { "a", "phi", "b" };
  static const double time[] = { 0, 3 };
  constrained c;
  constrained_open(&c, 3, name);
  model *m = &c.m;
  expr a = m->state[0], phi = m->state[1], b = m->state[2], two = number(m, 2);
  expr turn = sine(m, sub(m, phi, b)); /* 2 sin(phi - b) phi' = -sin(a - b) a', sin(phi - b) b' = -sin(a - phi) a' */
  m->rate[0] = number(m, -1);
  m->rate[1] = divide(m, sine(m, sub(m, a, b)), mul(m, two, turn));
  m->rate[2] = negative(m, divide(m, sine(m, sub(m, phi, a)), turn));
  m->initial[0] = m->initial[2] = number(m, 1), m->initial[1] = number(m, 0);
  expr x = sub(m, add(m, cosine(m, a), mul(m, two, cosine(m, phi))), add(m, two, cosine(m, b)));
  expr y = sub(m, add(m, sine(m, a), mul(m, two, sine(m, phi))), sine(m, b));
  constrained_add(&c, "loop: x", x), constrained_add(&c, "loop: y", y);
  track k = track_run(m, 2, time, 0, NULL);
  assert_int_equal(k.result.status, AMBIT_UNABLE);
  assert_true(k.result.t_reached > 0.9 && k.result.t_reached < 1);
  if (!strstr(k.result.reason, "lose rank here: `loop: ")) fail_msg("%s", k.result.reason);
  track_close(&k);
  model_close(m);
}

/* a run that ends for another reason blames nobody */
static void full_rank_is_not_blamed(void **unused) {
  (void)unused;
  static const double time[] = { 0, 30 };
  constrained c;
  model_cartesian_pendulum(&c, 0.02);
  track k = track_run(&c.m, 2, time, 0, NULL);
  assert_int_equal(k.result.status, AMBIT_UNABLE);
  assert_null(strstr(k.result.reason, "rank"));
  track_close(&k);
  model_close(&c.m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(random_boxes_keep_their_solutions),
    cmocka_unit_test(a_box_is_cut_at_once),
    cmocka_unit_test(data_of_the_constraint_stay_correlated),
    cmocka_unit_test(cuts_are_rounded_outward),
    cmocka_unit_test(dependent_and_empty_constraints_do_no_harm),
    cmocka_unit_test(scales_do_not_matter),
    cmocka_unit_test(units_do_not_matter),
    cmocka_unit_test(undefined_constraints_are_left_out),
    cmocka_unit_test(a_set_off_the_manifold_is_refused_by_name),
    cmocka_unit_test(a_false_invariant_is_found_out),
    cmocka_unit_test(a_flat_parallelogram_is_named),
    cmocka_unit_test(full_rank_is_not_blamed),
  };
  return cmocka_run_group_tests_name("solver lohner constraint", tests, NULL, NULL);
}
