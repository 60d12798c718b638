/* stiff_models.h -- stiff initial-value problems with published solutions, as expressions; data as decimals, so that
** they are exactly what is published. Sources: Mazzia & Magherini, Test Set for Initial Value Problem Solvers (Bari),
** and its R edition deTestSet (Soetaert, Cash & Mazzia); digits beyond the published ones were computed in quadruple
** precision by extrapolation. Shared by tests and benchmarks. */
#ifndef AMBIT_STIFF_MODELS_H
#define AMBIT_STIFF_MODELS_H
#include "reference_models.h"

static inline expr term(model *m, const char *factor, expr x) { return mul(m, decimal(m, factor), x); }

/* x'' = mu (1 - x^2) x' - x */
static inline void model_relaxation(model *m, const char *mu) {
  static const char *const name[] = { "x", "x'" };
  model_open(m, 2, name);
  const expr *x = m->state;
  m->rate[0] = x[1];
  m->rate[1] = sub(m, term(m, mu, mul(m, sub(m, number(m, 1), square(m, x[0])), x[1])), x[0]);
  m->initial[0] = number(m, 2), m->initial[1] = number(m, 0);
}

/* its other scaling: x' = y, eps y' = (1 - x^2) y - x */
static inline void model_scaled_relaxation(model *m, const char *eps) {
  static const char *const name[] = { "x", "y" };
  model_open(m, 2, name);
  const expr *x = m->state;
  m->rate[0] = x[1];
  expr f = sub(m, mul(m, sub(m, number(m, 1), square(m, x[0])), x[1]), x[0]);
  m->rate[1] = divide(m, f, decimal(m, eps));
  m->initial[0] = number(m, 2), m->initial[1] = number(m, 0);
}

/* y' = -1000 (y - cos t), y(0) = 0 */
static inline void model_stiff_cosine(model *m) {
  static const char *const name[] = { "y" };
  model_open(m, 1, name);
  expr t = ambit_graph_time(m->graph);
  m->rate[0] = mul(m, number(m, -1000), sub(m, m->state[0], cosine(m, t)));
  m->initial[0] = number(m, 0);
}

/* Robertson's reactions, k1 = 0.04, k2 = 3e7, k3 = 1e4, each with a relative spread, or NULL */
static inline expr robertson_rate(model *m, const char *value, const char *name, const char *spread) {
  expr k = decimal(m, value);
  if (!spread) return k;
  expr xi = ambit_graph_unknown(m->graph, name, (ambit_interval) { -1, 1 });
  return mul(m, k, add(m, number(m, 1), mul(m, decimal(m, spread), xi)));
}

static inline void model_spread_robertson(model *m, const char *spread) {
  static const char *const name[] = { "y1", "y2", "y3" };
  model_open(m, 3, name);
  const expr *y = m->state;
  expr k1 = robertson_rate(m, "0.04", "k1", spread), k2 = robertson_rate(m, "3e7", "k2", spread);
  expr k3 = robertson_rate(m, "1e4", "k3", spread);
  expr a = mul(m, k1, y[0]), b = mul(m, k3, mul(m, y[1], y[2])), c = mul(m, k2, square(m, y[1]));
  m->rate[0] = sub(m, b, a), m->rate[1] = sub(m, sub(m, a, b), c), m->rate[2] = c;
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 0), m->initial[2] = number(m, 0);
}

static inline void model_point_robertson(model *m) { model_spread_robertson(m, NULL); }

/* eight reactions of plant physiology; y1 .. y8 */
static inline void model_hires(model *m) {
  static const char *const name[] = { "y1", "y2", "y3", "y4", "y5", "y6", "y7", "y8" };
  model_open(m, 8, name);
  const expr *y = m->state;
  expr q = term(m, "280", mul(m, y[5], y[7])), seven = sub(m, q, term(m, "1.81", y[6]));
  m->rate[0] = add(
      m, add(m, term(m, "-1.71", y[0]), term(m, "0.43", y[1])), add(m, term(m, "8.32", y[2]), decimal(m, "0.0007")));
  m->rate[1] = sub(m, term(m, "1.71", y[0]), term(m, "8.75", y[1]));
  m->rate[2] = add(m, term(m, "-10.03", y[2]), add(m, term(m, "0.43", y[3]), term(m, "0.035", y[4])));
  m->rate[3] = sub(m, add(m, term(m, "8.32", y[1]), term(m, "1.71", y[2])), term(m, "1.12", y[3]));
  m->rate[4] = add(m, term(m, "-1.745", y[4]), term(m, "0.43", add(m, y[5], y[6])));
  expr six = add(m, term(m, "0.69", y[3]), sub(m, term(m, "1.71", y[4]), term(m, "0.43", y[5])));
  m->rate[5] = sub(m, add(m, six, term(m, "0.69", y[6])), q);
  m->rate[6] = seven, m->rate[7] = sub(m, number(m, 0), seven);
  for (int i = 0; i < 8; i++) m->initial[i] = number(m, 0);
  m->initial[0] = number(m, 1), m->initial[7] = decimal(m, "0.0057");
}

/* the heat equation by the method of lines: 24 points on (0, 1), u = 0 at both ends, u = x (1 - x) at first */
static inline void model_heat(model *m) {
  static const char *const name[] = { "u1", "u2", "u3", "u4", "u5", "u6", "u7", "u8", "u9", "u10", "u11", "u12", "u13",
    "u14", "u15", "u16", "u17", "u18", "u19", "u20", "u21", "u22", "u23", "u24" };
  model_open(m, 24, name);
  for (int i = 0; i < 24; i++) {
    expr sum = mul(m, number(m, -2), m->state[i]);
    if (i > 0) sum = add(m, sum, m->state[i - 1]);
    if (i < 23) sum = add(m, sum, m->state[i + 1]);
    m->rate[i] = mul(m, number(m, 625), sum);
    m->initial[i] = number(m, 0.0016 * (i + 1) * (24 - i));
  }
}

/* Field & Noyes' Oregonator */
static inline void model_oregonator(model *m) {
  static const char *const name[] = { "y1", "y2", "y3" };
  model_open(m, 3, name);
  const expr *y = m->state;
  expr s = decimal(m, "77.27"), product = mul(m, y[0], y[1]);
  expr f = sub(m, sub(m, add(m, y[1], y[0]), product), term(m, "8.375e-6", square(m, y[0])));
  m->rate[0] = mul(m, s, f);
  m->rate[1] = divide(m, sub(m, sub(m, y[2], y[1]), product), s);
  m->rate[2] = term(m, "0.161", sub(m, y[0], y[2]));
  m->initial[0] = number(m, 1), m->initial[1] = number(m, 2), m->initial[2] = number(m, 3);
}
#endif
