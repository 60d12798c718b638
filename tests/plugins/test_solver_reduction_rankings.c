/* Rankings of the plugin `reduction` against what cutting a term really does: both models are integrated here by the
** classical Runge-Kutta method with steps far below the references'. Linear and nonlinear, stiff and undamped systems;
** units; kinks and poles; singular matrices. */
#include "reduction_case.h"

#define NODES_MAX 400
#define TERMS_MAX 64
#define N_MAX 12

/* x' = sum of terms c * x_j, c * x_j^3 or c; nonlinear ones come from here only */
typedef struct term {
  uint32_t state, of, power; /* power 0: the constant c */
  double c;
} term;

typedef struct model {
  uint32_t n, nterm, nodes, nfixed; /* the first terms stay */
  term term[TERMS_MAX];
  double start[N_MAX], span, bound;
  double time[NODES_MAX], x[NODES_MAX * N_MAX];
  int output;
} model;

static void add(model *m, uint32_t state, double c, uint32_t of, uint32_t power) {
  m->term[m->nterm++] = (term) { state, of, power, c };
}

static void rates(const model *m, const double *x, uint32_t cut, double share, double *f) {
  memset(f, 0, m->n * sizeof *f);
  for (uint32_t k = 0; k < m->nterm; k++) {
    const term *t = &m->term[k];
    f[t->state] += (k == cut ? 1 - share : 1) * t->c * pow(x[t->of], t->power);
  }
}

static void runge_kutta(const model *m, double h, uint32_t cut, double share, double *x) {
  double k[4][N_MAX], at[N_MAX];
  rates(m, x, cut, share, k[0]);
  for (int stage = 1; stage < 4; stage++) {
    double step = stage == 3 ? h : 0.5 * h;
    for (uint32_t i = 0; i < m->n; i++) at[i] = x[i] + step * k[stage - 1][i];
    rates(m, at, cut, share, k[stage]);
  }
  for (uint32_t i = 0; i < m->n; i++) x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
}

/* nodes that come closer towards the start, as a controlled step would */
static void make_reference(model *m, uint32_t nodes, uint32_t steps) {
  double x[N_MAX];
  m->nodes = nodes;
  memcpy(x, m->start, sizeof x);
  for (uint32_t j = 0; j < nodes; j++) {
    double s = (double)j / (nodes - 1);
    m->time[j] = m->span * (0.3 * s + 0.7 * s * s);
    for (uint32_t i = 0; j > 0 && i < steps; i++)
      runge_kutta(m, (m->time[j] - m->time[j - 1]) / steps, UINT32_MAX, 0, x);
    memcpy(m->x + j * m->n, x, m->n * sizeof *x);
  }
}

/* greatest change of the output over the reference's times, relative to the bound */
static double true_effect(const model *m, uint32_t cut, double share, uint32_t steps) {
  double x[N_MAX], worst = 0;
  memcpy(x, m->start, sizeof x);
  for (uint32_t j = 1; j < m->nodes; j++) {
    for (uint32_t i = 0; i < steps; i++) runge_kutta(m, (m->time[j] - m->time[j - 1]) / steps, cut, share, x);
    worst = fmax(worst, fabs(x[m->output] - m->x[j * m->n + (uint32_t)m->output]));
  }
  return worst / m->bound;
}

/* `unit` [n]: the plugin's model counts state i in these units; effects are a share of each term */
static reduction_case *case_of(const model *m, const double *unit, double share) {
  static const char *const name[N_MAX] = { "a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l" };
  reduction_case *c = case_open();
  for (uint32_t i = 0; i < m->n; i++) case_state(c, name[i]);
  for (uint32_t k = 0; k < m->nterm; k++) {
    const term *t = &m->term[k];
    ambit_expr power = ambit_graph_pown(c->graph, case_times(c, unit[t->of], c->x[t->of]), (int32_t)t->power);
    if (t->power == 0) power = case_number(c, 1);
    case_term(c, t->state, case_times(c, t->c / unit[t->state], power));
    c->effect[k] = case_times(c, share, c->effect[k]);
  }
  case_output(c, "y", case_times(c, unit[m->output], c->x[m->output]), m->bound);
  double *x = calloc(m->nodes * m->n, sizeof *x);
  for (uint32_t j = 0; j < m->nodes * m->n; j++) x[j] = m->x[j] / unit[j % m->n];
  c->reference[0] = (ambit_reduction_reference) { 0, m->nodes, m->time, x, x };
  c->nreference = 1;
  case_set(c, "residual", "true"), case_set(c, "one_step", "true"), case_set(c, "adjoint", "true");
  case_set(c, "ends", "60");
  return c;
}

