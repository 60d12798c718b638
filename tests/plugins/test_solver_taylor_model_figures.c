/* What the Taylor-model integrator reaches where others break down, and its ends, records and threads. */
#include "kit/reference_models.h"
#include "kit/solution_oracle.h"
#include "graph/tape.h"
#include "verbs/simulate/problem.h"
#include <ambit/simulate.h>
#include "oracle.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define STATES 24
#define RECORDS 400
#define DENSE 48
#define TERMS 200
#define COLUMNS 24

typedef struct record {
  double from, to, lo[STATES], hi[STATES], tube_lo[STATES], tube_hi[STATES];
  uint32_t ndense, nterm, nu, exponent[TERMS * 4];
  uint32_t ncolumn;
  double mid[4][DENSE], rad[4][DENSE], column[4][COLUMNS][DENSE], about[4], scale[4], coefficient[4][TERMS], rest[4];
} record;

typedef struct track {
  ambit_sink sink; /* first */
  size_t count, nx;
  record *record;
  ambit_simulate_result result;
} track;

static void keep_set(record *k, const ambit_set *s, size_t nx) {
  if (s->nterm > TERMS || s->nu > 4 || nx > 4) return; /* no test looks at such a one: its nterm stays 0 */
  k->nterm = s->nterm, k->nu = s->nu;
  memcpy(k->exponent, s->exponent, (size_t)s->nterm * s->nu * sizeof *k->exponent);
  memcpy(k->about, s->about, s->nu * sizeof(double)), memcpy(k->scale, s->scale, s->nu * sizeof(double));
  memcpy(k->rest, s->rest, nx * sizeof(double));
  for (size_t i = 0; i < nx; i++) memcpy(k->coefficient[i], s->coefficient + i * s->nterm, s->nterm * sizeof(double));
}

static int32_t emit(ambit_sink *sink, const ambit_record *r) {
  track *t = (track *)(void *)sink;
  if (t->count == RECORDS) return 1;
  record *k = &t->record[t->count++];
  size_t bytes = r->nx * sizeof(double);
  t->nx = r->nx;
  *k = (record) { .from = r->t_from, .to = r->t_to, .ndense = r->ndense };
  memcpy(k->lo, r->lo, bytes), memcpy(k->hi, r->hi, bytes);
  memcpy(k->tube_lo, r->tube_lo, bytes), memcpy(k->tube_hi, r->tube_hi, bytes);
  for (size_t i = 0; i < r->nx && r->dense_mid && i < 4; i++) {
    assert_true(r->ndense <= DENSE);
    memcpy(k->mid[i], r->dense_mid + i * r->ndense, r->ndense * sizeof(double));
    memcpy(k->rad[i], r->dense_rad + i * r->ndense, r->ndense * sizeof(double));
    assert_true(r->ncolumn <= COLUMNS && r->ncoef_column == r->ndense);
    k->ncolumn = r->ncolumn;
    for (size_t c = 0; c < r->ncolumn; c++)
      memcpy(k->column[i][c], r->dense_column + (i * r->ncolumn + c) * r->ndense, r->ndense * sizeof(double));
  }
  if (r->set) keep_set(k, r->set, r->nx);
  return 0;
}

static track run_over(const char *arithmetic, const model *m, double from, double to, uint32_t threads, size_t noption,
    const ambit_option *option) {
  track t = { .sink = { sizeof(ambit_sink), emit, NULL } };
  ambit_failure f = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  const double time[] = { from, to };
  t.record = malloc(RECORDS * sizeof *t.record);
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "taylor_model",
    .arithmetic = arithmetic,
    .nsolver_option = noption,
    .solver_option = option,
    .initial = m->initial,
    .ntime = 2,
    .time = time,
    .threads = threads,
    .extras = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET,
    .sink = &t.sink };
  if (!t.record || ambit_simulate(&q, &t.result, NULL, &f) != AMBIT_OK) fail_msg("%s%s", m->failure.message, f.message);
  ambit_registry_close(registry);
  return t;
}

static track run(const model *m, double from, double to, uint32_t threads, size_t noption, const ambit_option *option) {
  return run_over(NULL, m, from, to, threads, noption, option);
}

