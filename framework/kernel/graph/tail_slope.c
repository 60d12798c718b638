/* tail_slope.c -- how much a tail changes over the box, per direction; upward mode.
**
** |T(x, s) - T(c, s)| <= sum_j sigma_j |x_j - c_j| s^(K+1). Each rule of tail_value.c is an identity of products, so
** its change follows from a b - a0 b0 = (a + a0)/2 (b - b0) + (b + b0)/2 (a - a0) with magnitudes; an elementary
** function again as the defect of its differential equation plus a shift. Only magnitudes of any valid slopes enter,
** so it does not matter by which rules the slopes were found.
*/
#include "graph/tail.h"
#include <math.h>

static size_t lane_of(const ambit_tails *t, uint32_t v) { return (size_t)v * t->ndir; }

static void clear(const ambit_tails *t, double *restrict out) {
  for (uint32_t d = 0; d < t->ndir; d++) out[d] = 0;
}

/* out += f x */
static void add(const ambit_tails *t, double *restrict out, double f, const double *restrict x) {
  for (uint32_t d = 0; d < t->ndir; d++) out[d] += f * x[d];
}

static void multiply(const ambit_tails *t, double *out, double f) {
  for (uint32_t d = 0; d < t->ndir; d++) out[d] *= f;
}

static void divide(const ambit_tails *t, double *out, double f) {
  for (uint32_t d = 0; d < t->ndir; d++) out[d] = f > 0 ? out[d] / f : INFINITY;
}

/* out += sum_k w_k V_v,k, four directions at a time in registers */
static void dot(const ambit_tails *t, double *out, const double *w, uint32_t v) {
  const double *V = t->V + lane_of(t, v) * t->stride;
  size_t nd = t->ndir, last = t->moving[v] ? t->K : 0, d = 0;
  for (; d + 4 <= nd; d += 4) {
    ambit_four *to = (ambit_four *)(void *)(out + d), even = *to, odd = { 0, 0, 0, 0 };
    size_t k = 0;
    for (; k < last; k += 2) {
      even += w[k] * *(const ambit_four *)(const void *)(V + k * nd + d);
      odd += w[k + 1] * *(const ambit_four *)(const void *)(V + (k + 1) * nd + d);
    }
    if (k == last) even += w[k] * *(const ambit_four *)(const void *)(V + k * nd + d);
    *to = even + odd;
  }
  for (; d < nd; d++)
    for (size_t k = 0; k <= last; k++) out[d] += w[k] * V[k * nd + d];
}

/* out += sum_k (f R_a,k + g) V_v,k */
static void rest(const ambit_tails *t, double *out, double f, double g, uint32_t a, uint32_t v) {
  const double *R = ambit_tails_row(t, t->R, a);
  for (uint32_t k = 0; k <= t->K; k++) t->weight[k] = f * R[k] + g;
  dot(t, out, t->weight, v);
}

/* out += what b's change does to a product's tail: [U_a V_b]_{>K} + tau_a |V_b| + (|U_a| + tau_a) sigma_b */
static void product(const ambit_tails *t, double *out, uint32_t a, uint32_t b) {
  rest(t, out, 1, t->tau[a], a, b);
  add(t, out, t->sum[a] + t->tau[a], t->sigma + lane_of(t, b));
}

/* out += change of the part of order >= K of U_u' U_v */
static void flow(const ambit_tails *t, double *out, uint32_t u, uint32_t v) {
  const double *R = ambit_tails_row(t, t->R, v);
  double order = 0;
  for (uint32_t k = 0; k <= t->K; k++, order += 1) t->weight[k] = order * R[k];
  dot(t, out, t->weight, u);
  dot(t, out, ambit_tails_row(t, t->RW, u), v);
}

/* out += f sum_k k V_u,k */
static void speed(const ambit_tails *t, double *out, double f, uint32_t u) {
  double order = 0;
  for (uint32_t k = 0; k <= t->K; k++, order += 1) t->weight[k] = order * f;
  dot(t, out, t->weight, u);
}

/* out += change of e^P (e^T - 1), of modulus e^(iP) (e^(iT) - 1): f (sigma + tau |V|) */
static void shift(const ambit_tails *t, double *out, double f, uint32_t u) {
  add(t, out, f, t->sigma + lane_of(t, u));
  add(t, out, f * t->tau[u], t->vsum + lane_of(t, u));
}

static void sum(const ambit_tails *t, double *out, uint32_t a, uint32_t b) {
  add(t, out, 1, t->sigma + lane_of(t, a));
  add(t, out, 1, t->sigma + lane_of(t, b));
}

static void quotient(const ambit_tails *t, double *out, uint32_t a, uint32_t b, uint32_t c) {
  add(t, out, 1, t->sigma + lane_of(t, a));
  product(t, out, c, b);
  rest(t, out, 1, t->tau[b], b, c);
  divide(t, out, ambit_tails_gap(ambit_tails_value(t, b)));
}

