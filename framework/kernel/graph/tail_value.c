/* tail_value.c -- the tail of every operation, from magnitudes; upward mode.
**
** P is the operand's polynomial, T its tail (continuous, no more), tau bounds it. Products are expanded; c = a/b and
** y = sqrt u come from the residual, b T_c = T_a - [P_b P_c]_{>K} - T_b P_c. An elementary function splits into f(P +
** T) - f(P), by the mean value theorem, and f(P) minus its own polynomial, which solves the differential equation of
** the recursion with a defect of orders >= K only: |E| <= growth D s^(K+1) / (K+1). Sine and cosine turn, so their
** growth is 1; exp, sinh and cosh grow by at most e^swing, tanh by a power of it. Proofs: docs/numerics/series.md.
*/
#include "graph/tail.h"
#include <math.h>

/* K + 1 */
static double next_order(const ambit_tails *t) { return (double)t->K + 1; }

static double product(const ambit_tails *t, uint32_t a, uint32_t b) {
  return ambit_tails_product(t, a, b) + t->tau[a] * t->sum[b] + t->tau[b] * (t->sum[a] + t->tau[a]);
}

static double square(const ambit_tails *t, uint32_t a) {
  return ambit_tails_product(t, a, a) + t->tau[a] * (2 * t->sum[a] + t->tau[a]);
}

/* x / floor, nothing claimed unless floor > 0 */
static double over(double x, double floor) { return floor > 0 ? x / floor : INFINITY; }

static double quotient(const ambit_tails *t, uint32_t a, uint32_t b, uint32_t c) {
  double residual = t->tau[a] + ambit_tails_product(t, c, b) + t->sum[c] * t->tau[b];
  return over(residual, ambit_tails_gap(ambit_tails_value(t, b)));
}

/* T (y + P) = T_u - [P^2]_{>K}, where u > 0 on the whole step */
static double root(const ambit_tails *t, uint32_t u, uint32_t y) {
  double residual = t->tau[u] + ambit_tails_product(t, y, y), floor = ambit_tails_sqrt_floor(t, u);
  double polynomial = -(t->swing[y] - t->lo[y]);
  return floor > 0 ? over(residual, -(-floor - polynomial)) : INFINITY;
}

/* |e^u - e^P| <= e^P (e^|T| - 1) <= e^(u_0 + swing + tau) tau, e^u_0 <= first */
static double exp_shift(const ambit_tails *t, uint32_t u, double first) {
  return t->tau[u] == 0 ? 0 : first * ambit_tails_exp(t->swing[u] + t->tau[u]) * t->tau[u];
}

static double exponential(const ambit_tails *t, uint32_t u, uint32_t y) {
  double defect = ambit_tails_flow(t, u, y) / next_order(t);
  return ambit_tails_exp(t->swing[u]) * defect + exp_shift(t, u, ambit_tails_row(t, t->U, y)[0]);
}

static double turn(const ambit_tails *t, uint32_t u, uint32_t s, uint32_t c) {
  double ds = ambit_tails_flow(t, u, c), dc = ambit_tails_flow(t, u, s);
  return sqrt(ds * ds + dc * dc) / next_order(t) + t->tau[u];
}

/* infinite if one is NaN */
static double larger(double a, double b) { return a <= b ? b : b <= a ? a : INFINITY; }

/* (E_s, E_c) under [cosh, sinh; sinh, cosh] of P(s) - P(r): at most e^swing times the larger defect */
static double hyperbola(const ambit_tails *t, uint32_t u, uint32_t s, uint32_t c, bool sine_first) {
  double ds = ambit_tails_flow(t, u, c), dc = ambit_tails_flow(t, u, s);
  double cosh_first = ambit_tails_row(t, t->U, sine_first ? c : s)[0];
  return ambit_tails_exp(t->swing[u]) * larger(ds, dc) / next_order(t) + exp_shift(t, u, cosh_first);
}

/* the integral over the step of |f(P) + P_y| |P'|, f = tanh */
double ambit_tails_tanh_swing(const ambit_tails *t, uint32_t i) {
  return (1 + t->sum[t->tape->dst[i]]) * t->swing[t->tape->a[i]];
}

