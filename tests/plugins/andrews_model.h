/* andrews_model.h -- Andrews' squeezer: seven bodies, three loops, one degree of freedom, motions of 1 kHz.
**
** Data and start: IVP Test Set (Mazzia & Magherini 2008). Here in partitioned form: with q(beta) on the loops,
** n = dq/dbeta from three pairs of equations, mu = sum m |dc/dbeta|^2 + I (dangle/dbeta)^2,
**   q' = n beta',   mu beta'' = mom - dV/dbeta - mu' beta'^2 / 2   (Lagrange, one degree of freedom);
** the six equations of the loops are invariants.
*/
#ifndef AMBIT_ANDREWS_MODEL_H
#define AMBIT_ANDREWS_MODEL_H
#include "constrained_models.h"

enum { BETA, THETA, GAMMA, PHI, DELTA, OMEGA, EPSILON, ANDREWS_ANGLES };

typedef struct plane {
  expr x, y;
} plane;

static inline plane plane_add(model *m, plane a, plane b) { return (plane) { add(m, a.x, b.x), add(m, a.y, b.y) }; }
static inline plane plane_sub(model *m, plane a, plane b) { return (plane) { sub(m, a.x, b.x), sub(m, a.y, b.y) }; }
static inline plane plane_scale(model *m, expr s, plane a) { return (plane) { mul(m, s, a.x), mul(m, s, a.y) }; }
static inline plane plane_point(model *m, const char *x, const char *y) {
  return (plane) { decimal(m, x), decimal(m, y) };
}
/* length (cos a, sin a), and the same turned by -90 degrees: length (sin a, -cos a) */
static inline plane plane_along(model *m, const char *length, expr a) {
  return plane_scale(m, decimal(m, length), (plane) { cosine(m, a), sine(m, a) });
}
static inline plane plane_right(model *m, const char *length, expr a) {
  return plane_scale(m, decimal(m, length), (plane) { sine(m, a), negative(m, cosine(m, a)) });
}

typedef struct andrews {
  model *m;
  expr n[ANDREWS_ANGLES]; /* dq/dbeta */
} andrews;

static inline expr andrews_slope(andrews *a, expr e) {
  model *m = a->m;
  return ambit_graph_time_derivative(m->graph, e, ANDREWS_ANGLES, m->state, a->n, &m->failure);
}

/* Of vectors a x + b y = c */
static inline void andrews_pair(model *m, plane a, plane b, plane c, expr *x, expr *y) {
  expr determinant = sub(m, mul(m, a.x, b.y), mul(m, a.y, b.x));
  *x = divide(m, sub(m, mul(m, c.x, b.y), mul(m, c.y, b.x)), determinant);
  *y = divide(m, sub(m, mul(m, a.x, c.y), mul(m, a.y, c.x)), determinant);
}

/* derivative of a vector by state i, the others held */
static inline plane andrews_partial(model *m, plane p, int i) {
  return (plane) { ambit_graph_derivative(m->graph, p.x, m->state[i], &m->failure),
    ambit_graph_derivative(m->graph, p.y, m->state[i], &m->failure) };
}

/* n[i], n[j] such that the loop a = b, of which b contains q_i and q_j only, stays closed; a's slopes are known */
static inline void andrews_loop(andrews *s, plane slope, plane b, int i, int j) {
  andrews_pair(s->m, andrews_partial(s->m, b, i), andrews_partial(s->m, b, j), slope, &s->n[i], &s->n[j]);
}

/* adds what a body with mass, inertia, centre of mass and angle contributes to mu */
static inline expr andrews_body(andrews *s, expr mu, const char *mass, const char *inertia, plane c, expr angle) {
  model *m = s->m;
  expr v2 = add(m, square(m, andrews_slope(s, c.x)), square(m, andrews_slope(s, c.y)));
  mu = add(m, mu, mul(m, decimal(m, mass), v2));
  return add(m, mu, mul(m, decimal(m, inertia), square(m, andrews_slope(s, angle))));
}

