/* rules.c -- order k of each operation, from lower orders of all and order k of its operands.
**
** The recursions of docs/numerics/series.md, section 1, with products of polynomials; those that divide multiply by a
** polynomial enclosure of the inverse of the divisor's order 0. Order 0 of functions: functions.c.
*/
#include "series.h"

typedef struct instruction {
  uint32_t op, dst, a, b, aux, i;
} instruction;

/* sum += factor sum_{j=from}^{to} a_j b_(k-j), each term times j if weighted */
static void convolve(
    series *s, double factor, uint32_t a, uint32_t b, uint32_t from, uint32_t to, uint32_t k, int weighted) {
  uint32_t adegree = s->tape->degree[a], bdegree = s->tape->degree[b];
  if (to > adegree) to = adegree;
  if (k > bdegree && from < k - bdegree) from = k - bdegree;
  const series_part part = { series_cell(s, a, 0).c, series_cell(s, b, 0).c, from, to, k, weighted != 0, factor };
  s->space->convolve(s->space, &s->sum, &part);
}

/* sum_{j=from}^{k-from} y_j y_(k-j), each product once */
static void convolve_square(series *s, uint32_t y, uint32_t from, uint32_t k) {
  if (k > 2 * from) convolve(s, 2, y, y, from, (k - 1) / 2, k, 0);
  if (k % 2 == 0 && k >= 2 * from) convolve(s, 1, y, y, k / 2, k / 2, k, 0);
}

static cell inverse_of(const series *s, uint32_t i) { return cell_at(s->space, s->inverses, s->has_inverse[i] - 1u); }

/* a lower bound of |x| from what sealing the tape knows of slot x for all real inputs */
static double floor_of(const ambit_tape *t, uint32_t slot) {
  return larger(larger(t->range_lo[slot], -t->range_hi[slot]), 0);
}

static uint32_t invert(series *s, uint32_t i, cell divisor, double floor) {
  uint32_t flags = series_inverse(s, inverse_of(s, i), divisor, floor);
  sum_clear(s->space, &s->sum);
  return flags;
}

/* to := (a_k - factor sum) * inverse */
static void solve(series *s, uint32_t i, cell a, double factor, cell to) {
  cell taken = series_scratch(s, 0), left = series_scratch(s, 1);
  sum_take(s->space, &s->sum, factor, taken);
  cell_add(s->space, left, a, taken, -1);
  sum_clear(s->space, &s->sum);
  sum_add(s->space, &s->sum, 1, left, inverse_of(s, i));
  sum_take(s->space, &s->sum, 1, to);
}

static uint32_t quotient(series *s, const instruction *t, uint32_t k) {
  if (k == 0) {
    uint32_t flags = invert(s, t->i, series_cell(s, t->b, 0), floor_of(s->tape, t->b));
    if (flags) return flags;
  }
  if (k) convolve(s, 1, t->dst, t->b, 0, k - 1, k, 0);
  solve(s, t->i, series_cell(s, t->a, k), 1, series_cell(s, t->dst, k));
  return 0;
}

static uint32_t root(series *s, const instruction *t, uint32_t k) {
  cell y = series_cell(s, t->dst, 0);
  if (k == 0) return series_function(s, t->op, y, y, series_cell(s, t->a, 0), y);
  if (k == 1) {
    cell twice = series_scratch(s, 2);
    cell_scale(s->space, twice, y, 2);
    uint32_t flags = invert(s, t->i, twice, 0);
    if (flags) return flags;
  }
  convolve_square(s, t->dst, 1, k);
  solve(s, t->i, series_cell(s, t->a, k), 1, series_cell(s, t->dst, k));
  return 0;
}

/* y_k = (1/k) sum_{j>=1} j u_j v_(k-j) */
static void flow(series *s, uint32_t y, uint32_t u, uint32_t v, uint32_t k, double sign) {
  convolve(s, 1, u, v, 1, k, k, 1);
  /* 1/k is rounded: divide instead, below one ulp more, which sum_take counts with its factor */
  sum_take(s->space, &s->sum, sign / k, series_cell(s, y, k));
}

/* the divisor of a logarithm or an arc tangent, from order 1 on, when all orders 0 are there */
static uint32_t prepare(series *s, const instruction *t, uint32_t divisor, uint32_t k) {
  return k == 1 ? invert(s, t->i, series_cell(s, divisor, 0), floor_of(s->tape, divisor)) : 0;
}

/* y_k q_0 = n_k - (1/k) sum_{j=1}^{k-1} j y_j q_(k-j) */
static uint32_t angle(series *s, const instruction *t, uint32_t divisor, cell numerator, uint32_t k) {
  convolve(s, 1, t->dst, divisor, 1, k - 1, k, 1);
  solve(s, t->i, numerator, 1.0 / k, series_cell(s, t->dst, k));
  return 0;
}

static uint32_t angle_of_point(series *s, const instruction *t, uint32_t k) {
  cell numerator = series_scratch(s, 2); /* (1/k) sum j (a_j b_(k-j) - b_j a_(k-j)) */
  uint32_t flags = prepare(s, t, t->aux, k);
  if (flags) return flags;
  convolve(s, 1, t->a, t->b, 1, k, k, 1);
  convolve(s, -1, t->b, t->a, 1, k, k, 1);
  sum_take(s->space, &s->sum, 1.0 / k, numerator);
  sum_clear(s->space, &s->sum);
  return angle(s, t, t->aux, numerator, k);
}

