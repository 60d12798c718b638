/* jet_value.c -- Taylor coefficients of the operations, order by order.
**
** Moore, Interval Analysis, 1966; Griewank and Walther, Evaluating Derivatives, 2nd ed., section 13.2. Elementary
** functions follow from their differential equations: y = exp u from y' = y u', so k y_k = sum j u_j y_(k-j), and
** likewise
**   log: y' u = u'            sin, cos: s' = c u', c' = -s u'      sinh, cosh: s' = c u', c' = s u'
**   atan: y' q = u', q = 1 + u^2                                    atan2: y' q = a' b - a b', q = a^2 + b^2
**   tanh: y' = s u', s = 1 - y^2
** Each is an identity of real numbers for every point of the box, so it holds for any enclosing arithmetic. ABS, MIN
** and MAX are one of their branches if order 0 tells which one over the whole set; at the branch cut of ATAN2, and
** where the branch is not known, nothing is proved: AMBIT_F_UNBOUNDED.
*/
#include "graph/jet_general.h"

#define NEW AMBIT_SERIES_NEW

static uint32_t add(ambit_series *s, uint32_t a, uint32_t b) { return ambit_series_apply(s, NEW, AMBIT_OP_ADD, a, b); }
static uint32_t sub(ambit_series *s, uint32_t a, uint32_t b) { return ambit_series_apply(s, NEW, AMBIT_OP_SUB, a, b); }
static uint32_t divide(ambit_series *s, uint32_t a, uint32_t b) {
  return ambit_series_apply(s, NEW, AMBIT_OP_DIV, a, b);
}
static uint32_t sum(ambit_series *s, ambit_row a, ambit_row b, uint32_t from, uint32_t to, uint32_t k) {
  return ambit_series_convolve(s, NEW, a, b, from, to, k);
}

/* sum_{j=from}^{k-from} a_j a_(k-j): each product of two different ones once, the middle one as a square; k >= 1 */
static uint32_t symmetric_sum(ambit_series *s, ambit_row a, uint32_t from, uint32_t k) {
  uint32_t half = sum(s, a, a, from, (k - 1) / 2, k), twice = add(s, half, half);
  if (k % 2 || k / 2 < from || k / 2 >= a.length) return twice;
  uint32_t middle = a.first + k / 2;
  return add(s, twice, ambit_series_apply(s, NEW, AMBIT_OP_SQR, middle, middle));
}

/* The angle of (b, a) is smooth on the box if it keeps off the negative half axis a = 0, b <= 0. */
static bool crosses_cut(const ambit_series *s, uint32_t a, uint32_t b) {
  ambit_interval y = ambit_series_bounds(s, a), x = ambit_series_bounds(s, b);
  return !(x.lo > 0 || y.lo > 0 || y.hi < 0);
}

static int8_t branch_of(const ambit_series *s, uint32_t op, uint32_t a, uint32_t b) {
  ambit_interval x = ambit_series_bounds(s, a), y = ambit_series_bounds(s, b);
  if (op == AMBIT_OP_ABS) return x.lo > 0 ? 1 : x.hi < 0 ? -1 : 0;
  if (op == AMBIT_OP_MIN) return x.hi < y.lo ? 1 : y.hi < x.lo ? -1 : 0;
  return x.lo > y.hi ? 1 : y.lo > x.hi ? -1 : 0;
}

static void first_order(ambit_series *s, uint32_t i, uint32_t dst, uint32_t a, uint32_t b) {
  const ambit_tape *t = s->tape;
  uint32_t op = t->op[i];
  bool steady = t->degree[t->dst[i]] == 0; /* constant in time: a kink is no harm to the value */
  if (op == AMBIT_OP_ABS || op == AMBIT_OP_MIN || op == AMBIT_OP_MAX) {
    s->branch[i] = branch_of(s, op, a, b);
    if (s->branch[i] == 0 && !steady) s->flags |= AMBIT_F_UNBOUNDED;
  }
  if (op == AMBIT_OP_ATAN2 && (!steady || s->ndir > 0) && crosses_cut(s, a, b)) s->flags |= AMBIT_F_UNBOUNDED;
  ambit_series_apply(s, dst, op, a, b);
}

/* (a_k - (1/k) sum_{j=1}^{k-1} j y_j q_(k-j)) / q_0 */
static void logarithm(ambit_series *s, uint32_t dst, uint32_t ak, ambit_row wy, ambit_row q, uint32_t k) {
  uint32_t rest = divide(s, sum(s, wy, q, 1, k - 1, k), s->number + k);
  ambit_series_apply(s, dst, AMBIT_OP_DIV, sub(s, ak, rest), q.first);
}

