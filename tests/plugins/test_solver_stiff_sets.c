/* The stiff integrator with uncertain data: sets as polynomials of the unknowns hold sampled solutions in 300-bit
** series and the enclosures of runs with one value of the data each; spoilt ones do not; what is reached and how
** tightly. */
#include "kit/stiff_models.h"
#include "num/random.h"
#include "solver_track.h"

#define TERMS 200

/* -- a run that keeps all records, and the set of the last one */

typedef struct set_run {
  track k; /* first */
  ambit_set set;
  double about[TRACK_UNKNOWNS], scale[TRACK_UNKNOWNS], coefficient[MODEL_STATES * TERMS], rest[MODEL_STATES];
  uint32_t exponent[TERMS * TRACK_UNKNOWNS];
} set_run;

static int32_t keep_set(ambit_sink *sink, const ambit_record *r) {
  set_run *run = (set_run *)(void *)sink;
  assert_non_null(r->set);
  run->set = *r->set;
  size_t nu = r->set->nu, terms = r->set->nterm;
  assert_true(nu <= TRACK_UNKNOWNS && terms <= TERMS);
  memcpy(run->about, r->set->about, nu * sizeof(double));
  memcpy(run->scale, r->set->scale, nu * sizeof(double));
  memcpy(run->exponent, r->set->exponent, terms * nu * sizeof(uint32_t));
  memcpy(run->coefficient, r->set->coefficient, r->nx * terms * sizeof(double));
  memcpy(run->rest, r->set->rest, r->nx * sizeof(double));
  return track_emit(sink, r);
}

static void run_set(set_run *run, const model *m, size_t ntime, const double *time) {
  ambit_failure f = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  *run = (set_run) { .k.sink = { sizeof(ambit_sink), keep_set, NULL } };
  run->k.record = malloc(TRACK_RECORDS * sizeof *run->k.record);
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "stiff",
    .initial = m->initial,
    .ntime = ntime,
    .time = time,
    .extras = AMBIT_EXTRA_SET,
    .sink = &run->k.sink };
  if (!run->k.record || ambit_simulate(&q, &run->k.result, NULL, &f) != AMBIT_OK)
    fail_msg("%s%s", m->failure.message, f.message);
  if (run->k.result.status != AMBIT_OK) fail_msg("t = %g: %s", run->k.result.t_reached, run->k.result.reason);
  ambit_registry_close(registry);
}

/* sum_t coefficient_t prod v_j^e_tj of state i, in 300 bits */
static void set_value(const set_run *run, uint32_t i, const double *u, mpfr_t sum) {
  const ambit_set *set = &run->set;
  mpfr_t v, term;
  mpfr_inits2(300, v, term, (mpfr_ptr)0);
  mpfr_set_zero(sum, 1);
  for (uint32_t t = 0; t < set->nterm; t++) {
    mpfr_set_d(term, run->coefficient[i * set->nterm + t], MPFR_RNDN);
    for (uint32_t j = 0; j < set->nu; j++) {
      mpfr_set_d(v, u[j], MPFR_RNDN);
      mpfr_sub_d(v, v, run->about[j], MPFR_RNDN);
      mpfr_div_d(v, v, run->scale[j], MPFR_RNDN);
      mpfr_pow_ui(v, v, run->exponent[t * set->nu + j], MPFR_RNDN);
      mpfr_mul(term, term, v, MPFR_RNDN);
    }
    mpfr_add(sum, sum, term, MPFR_RNDN);
  }
  mpfr_clears(v, term, (mpfr_ptr)0);
}

/* states of the solution from u that are not in the set at its end */
static size_t set_misses(const set_run *run, solution_oracle *o, const double *u, double end) {
  mpfr_t x;
  size_t misses = 0;
  mpfr_init2(x, 300);
  solution_start(o, u);
  solution_advance(o, end);
  for (uint32_t i = 0; i < run->k.nx; i++) {
    set_value(run, i, u, x);
    mpfr_sub(x, x, *solution_state(o, i), MPFR_RNDN);
    mpfr_abs(x, x, MPFR_RNDN);
    misses += mpfr_cmp_d(x, run->rest[i]) > 0;
  }
  mpfr_clear(x);
  return misses;
}