static void case_free(reduction_case *c) {
  free((void *)(uintptr_t)c->reference[0].x);
  case_close(c);
}

static const double ones[N_MAX] = { 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1 };

/* -- systems */

/* a ladder of resistors and capacitors, charged from one end: x_i' = g_i (x_{i-1} - 2 x_i + x_{i+1}), with losses,
** sources and cubic parts of all sizes that may go */
static void make_ladder(model *m) {
  *m = (model) { .n = 10, .span = 40, .bound = 0.01, .output = 7 };
  for (uint32_t i = 0; i < m->n; i++) {
    double g = 1 + 0.3 * i;
    if (i == 0) add(m, 0, g, 0, 0);
    if (i > 0) add(m, i, g, i - 1, 1);
    add(m, i, -2 * g, i, 1);
    if (i + 1 < m->n) add(m, i, g, i + 1, 1);
  }
  m->nfixed = m->nterm;
  for (uint32_t i = 0; i < m->n; i++) {
    add(m, i, -pow(10, case_between(-6, -2)), i, 1);
    add(m, i, pow(10, case_between(-6, -2)), 0, 0);
    add(m, i, -pow(10, case_between(-6, -1)), i, 3);
  }
  make_reference(m, 150, 40);
}

/* masses on springs with cubic parts, hardly damped: several periods */
static void make_masses(model *m) {
  *m = (model) { .n = 6, .span = 12, .bound = 0.02, .output = 0, .start = { 0.5, 0, -0.2, 0, 0.3, 0.1 } };
  for (uint32_t i = 0; i < 3; i++) {
    add(m, 2 * i, 1, 2 * i + 1, 1);
    add(m, 2 * i + 1, -2.0 - i, 2 * i, 1);
    add(m, 2 * i + 1, -0.2, 2 * i, 3);
    add(m, 2 * i + 1, -0.05 * (i + 1), 2 * i + 1, 1);
    if (i < 2) add(m, 2 * i + 1, 0.3, 2 * i + 2, 1);
    if (i > 0) add(m, 2 * i + 1, 0.1, 2 * i - 2, 1);
  }
  make_reference(m, 300, 20);
}

/* a slow oscillator that drives a fast decay, 5000 times faster than the nodes resolve, which drives it */
static void make_stiff(model *m) {
  *m = (model) { .n = 3, .span = 6, .bound = 0.1, .output = 0, .start = { 1, 0, 1 } };
  add(m, 0, 1, 1, 1);
  add(m, 1, -1, 0, 1), add(m, 1, -0.5, 2, 1), add(m, 1, -0.02, 1, 1);
  add(m, 2, -1e4, 2, 1), add(m, 2, 1e4, 0, 1), add(m, 2, 10, 1, 1), add(m, 2, 300, 0, 0);
  make_reference(m, 200, 400);
}

/* -- to first order */

/* One tenth of a thousandth of each term is taken away: the adjoint is as good as its steps. */
static void assert_adjoint_is_true(const model *m, uint32_t steps, double tolerance) {
  const double share = 1e-4;
  reduction_case *c = case_of(m, ones, share);
  case_must_run(c);
  for (uint32_t k = m->nfixed; k < m->nterm; k++) {
    double truth = true_effect(m, k, share, steps), rank = c->rank[AMBIT_RANK_ADJOINT][k];
    if (!(fabs(rank - truth) <= tolerance * truth + 1e-11))
      fail_msg("term %u of %u: rank %g, effect %g", k, m->nterm, rank, truth);
  }
  case_free(c);
}

