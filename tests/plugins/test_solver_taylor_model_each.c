/* The Taylor-model integrator, seen from inside: for EACH value of the uncertain data its own piece's polynomial and
** the remainder of its own sub-range contain its solution, in 300-bit arithmetic, through every operation and across
** splits. That is thousands to millions of times sharper than the hull; without the remainder it fails. */
#include "host/params.h"
#include "kit/reference_models.h"
#include "kit/solution_oracle.h"
#include "graph/tape.h"
#include "verbs/simulate/problem.h"
#include "oracle.h"
#include "solver/taylor_model/flow.h"
#include "solver_case.h"
#include <stdio.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define UNKNOWNS 4
#define SAMPLES_MAX 16
#define PARTS 3 /* of a step, at which tubes are looked at */

typedef struct judge {
  ambit_sink sink; /* first */
  flow *f;
  solution_oracle oracle[SAMPLES_MAX];
  int samples, backwards;
  double xi[SAMPLES_MAX][UNKNOWNS];
  double share;       /* of the remainder that is believed */
  double tube;        /* share of the width of tubes that is believed */
  double every, last; /* records that are looked at are so far apart */
  size_t checks, misses;
  uint32_t most_pieces;
  double t;
} judge;

/* |truth - X(xi)| <= remainder of the sub-range; xi as exact doubles, so pieces' boxes cut it exactly */
static void check_state(judge *j, solution_oracle *o, const piece *p, const double *eta, uint32_t n, uint32_t i) {
  const flow *f = j->f;
  const space *s = &f->space;
  mpfr_t x, term;
  mpfr_inits2(SERIES_BITS, x, term, (mpfr_ptr)0);
  mpfr_set_zero(x, 1);
  for (uint32_t r = 0; r < s->nrow; r++)
    for (uint32_t k = 0; k < s->row[r].length; k++) {
      mpfr_set_d(term, p->x[i * s->size + s->row[r].at + k], MPFR_RNDN);
      for (uint32_t v = 0; v < f->m; v++)
        for (uint32_t e = v ? s->exponent[(size_t)r * f->m + v] : k; e > 0; e--)
          mpfr_mul_d(term, term, eta[v], MPFR_RNDN);
      mpfr_add(x, x, term, MPFR_RNDN);
    }
  mpfr_sub(x, x, *solution_state(o, i), MPFR_RNDN);
  mpfr_abs(x, x, MPFR_RNDN);
  double rest = zonotope_at(&f->worker[0].shape, p->zonotope, n).sum[i] * j->share;
  j->misses += mpfr_cmp_d(x, rest) > 0;
  j->checks++;
  mpfr_clears(x, term, (mpfr_ptr)0);
}

static void check_sample(judge *j, int k) {
  const flow *f = j->f;
  int found = 0;
  for (uint32_t q = 0; q < f->npiece; q++) {
    const piece *p = &f->piece[q];
    double eta[UNKNOWNS] = { 0 };
    int inside = 1;
    for (uint32_t v = 0; v < f->m; v++) {
      inside &= p->from[v] <= j->xi[k][v] && j->xi[k][v] <= p->to[v];
      eta[v] = (2 * j->xi[k][v] - (p->from[v] + p->to[v])) / (p->to[v] - p->from[v]);
    }
    if (!inside) continue;
    uint32_t n = 0, stride = 1;
    for (uint32_t v = 0; v < f->m; v++) {
      double digit = floor((eta[v] + 1) / 2 * f->cuts[v]);
      n += stride * (uint32_t)fmin(digit, f->cuts[v] - 1.0);
      stride *= f->cuts[v];
    }
    for (uint32_t i = 0; i < f->nx; i++) check_state(j, &j->oracle[k], p, eta, n, i);
    found = 1;
  }
  if (!found) j->misses++;
}

/* solutions lie in the tube, all the way if every record is looked at */
static void check_tube(judge *j, const ambit_record *r) {
  for (int k = 0; k < j->samples; k++)
    for (int part = j->every > 0 ? PARTS : 0; part <= PARTS; part++) {
      solution_advance(&j->oracle[k], part < PARTS ? r->t_from + (r->t_to - r->t_from) * part / PARTS : r->t_to);
      for (uint32_t i = 0; i < r->nx; i++) {
        double cut = (1 - j->tube) * 0.5 * (r->tube_hi[i] - r->tube_lo[i]);
        j->misses += !solution_within(&j->oracle[k], i, r->tube_lo[i] + cut, r->tube_hi[i] - cut);
      }
    }
}