static void drop(track *t) { free(t->record); }
static const record *last(const track *t) { return &t->record[t->count - 1]; }

/* -- figures */

static void one_piece_is_tight_at_1(void **unused) {
  (void)unused;
  static const double sampled[] = { .0128, .1229, .6294, 1.0191 }; /* of 20001 solutions */
  const ambit_option one = { "pieces_max", "1" };
  model m;
  model_wide_double_pendulum(&m);
  track t = run(&m, 0, 1, 1, 1, &one);
  assert_int_equal(t.result.status, AMBIT_OK);
  for (size_t i = 0; i < 4; i++) {
    double width = last(&t)->hi[i] - last(&t)->lo[i];
    assert_true(width > 0.995 * sampled[i] && width < 1.01 * sampled[i]);
  }
  drop(&t);
  model_close(&m);
}

/* DESIGN's example; the hull of 4 pi / 1000 wide angles at t = 5 was sampled with 4001 solutions */
static void splitting_goes_on_to_5(void **unused) {
  (void)unused;
  const ambit_option order = { "order", "12" };
  model m;
  model_wide_double_pendulum(&m);
  track t = run(&m, 0, 5, 1, 1, &order);
  if (t.result.status != AMBIT_OK) fail_msg("%s", t.result.reason);
  assert_true(last(&t)->hi[3] - last(&t)->lo[3] < 8.2);
  drop(&t);
  model_close(&m);
}

static void van_der_pol_from_a_box(void **unused) {
  (void)unused;
  model m;
  model_van_der_pol_box(&m);
  track t = run(&m, 0, 7, 1, 0, NULL);
  assert_int_equal(t.result.status, AMBIT_OK);
  /* sampled: [1.79998, 1.90417] x [.8479741, 1.2839373]; Flow* ends with widths .147, .591 */
  assert_true(last(&t)->lo[0] <= 1.79998 && last(&t)->hi[0] >= 1.90417 && last(&t)->hi[0] - last(&t)->lo[0] < 0.1049);
  assert_true(
      last(&t)->lo[1] <= 0.8479741 && last(&t)->hi[1] >= 1.2839373 && last(&t)->hi[1] - last(&t)->lo[1] < 0.4361);
  drop(&t);
  model_close(&m);
}

/* -- threads */

static void compare(track one, track three) {
  assert_int_equal(one.result.status, AMBIT_OK);
  assert_int_equal(one.count, three.count);
  for (size_t i = 0; i < one.count; i++) {
    assert_memory_equal(one.record[i].lo, three.record[i].lo, one.nx * sizeof(double));
    assert_memory_equal(one.record[i].hi, three.record[i].hi, one.nx * sizeof(double));
    assert_memory_equal(one.record[i].tube_lo, three.record[i].tube_lo, one.nx * sizeof(double));
  }
  drop(&one), drop(&three);
}

/* over affine forms as well, whose contexts remember what they did before */
static void threads_change_no_bit(void **unused) {
  (void)unused;
  static const ambit_option many[] = { { "order", "4" }, { "split_tolerance", "1e-10" }, { "pieces_max", "9" } };
  model m;
  model_wide_double_pendulum(&m);
  compare(run(&m, 0, 4, 1, 0, NULL), run(&m, 0, 4, 3, 0, NULL));
  for (int i = 0; i < 3; i++)
    compare(run_over("affine", &m, 0, 0.3, 1, 3, many), run_over("affine", &m, 0, 0.3, 3, 3, many));
  model_close(&m);
}

/* -- dense output and sets, judged by solutions */

static double polynomial(const record *r, size_t i, const double *u) {
  double x = 0;
  for (uint32_t t = 0; t < r->nterm; t++) {
    double term = r->coefficient[i][t];
    for (uint32_t v = 0; v < r->nu; v++) term *= pow((u[v] - r->about[v]) / r->scale[v], r->exponent[t * r->nu + v]);
    x += term;
  }
  return x;
}