static size_t sampled_misses(const set_run *run, const model *m, size_t ntime, const double *time, int samples) {
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_problem p;
  solution_oracle o;
  uint64_t random = 5;
  size_t misses = 0;
  const ambit_problem_request q = { .system = &m->system,
    .initial = m->initial,
    .ntime = ntime,
    .time = time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL,
    .seal = AMBIT_SEAL_KEEP };
  if (ambit_problem_build(&q, arena, &p, &f) != AMBIT_OK) fail_msg("%s", f.message);
  solution_open(&o, &p);
  for (int n = 0; n < samples; n++) {
    double u[TRACK_UNKNOWNS];
    for (uint32_t j = 0; j < p.nu; j++)
      u[j] = n < 1 << p.nu ? (n >> j & 1 ? p.u_hi[j] : p.u_lo[j]) : oracle_uniform(&random, p.u_lo[j], p.u_hi[j]);
    misses += set_misses(run, &o, u, time[ntime - 1]);
  }
  solution_close(&o);
  ambit_arena_close(arena);
  return misses;
}

/* every record and the last set against sampled series; the set's rest is below `rest`; spoilt ones are noticed */
static void check_sets(model *m, size_t ntime, const double *time, int samples, double rest) {
  set_run run;
  run_set(&run, m, ntime, time);
  assert_int_equal(track_check(&run.k, m, ntime, time, 3, 1), 0);
  assert_int_equal(sampled_misses(&run, m, ntime, time, samples), 0);
  for (uint32_t i = 0; i < run.k.nx; i++)
    if (!(run.rest[i] <= rest)) fail_msg("state %u: the set leaves %g open, more than %g", i, run.rest[i], rest);
  double *first = &run.coefficient[1], kept = *first; /* what state 0 has in common with the first unknown */
  *first += 2.5 * run.rest[0] + 1e-15 * fabs(kept);
  assert_true(sampled_misses(&run, m, ntime, time, samples) > 0);
  track_close(&run.k);
  model_close(m);
}

/* -- against series */

static void robertson_one_percent(void **unused) {
  (void)unused;
  static const double time[] = { 0, 0.01, 0.1 };
  model m;
  model_spread_robertson(&m, "0.01");
  check_sets(&m, 3, time, 9, 1e-10);
}

static expr unknown(model *m, const char *name, const char *radius) {
  return term(m, radius, ambit_graph_unknown(m->graph, name, (ambit_interval) { -1, 1 }));
}

/* a relaxation oscillator with mu = 20 +- 0.2 through a jump, from uncertain states */
static void uncertain_relaxation(void **unused) {
  (void)unused;
  static const double time[] = { 0, 5, 17 };
  model m;
  model_relaxation(&m, "20");
  const expr *x = m.state;
  expr mu = add(&m, number(&m, 20), unknown(&m, "mu", "0.001"));
  m.rate[1] = sub(&m, mul(&m, mu, mul(&m, sub(&m, number(&m, 1), square(&m, x[0])), x[1])), x[0]);
  m.initial[0] = add(&m, number(&m, 2), unknown(&m, "x0", "1e-4"));
  check_sets(&m, 3, time, 6, 1e-4);
}