/* 2 ybar dT = dT_u - 2 [Pbar dP]_{>K} - 2 Tbar dP */
static void root(const ambit_tails *t, double *out, uint32_t u, uint32_t y) {
  add(t, out, 1, t->sigma + lane_of(t, u));
  rest(t, out, 2, 2 * t->tau[y], y, y);
  divide(t, out, 2 * ambit_tails_sqrt_floor(t, u));
}

/* dE' = P' dE + E dP' + dd, with |E| <= error s^(K+1), and e^swing the growth */
static void grow(const ambit_tails *t, double *out, double growth, double error, uint32_t u) {
  multiply(t, out, growth / ((double)t->K + 1));
  speed(t, out, growth * error / ((double)t->K + 2), u);
}

static void exponential(const ambit_tails *t, double *out, uint32_t u, uint32_t y) {
  double growth = ambit_tails_exp(t->swing[u]), error = growth * ambit_tails_flow(t, u, y) / ((double)t->K + 1);
  flow(t, out, u, y);
  grow(t, out, growth, error, u);
  shift(t, out, ambit_tails_row(t, t->U, y)[0] * ambit_tails_exp(t->swing[u] + t->tau[u]), u);
}

/* the pair of sine and cosine turns: norms of both lanes */
static void turn(const ambit_tails *t, double *out, uint32_t u, uint32_t s, uint32_t c) {
  double *x = t->lane, ds = ambit_tails_flow(t, u, c), dc = ambit_tails_flow(t, u, s);
  clear(t, x);
  flow(t, out, u, c);
  flow(t, x, u, s);
  for (uint32_t d = 0; d < t->ndir; d++) out[d] = sqrt(out[d] * out[d] + x[d] * x[d]);
  grow(t, out, 1, sqrt(ds * ds + dc * dc) / ((double)t->K + 1), u);
  shift(t, out, 1, u);
}

/* sinh +- cosh decouple: E+-' = +-P' E+- + d_s +- d_c */
static void hyperbola(const ambit_tails *t, double *out, uint32_t u, uint32_t s, uint32_t c, bool sine_first) {
  double growth = ambit_tails_exp(t->swing[u]);
  double defect = ambit_tails_flow(t, u, c) + ambit_tails_flow(t, u, s);
  flow(t, out, u, c);
  flow(t, out, u, s);
  grow(t, out, growth, growth * defect / ((double)t->K + 1), u);
  shift(t, out, ambit_tails_row(t, t->U, sine_first ? c : s)[0] * ambit_tails_exp(t->swing[u] + t->tau[u]), u);
}

/* out += change of P_y' [P_a^2]_{>K} */
static void square_part(const ambit_tails *t, double *out, uint32_t y, uint32_t a) {
  speed(t, out, ambit_tails_product(t, a, a), y);
  rest(t, out, 2 * ambit_tails_row(t, t->RW, y)[t->K], 0, a, a);
}

/* dE' = -(f + P_y) P' dE - d((f + P_y) P') E + dd, f = tanh P, |df| <= |dP|; and T m with m = int f'(P + theta T),
** |m| <= slope, |f''| <= 2 |f'| and < 0.77 */
static void tangent(const ambit_tails *t, double *out, uint32_t i, uint32_t u, uint32_t y) {
  double growth = ambit_tails_exp(ambit_tails_tanh_swing(t, i)), next = (double)t->K + 1;
  double speed_of_u = ambit_tails_row(t, t->RW, u)[t->K], slope = ambit_tails_tanh_slope(t, u);
  double error = growth * ambit_tails_tanh_defect(t, i) / next, bend = 2 * slope < 0.77 ? 2 * slope : 0.77;
  double part = error * next / (next + 1);
  flow(t, out, u, t->tape->aux[i]);
  square_part(t, out, u, y);
  add(t, out, part * speed_of_u, t->vsum + lane_of(t, u));
  add(t, out, part * speed_of_u, t->vsum + lane_of(t, y));
  speed(t, out, part * (1 + t->sum[y]), u);
  multiply(t, out, growth / next);
  add(t, out, slope + t->tau[u] * bend, t->sigma + lane_of(t, u));
  add(t, out, t->tau[u] * bend, t->vsum + lane_of(t, u));
}

static void logarithm(const ambit_tails *t, double *out, uint32_t u, uint32_t y) {
  double floor = ambit_tails_segment(t, u).lo, next = (double)t->K + 1;
  double defect = ambit_tails_flow(t, y, u), fraction = t->tau[u] / floor;
  flow(t, out, y, u);
  add(t, out, defect / floor, t->vsum + lane_of(t, u));
  divide(t, out, next);
  add(t, out, 1 + fraction, t->sigma + lane_of(t, u));
  add(t, out, fraction, t->vsum + lane_of(t, u));
  divide(t, out, floor);
}

