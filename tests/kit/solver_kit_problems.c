/* solver_kit_problems.c -- small problems, each for one thing that a solver may get wrong. */
#include "kit/solver_kit_problems.h"
#include "kit/solver_kit_random.h"
#include "num/interval.h"

static ambit_expr op(kit_model *m, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(m->graph, code, a, b);
}
static ambit_expr number(kit_model *m, double x) { return ambit_graph_number(m->graph, x); }
static ambit_expr negative(kit_model *m, ambit_expr a) { return op(m, AMBIT_OP_NEG, a, a); }

static size_t state(kit_model *m, const char *name, ambit_expr initial) {
  size_t i = m->nx++;
  m->name[i] = name;
  m->unit[i] = "1";
  m->state[i] = ambit_graph_symbol(m->graph, name, "1");
  m->initial[i] = initial;
  return i;
}

static ambit_expr datum(kit_model *m, double lo, double hi) {
  return m->datum[m->ndatum++] = ambit_graph_unknown(m->graph, "u", (ambit_interval) { lo, hi });
}

static ambit_interval point(double x) { return (ambit_interval) { x, x }; }

static ambit_interval function(uint32_t code, ambit_interval a) {
  ambit_interval r;
  ambit_interval_op(code, &r, a, a);
  return r;
}

/* x' = -x */
static void build_decay(kit_model *m) {
  size_t x = state(m, "x", number(m, 1));
  m->rate[x] = negative(m, m->state[x]);
}

static void truth_decay(double t, double u, ambit_interval *x) {
  (void)u;
  x[0] = function(AMBIT_OP_EXP, point(-t));
}

/* x'' = -x, backwards from t = 2 */
static void build_oscillator(kit_model *m) {
  size_t x = state(m, "x", number(m, 1)), v = state(m, "v", number(m, 0));
  m->rate[x] = m->state[v];
  m->rate[v] = negative(m, m->state[x]);
}

static void truth_oscillator(double t, double u, ambit_interval *x) {
  (void)u;
  ambit_interval since = ambit_interval_sub(point(t), point(2));
  x[0] = function(AMBIT_OP_COS, since);
  x[1] = function(AMBIT_OP_NEG, function(AMBIT_OP_SIN, since));
}

/* x' = u x (1 - x), an uncertain parameter */
static void build_logistic(kit_model *m) {
  size_t x = state(m, "x", number(m, 0.5));
  ambit_expr growth = op(m, AMBIT_OP_MUL, datum(m, 1, 1.25), m->state[x]);
  m->rate[x] = op(m, AMBIT_OP_MUL, growth, op(m, AMBIT_OP_SUB, number(m, 1), m->state[x]));
}

static void truth_logistic(double t, double u, ambit_interval *x) {
  ambit_interval e = function(AMBIT_OP_EXP, ambit_interval_mul(point(-u), point(t)));
  x[0] = ambit_interval_div(point(1), ambit_interval_add(point(1), e));
}

/* x' = -2 t x from t = -1 */
static void build_bell(kit_model *m) {
  size_t x = state(m, "x", number(m, 1));
  m->rate[x] = op(m, AMBIT_OP_MUL, op(m, AMBIT_OP_MUL, number(m, -2), ambit_graph_time(m->graph)), m->state[x]);
}

static void truth_bell(double t, double u, ambit_interval *x) {
  (void)u;
  ambit_interval square = function(AMBIT_OP_SQR, point(t));
  x[0] = function(AMBIT_OP_EXP, ambit_interval_sub(point(1), square));
}

/* x' = y, x(0) = u, y = -u: x(1) = 0 whatever u is, if its two places are seen to be one */
static void build_shared(kit_model *m) {
  ambit_expr u = datum(m, 1, 3);
  size_t x = state(m, "x", u), y = state(m, "y", negative(m, u));
  m->rate[x] = m->state[y];
  m->rate[y] = number(m, 0);
}

static void truth_shared(double t, double u, ambit_interval *x) {
  x[0] = ambit_interval_mul(point(u), ambit_interval_sub(point(1), point(t)));
  x[1] = point(-u);
}

/* (x, y) turns about (0, 0) and stays on a circle of radius u, which is an invariant */
static void build_circle(kit_model *m) {
  ambit_expr u = datum(m, 0.5, 0.75);
  size_t x = state(m, "x", u), y = state(m, "y", number(m, 0));
  m->rate[x] = negative(m, m->state[y]);
  m->rate[y] = m->state[x];
  ambit_expr square[2];
  for (size_t i = 0; i < 2; i++) square[i] = op(m, AMBIT_OP_SQR, m->state[i], m->state[i]);
  ambit_expr radius = op(m, AMBIT_OP_SQRT, op(m, AMBIT_OP_ADD, square[0], square[1]), 0);
  m->ninvariant = 1;
  m->invariant[0] = op(m, AMBIT_OP_SUB, radius, u);
  m->invariant_name[0] = "radius";
}

