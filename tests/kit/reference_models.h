/* reference_models.h -- the initial-value problems that validated integrators are compared on, as expressions.
** Shared by tests and benchmarks. */
#ifndef AMBIT_REFERENCE_MODELS_H
#define AMBIT_REFERENCE_MODELS_H
#include <ambit/system.h>

#define MODEL_STATES 64

typedef ambit_expr expr;

typedef struct model {
  ambit_graph *graph;
  ambit_failure failure;
  const char *name[MODEL_STATES], *unit[MODEL_STATES];
  expr state[MODEL_STATES], rate[MODEL_STATES], initial[MODEL_STATES];
  ambit_system system;
} model;

static inline expr add(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_ADD, a, b); }
static inline expr sub(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_SUB, a, b); }
static inline expr mul(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_MUL, a, b); }
static inline expr divide(model *m, expr a, expr b) { return ambit_graph_op(m->graph, AMBIT_OP_DIV, a, b); }
static inline expr sine(model *m, expr a) { return ambit_graph_op(m->graph, AMBIT_OP_SIN, a, a); }
static inline expr cosine(model *m, expr a) { return ambit_graph_op(m->graph, AMBIT_OP_COS, a, a); }
static inline expr square(model *m, expr a) { return ambit_graph_op(m->graph, AMBIT_OP_SQR, a, a); }
static inline expr number(model *m, double x) { return ambit_graph_number(m->graph, x); }
static inline expr decimal(model *m, const char *text) { return ambit_graph_decimal(m->graph, text, &m->failure); }

static inline void model_open(model *m, size_t nx, const char *const *name) {
  *m = (model) { .graph = ambit_graph_open() };
  for (size_t i = 0; i < nx; i++) {
    m->name[i] = name[i], m->unit[i] = "1";
    m->state[i] = ambit_graph_symbol(m->graph, name[i], "1");
  }
  m->system = (ambit_system) {
    .graph = m->graph, .nx = nx, .name = m->name, .unit = m->unit, .state = m->state, .rate = m->rate
  };
}

/* Relative angles and velocities; ValEncIA-IVP paper (Rauh, Auer & Hofer 2006), equations 23 to 25, solved for the
** accelerations. */
static inline void model_double_pendulum(model *m, const char *spread) {
  static const char *const name[] = { "psi1", "psi2", "psi1'", "psi2'" };
  model_open(m, 4, name);
  const expr *x = m->state;
  expr g = decimal(m, "9.81"), two = number(m, 2), s = sine(m, x[1]), c = cosine(m, x[1]);
  expr outer = square(m, add(m, x[2], x[3])), inner = square(m, x[2]);
  /* [2 c; c 1] (phi1'', phi2'') = (r1, r2), c the cosine of the relative angle */
  expr r1 = sub(m, mul(m, s, outer), mul(m, mul(m, two, g), sine(m, x[0])));
  expr r2 = sub(m, mul(m, sub(m, number(m, 0), g), sine(m, add(m, x[0], x[1]))), mul(m, s, inner));
  expr determinant = add(m, number(m, 1), square(m, s)); /* 2 - c^2 */
  expr a1 = divide(m, sub(m, r1, mul(m, c, r2)), determinant);
  expr a2 = divide(m, sub(m, mul(m, two, r2), mul(m, c, r1)), determinant);
  m->rate[0] = x[2], m->rate[1] = x[3], m->rate[2] = a1, m->rate[3] = sub(m, a2, a1);
  expr pi = ambit_graph_pi(m->graph);
  m->initial[0] = divide(m, mul(m, number(m, 3), pi), number(m, 4));
  if (spread) {
    expr factor = ambit_graph_unknown(m->graph, "spread", (ambit_interval) { -1, 1 });
    m->initial[0] = mul(m, m->initial[0], add(m, number(m, 1), mul(m, decimal(m, spread), factor)));
  }
  m->initial[1] = divide(m, mul(m, number(m, -11), pi), number(m, 20));
  m->initial[2] = decimal(m, "0.43"), m->initial[3] = decimal(m, "0.67");
}