static void adjoint_is_the_effect_to_first_order(void **state) {
  (void)state;
  model m;
  make_ladder(&m);
  assert_adjoint_is_true(&m, 40, 0.02);
  make_masses(&m);
  assert_adjoint_is_true(&m, 20, 0.04);
  make_stiff(&m);
  assert_adjoint_is_true(&m, 400, 0.04);
}

/* x' = -a x + b: closed forms of what b's loss and a's do, at the end and at most */
static void closed_forms(void **state) {
  (void)state;
  const double a = 2, b = 3, span = 4;
  model m = { .n = 1, .span = span, .bound = 0.5, .start = { 1 } };
  add(&m, 0, -a, 0, 1), add(&m, 0, b, 0, 0);
  make_reference(&m, 400, 10);
  reduction_case *c = case_of(&m, ones, 1);
  case_set(c, "ends", "1");
  case_must_run(c);
  double end = exp(-a * span), loss_of_b = b / a * (1 - end);
  /* d' = -a d + a x with x = b/a + (1 - b/a) e^(-a t) */
  double loss_of_a = b / a * (1 - end) + (1 - b / a) * a * span * end;
  assert_true(fabs(c->rank[AMBIT_RANK_ADJOINT][1] / (loss_of_b / 0.5) - 1) < 1e-3);
  assert_true(fabs(c->rank[AMBIT_RANK_ADJOINT][0] / (loss_of_a / 0.5) - 1) < 1e-3);
  /* one step: h b/(1 + h a), greatest at the longest, which is the last; residual: b over the variation of x */
  double h = m.time[399] - m.time[398], range = m.x[399] - m.x[0];
  assert_true(fabs(c->rank[AMBIT_RANK_ONE_STEP][1] / (h * b / (1 + h * a) / 0.5) - 1) < 1e-12);
  assert_true(fabs(c->rank[AMBIT_RANK_RESIDUAL][1] / (b / range) - 1) < 1e-12);
  case_set(c, "norm", "max");
  case_must_run(c);
  assert_true(fabs(c->rank[AMBIT_RANK_RESIDUAL][0] / (a * m.x[399] / range) - 1) < 1e-12);
  case_free(c);
}

/* -- order */

static void rank_of(uint32_t n, const double *x, double *r) {
  for (uint32_t i = 0; i < n; i++) {
    r[i] = 0;
    for (uint32_t j = 0; j < n; j++) r[i] += x[j] < x[i] ? 1 : x[j] == x[i] ? 0.5 : 0;
  }
}

/* Spearman's correlation */
static double correlation(uint32_t n, const double *x, const double *y) {
  double a[TERMS_MAX], b[TERMS_MAX], mean = 0.5 * n, up = 0, of_a = 0, of_b = 0;
  rank_of(n, x, a), rank_of(n, y, b);
  for (uint32_t i = 0; i < n; i++) {
    up += (a[i] - mean) * (b[i] - mean);
    of_a += (a[i] - mean) * (a[i] - mean), of_b += (b[i] - mean) * (b[i] - mean);
  }
  return up / sqrt(of_a * of_b);
}

static void assert_order(const model *m, const char *name, uint32_t steps, const double least[AMBIT_RANK_COUNT]) {
  double truth[TERMS_MAX];
  uint32_t n = m->nterm - m->nfixed;
  for (uint32_t k = 0; k < n; k++) truth[k] = true_effect(m, m->nfixed + k, 1, steps);
  reduction_case *c = case_of(m, ones, 1);
  case_must_run(c);
  for (uint32_t i = 0; i < AMBIT_RANK_COUNT; i++) {
    if (!c->ranked[i]) continue;
    double found = correlation(n, c->rank[i] + m->nfixed, truth);
    if (found < least[i]) fail_msg("%s, %s: correlation %g", name, ambit_reduction_ranking_name(i), found);
  }
  case_free(c);
}