static void truth_circle(double t, double u, ambit_interval *x) {
  x[0] = ambit_interval_mul(point(u), function(AMBIT_OP_COS, point(t)));
  x[1] = ambit_interval_mul(point(u), function(AMBIT_OP_SIN, point(t)));
}

/* x' = x^2: gone at t = 1 */
static void build_escape(kit_model *m) {
  size_t x = state(m, "x", number(m, 1));
  m->rate[x] = op(m, AMBIT_OP_SQR, m->state[x], m->state[x]);
}

static void truth_escape(double t, double u, ambit_interval *x) {
  (void)u;
  x[0] = ambit_interval_div(point(1), ambit_interval_sub(point(1), point(t)));
}

/* x' = -1 / (2 x): leaves the domain at t = 1 */
static void build_edge(kit_model *m) {
  size_t x = state(m, "x", number(m, 1));
  m->rate[x] = op(m, AMBIT_OP_DIV, number(m, -0.5), m->state[x]);
}

static void truth_edge(double t, double u, ambit_interval *x) {
  (void)u;
  x[0] = function(AMBIT_OP_SQRT, ambit_interval_sub(point(1), point(t)));
}

const kit_problem kit_problems[] = {
  { "decay", build_decay, truth_decay, 0, { 0 }, { 0 }, INFINITY, 5, { 0, 0x1p-30, 0.1, 0.7, 3 }, INFINITY, NULL },
  { "oscillator backwards", build_oscillator, truth_oscillator, 0, { 0 }, { 0 }, INFINITY, 4, { 2, 1.3, 0x1.1p-40, -5 },
      INFINITY, NULL },
  { "logistic", build_logistic, truth_logistic, 1, { 1 }, { 1.25 }, INFINITY, 3, { 0, 1, 2 }, INFINITY, NULL },
  { "explicit time", build_bell, truth_bell, 0, { 0 }, { 0 }, INFINITY, 5, { -1, -0.3, 0x1p-60, 0.5, 2 }, INFINITY,
      NULL },
  { "shared datum", build_shared, truth_shared, 1, { 1 }, { 3 }, INFINITY, 3, { 0, 0.5, 1 }, 1e-12, NULL },
  { "circle with an invariant", build_circle, truth_circle, 1, { 0.5 }, { 0.75 }, INFINITY, 3, { 0, 1, 7 }, 0.26,
      NULL },
  { "finite escape", build_escape, truth_escape, 0, { 0 }, { 0 }, 1, 3, { 0, 0.5, 2 }, INFINITY, NULL },
  { "edge of the domain", build_edge, truth_edge, 0, { 0 }, { 0 }, 1, 3, { 0, 0.5, 2 }, INFINITY, NULL },
};
const size_t kit_problem_count = sizeof kit_problems / sizeof *kit_problems;

void kit_model_open(kit_model *m, const kit_problem *p) {
  *m = (kit_model) { .graph = ambit_graph_open() };
  if (p->random)
    kit_random_build(m, p->random);
  else
    p->build(m);
  m->system = (ambit_system) { .graph = m->graph,
    .nx = m->nx,
    .name = m->name,
    .unit = m->unit,
    .state = m->state,
    .rate = m->rate,
    .ninvariant = m->ninvariant,
    .invariant = m->invariant,
    .invariant_name = m->invariant_name,
    .source = m->form.na ? &m->form.source : NULL };
}

void kit_model_close(kit_model *m) { ambit_graph_close(m->graph); }

void kit_truth(const kit_problem *p, double t, const double *u, ambit_interval *x) {
  if (p->random)
    kit_random_truth(p->random, t, u, x);
  else
    p->truth(t, p->nu ? u[0] : 0, x);
}

/* One datum: its ends and four between. Several: all corners. */
bool kit_sample(const kit_problem *p, size_t k, double *u) {
  size_t corners = (size_t)1 << p->nu;
  if (k >= corners + (p->nu ? 4 : 0)) return false;
  for (uint32_t j = 0; j < p->nu; j++) {
    double share = (double)(k + 1 - corners) / 5, between = p->u_lo[j] + share * (p->u_hi[j] - p->u_lo[j]);
    u[j] = k >= corners ? between : k >> j & 1 ? p->u_hi[j] : p->u_lo[j];
  }
  return true;
}