static double dense(const record *r, size_t i, double s, double *rad) {
  double x = 0, more = 0;
  for (uint32_t k = r->ndense; k-- > 0;) x = x * s + r->mid[i][k], more = more * fabs(s) + r->rad[i][k];
  for (uint32_t c = 0; c < r->ncolumn; c++) {
    double column = 0;
    for (uint32_t k = r->ndense; k-- > 0;) column = column * s + r->column[i][c][k];
    more += fabs(column);
  }
  *rad = more;
  return x;
}

/* doubles judge here, so a few ulps are allowed */
static size_t count_misses(const track *t, solution_oracle *o, const double *u, double shift) {
  size_t misses = 0;
  solution_start(o, u);
  for (size_t n = 0; n < t->count; n++) {
    const record *r = &t->record[n];
    assert_true(r->ndense > 0 && r->nterm > 0);
    double middle = 0.5 * (r->from + r->to), rad;
    solution_advance(o, middle);
    for (uint32_t i = 0; i < t->nx; i++) {
      double x = dense(r, i, middle - r->from, &rad) + shift;
      misses += !solution_within(o, i, x - rad - 1e-13, x + rad + 1e-13);
    }
    solution_advance(o, r->to);
    for (uint32_t i = 0; i < t->nx; i++) {
      double x = polynomial(r, i, u) + shift, rest = r->rest[i] + 1e-13, end = dense(r, i, r->to - r->from, &rad);
      misses += !solution_within(o, i, x - rest, x + rest);
      misses += !solution_within(o, i, end - rad - 1e-13, end + rad + 1e-13);
      misses += !solution_within(o, i, r->lo[i], r->hi[i]);
      misses += !solution_within(o, i, r->tube_lo[i], r->tube_hi[i]);
    }
  }
  return misses;
}

static void records_hold_between_and_at_the_ends_of_steps(void **unused) {
  (void)unused;
  static const double samples[][2] = { { 1.25, 2.35 }, { 1.55, 2.45 }, { 1.375, 2.4375 } };
  model m;
  model_van_der_pol_box(&m);
  track t = run(&m, 0, 2, 1, 0, NULL);
  ambit_arena *arena = ambit_arena_open();
  ambit_failure f = { 0 };
  ambit_problem p;
  solution_oracle o;
  static const double time[] = { 0, 2 };
  const ambit_problem_request q = { .system = &m.system,
    .initial = m.initial,
    .ntime = 2,
    .time = time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL,
    .seal = AMBIT_SEAL_KEEP };
  assert_int_equal(t.result.status, AMBIT_OK);
  assert_int_equal(ambit_problem_build(&q, arena, &p, &f), AMBIT_OK);
  assert_int_equal(p.nu, 2);
  solution_open(&o, &p);
  for (size_t n = 0; n < COUNT(samples); n++) assert_int_equal(count_misses(&t, &o, samples[n], 0), 0);
  assert_true(count_misses(&t, &o, samples[0], 1e-6) > 10); /* the check sees a shift by a millionth */
  solution_close(&o);
  ambit_arena_close(arena);
  drop(&t);
  model_close(&m);
}

/* x'' = -x from 1 +-1 % is 0.02 |cos t| wide, and 0.02 |sin t|, in the middle of a step too; Van der Pol's box as much
** within a step as its hull is before and after */
static void dense_enclosures_are_tight_within_steps(void **unused) {
  (void)unused;
  model m;
  model_oscillator(&m);
  m.initial[0] = ambit_graph_unknown(m.graph, "x0", (ambit_interval) { 0.99, 1.01 });
  track t = run(&m, 0, 3, 1, 0, NULL);
  assert_int_equal(t.result.status, AMBIT_OK);
  for (size_t n = 0; n < t.count; n++)
    for (double share = 0; share <= 1; share += 0.0625) {
      double s = share * (t.record[n].to - t.record[n].from), at = t.record[n].from + s, rad[2];
      for (size_t i = 0; i < 2; i++) dense(&t.record[n], i, s, &rad[i]);
      assert_true(rad[0] <= 0.01 * fabs(cos(at)) + 1e-9 && rad[0] >= 0.01 * fabs(cos(at)) - 1e-9);
      assert_true(rad[1] <= 0.01 * fabs(sin(at)) + 1e-9);
    }
  drop(&t);
  model_close(&m);
  model_van_der_pol_box(&m);
  t = run(&m, 0, 2, 1, 0, NULL);
  for (size_t n = 1; n < t.count; n++) {
    const record *r = &t.record[n];
    for (size_t i = 0; i < 2; i++) {
      double begin, end, width = r->hi[i] - r->lo[i], before = t.record[n - 1].hi[i] - t.record[n - 1].lo[i];
      dense(r, i, 0, &begin), dense(r, i, r->to - r->from, &end);
      assert_true(2 * end < 1.3 * width && 2 * begin < 1.3 * before);
    }
  }
  drop(&t);
  model_close(&m);
}

