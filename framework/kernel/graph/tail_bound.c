/* tail_bound.c -- the bounds that the tail rules share: convolutions of magnitudes, spans over the step, denominators.
**
** Upward mode. A lower bound is minus the upward-rounded negated value. Infinite magnitudes make NaN in places (inf -
** inf, 0 inf): comparisons are written so that NaN claims nothing.
*/
#include "graph/tail.h"
#include "num/interval.h"

double ambit_tails_dot(const ambit_tails *t, const double *a, const double *r) {
  const ambit_four *x = (const ambit_four *)(const void *)a, *y = (const ambit_four *)(const void *)r;
  ambit_four even = x[0] * y[0], odd = { 0, 0, 0, 0 };
  size_t n = t->K / 4 + 1, i = 1;
  for (; i + 1 < n; i += 2) {
    odd += x[i] * y[i];
    even += x[i + 1] * y[i + 1];
  }
  if (i < n) odd += x[i] * y[i];
  even += odd;
  return (even[0] + even[1]) + (even[2] + even[3]);
}

double ambit_tails_product(const ambit_tails *t, uint32_t a, uint32_t b) {
  if (!t->moving[a] || !t->moving[b]) return 0;
  return ambit_tails_dot(t, ambit_tails_row(t, t->U, a), ambit_tails_row(t, t->R, b));
}

double ambit_tails_flow(const ambit_tails *t, uint32_t u, uint32_t v) {
  if (!t->moving[u] || !t->moving[v]) return 0;
  return ambit_tails_dot(t, ambit_tails_row(t, t->W, u), ambit_tails_row(t, t->R, v));
}

double ambit_tails_exp(double x) {
  if (!(x < 700)) return INFINITY;
  ambit_interval r, a = { x, x };
  ambit_interval_op(AMBIT_OP_EXP, &r, a, a);
  return r.hi;
}

/* [lo, hi] of coefficient 0 widened by r */
static ambit_span widened(const ambit_tails *t, uint32_t v, double r) {
  return (ambit_span) { -(r - t->lo[v]), t->hi[v] + r };
}

/* Both hold: the step keeps within swing and tail of coefficient 0, and the range holds for all reals. */
ambit_span ambit_tails_value(const ambit_tails *t, uint32_t v) {
  ambit_span x = widened(t, v, t->swing[v] + t->tau[v]);
  double lo = t->tape->range_lo[v], hi = t->tape->range_hi[v];
  return (ambit_span) { x.lo > lo ? x.lo : lo, x.hi < hi ? x.hi : hi };
}

/* The polynomial is the function minus its tail, so it leaves the range by at most tau. */
ambit_span ambit_tails_segment(const ambit_tails *t, uint32_t v) {
  ambit_span x = widened(t, v, t->swing[v] + t->tau[v]);
  double lo = -(t->tau[v] - t->tape->range_lo[v]), hi = t->tape->range_hi[v] + t->tau[v];
  return (ambit_span) { x.lo > lo ? x.lo : lo, x.hi < hi ? x.hi : hi };
}

double ambit_tails_gap(ambit_span x) { return x.lo > 0 ? x.lo : x.hi < 0 ? -x.hi : 0; }

/* below sqrt x: r >= sqrt x, so x / r <= sqrt x */
double ambit_tails_sqrt_floor(const ambit_tails *t, uint32_t u) {
  double x = ambit_tails_value(t, u).lo;
  return x > 0 ? -(-x / sqrt(x)) : 0;
}

/* 1 - tanh(x)^2 = 1 / cosh(x)^2 <= 4 e^-2|x| */
double ambit_tails_tanh_slope(const ambit_tails *t, uint32_t u) {
  double near = ambit_tails_gap(ambit_tails_segment(t, u));
  ambit_interval r, a = { -2 * near, -2 * near };
  if (!(near > 1)) return 1;
  ambit_interval_op(AMBIT_OP_EXP, &r, a, a);
  return 4 * r.hi;
}

/* below q_0 - sum_{k>=1} Q_k - excess */
static double floor_of(const ambit_tails *t, uint32_t q, double excess) { return -(excess + t->swing[q] - t->lo[q]); }

/* What a^2 can exceed its polynomial by, all along the segment: sum_{i+j>K} U_i U_j + tau (2 |U| + tau). */
static double square_excess(const ambit_tails *t, uint32_t a) {
  return ambit_tails_product(t, a, a) + t->tau[a] * (2 * t->sum[a] + t->tau[a]);
}

static double square_down(double x) { return -(-x * x); }

double ambit_tails_atan_floor(const ambit_tails *t, uint32_t i) {
  uint32_t a = t->tape->a[i];
  double low = floor_of(t, t->tape->aux[i], square_excess(t, a));
  return low > 1 ? low : 1;
}

double ambit_tails_atan2_floor(const ambit_tails *t, uint32_t i) {
  uint32_t a = t->tape->a[i], b = t->tape->b[i];
  ambit_span y = ambit_tails_segment(t, a), x = ambit_tails_segment(t, b);
  if (!(x.lo > 0 || y.lo > 0 || y.hi < 0)) return 0;
  double low = floor_of(t, t->tape->aux[i], square_excess(t, a) + square_excess(t, b));
  double apart = -(-square_down(ambit_tails_gap(y)) - square_down(ambit_tails_gap(x)));
  return low > apart ? low : apart;
}

uint32_t ambit_tails_branch(const ambit_tails *t, uint32_t i) {
  uint32_t op = t->tape->op[i], a = t->tape->a[i], b = t->tape->b[i];
  ambit_span x = ambit_tails_value(t, a), y = ambit_tails_value(t, b);
  if (op == AMBIT_OP_ABS) return x.lo > 0 || x.hi < 0 ? a : AMBIT_NO_SLOT;
  /* Both must exist on the whole step: the range of a square root may decide a minimum, but an operand without a finite
  ** tail may leave its domain. */
  if (!(t->tau[a] < INFINITY && t->tau[b] < INFINITY)) return AMBIT_NO_SLOT;
  if (op == AMBIT_OP_MAX) return x.lo > y.hi ? a : y.lo > x.hi ? b : AMBIT_NO_SLOT;
  return x.hi < y.lo ? a : y.hi < x.lo ? b : AMBIT_NO_SLOT;
}