static int32_t look(ambit_sink *sink, const ambit_record *r) {
  judge *j = (judge *)(void *)sink;
  j->t = r->t_to;
  if (j->f->npiece > j->most_pieces) j->most_pieces = j->f->npiece;
  if (fabs(r->t_to - j->last) < j->every) return 0;
  j->last = r->t_to;
  check_tube(j, r);
  for (int k = 0; k < j->samples; k++) {
    check_sample(j, k);
    for (uint32_t i = 0; i < r->nx; i++) j->misses += !solution_within(&j->oracle[k], i, r->lo[i], r->hi[i]);
  }
  return 0;
}

typedef struct run {
  ambit_status status;
  char reason[AMBIT_MESSAGE_MAX];
  size_t checks, misses;
  uint32_t most_pieces;
  double t;
} run;

/* dyadic values of the data: vertices first, then at random */
static void choose_samples(judge *j, uint32_t nu, int samples) {
  uint64_t random = 5;
  j->samples = samples;
  for (int k = 0; k < samples; k++)
    for (uint32_t v = 0; v < nu; v++)
      j->xi[k][v] = k < 1 << nu ? (k >> v & 1 ? 1 : -1) : floor(oracle_uniform(&random, -1, 1) * 0x1p20) * 0x1p-20;
}

static run follow_with(model *m, double from, double to, double every, int samples, double share, double tube,
    size_t noption, const ambit_option *option) {
  solver_case c;
  ambit_arena *arena = ambit_arena_open();
  ambit_failure failure = { 0 };
  ambit_problem p;
  ambit_scope *scope;
  double values[16];
  const double time[] = { from, to };
  void *self = NULL;
  static judge j;
  j = (judge) {
    .sink = { sizeof(ambit_sink), look, NULL }, .share = share, .tube = tube, .every = every, .last = from
  };
  const ambit_problem_request q = { .system = &m->system,
    .initial = m->initial,
    .ntime = 2,
    .time = time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL,
    .seal = AMBIT_SEAL_KEEP };
  if (m->failure.message[0] || ambit_problem_build(&q, arena, &p, &failure) != AMBIT_OK)
    fail_msg("%s%s", m->failure.message, failure.message);
  case_open(&c, "taylor_model", "interval");
  p.arithmetic = &c.arithmetic.full, p.actx = c.arithmetic.ctx;
  p.worker = NULL, p.nworker = 1;
  assert_int_equal(
      ambit_params_resolve(c.kit.plugin->param, "taylor_model", noption, option, values, &failure), AMBIT_OK);
  assert_int_equal(ambit_scope_open(&scope, NULL, NULL), AMBIT_OK);
  run r = { .status = c.kit.plugin->open(&scope->host, &p, values, &self) };
  if (r.status == AMBIT_OK) {
    j.f = self;
    assert_true(p.nu <= UNKNOWNS);
    choose_samples(&j, p.nu, samples);
    for (int k = 0; k < samples; k++) {
      double u[UNKNOWNS];
      for (uint32_t v = 0; v < p.nu; v++) u[v] = j.f->unit_mid[v] + j.f->unit_rad[v] * j.xi[k][v];
      solution_open(&j.oracle[k], &p);
      solution_start(&j.oracle[k], u);
    }
    r.status = c.kit.plugin->run(self, &j.sink);
    c.kit.plugin->close(self);
    for (int k = 0; k < samples; k++) solution_close(&j.oracle[k]);
  }
  r.checks = j.checks, r.misses = j.misses, r.most_pieces = j.most_pieces, r.t = j.t;
  snprintf(r.reason, sizeof r.reason, "%s", scope->failure.message);
  ambit_scope_close(scope);
  case_close(&c);
  ambit_arena_close(arena);
  return r;
}

static run follow(model *m, double from, double to, double every, int samples, double share, size_t noption,
    const ambit_option *option) {
  return follow_with(m, from, to, every, samples, share, 1, noption, option);
}

/* -- the double pendulum, also across splits */