static void angle(ambit_series *s, uint32_t i, uint32_t dst, uint32_t k) {
  const ambit_tape *t = s->tape;
  ambit_row a = ambit_series_row(s, t->a[i], 0), b = ambit_series_row(s, t->b[i], 0),
            q = ambit_series_row(s, t->aux[i], 0);
  uint32_t cross = sub(s, sum(s, ambit_series_weighted(s, t->a[i], 0), b, 1, k, k),
      sum(s, ambit_series_weighted(s, t->b[i], 0), a, 1, k, k));
  uint32_t rest = sub(s, cross, sum(s, ambit_series_weighted(s, t->dst[i], 0), q, 1, k - 1, k));
  ambit_series_apply(s, dst, AMBIT_OP_DIV, divide(s, rest, s->number + k), q.first);
}

static void root(ambit_series *s, uint32_t dst, uint32_t ak, ambit_row y, uint32_t k) {
  uint32_t rest = k > 1 ? sub(s, ak, symmetric_sum(s, y, 1, k)) : ak;
  ambit_series_apply(s, dst, AMBIT_OP_DIV, rest, add(s, y.first, y.first));
}

/* (1/k) sum_{j=1}^k j u_j v_(k-j), from y' = v u' */
static void primitive(ambit_series *s, uint32_t dst, uint32_t slot, ambit_row v, uint32_t k, bool negative) {
  uint32_t product = sum(s, ambit_series_weighted(s, slot, 0), v, 1, k, k);
  if (negative) product = ambit_series_apply(s, NEW, AMBIT_OP_NEG, product, product);
  ambit_series_apply(s, dst, AMBIT_OP_DIV, product, s->number + k);
}

static void follow_branch(ambit_series *s, uint32_t i, uint32_t dst, uint32_t ak, uint32_t bk) {
  if (s->branch[i] == 0) {
    s->flags |= AMBIT_F_UNBOUNDED;
    ambit_series_set(s, dst, AMBIT_ENTIRE);
  } else if (s->tape->op[i] == AMBIT_OP_ABS && s->branch[i] < 0) {
    ambit_series_apply(s, dst, AMBIT_OP_NEG, ak, ak);
  } else {
    ambit_series_apply(s, dst, AMBIT_OP_ADD, s->branch[i] > 0 ? ak : bk, s->zero);
  }
}

static void later_order(ambit_series *s, uint32_t i, uint32_t dst, ambit_row a, ambit_row b, uint32_t k) {
  const ambit_tape *t = s->tape;
  ambit_row y = ambit_series_row(s, t->dst[i], 0);
  ambit_row aux = t->aux[i] == AMBIT_NO_SLOT ? y : ambit_series_row(s, t->aux[i], 0);
  uint32_t ak = ambit_series_at(s, a, k), bk = ambit_series_at(s, b, k), op = t->op[i];
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_NEG: ambit_series_apply(s, dst, op, ak, bk); break;
  case AMBIT_OP_MUL: ambit_series_convolve(s, dst, a, b, 0, k, k); break;
  case AMBIT_OP_SQR: ambit_series_apply(s, dst, AMBIT_OP_ADD, symmetric_sum(s, a, 0, k), s->zero); break;
  case AMBIT_OP_DIV: ambit_series_apply(s, dst, op, sub(s, ak, sum(s, b, y, 1, k, k)), b.first); break;
  case AMBIT_OP_SQRT: root(s, dst, ak, y, k); break;
  case AMBIT_OP_EXP: primitive(s, dst, t->a[i], y, k, false); break;
  case AMBIT_OP_SIN:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
  case AMBIT_OP_TANH: primitive(s, dst, t->a[i], aux, k, false); break;
  case AMBIT_OP_COS: primitive(s, dst, t->a[i], aux, k, true); break;
  case AMBIT_OP_LOG: logarithm(s, dst, ak, ambit_series_weighted(s, t->dst[i], 0), a, k); break;
  case AMBIT_OP_ATAN: logarithm(s, dst, ak, ambit_series_weighted(s, t->dst[i], 0), aux, k); break;
  case AMBIT_OP_ATAN2: angle(s, i, dst, k); break;
  default: follow_branch(s, i, dst, ak, bk); break; /* ABS, MIN, MAX: open() admits no other */
  }
}

void ambit_series_value(ambit_series *s, uint32_t i, uint32_t k) {
  const ambit_tape *t = s->tape;
  ambit_row a = ambit_series_row(s, t->a[i], 0), b = ambit_series_row(s, t->b[i], 0);
  uint32_t dst = ambit_series_row(s, t->dst[i], 0).first + k;
  if (k == 0)
    first_order(s, i, dst, a.first, b.first);
  else
    later_order(s, i, dst, a, b, k);
}
