/* What lohner says of a step besides bounds: the dense enclosure holds at any time within it, the set for any values of
** the unknowns. Judged by solutions in 300-bit arithmetic while records come in. */
#include "kit/solver_kit_values.h"
#include "solver_track.h"
#include "num/interval.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define SOLUTIONS 3
#define TIMES 3 /* within a step, one of them its end */

typedef struct judge {
  ambit_sink sink; /* first */
  solution_oracle o[SOLUTIONS];
  double u[SOLUTIONS][TRACK_UNKNOWNS];
  size_t records, misses;
  double widest_rest; /* of the sets' rests over their widths */
  double spoil;       /* added to what is judged */
} judge;

static size_t miss(judge *g, solution_oracle *o, uint32_t i, ambit_interval x) {
  return !solution_within(o, i, x.lo + g->spoil, x.hi + g->spoil);
}

static void judge_dense(judge *g, const ambit_record *r, solution_oracle *o) {
  for (int k = 1; k <= TIMES; k++) {
    double t = k < TIMES ? r->t_from + (double)k / TIMES * (r->t_to - r->t_from) : r->t_to;
    solution_advance(o, t);
    ambit_interval since = ambit_interval_sub((ambit_interval) { t, t }, (ambit_interval) { r->t_from, r->t_from });
    for (uint32_t i = 0; i < r->nx; i++) g->misses += miss(g, o, i, kit_dense_value(r, i, since));
  }
}

static int32_t judge_emit(ambit_sink *sink, const ambit_record *r) {
  judge *g = (judge *)(void *)sink;
  if (!r->dense_mid || !r->set || kit_dense_fault(r) || kit_set_fault(r, r->set->nu)) fail_msg("no gifts");
  g->records++;
  for (int n = 0; n < SOLUTIONS; n++) {
    judge_dense(g, r, &g->o[n]);
    for (uint32_t i = 0; i < r->nx; i++) g->misses += miss(g, &g->o[n], i, kit_set_value(r->set, i, g->u[n]));
  }
  for (uint32_t i = 0; i < r->nx; i++)
    if (r->hi[i] - r->lo[i] > 1e-9) g->widest_rest = fmax(g->widest_rest, r->set->rest[i] / (r->hi[i] - r->lo[i]));
  return 0;
}

static void judge_open(judge *g, ambit_arena *arena, ambit_problem *p, const model *m, const double *time) {
  ambit_failure f = { 0 };
  uint64_t random = 5;
  const ambit_problem_request q = { .system = &m->system,
    .initial = m->initial,
    .ntime = 2,
    .time = time,
    .want = AMBIT_WANT_RHS | AMBIT_WANT_SERIES | AMBIT_WANT_INITIAL,
    .seal = AMBIT_SEAL_KEEP };
  if (ambit_problem_build(&q, arena, p, &f) != AMBIT_OK) fail_msg("%s", f.message);
  g->sink = (ambit_sink) { sizeof(ambit_sink), judge_emit, NULL };
  for (int n = 0; n < SOLUTIONS; n++) {
    for (uint32_t j = 0; j < p->nu; j++) /* a corner, the opposite one, any */
      g->u[n][j] = n == 0 ? p->u_lo[j] : n == 1 ? p->u_hi[j] : oracle_uniform(&random, p->u_lo[j], p->u_hi[j]);
    solution_open(&g->o[n], p);
    solution_start(&g->o[n], g->u[n]);
  }
}

static judge judged(const model *m, double from, double to, size_t noption, const ambit_option *option, double spoil) {
  const double time[] = { from, to };
  judge g = { .spoil = spoil };
  ambit_problem p;
  ambit_failure f = { 0 };
  ambit_simulate_result result = { 0 };
  ambit_arena *arena = ambit_arena_open();
  judge_open(&g, arena, &p, m, time);
  ambit_registry *registry = ambit_registry_open(NULL);
  const ambit_simulate_request q = { .system = &m->system,
    .registry = registry,
    .solver = "lohner",
    .nsolver_option = noption,
    .solver_option = option,
    .initial = m->initial,
    .ntime = 2,
    .time = time,
    .extras = AMBIT_EXTRA_DENSE | AMBIT_EXTRA_SET,
    .sink = &g.sink };
  if (ambit_simulate(&q, &result, NULL, &f) != AMBIT_OK) fail_msg("%s%s", m->failure.message, f.message);
  if (result.status != AMBIT_OK) fail_msg("%s", result.reason);
  assert_true(g.records > 1);
  for (int n = 0; n < SOLUTIONS; n++) solution_close(&g.o[n]);
  ambit_registry_close(registry);
  ambit_arena_close(arena);
  return g;
}