static void rankings_order_terms_as_their_effects_do(void **state) {
  (void)state;
  static const double ladder[AMBIT_RANK_COUNT] = { 0.9, 0.8, 0, 0, 0.99 };
  static const double masses[AMBIT_RANK_COUNT] = { 0.6, 0.75, 0, 0, 0.95 };
  static const double stiff[AMBIT_RANK_COUNT] = { 0.2, 0.75, 0, 0, 0.75 };
  model m;
  make_ladder(&m);
  assert_order(&m, "ladder", 40, ladder);
  make_masses(&m);
  assert_order(&m, "masses", 20, masses);
  make_stiff(&m);
  assert_order(&m, "stiff", 400, stiff);
}

/* -- units */

static void units_decide_nothing(void **state) {
  (void)state;
  double unit[N_MAX], before[AMBIT_RANK_COUNT][TERMS_MAX];
  model m;
  make_masses(&m);
  for (uint32_t i = 0; i < N_MAX; i++) unit[i] = i % 3 == 0 ? 1000 : i % 3 == 1 ? 1e-6 : 0.3048;
  reduction_case *c = case_of(&m, ones, 1), *other = case_of(&m, unit, 1);
  case_must_run(c);
  for (uint32_t i = 0; i < AMBIT_RANK_COUNT; i++) memcpy(before[i], c->rank[i], m.nterm * sizeof(double));
  case_must_run(other);
  for (uint32_t i = 0; i < AMBIT_RANK_COUNT; i++)
    for (uint32_t k = 0; c->ranked[i] && k < m.nterm; k++)
      if (!(fabs(other->rank[i][k] - before[i][k]) <= 1e-9 * before[i][k]))
        fail_msg("%s of term %u: %g, %g", ambit_reduction_ranking_name(i), k, before[i][k], other->rank[i][k]);
  case_free(c), case_free(other);
}

/* a state that stays at 0 between two great terms that cancel: its scale is what they would make of it */
static void a_state_at_rest_has_a_scale(void **state) {
  (void)state;
  double first = 0;
  for (int i = 0; i < 2; i++) {
    double unit = i ? 1e-4 : 1;
    model m = { .n = 1, .span = 2, .bound = 1 };
    add(&m, 0, 7, 0, 0), add(&m, 0, -7, 0, 0), add(&m, 0, -0.7, 0, 0), add(&m, 0, 0.7, 0, 0);
    make_reference(&m, 5, 1);
    reduction_case *c = case_of(&m, &unit, 1);
    case_must_run(c);
    const double *r = c->rank[AMBIT_RANK_RESIDUAL];
    assert_true(r[0] == r[1] && fabs(r[0] - 0.5) < 1e-12 && fabs(r[2] - 0.05) < 1e-12);
    if (i) assert_true(fabs(r[0] - first) < 1e-12);
    first = r[0];
    case_free(c);
  }
}

/* -- where there is no derivative */

/* x' = -|x| - sqrt x from 1, in the plugin with formulas that have no derivative, or none at 0 */
static void kinks_and_poles(void **state) {
  (void)state;
  const uint32_t nodes = 41;
  double time[41], x[41], rank[3];
  for (uint32_t j = 0; j < nodes; j++) {
    time[j] = 0.04 * j;
    double root = fmax(0, 2 * exp(-0.5 * time[j]) - 1); /* sqrt x: s' = -(s + 1)/2 */
    x[j] = root * root;
  }
  assert_true(x[nodes - 1] == 0);
  for (int kind = 0; kind < 3; kind++) {
    reduction_case *c = case_open();
    ambit_expr s = case_state(c, "s"), v = case_state(c, "v");
    ambit_expr size = kind == 1 ? ambit_graph_op(c->graph, AMBIT_OP_ABS, s, s)
                      : kind == 2
                          ? ambit_graph_op(c->graph, AMBIT_OP_MAX, s, ambit_graph_op(c->graph, AMBIT_OP_NEG, s, s))
                          : s;
    case_term(c, 0, case_times(c, -1, size));
    case_term(c, 0, case_times(c, -1, ambit_graph_op(c->graph, AMBIT_OP_SQRT, s, s)));
    case_term(c, 1, s);
    (void)v;
    case_output(c, "s", s, 1);
    double both[82];
    for (uint32_t j = 0; j < nodes; j++) both[2 * j] = x[j], both[2 * j + 1] = 0;
    c->reference[0] = (ambit_reduction_reference) { 0, nodes, time, both, both };
    c->nreference = 1;
    case_set(c, "ranking", "adjoint"), case_set(c, "one_step", "true");
    case_must_run(c);
    for (uint32_t k = 0; k < 3; k++) {
      double r = c->rank[AMBIT_RANK_ADJOINT][k];
      assert_true(isfinite(r) && isfinite(c->rank[AMBIT_RANK_ONE_STEP][k]));
      if (kind) assert_true(fabs(r - rank[k]) <= 1e-4 * rank[k]);
      if (!kind) rank[k] = r;
    }
    assert_true(rank[0] > 0.05 && rank[1] > 0.05 && rank[2] == 0); /* v reaches no output: exactly 0 */
    case_close(c);
  }
}