/* of P' P_s - P_y' and of P' [P_y^2]_{>K}, s = 1 - y^2 */
double ambit_tails_tanh_defect(const ambit_tails *t, uint32_t i) {
  uint32_t u = t->tape->a[i], y = t->tape->dst[i];
  return ambit_tails_flow(t, u, t->tape->aux[i]) + ambit_tails_row(t, t->RW, u)[t->K] * ambit_tails_product(t, y, y);
}

/* E = f(P) - P_y: E' = -(f(P) + P_y) P' E + defect */
static double tangent(const ambit_tails *t, uint32_t i, uint32_t u) {
  double growth = ambit_tails_exp(ambit_tails_tanh_swing(t, i));
  return growth * ambit_tails_tanh_defect(t, i) / next_order(t) + ambit_tails_tanh_slope(t, u) * t->tau[u];
}

static double logarithm(const ambit_tails *t, uint32_t u, uint32_t y) {
  return over(ambit_tails_flow(t, y, u) / next_order(t) + t->tau[u], ambit_tails_segment(t, u).lo);
}

static double arc(const ambit_tails *t, uint32_t i, uint32_t u, uint32_t y) {
  double sum_of_flow = ambit_tails_row(t, t->RW, y)[t->K];
  double defect = ambit_tails_flow(t, y, t->tape->aux[i]) + sum_of_flow * ambit_tails_product(t, u, u);
  return (defect / next_order(t) + t->tau[u]) / ambit_tails_atan_floor(t, i);
}

static double angle(const ambit_tails *t, uint32_t i, uint32_t a, uint32_t b, uint32_t y) {
  double floor = ambit_tails_atan2_floor(t, i), sum_of_flow = ambit_tails_row(t, t->RW, y)[t->K];
  double defect = ambit_tails_flow(t, a, b) + ambit_tails_flow(t, b, a) + ambit_tails_flow(t, y, t->tape->aux[i]) +
                  sum_of_flow * (ambit_tails_product(t, a, a) + ambit_tails_product(t, b, b));
  double shift = sqrt(t->tau[a] * t->tau[a] + t->tau[b] * t->tau[b]);
  if (!(floor > 0)) return INFINITY;
  return defect / next_order(t) / floor + shift / -(-floor / sqrt(floor));
}

static double follow(const ambit_tails *t, uint32_t i) {
  uint32_t operand = ambit_tails_branch(t, i);
  return operand == AMBIT_NO_SLOT ? INFINITY : t->tau[operand];
}

static double value(const ambit_tails *t, uint32_t i) {
  const ambit_tape *tape = t->tape;
  uint32_t op = tape->op[i], y = tape->dst[i], a = tape->a[i], b = tape->b[i], aux = tape->aux[i];
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB: return t->tau[a] + t->tau[b];
  case AMBIT_OP_NEG: return t->tau[a];
  case AMBIT_OP_MUL: return product(t, a, b);
  case AMBIT_OP_SQR: return square(t, a);
  case AMBIT_OP_DIV: return quotient(t, a, b, y);
  case AMBIT_OP_SQRT: return root(t, a, y);
  case AMBIT_OP_EXP: return exponential(t, a, y);
  case AMBIT_OP_LOG: return logarithm(t, a, y);
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: return aux < y ? t->tau[aux] : turn(t, a, y, aux); /* the pair shares one bound */
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH: return aux < y ? t->tau[aux] : hyperbola(t, a, y, aux, op == AMBIT_OP_SINH);
  case AMBIT_OP_TANH: return tangent(t, i, a);
  case AMBIT_OP_ATAN: return arc(t, i, a, y);
  case AMBIT_OP_ATAN2: return angle(t, i, a, b, y);
  default: return follow(t, i);
  }
}

void ambit_tails_values(ambit_tails *t, uint32_t i) {
  double tau = value(t, i);
  t->tau[t->tape->dst[i]] = tau >= 0 ? tau : INFINITY; /* NaN claims nothing */
}
