/* constrained_models.h -- systems whose solutions stay on a manifold, with its equations as invariants. */
#ifndef AMBIT_CONSTRAINED_MODELS_H
#define AMBIT_CONSTRAINED_MODELS_H
#include "kit/reference_models.h"

#define MODEL_INVARIANTS 16

typedef struct constrained {
  model m; /* first */
  expr invariant[MODEL_INVARIANTS];
  const char *name[MODEL_INVARIANTS];
} constrained;

static inline void constrained_open(constrained *c, size_t nx, const char *const *name) {
  *c = (constrained) { 0 };
  model_open(&c->m, nx, name);
}

static inline void constrained_add(constrained *c, const char *name, expr g) {
  size_t k = c->m.system.ninvariant++;
  c->invariant[k] = g, c->name[k] = name;
  c->m.system.invariant = c->invariant, c->m.system.invariant_name = c->name;
}

static inline expr negative(model *m, expr a) { return sub(m, number(m, 0), a); }
static inline expr root(model *m, expr a) { return ambit_graph_op(m->graph, AMBIT_OP_SQRT, a, a); }
static inline expr unknown(model *m, const char *name, double lo, double hi) {
  return ambit_graph_unknown(m->graph, name, (ambit_interval) { lo, hi });
}
static inline expr sum_of_squares(model *m, size_t n, const expr *x) {
  expr sum = number(m, 0);
  for (size_t i = 0; i < n; i++) sum = add(m, sum, square(m, x[i]));
  return sum;
}

/* q' = q w / 2, w the angular velocity in the body's axes; from a turn by 2 a about x */
static inline void model_quaternion(constrained *c, int varying, double spread) {
  static const char *const name[] = { "q0", "q1", "q2", "q3" };
  constrained_open(c, 4, name);
  model *m = &c->m;
  const expr *q = m->state;
  expr t = ambit_graph_time(m->graph), half = number(m, 0.5);
  expr w[3] = { decimal(m, "0.3"), decimal(m, "-0.5"), decimal(m, "0.8") };
  if (varying) {
    w[0] = sine(m, t), w[1] = mul(m, w[1], cosine(m, mul(m, number(m, 3), t)));
    w[2] = add(m, w[2], mul(m, decimal(m, "0.1"), cosine(m, t)));
  }
  expr rate[4] = { negative(m, add(m, add(m, mul(m, q[1], w[0]), mul(m, q[2], w[1])), mul(m, q[3], w[2]))),
    sub(m, add(m, mul(m, q[0], w[0]), mul(m, q[2], w[2])), mul(m, q[3], w[1])),
    sub(m, add(m, mul(m, q[0], w[1]), mul(m, q[3], w[0])), mul(m, q[1], w[2])),
    sub(m, add(m, mul(m, q[0], w[2]), mul(m, q[1], w[1])), mul(m, q[2], w[0])) };
  expr a = spread > 0 ? unknown(m, "a", 0.4 - spread, 0.4 + spread) : decimal(m, "0.4");
  for (size_t i = 0; i < 4; i++) m->rate[i] = mul(m, half, rate[i]), m->initial[i] = number(m, 0);
  m->initial[0] = cosine(m, a), m->initial[1] = sine(m, a);
  constrained_add(c, "spin: norm", sub(m, sum_of_squares(m, 4, q), number(m, 1)));
}

/* A point on a circle of radius 1, held by a multiplier, from the angle a below the horizontal, at rest or in motion:
** x'' = -lambda x, y'' = -lambda y - g, lambda = (v^2 - g y) / (x^2 + y^2) */
static inline void model_cartesian_pendulum(constrained *c, double spread) {
  static const char *const name[] = { "x", "y", "x'", "y'" };
  constrained_open(c, 4, name);
  model *m = &c->m;
  const expr *s = m->state;
  expr g = decimal(m, "9.81"), r2 = sum_of_squares(m, 2, s);
  expr lambda = divide(m, sub(m, sum_of_squares(m, 2, s + 2), mul(m, g, s[1])), r2);
  m->rate[0] = s[2], m->rate[1] = s[3];
  m->rate[2] = negative(m, mul(m, lambda, s[0])), m->rate[3] = sub(m, negative(m, mul(m, lambda, s[1])), g);
  expr a = spread > 0 ? unknown(m, "a", 0.3 - spread, 0.3 + spread) : decimal(m, "0.3"), u = decimal(m, "0.7");
  m->initial[0] = cosine(m, a), m->initial[1] = negative(m, sine(m, a));
  m->initial[2] = mul(m, u, sine(m, a)), m->initial[3] = mul(m, u, cosine(m, a));
  constrained_add(c, "rod: length", sub(m, r2, number(m, 1)));
  constrained_add(c, "rod: speed", add(m, mul(m, s[0], s[2]), mul(m, s[1], s[3])));
}

/* x'' = -x with its energy, which is known for each value of the uncertain data */
static inline void model_energy_oscillator(constrained *c, double spread) {
  static const char *const name[] = { "x", "v" };
  constrained_open(c, 2, name);
  model *m = &c->m;
  const expr *s = m->state;
  m->rate[0] = s[1], m->rate[1] = negative(m, s[0]);
  m->initial[0] = unknown(m, "x0", 1 - spread, 1 + spread), m->initial[1] = unknown(m, "v0", -spread, 2 * spread);
  constrained_add(c, "energy", sub(m, sum_of_squares(m, 2, s), sum_of_squares(m, 2, m->initial)));
}

/* x'' = -x / |x|^3 in the plane, eccentricity 0.6 and more, with its energy and angular momentum */
static inline void model_kepler(constrained *c, double spread) {
  static const char *const name[] = { "x", "y", "x'", "y'" };
  constrained_open(c, 4, name);
  model *m = &c->m;
  const expr *s = m->state;
  expr r2 = sum_of_squares(m, 2, s), r3 = mul(m, r2, root(m, r2));
  m->rate[0] = s[2], m->rate[1] = s[3];
  for (size_t i = 0; i < 2; i++) m->rate[2 + i] = negative(m, divide(m, s[i], r3));
  expr v = spread > 0 ? unknown(m, "v", 2 - spread, 2 + spread) : number(m, 2);
  m->initial[0] = decimal(m, "0.4"), m->initial[1] = m->initial[2] = number(m, 0), m->initial[3] = v;
  expr energy = sub(m, divide(m, square(m, v), number(m, 2)), decimal(m, "2.5"));
  expr at = sub(m, divide(m, sum_of_squares(m, 2, s + 2), number(m, 2)), divide(m, number(m, 1), root(m, r2)));
  constrained_add(c, "energy", sub(m, at, energy));
  expr momentum = sub(m, mul(m, s[0], s[3]), mul(m, s[1], s[2]));
  constrained_add(c, "momentum", sub(m, momentum, mul(m, v, decimal(m, "0.4"))));
}
#endif