/* every function that is composed with the unknowns, and some that are not, around a slowly moving point */
static void functions_of_unknowns(void **unused) {
  (void)unused;
  static const double forwards[] = { 0, 0.125, 0.25 }, backwards[] = { 1, 0.999, 0.99 };
  static const char *const name[] = { "x", "y" };
  for (int turn = 0; turn < 2; turn++) {
    model m;
    model_open(&m, 2, name);
    ambit_graph *g = m.graph;
    const expr *s = m.state;
    expr a = unknown(&m, "a", "0.02"), b = unknown(&m, "b", "0.03");
    expr x = add(&m, s[0], number(&m, 3)), y = add(&m, s[1], add(&m, number(&m, 2), b));
    expr f = add(&m, ambit_graph_op(g, AMBIT_OP_LOG, x, x), mul(&m, a, cosine(&m, y)));
    f = add(&m, f, ambit_graph_op(g, AMBIT_OP_EXP, ambit_graph_op(g, AMBIT_OP_NEG, y, y), 0));
    f = add(&m, f, divide(&m, ambit_graph_op(g, AMBIT_OP_SQRT, x, x), y));
    expr h = add(&m, term(&m, "1e-6", ambit_graph_op(g, AMBIT_OP_ATAN, b, b)),
        ambit_graph_op(g, AMBIT_OP_SINH, divide(&m, s[0], x), 0));
    h = add(&m, h, ambit_graph_op(g, AMBIT_OP_COSH, divide(&m, s[1], y), 0));
    h = add(&m, h, add(&m, sine(&m, mul(&m, y, s[0])), divide(&m, square(&m, s[1]), square(&m, square(&m, x)))));
    m.rate[0] = add(&m, mul(&m, add(&m, number(&m, -200), a), s[0]), f);
    m.rate[1] = add(&m, mul(&m, number(&m, -1), s[1]), mul(&m, decimal(&m, "0.3"), h));
    m.initial[0] = add(&m, decimal(&m, "0.1"), square(&m, a)), m.initial[1] = divide(&m, a, y = number(&m, 3));
    check_sets(&m, 3, turn ? backwards : forwards, 4, 2e-6);
  }
}

/* x' = -x, y' = 100 (x - y) around 0: only the unknowns move anything */
static void around_zero(void **unused) {
  (void)unused;
  static const double time[] = { 0, 0.25, 1 };
  static const char *const name[] = { "x", "y" };
  model m;
  model_open(&m, 2, name);
  const expr *x = m.state;
  m.rate[0] = mul(&m, number(&m, -1), x[0]), m.rate[1] = mul(&m, number(&m, 100), sub(&m, x[0], x[1]));
  m.initial[0] = unknown(&m, "x0", "0.1"), m.initial[1] = number(&m, 0);
  check_sets(&m, 3, time, 4, 1e-12);
}

/* -- far runs: solutions with one value of the data each are in the sets */

/* the boxes of runs of `point` models, at the end, are within the set's polynomial, taken at u, with its rest */
static size_t far_misses(const set_run *run, model *point, const double *u, double end) {
  const double time[] = { 0, end };
  set_run one;
  run_set(&one, point, 2, time);
  const track_record *r = track_at(&one.k, end);
  mpfr_t x;
  size_t misses = 0;
  mpfr_init2(x, 300);
  for (uint32_t i = 0; i < run->k.nx; i++) {
    set_value(run, i, u, x);
    double value = mpfr_get_d(x, MPFR_RNDN), room = run->rest[i] + 1e-15 * fabs(value);
    misses += !(r->lo[i] <= value + room && r->hi[i] >= value - room);
  }
  mpfr_clear(x);
  track_close(&one.k);
  model_close(point);
  return misses;
}

static void build_robertson(model *m, const char *const *rate) {
  model_point_robertson(m);
  const expr *y = m->state;
  expr a = term(m, rate[0], y[0]), b = term(m, rate[2], mul(m, y[1], y[2])), c = term(m, rate[1], square(m, y[1]));
  m->rate[0] = sub(m, b, a), m->rate[1] = sub(m, sub(m, a, b), c), m->rate[2] = c;
}