static uint32_t function(series *s, const instruction *t, uint32_t k) {
  cell a = series_cell(s, t->a, k), y = series_cell(s, t->dst, k);
  int paired = t->op == AMBIT_OP_SIN || t->op == AMBIT_OP_COS || t->op == AMBIT_OP_SINH || t->op == AMBIT_OP_COSH;
  if (k == 0) {
    if (!paired || t->aux == AMBIT_NO_SLOT)
      return series_function(s, t->op, y, series_scratch(s, 11), a, series_cell(s, t->b, 0));
    if (t->aux < t->dst) return 0; /* came with its partner */
    return series_function(s, t->op, y, series_cell(s, t->aux, 0), a, a);
  }
  uint32_t flags = 0;
  switch (t->op) {
  case AMBIT_OP_EXP: flow(s, t->dst, t->a, t->dst, k, 1); break;
  case AMBIT_OP_COS: flow(s, t->dst, t->a, t->aux, k, -1); break;
  case AMBIT_OP_LOG: flags = prepare(s, t, t->a, k); return flags ? flags : angle(s, t, t->a, a, k);
  case AMBIT_OP_ATAN: flags = prepare(s, t, t->aux, k); return flags ? flags : angle(s, t, t->aux, a, k);
  case AMBIT_OP_ATAN2: return angle_of_point(s, t, k);
  default: flow(s, t->dst, t->a, t->aux, k, 1);
  }
  return 0;
}

/* -- kinks: a branch that holds on the whole cube, strictly; a slot that is constant in time may keep its hull */

static uint32_t undecided(series *s, const instruction *t, double low, double high) {
  if (s->tape->degree[t->dst] != 0) {
    s->kink = t->i + 1;
    return AMBIT_F_UNBOUNDED;
  }
  double mid = 0.5 * (low + high);
  cell_constant(s->space, series_cell(s, t->dst, 0), mid, larger(high - mid, mid - low));
  return 0;
}

static void branch(series *s, const instruction *t, uint32_t k) {
  int second = t->op != AMBIT_OP_ABS && s->branch[t->i] < 0;
  cell from = series_cell(s, second ? t->b : t->a, k), to = series_cell(s, t->dst, k);
  if (t->op == AMBIT_OP_ABS && s->branch[t->i] < 0)
    cell_scale(s->space, to, from, -1);
  else
    cell_copy(s->space, to, from);
}

static uint32_t kink(series *s, const instruction *t, uint32_t k) {
  if (k == 0) {
    cell a = series_cell(s, t->a, 0), b = series_cell(s, t->b, 0), difference = series_scratch(s, 2);
    double low, high, blow, bhigh;
    if (t->op == AMBIT_OP_ABS)
      cell_copy(s->space, difference, a);
    else
      cell_add(s->space, difference, a, b, -1);
    series_range(s, difference, &low, &high);
    int sign = low > 0 ? 1 : high < 0 ? -1 : 0;
    s->branch[t->i] = (int8_t)(t->op == AMBIT_OP_MIN ? -sign : sign);
    if (!sign) {
      series_range(s, a, &low, &high), series_range(s, b, &blow, &bhigh);
      if (t->op == AMBIT_OP_ABS) return undecided(s, t, 0, larger(high, -low));
      if (t->op == AMBIT_OP_MIN) return undecided(s, t, smaller(low, blow), smaller(high, bhigh));
      return undecided(s, t, larger(low, blow), larger(high, bhigh));
    }
  }
  branch(s, t, k);
  return 0;
}

uint32_t series_rule(series *s, uint32_t i, uint32_t k) {
  const ambit_tape *tape = s->tape;
  const instruction t = { tape->op[i], tape->dst[i], tape->a[i], tape->b[i], tape->aux[i], i };
  cell to = series_cell(s, t.dst, k);
  sum_clear(s->space, &s->sum);
  switch (t.op) {
  case AMBIT_OP_ADD: cell_add(s->space, to, series_cell(s, t.a, k), series_cell(s, t.b, k), 1); return 0;
  case AMBIT_OP_SUB: cell_add(s->space, to, series_cell(s, t.a, k), series_cell(s, t.b, k), -1); return 0;
  case AMBIT_OP_NEG: cell_scale(s->space, to, series_cell(s, t.a, k), -1); return 0;
  case AMBIT_OP_MUL:
    convolve(s, 1, t.a, t.b, 0, k, k, 0);
    sum_take(s->space, &s->sum, 1, to);
    return 0;
  case AMBIT_OP_SQR:
    convolve_square(s, t.a, 0, k);
    sum_take(s->space, &s->sum, 1, to);
    return 0;
  case AMBIT_OP_DIV: return quotient(s, &t, k);
  case AMBIT_OP_SQRT: return root(s, &t, k);
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return kink(s, &t, k);
  default: return function(s, &t, k);
  }
}