static void the_double_pendulum_is_followed_through_splits(void **unused) {
  (void)unused;
  model m;
  model_wide_double_pendulum(&m);
  run r = follow(&m, 0, 3.6, 0.4, 4, 1, 0, NULL);
  if (r.status != AMBIT_OK) fail_msg("%s", r.reason);
  assert_true(r.most_pieces > 4 && r.checks > 120);
  assert_int_equal(r.misses, 0);
  model_close(&m);
}

static void a_missing_remainder_is_noticed(void **unused) {
  (void)unused;
  static const double share[] = { 0, 1e-4 };
  model m;
  model_wide_double_pendulum(&m);
  for (size_t i = 0; i < COUNT(share); i++) {
    run r = follow(&m, 0, 0.8, 0.1, 3, share[i], 0, NULL);
    assert_int_equal(r.status, AMBIT_OK);
    assert_true(r.misses > (i ? 1 : r.checks / 2));
  }
  model_close(&m);
}

static void build_random(model *m, uint64_t *random, double wide);

/* tubes of long steps with two unknowns are those of the polynomials, and most of their width is solutions */
static void a_narrow_tube_is_noticed(void **unused) {
  (void)unused;
  static const ambit_option option[] = { { "order", "6" }, { "pieces_max", "1" } };
  static const double tube[] = { 1, 0.9 };
  for (size_t i = 0; i < COUNT(tube); i++) {
    model m;
    uint64_t random = 7;
    build_random(&m, &random, 0.3);
    run r = follow_with(&m, 0, 1, 0, 4, 1, tube[i], 2, option);
    if (r.status != AMBIT_OK) fail_msg("%s", r.reason);
    assert_true(i ? r.misses > 5 : r.misses == 0);
    model_close(&m);
  }
}

/* -- every operation */

static expr op(model *m, uint32_t code, expr a, expr b) { return ambit_graph_op(m->graph, code, a, b); }
static expr u_of(model *m, const char *name, double lo, double hi) {
  return ambit_graph_unknown(m->graph, name, (ambit_interval) { lo, hi });
}

/* x' = f(x, y) - x / 2, y' = -y / 4 + 1 / 4, around (1, 1); x, y > 1/2 */
static expr right_hand_side(model *m, int n) {
  expr x = m->state[0], y = m->state[1];
  switch (n) {
  case 0: return op(m, AMBIT_OP_EXP, sub(m, x, number(m, 1.5)), x);
  case 1: return op(m, AMBIT_OP_LOG, add(m, x, mul(m, x, y)), x);
  case 2: return op(m, AMBIT_OP_SQRT, mul(m, x, y), x);
  case 3: return op(m, AMBIT_OP_ATAN, mul(m, number(m, 2), sub(m, x, y)), x);
  case 4: return op(m, AMBIT_OP_ATAN2, sub(m, x, y), x);
  case 5: return op(m, AMBIT_OP_ATAN2, y, sub(m, x, number(m, 1)));
  case 6: return op(m, AMBIT_OP_SINH, sub(m, y, x), x);
  case 7: return sub(m, op(m, AMBIT_OP_COSH, x, x), number(m, 1));
  case 8: return op(m, AMBIT_OP_TAN, mul(m, decimal(m, "0.3"), x), x);
  case 9: return op(m, AMBIT_OP_TANH, mul(m, x, y), x);
  case 10: return op(m, AMBIT_OP_ASIN, divide(m, x, number(m, 4)), x);
  case 11: return op(m, AMBIT_OP_ACOS, divide(m, y, number(m, 4)), x);
  case 12: return divide(m, number(m, 1), add(m, x, square(m, y)));
  case 13: return ambit_graph_pown(m->graph, y, -3);
  case 14: return op(m, AMBIT_OP_ABS, sub(m, x, number(m, 9)), x);
  case 15: return op(m, AMBIT_OP_MIN, mul(m, x, y), number(m, 20));
  case 16: return op(m, AMBIT_OP_MAX, mul(m, x, y), number(m, -20));
  case 17: return add(m, sine(m, mul(m, number(m, 3), x)), cosine(m, mul(m, ambit_graph_time(m->graph), y)));
  case 18: return divide(m, sine(m, ambit_graph_time(m->graph)), x);
  default: return op(m, AMBIT_OP_ATAN2, sub(m, number(m, 0), y), sub(m, number(m, 0), x));
  }
}