/* -- ends */

static void escapes_end_with_a_reason(void **unused) {
  (void)unused;
  for (int wide = 0; wide < 2; wide++) {
    model m;
    model_escape(&m);
    if (wide) m.initial[0] = ambit_graph_unknown(m.graph, "x0", (ambit_interval) { 0.99, 1.01 });
    track t = run(&m, 0, 2, 1, 0, NULL);
    assert_int_equal(t.result.status, AMBIT_UNABLE);
    assert_true(strlen(t.result.reason) > 20);
    assert_true(t.result.t_reached > (wide ? 0.95 : 0.999) && t.result.t_reached < (wide ? 1 / 1.01 : 1));
    drop(&t);
    model_close(&m);
  }
}

/* x' = -|x - 0.5| - 1 from 1 comes to the kink at t = ln 1.5 */
static void kinks_are_named(void **unused) {
  (void)unused;
  static const char *const name[] = { "x" };
  for (int wide = 0; wide < 2; wide++) {
    model m;
    model_open(&m, 1, name);
    expr off = sub(&m, m.state[0], number(&m, 0.5)), size = ambit_graph_op(m.graph, AMBIT_OP_ABS, off, off);
    m.rate[0] = sub(&m, number(&m, -1), size);
    m.initial[0] = wide ? ambit_graph_unknown(m.graph, "x0", (ambit_interval) { 0.9, 1.1 }) : number(&m, 1);
    track t = run(&m, 0, 1, 1, 0, NULL);
    assert_int_equal(t.result.status, AMBIT_UNABLE);
    assert_true(t.result.t_reached < log(1.5));
    if (!strstr(t.result.reason, "abs(0.5 - x)")) fail_msg("%s", t.result.reason);
    drop(&t);
    model_close(&m);
  }
}

static void starting_on_a_kink_is_refused_at_once(void **unused) {
  (void)unused;
  static const char *const name[] = { "x" };
  static const uint32_t op[] = { AMBIT_OP_ABS, AMBIT_OP_MIN, AMBIT_OP_MAX };
  static const char *const said[] = { "abs(x)", "min(x, sin(x))", "max(x, sin(x))" };
  for (size_t i = 0; i < COUNT(op); i++) {
    model m;
    model_open(&m, 1, name);
    m.rate[0] = ambit_graph_op(m.graph, op[i], m.state[0], op[i] == AMBIT_OP_ABS ? m.state[0] : sine(&m, m.state[0]));
    m.initial[0] = ambit_graph_unknown(m.graph, "x0", (ambit_interval) { -1, 1 });
    track t = run(&m, 0, 1, 1, 0, NULL);
    assert_int_equal(t.result.status, AMBIT_UNABLE);
    assert_int_equal(t.count, 0);
    if (!strstr(t.result.reason, said[i])) fail_msg("%s", t.result.reason);
    drop(&t);
    model_close(&m);
  }
}

/* -- many states, many data, data that are plain intervals, zero states */