/* -- models */

/* x'' = -k x - 0.1 x' + b cos 2 t: k is only a parameter, b a parameter and the initial speed, x0 only initial */
static void model_mixed(model *m) {
  static const char *const name[] = { "x", "v" };
  model_open(m, 2, name);
  expr k = ambit_graph_unknown(m->graph, "k", (ambit_interval) { 0.9, 1.1 });
  expr b = ambit_graph_unknown(m->graph, "b", (ambit_interval) { 0.45, 0.55 });
  expr force = mul(m, b, cosine(m, mul(m, number(m, 2), ambit_graph_time(m->graph))));
  expr spring = add(m, mul(m, k, m->state[0]), mul(m, decimal(m, "0.1"), m->state[1]));
  m->rate[0] = m->state[1], m->rate[1] = sub(m, force, spring);
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { 1, 1.05 }), m->initial[1] = b;
}

/* exact initial values, only the parameter is uncertain */
static void model_parameter(model *m) {
  static const char *const name[] = { "x", "v" };
  model_open(m, 2, name);
  expr k = ambit_graph_unknown(m->graph, "k", (ambit_interval) { 0.99, 1.01 });
  m->rate[0] = m->state[1], m->rate[1] = sub(m, number(m, 0), mul(m, k, sine(m, m->state[0])));
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0);
}

/* 12 pendulums in a row, each tied to its neighbours by springs of uncertain stiffness */
static void model_pendulums(model *m) {
  static const char *const name[24] = { "a1", "a2", "a3", "a4", "a5", "a6", "a7", "a8", "a9", "a10", "a11", "a12", "b1",
    "b2", "b3", "b4", "b5", "b6", "b7", "b8", "b9", "b10", "b11", "b12" };
  model_open(m, 24, name);
  expr k = ambit_graph_unknown(m->graph, "k", (ambit_interval) { 0.99, 1.01 });
  for (size_t i = 0; i < 12; i++) {
    expr pull = sub(m, number(m, 0), sine(m, m->state[i]));
    if (i > 0) pull = add(m, pull, mul(m, k, sub(m, m->state[i - 1], m->state[i])));
    if (i < 11) pull = add(m, pull, mul(m, k, sub(m, m->state[i + 1], m->state[i])));
    m->rate[i] = m->state[12 + i], m->rate[12 + i] = pull;
    m->initial[i] = number(m, i == 0), m->initial[12 + i] = number(m, 0);
  }
}

typedef struct example {
  void (*build)(model *m);
  double from, to, rest; /* most of a set's width that is no function of the unknowns */
  ambit_option option;
} example;

static void dense_and_set_hold(void **unused) {
  (void)unused;
  static const example list[] = { { model_mixed, -1, 3, 0.3, { "order", "0" } },
    { model_mixed, 2, -1, 0.3, { "step", "hermite_obreschkoff" } }, { model_mixed, 0, 1, 0.3, { "order", "4" } },
    { model_parameter, 0, 6, 0.3, { "set", "qr" } }, { model_pendulums, 0, 3, 1, { "order", "40" } },
    { model_wide_double_pendulum, 0, 0.4, 0.25, { "pieces", "8" } },
    { model_van_der_pol_box, 0, 1, 0.3, { "history", "4" } }, { model_lorenz, 0.5, 0, 1, { "order", "12" } },
    { model_stiff_line, 0, 0.05, 1, { "step", "hermite_obreschkoff" } } };
  for (size_t n = 0; n < COUNT(list); n++) {
    const example *e = &list[n];
    model m;
    e->build(&m);
    judge g = judged(&m, e->from, e->to, 1, &e->option, 0);
    if (g.misses) fail_msg("example %zu: %zu misses in %zu records", n, g.misses, g.records);
    if (!(g.widest_rest <= e->rest)) fail_msg("example %zu: %g of the set is rest", n, g.widest_rest);
    model_close(&m);
  }
}

static void the_judge_sees_a_shift(void **unused) {
  (void)unused;
  model m;
  model_parameter(&m);
  assert_true(judged(&m, 0, 1, 0, NULL, 0.1).misses > 0);
  model_close(&m);
  model_lorenz(&m);
  assert_true(judged(&m, 0, 0.5, 0, NULL, 1e-9).misses > 0);
  model_close(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = { cmocka_unit_test(dense_and_set_hold), cmocka_unit_test(the_judge_sees_a_shift) };
  return cmocka_run_group_tests_name("solver lohner dense", tests, NULL, NULL);
}