static inline void model_wide_double_pendulum(model *m) { model_double_pendulum(m, "0.01"); }
static inline void model_point_double_pendulum(model *m) { model_double_pendulum(m, NULL); }

static inline void model_lorenz(model *m) {
  static const char *const name[] = { "x", "y", "z" };
  model_open(m, 3, name);
  const expr *x = m->state;
  m->rate[0] = mul(m, number(m, 10), sub(m, x[1], x[0]));
  m->rate[1] = sub(m, mul(m, x[0], sub(m, number(m, 28), x[2])), x[1]);
  m->rate[2] = sub(m, mul(m, x[0], x[1]), mul(m, decimal(m, "8/3"), x[2]));
  m->initial[0] = number(m, 15), m->initial[1] = number(m, 15), m->initial[2] = number(m, 36);
}

static inline void model_pendulum(model *m) {
  static const char *const name[] = { "phi", "phi'" };
  model_open(m, 2, name);
  m->rate[0] = m->state[1], m->rate[1] = sub(m, number(m, 0), sine(m, m->state[0]));
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0);
}

static inline void model_oscillator(model *m) {
  static const char *const name[] = { "x", "x'" };
  model_open(m, 2, name);
  m->rate[0] = m->state[1], m->rate[1] = sub(m, number(m, 0), m->state[0]);
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0);
}

static inline void model_van_der_pol(model *m) {
  static const char *const name[] = { "x", "x'" };
  model_open(m, 2, name);
  const expr *x = m->state;
  m->rate[0] = x[1], m->rate[1] = sub(m, mul(m, sub(m, number(m, 1), square(m, x[0])), x[1]), x[0]);
  m->initial[0] = number(m, 2), m->initial[1] = number(m, 0);
}

static inline void model_van_der_pol_box(model *m) {
  model_van_der_pol(m);
  m->initial[0] = ambit_graph_unknown(m->graph, "x0", (ambit_interval) { 1.25, 1.55 });
  m->initial[1] = ambit_graph_unknown(m->graph, "v0", (ambit_interval) { 2.35, 2.45 });
}

static inline void model_stiff_line(model *m) {
  static const char *const name[] = { "x" };
  model_open(m, 1, name);
  expr away = sub(m, m->state[0], cosine(m, ambit_graph_time(m->graph)));
  m->rate[0] = mul(m, number(m, -1000), away);
  m->initial[0] = number(m, 0);
}

/* heat in a rod of 16 pieces, its ends at sin t and 0 */
static inline void model_rod(model *m) {
  static const char *const name[16] = { "u1", "u2", "u3", "u4", "u5", "u6", "u7", "u8", "u9", "u10", "u11", "u12",
    "u13", "u14", "u15", "u16" };
  model_open(m, 16, name);
  for (size_t i = 0; i < 16; i++) {
    expr before = i ? m->state[i - 1] : sine(m, ambit_graph_time(m->graph));
    expr after = i + 1 < 16 ? m->state[i + 1] : number(m, 0);
    expr twice = mul(m, number(m, 2), m->state[i]);
    m->rate[i] = mul(m, number(m, 100), sub(m, add(m, before, after), twice));
    m->initial[i] = number(m, i == 0);
  }
}

/* x'' = mu (1 - x^2) x' - x with mu = 20, as a first-order system in x and x' */
static inline void model_stiff_van_der_pol(model *m) {
  static const char *const name[] = { "x", "x'" };
  model_open(m, 2, name);
  const expr *x = m->state;
  expr damping = mul(m, number(m, 20), sub(m, number(m, 1), square(m, x[0])));
  m->rate[0] = x[1], m->rate[1] = sub(m, mul(m, damping, x[1]), x[0]);
  m->initial[0] = number(m, 2), m->initial[1] = number(m, 0);
}

static inline void model_escape(model *m) {
  static const char *const name[] = { "x" };
  model_open(m, 1, name);
  m->rate[0] = square(m, m->state[0]);
  m->initial[0] = number(m, 1);
}

static inline void model_close(model *m) { ambit_graph_close(m->graph); }
#endif