static void robertson_to_1e4(void **unused) {
  (void)unused;
  static const double time[] = { 0, 1e4 };
  static const struct {
    const char *rate[3]; /* in the order of the model's */
    double k1, k2, k3;
  } point[] = { { { "0.04", "3e7", "1e4" }, 0, 0, 0 }, { { "0.0404", "2.97e7", "1.01e4" }, 1, -1, 1 },
    { { "0.0396", "3.03e7", "0.99e4" }, -1, 1, -1 }, { { "0.0404", "3.03e7", "1.01e4" }, 1, 1, 1 },
    { { "0.0398", "2.97e7", "1.0025e4" }, -0.5, -1, 0.25 } };
  model m;
  set_run run;
  model_spread_robertson(&m, "0.01");
  run_set(&run, &m, 2, time);
  const track_record *r = track_at(&run.k, 1e4);
  /* 1 percent of the rates is about 3 percent of y1 */
  assert_true(r->hi[0] - r->lo[0] < 0.0075 && run.rest[0] < 1e-6 && run.rest[1] < 1e-11 && run.rest[2] < 1e-6);
  for (size_t i = 0; i < sizeof point / sizeof *point; i++) {
    model one;
    double u[] = { point[i].k1, point[i].k2, point[i].k3 };
    build_robertson(&one, point[i].rate);
    if (far_misses(&run, &one, u, 1e4)) fail_msg("point %zu is not in the set", i);
    u[0] -= 0.01; /* a ten-thousandth of k1 is seen */
    build_robertson(&one, point[i].rate);
    assert_true(far_misses(&run, &one, u, 1e4) > 0);
  }
  track_close(&run.k);
  model_close(&m);
}

/* two jumps, from a small set */
static void van_der_pol_set(void **unused) {
  (void)unused;
  static const double time[] = { 0, 2000 };
  static const char *const start[] = { "1.9999999999", "2", "2.0000000001" };
  model m;
  set_run run;
  model_relaxation(&m, "1000");
  m.initial[0] = add(&m, number(&m, 2), unknown(&m, "x0", "1e-10"));
  run_set(&run, &m, 2, time);
  assert_true(track_widest(&run.k, track_at(&run.k, 2000)) < 1e-9 && run.rest[0] < 1e-10);
  for (int i = 0; i < 3; i++) {
    model one;
    double u = i - 1.0;
    model_relaxation(&one, "1000");
    one.initial[0] = decimal(&one, start[i]);
    assert_int_equal(far_misses(&run, &one, &u, 2000), 0);
    u = 0.5 - u;
    model_relaxation(&one, "1000");
    one.initial[0] = decimal(&one, start[i]);
    assert_true(far_misses(&run, &one, &u, 2000) > 0);
  }
  track_close(&run.k);
  model_close(&m);
}

/* mu = 1e5 to its period, in both scalings */
static void van_der_pol_of_1e5(void **unused) {
  (void)unused;
  static const double time[] = { 0, 161500 }, scaled[] = { 0, 1.615 };
  model m;
  set_run run, other;
  model_relaxation(&m, "100000");
  run_set(&run, &m, 2, time);
  model_close(&m);
  model_scaled_relaxation(&m, "1e-10");
  run_set(&other, &m, 2, scaled);
  model_close(&m);
  const track_record *a = track_at(&run.k, time[1]), *b = track_at(&other.k, scaled[1]);
  assert_true(a->hi[0] - a->lo[0] < 1e-5 && a->lo[0] > 1.99 && a->hi[0] < 2); /* back on the branch it began on */
  double slack = 1e-12; /* 1.615 as a double is not 161500 / 1e5 */
  assert_true(a->lo[0] <= b->hi[0] + slack && b->lo[0] - slack <= a->hi[0]);
  track_close(&run.k), track_close(&other.k);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(robertson_one_percent),
    cmocka_unit_test(uncertain_relaxation),
    cmocka_unit_test(functions_of_unknowns),
    cmocka_unit_test(around_zero),
    cmocka_unit_test(robertson_to_1e4),
    cmocka_unit_test(van_der_pol_set),
    cmocka_unit_test(van_der_pol_of_1e5),
  };
  return cmocka_run_group_tests_name("solver stiff: sets", tests, NULL, NULL);
}