static void singular_steps_are_survived(void **state) {
  (void)state;
  model m = { .n = 2, .span = 1, .bound = 1, .start = { 1e-3, 0 }, .nodes = 5 };
  double h = 0.25, gamma = 1 - sqrt(0.5);
  for (int i = 0; i < 2; i++) {
    m.nterm = 0;
    add(&m, 0, i ? 1 / h : 1 / (gamma * h), 0, 1), add(&m, 1, 1, 0, 1), add(&m, 1, 1e300, 1, 1);
    for (uint32_t j = 0; j < 5; j++) {
      m.time[j] = h * j;
      m.x[2 * j] = 1e-3 * exp(m.term[0].c * m.time[j]), m.x[2 * j + 1] = 0;
    }
    reduction_case *c = case_of(&m, ones, 1);
    case_must_run(c);
    for (uint32_t k = 0; k < 3; k++) {
      assert_false(isnan(c->rank[AMBIT_RANK_ADJOINT][k]) || isnan(c->rank[AMBIT_RANK_ONE_STEP][k]));
      assert_true(c->rank[AMBIT_RANK_ADJOINT][k] >= 0 && c->rank[AMBIT_RANK_ONE_STEP][k] >= 0);
    }
    assert_true(c->rank[AMBIT_RANK_ADJOINT][0] > 0);
    case_free(c);
  }
}

/* several references: the worst counts; data that references give, and data that only have a range */
static void references_and_data(void **state) {
  (void)state;
  const double time[3] = { 0, 0.5, 1 }, x[3] = { 0, 0.5, 1 };
  reduction_case *c = case_open();
  case_state(c, "x");
  ambit_expr given = ambit_graph_unknown(c->graph, "p", (ambit_interval) { 1, 9 });
  ambit_expr middle = ambit_graph_unknown(c->graph, "q", (ambit_interval) { 2, 4 });
  case_term(c, 0, given), case_term(c, 0, middle), case_term(c, 0, ambit_graph_time(c->graph));
  case_output(c, "x", c->x[0], 1);
  double low[3] = { 2, 2, 2 }, high[3] = { 5, 6, 5 };
  case_set(c, "norm", "max");
  c->data = given;
  c->reference[0] = (ambit_reduction_reference) { 0, 3, time, x, low };
  c->reference[1] = (ambit_reduction_reference) { 1, 3, time, x, high };
  c->nreference = 2;
  case_must_run(c);
  const double expected[3] = { 6, 3, 1 };
  for (uint32_t k = 0; k < 3; k++) assert_true(fabs(c->rank[AMBIT_RANK_RESIDUAL][k] - expected[k]) < 1e-12);
  case_close(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(adjoint_is_the_effect_to_first_order),
    cmocka_unit_test(closed_forms),
    cmocka_unit_test(rankings_order_terms_as_their_effects_do),
    cmocka_unit_test(units_decide_nothing),
    cmocka_unit_test(a_state_at_rest_has_a_scale),
    cmocka_unit_test(kinks_and_poles),
    cmocka_unit_test(singular_steps_are_survived),
    cmocka_unit_test(references_and_data),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