static void build_case(model *m, int n, int unknowns, double wide) {
  static const char *const name[] = { "x", "y" };
  model_open(m, 2, name);
  expr one = number(m, 1), quarter = number(m, 0.25), p = quarter;
  m->initial[0] = unknowns > 0 ? u_of(m, "x0", 1 - wide, 1 + wide) : one;
  m->initial[1] = unknowns > 1 ? add(m, one, mul(m, m->initial[0], u_of(m, "y0", -wide, wide))) : one;
  if (unknowns > 2) p = op(m, AMBIT_OP_EXP, u_of(m, "p", -1.5, -1.25), one);
  m->rate[0] = sub(m, right_hand_side(m, n), divide(m, m->state[0], number(m, 2)));
  m->rate[1] = mul(m, p, sub(m, one, m->state[1]));
}

static void every_operation_is_enclosed(void **unused) {
  (void)unused;
  static const ambit_option option[][3] = { { { "order", "0" }, { "pieces_max", "6" }, { "step_max", "0.1" } },
    { { "order", "3" }, { "pieces_max", "12" }, { "step_max", "0.1" } },
    { { "order", "8" }, { "pieces_max", "2" }, { "step_max", "0.1" } } };
  size_t checks = 0;
  for (int n = 0; n < 20; n++)
    for (int unknowns = n % 2; unknowns < 4; unknowns += 2) {
      model m;
      build_case(&m, n, unknowns, n % 2 ? 0.1 : 0.2);
      run r = follow(&m, n % 3 ? 0 : 0.3, n % 3 ? 0.4 : -0.1, 0.15, unknowns ? 3 : 1, 1, 3, option[(n + unknowns) % 3]);
      if (r.status != AMBIT_OK) fail_msg("operation %d, %d unknowns: %s", n, unknowns, r.reason);
      if (r.misses) fail_msg("operation %d, %d unknowns: %zu misses of %zu", n, unknowns, r.misses, r.checks);
      checks += r.checks;
      model_close(&m);
    }
  assert_true(checks > 300);
}

/* -- random quadratic systems with sines, from wide boxes, in few and in many pieces */

static void build_random(model *m, uint64_t *random, double wide) {
  static const char *const name[] = { "x", "y", "z" };
  model_open(m, 3, name);
  for (size_t i = 0; i < 3; i++) {
    m->rate[i] = number(m, oracle_uniform(random, -0.5, 0.5));
    for (size_t k = 0; k < 3; k++) {
      expr term = mul(m, number(m, oracle_uniform(random, -1, 1)), m->state[k]);
      if (oracle_random(random) % 2)
        term = mul(m, term, m->state[oracle_random(random) % 3]);
      else if (oracle_random(random) % 2)
        term = sine(m, term);
      m->rate[i] = add(m, m->rate[i], term);
    }
    double at = oracle_uniform(random, -1, 1);
    m->initial[i] = i < 2 ? u_of(m, name[i], at, at + wide) : number(m, at);
  }
}

static void random_systems_are_enclosed(void **unused) {
  (void)unused;
  static const ambit_option option[][2] = { { { "order", "2" }, { "pieces_max", "12" } },
    { { "order", "7" }, { "pieces_max", "4" } }, { { "pieces_max", "16" }, { "time_order", "9" } },
    { { "order", "4" }, { "pieces_max", "30" } } };
  uint64_t random = 3;
  size_t checks = 0, split = 0;
  for (int n = 0; n < 16; n++) {
    model m;
    build_random(&m, &random, n % 3 ? 0.3 : 1e-3);
    run r = follow(&m, 0, n % 2 ? 1.5 : -1.5, 0.25, 5, 1, 2, option[n % 4]);
    if (r.misses) fail_msg("random system %d: %zu misses of %zu", n, r.misses, r.checks);
    checks += r.checks, split += r.most_pieces > 1;
    model_close(&m);
  }
  assert_true(checks > 500 && split > 2);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_double_pendulum_is_followed_through_splits),
    cmocka_unit_test(a_missing_remainder_is_noticed),
    cmocka_unit_test(a_narrow_tube_is_noticed),
    cmocka_unit_test(every_operation_is_enclosed),
    cmocka_unit_test(random_systems_are_enclosed),
  };
  return cmocka_run_group_tests_name("solver taylor_model, each solution", tests, NULL, NULL);
}