static inline void andrews_motion(andrews *s, expr be, expr bt, expr pd, expr oe) {
  model *m = s->m;
  const expr *q = m->state;
  plane A = plane_point(m, "-0.06934", "-0.00227"), B = plane_point(m, "-0.03635", "0.03273");
  plane C = plane_point(m, "0.014", "0.072"), F = plane_along(m, "0.007", be);
  expr mu = andrews_body(s, number(m, 0), "0.04325", "2.194e-6", plane_along(m, "0.00092", be), be);
  mu = andrews_body(s, mu, "0.00365", "4.410e-7", plane_sub(m, F, plane_along(m, "0.0115", bt)), bt);
  plane c3 = plane_add(m, B, plane_add(m, plane_right(m, "0.01874", q[GAMMA]), plane_along(m, "0.01043", q[GAMMA])));
  mu = andrews_body(s, mu, "0.02373", "5.255e-6", c3, q[GAMMA]);
  plane c4 = plane_add(m, plane_along(m, "0.04", q[DELTA]), plane_right(m, "0.00579", pd)); /* e - ea */
  mu = andrews_body(s, mu, "0.00706", "5.667e-7", plane_add(m, A, c4), pd);
  plane c5 = plane_sub(m, plane_right(m, "0.02308", q[DELTA]), plane_along(m, "0.00916", q[DELTA]));
  mu = andrews_body(s, mu, "0.07050", "1.169e-5", plane_add(m, A, c5), q[DELTA]);
  plane c6 = plane_add(m, plane_right(m, "0.04", q[EPSILON]), plane_along(m, "0.00579", oe)); /* zf - fa */
  mu = andrews_body(s, mu, "0.00706", "5.667e-7", plane_add(m, A, c6), oe);
  plane c7 = plane_sub(m, plane_right(m, "0.01228", q[EPSILON]), plane_along(m, "0.00449", q[EPSILON]));
  mu = andrews_body(s, mu, "0.05498", "1.912e-5", plane_add(m, A, c7), q[EPSILON]);
  plane D = plane_add(m, B, plane_add(m, plane_along(m, "0.02", q[GAMMA]), plane_right(m, "0.018", q[GAMMA])));
  plane r = plane_sub(m, D, C);
  expr length = root(m, add(m, square(m, r.x), square(m, r.y)));
  expr pull = mul(m, decimal(m, "4530"), sub(m, length, decimal(m, "0.07785")));
  expr effort = sub(m, decimal(m, "0.033"), mul(m, pull, andrews_slope(s, length)));
  expr curve = mul(m, mul(m, number(m, 0.5), andrews_slope(s, mu)), square(m, q[ANDREWS_ANGLES]));
  m->rate[ANDREWS_ANGLES] = divide(m, sub(m, effort, curve), mu);
  for (int i = 0; i < ANDREWS_ANGLES; i++) m->rate[i] = mul(m, s->n[i], q[ANDREWS_ANGLES]);
}

static inline void model_andrews(constrained *c) {
  static const char *const name[] = { "beta", "theta", "gamma", "phi", "delta", "omega", "epsilon", "beta'" };
  static const char *const start[] = { "-0.0617138900142764496358948458001", "0", "0.455279819163070380255912382449",
    "0.222668390165885884674473185609", "0.487364979543842550225598953530", "-0.222668390165885884674473185609",
    "1.23054744454982119249735015568", "0" };
  static const char *const row[] = { "first: x", "first: y", "second: x", "second: y", "third: x", "third: y" };
  constrained_open(c, 8, name);
  model *m = &c->m;
  const expr *q = m->state;
  expr bt = add(m, q[BETA], q[THETA]), pd = add(m, q[PHI], q[DELTA]), oe = add(m, q[OMEGA], q[EPSILON]);
  plane A = plane_point(m, "-0.06934", "-0.00227"), B = plane_point(m, "-0.03635", "0.03273");
  plane E = plane_sub(m, plane_along(m, "0.007", q[BETA]), plane_along(m, "0.028", bt));
  plane first = plane_add(m, B, plane_right(m, "0.035", q[GAMMA]));
  plane second = plane_add(m, A, plane_add(m, plane_along(m, "0.04", q[DELTA]), plane_right(m, "0.02", pd)));
  plane third = plane_add(m, A, plane_add(m, plane_right(m, "0.04", q[EPSILON]), plane_along(m, "0.02", oe)));
  andrews s = { .m = m };
  s.n[BETA] = number(m, 1);
  andrews_loop(&s, plane_scale(m, number(m, -1), andrews_partial(m, E, BETA)), plane_sub(m, E, first), THETA, GAMMA);
  plane slope = plane_scale(m, s.n[GAMMA], andrews_partial(m, first, GAMMA));
  andrews_loop(&s, slope, second, PHI, DELTA);
  andrews_loop(&s, slope, third, OMEGA, EPSILON);
  andrews_motion(&s, q[BETA], bt, pd, oe);
  for (int i = 0; i < 8; i++) m->initial[i] = decimal(m, start[i]);
  const plane loop[] = { plane_sub(m, E, first), plane_sub(m, E, second), plane_sub(m, E, third) };
  for (int i = 0; i < 3; i++) constrained_add(c, row[2 * i], loop[i].x), constrained_add(c, row[2 * i + 1], loop[i].y);
}
#endif