static void chains_of_24_states_with_8_data(void **unused) {
  (void)unused;
  static char text[24][8];
  static const char *name[24];
  for (size_t i = 0; i < 24; i++)
    snprintf(text[i], sizeof text[i], "%c%zu", i < 12 ? 'x' : 'v', i % 12), name[i] = text[i];
  static const ambit_option few[] = { { "pieces_max", "2" } };
  model m;
  model_open(&m, 24, name);
  for (size_t i = 0; i < 12; i++) {
    expr left = i ? sub(&m, m.state[i], m.state[i - 1]) : m.state[i];
    expr right = i < 11 ? sub(&m, m.state[i + 1], m.state[i]) : sub(&m, number(&m, 0), m.state[i]);
    expr bend = sub(&m, mul(&m, right, square(&m, right)), mul(&m, left, square(&m, left)));
    m.rate[i] = m.state[12 + i], m.rate[12 + i] = add(&m, sub(&m, right, left), mul(&m, decimal(&m, "0.3"), bend));
    m.initial[i] = i < 8 ? ambit_graph_unknown(m.graph, name[i], (ambit_interval) { 0.1, 0.11 }) : number(&m, 0);
    m.initial[12 + i] = number(&m, 0);
  }
  track t = run(&m, 0, 0.5, 1, 1, few);
  if (t.result.status != AMBIT_OK) fail_msg("%s", t.result.reason);
  for (size_t i = 0; i < 24; i++) assert_true(last(&t)->hi[i] - last(&t)->lo[i] < 0.03);
  drop(&t);
  model_close(&m);
}

/* no unknowns at all, so initial values are constants: y = 10 t - 5 t^2 */
static void points_are_followed(void **unused) {
  (void)unused;
  static const char *const name[] = { "y", "v" };
  model m;
  model_open(&m, 2, name);
  m.rate[0] = m.state[1], m.rate[1] = number(&m, -10);
  m.initial[0] = number(&m, 0), m.initial[1] = number(&m, 10);
  track t = run(&m, 0, 3, 1, 0, NULL);
  assert_int_equal(t.result.status, AMBIT_OK);
  assert_true(last(&t)->lo[0] <= -15 && last(&t)->hi[0] >= -15 && last(&t)->hi[0] - last(&t)->lo[0] < 1e-11);
  assert_true(last(&t)->lo[1] <= -20 && last(&t)->hi[1] >= -20);
  drop(&t);
  model_close(&m);
}

static void too_many_terms_are_refused(void **unused) {
  (void)unused;
  static const char *const name[] = { "x" };
  model m;
  model_open(&m, 1, name);
  expr total = number(&m, 1);
  for (int i = 0; i < 8; i++) {
    char text[8];
    snprintf(text, sizeof text, "u%d", i);
    total = add(&m, total, ambit_graph_unknown(m.graph, text, (ambit_interval) { 0, 0.1 }));
  }
  m.rate[0] = sub(&m, number(&m, 0), m.state[0]), m.initial[0] = total;
  const ambit_option order = { "order", "12" };
  track t = { .sink = { sizeof(ambit_sink), emit, NULL } };
  ambit_failure f = { 0 };
  ambit_registry *registry = ambit_registry_open(NULL);
  static const double time[] = { 0, 1 };
  const ambit_simulate_request q = { .system = &m.system,
    .registry = registry,
    .solver = "taylor_model",
    .nsolver_option = 1,
    .solver_option = &order,
    .initial = m.initial,
    .ntime = 2,
    .time = time,
    .sink = &t.sink };
  assert_int_not_equal(ambit_simulate(&q, &t.result, NULL, &f), AMBIT_OK);
  if (!strstr(f.message, "`order`")) fail_msg("%s", f.message);
  ambit_registry_close(registry);
  model_close(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_piece_is_tight_at_1),
    cmocka_unit_test(splitting_goes_on_to_5),
    cmocka_unit_test(van_der_pol_from_a_box),
    cmocka_unit_test(threads_change_no_bit),
    cmocka_unit_test(records_hold_between_and_at_the_ends_of_steps),
    cmocka_unit_test(dense_enclosures_are_tight_within_steps),
    cmocka_unit_test(points_are_followed),
    cmocka_unit_test(escapes_end_with_a_reason),
    cmocka_unit_test(kinks_are_named),
    cmocka_unit_test(starting_on_a_kink_is_refused_at_once),
    cmocka_unit_test(chains_of_24_states_with_8_data),
    cmocka_unit_test(too_many_terms_are_refused),
  };
  return cmocka_run_group_tests_name("solver taylor_model figures", tests, NULL, NULL);
}