/* out += f times the change of u_theta^2, u_theta = P + theta T */
static void square_change(const ambit_tails *t, double *out, double f, uint32_t u) {
  double twice = 2 * f * (t->sum[u] + t->tau[u]);
  add(t, out, twice, t->vsum + lane_of(t, u));
  add(t, out, twice, t->sigma + lane_of(t, u));
}

/* N dE' = -dd - E' dN and N r = T, N = 1 + u_theta^2 */
static void arc(const ambit_tails *t, double *out, uint32_t i, uint32_t u, uint32_t y) {
  uint32_t q = t->tape->aux[i];
  double floor = ambit_tails_atan_floor(t, i);
  double sum_of_flow = ambit_tails_row(t, t->RW, y)[t->K];
  double defect = ambit_tails_flow(t, y, q) + sum_of_flow * ambit_tails_product(t, u, u);
  flow(t, out, y, q);
  square_part(t, out, y, u);
  square_change(t, out, defect / floor, u);
  divide(t, out, (double)t->K + 1);
  add(t, out, 1, t->sigma + lane_of(t, u));
  square_change(t, out, t->tau[u] / floor, u);
  divide(t, out, floor);
}

/* out += change of T_a P_b */
static void cross(const ambit_tails *t, double *out, uint32_t a, uint32_t b) {
  add(t, out, t->tau[a], t->vsum + lane_of(t, b));
  add(t, out, t->sum[b], t->sigma + lane_of(t, a));
}

/* the same with N = a_theta^2 + b_theta^2 and T_a P_b - P_a T_b over it */
static void angle(const ambit_tails *t, double *out, uint32_t i, uint32_t a, uint32_t b, uint32_t y) {
  uint32_t q = t->tape->aux[i];
  double floor = ambit_tails_atan2_floor(t, i), sum_of_flow = ambit_tails_row(t, t->RW, y)[t->K];
  double defect = ambit_tails_flow(t, a, b) + ambit_tails_flow(t, b, a) + ambit_tails_flow(t, y, q) +
                  sum_of_flow * (ambit_tails_product(t, a, a) + ambit_tails_product(t, b, b));
  flow(t, out, a, b), flow(t, out, b, a), flow(t, out, y, q);
  square_part(t, out, y, a), square_part(t, out, y, b);
  square_change(t, out, defect / floor, a), square_change(t, out, defect / floor, b);
  divide(t, out, (double)t->K + 1);
  double shift = sqrt(t->tau[a] * t->tau[a] + t->tau[b] * t->tau[b]) / -(-floor / sqrt(floor));
  cross(t, out, a, b), cross(t, out, b, a);
  square_change(t, out, shift, a), square_change(t, out, shift, b);
  divide(t, out, floor);
}

static void follow(const ambit_tails *t, double *out, uint32_t i) {
  uint32_t operand = ambit_tails_branch(t, i);
  if (operand == AMBIT_NO_SLOT)
    divide(t, out, 0);
  else
    add(t, out, 1, t->sigma + lane_of(t, operand));
}

static void slopes(const ambit_tails *t, double *out, uint32_t i) {
  const ambit_tape *tape = t->tape;
  uint32_t op = tape->op[i], y = tape->dst[i], a = tape->a[i], b = tape->b[i], aux = tape->aux[i];
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB: sum(t, out, a, b); break;
  case AMBIT_OP_NEG: add(t, out, 1, t->sigma + lane_of(t, a)); break;
  case AMBIT_OP_MUL: product(t, out, a, b), product(t, out, b, a); break;
  case AMBIT_OP_SQR: product(t, out, a, a), multiply(t, out, 2); break;
  case AMBIT_OP_DIV: quotient(t, out, a, b, y); break;
  case AMBIT_OP_SQRT: root(t, out, a, y); break;
  case AMBIT_OP_EXP: exponential(t, out, a, y); break;
  case AMBIT_OP_LOG: logarithm(t, out, a, y); break;
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS: /* the pair shares one bound */
    if (aux < y)
      add(t, out, 1, t->sigma + lane_of(t, aux));
    else
      turn(t, out, a, y, aux);
    break;
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
    if (aux < y)
      add(t, out, 1, t->sigma + lane_of(t, aux));
    else
      hyperbola(t, out, a, y, aux, op == AMBIT_OP_SINH);
    break;
  case AMBIT_OP_TANH: tangent(t, out, i, a, y); break;
  case AMBIT_OP_ATAN: arc(t, out, i, a, y); break;
  case AMBIT_OP_ATAN2: angle(t, out, i, a, b, y); break;
  default: follow(t, out, i); break;
  }
}

void ambit_tails_slopes(ambit_tails *t, uint32_t i) {
  double *out = t->sigma + lane_of(t, t->tape->dst[i]);
  clear(t, out);
  slopes(t, out, i);
  for (uint32_t d = 0; d < t->ndir; d++)
    if (!(out[d] >= 0)) out[d] = INFINITY; /* NaN claims nothing */
}
