/* jet_slope.c -- slopes: series s_j with u(x) - u(c) = sum_j s_j (x_j - c_j) for every x of the box.
**
** One identity carries all bilinear rules: a b - a0 b0 = (a + a0)/2 (b - b0) + (b + b0)/2 (a - a0); the mean series
** is in the column `mean`. It applies to power series in time, to quotients and roots solved for their result, and to
** the differential equation y' = v u' of an elementary function. Order 0 of an elementary function takes a slope of
** the real function: with H the hull of U and u0 it lies in f'(H) by the mean value theorem, and where f'' costs little
** also in f'(u0) + f''(H)/2 (U - u0) by Taylor's; it is one and the same number, so the sets are intersected. Without a
** centre the mean is the value, and the same rules are the product rule: derivatives. Proofs:
** docs/numerics/series.md.
*/
#include "graph/jet_general.h"
#include "num/interval.h"

#define NEW AMBIT_SERIES_NEW

static uint32_t add(ambit_series *s, uint32_t a, uint32_t b) { return ambit_series_apply(s, NEW, AMBIT_OP_ADD, a, b); }
static uint32_t sub(ambit_series *s, uint32_t a, uint32_t b) { return ambit_series_apply(s, NEW, AMBIT_OP_SUB, a, b); }
static uint32_t divide(ambit_series *s, uint32_t a, uint32_t b) {
  return ambit_series_apply(s, NEW, AMBIT_OP_DIV, a, b);
}

/* The four rows of an operand in direction d: mean and slope, plain and weighted by k. */
typedef struct operand {
  ambit_row mean, slope, wmean, wslope;
} operand;

static operand operand_of(const ambit_series *s, uint32_t slot, uint32_t d) {
  return (operand) { ambit_series_row(s, slot, s->mean), ambit_series_row(s, slot, s->slope + d),
    ambit_series_weighted(s, slot, s->mean), ambit_series_weighted(s, slot, s->slope + d) };
}

/* coefficient k of the slope of a product, the sum over orders [from, k] of both factors' slopes */
static uint32_t product(ambit_series *s, operand a, operand b, uint32_t k) {
  return add(s, ambit_series_convolve(s, NEW, a.mean, b.slope, 0, k, k),
      ambit_series_convolve(s, NEW, b.mean, a.slope, 0, k, k));
}

/* sum_{j=1}^k of the slope of (j u_j) v_(k-j): coefficient k - 1 of the slope of u' v */
static uint32_t flow(ambit_series *s, operand u, operand v, uint32_t k) {
  return add(s, ambit_series_convolve(s, NEW, u.wslope, v.mean, 1, k, k),
      ambit_series_convolve(s, NEW, u.wmean, v.slope, 1, k, k));
}

/* the same for y' q without the term that holds the unknown k s_k q_0 */
static uint32_t flow_but_last(ambit_series *s, operand y, operand q, uint32_t k) {
  return add(s, ambit_series_convolve(s, NEW, y.wslope, q.mean, 1, k - 1, k),
      ambit_series_convolve(s, NEW, y.wmean, q.slope, 1, k, k));
}

/* c b = a: s_c = (s_a - cbar s_b) / bbar */
static void quotient(ambit_series *s, uint32_t dst, operand a, operand b, operand c, uint32_t k) {
  uint32_t known = add(s, ambit_series_convolve(s, NEW, c.mean, b.slope, 0, k, k),
      ambit_series_convolve(s, NEW, b.mean, c.slope, 1, k, k));
  ambit_series_apply(s, dst, AMBIT_OP_DIV, sub(s, ambit_series_at(s, a.slope, k), known), b.mean.first);
}

/* y^2 = a: s_y = s_a / (2 ybar) */
static void root(ambit_series *s, uint32_t dst, operand a, operand y, uint32_t k) {
  uint32_t known = ambit_series_convolve(s, NEW, y.mean, y.slope, 1, k, k);
  uint32_t rest = sub(s, ambit_series_at(s, a.slope, k), add(s, known, known));
  ambit_series_apply(s, dst, AMBIT_OP_DIV, rest, add(s, y.mean.first, y.mean.first));
}

static void primitive(ambit_series *s, uint32_t dst, operand u, operand v, uint32_t k, bool negative) {
  uint32_t sum = flow(s, u, v, k);
  if (negative) sum = ambit_series_apply(s, NEW, AMBIT_OP_NEG, sum, sum);
  ambit_series_apply(s, dst, AMBIT_OP_DIV, sum, s->number + k);
}

/* y' q = u' */
static void logarithm(ambit_series *s, uint32_t dst, operand u, operand y, operand q, uint32_t k) {
  uint32_t known = divide(s, flow_but_last(s, y, q, k), s->number + k);
  ambit_series_apply(s, dst, AMBIT_OP_DIV, sub(s, ambit_series_at(s, u.slope, k), known), q.mean.first);
}

/* y' q = a' b - a b' */
static void angle(ambit_series *s, uint32_t dst, operand a, operand b, operand y, operand q, uint32_t k) {
  uint32_t sum = sub(s, sub(s, flow(s, a, b, k), flow(s, b, a, k)), flow_but_last(s, y, q, k));
  ambit_series_apply(s, dst, AMBIT_OP_DIV, divide(s, sum, s->number + k), q.mean.first);
}

/* -- order 0 */

static ambit_interval op1(uint32_t op, ambit_interval x) {
  ambit_interval r;
  ambit_interval_op(op, &r, x, x);
  return r;
}

static ambit_interval half(ambit_interval x) { return ambit_interval_mul((ambit_interval) { 0.5, 0.5 }, x); }

/* f' and f'' of tanh: 1 - f^2 and -2 f f' */
static void derivatives_of_tanh(ambit_interval u, ambit_interval *first, ambit_interval *second) {
  const ambit_interval one = { 1, 1 }, minus_two = { -2, -2 };
  ambit_interval y = op1(AMBIT_OP_TANH, u);
  *first = ambit_interval_sub(one, op1(AMBIT_OP_SQR, y));
  *second = ambit_interval_mul(minus_two, ambit_interval_mul(y, *first));
}

/* f' and f'' of the functions that tell both of them */
static bool derivatives_of(uint32_t op, ambit_interval u, ambit_interval *first, ambit_interval *second) {
  switch (op) {
  case AMBIT_OP_EXP: *first = *second = op1(AMBIT_OP_EXP, u); return true;
  case AMBIT_OP_SINH: *first = op1(AMBIT_OP_COSH, u), *second = op1(AMBIT_OP_SINH, u); return true;
  case AMBIT_OP_TANH: derivatives_of_tanh(u, first, second); return true;
  case AMBIT_OP_COSH: *first = op1(AMBIT_OP_SINH, u), *second = op1(AMBIT_OP_COSH, u); return true;
  case AMBIT_OP_SIN: *first = op1(AMBIT_OP_COS, u), *second = op1(AMBIT_OP_NEG, op1(AMBIT_OP_SIN, u)); return true;
  case AMBIT_OP_COS:
    *first = op1(AMBIT_OP_NEG, op1(AMBIT_OP_SIN, u));
    *second = op1(AMBIT_OP_NEG, op1(AMBIT_OP_COS, u));
    return true;
  default: return false;
  }
}

static ambit_interval derivative_of(uint32_t op, ambit_interval u) {
  const ambit_interval one = { 1, 1 };
  ambit_interval slope = op == AMBIT_OP_LOG ? u : ambit_interval_add(one, op1(AMBIT_OP_SQR, u)); /* LOG, ATAN */
  return ambit_interval_div(one, slope);
}

/* coefficient 0 of a slot over the box and at the centre, which need not lie in the box */
static ambit_interval span_of(const ambit_series *s, uint32_t slot) {
  ambit_interval u = ambit_series_bounds(s, s->first[slot]);
  if (!s->centre) return u;
  return ambit_interval_hull(u, ambit_series_bounds(s->centre, s->centre->first[slot]));
}

/* A slope of f over U about u0. Both sets hold it, so their intersection is empty only if an arithmetic without rigour
** reported bounds that no number meets. */
static ambit_interval slope_of(const ambit_series *s, uint32_t op, uint32_t slot) {
  ambit_interval u = span_of(s, slot), first, second, first0, second0;
  if (!derivatives_of(op, u, &first, &second)) return derivative_of(op, u);
  if (!s->centre) return first;
  ambit_interval u0 = ambit_series_bounds(s->centre, s->centre->first[slot]);
  derivatives_of(op, u0, &first0, &second0);
  ambit_interval away = ambit_interval_sub(ambit_series_bounds(s, s->first[slot]), u0);
  ambit_interval taylor = ambit_interval_add(first0, ambit_interval_mul(half(second), away));
  ambit_interval both = ambit_interval_intersect(first, taylor);
  return ambit_interval_is_empty(both) ? first : both;
}

/* the gradient of the angle of (b, a) over the box and the way to the centre: (b, -a) / (a^2 + b^2), off the cut */
static void angle_factors(ambit_series *s, uint32_t a, uint32_t b) {
  ambit_interval y = span_of(s, a), x = span_of(s, b);
  ambit_interval q = ambit_interval_add(op1(AMBIT_OP_SQR, x), op1(AMBIT_OP_SQR, y));
  bool cut = y.lo <= 0 && y.hi >= 0 && x.lo <= 0;
  if (cut) s->flags |= AMBIT_F_UNBOUNDED;
  ambit_series_set(s, s->factor, cut ? AMBIT_ENTIRE : ambit_interval_div(x, q));
  ambit_series_set(s, s->factor + 1, cut ? AMBIT_ENTIRE : ambit_interval_div(op1(AMBIT_OP_NEG, y), q));
}

void ambit_series_factor(ambit_series *s, uint32_t i) {
  const ambit_tape *t = s->tape;
  switch (t->op[i]) {
  case AMBIT_OP_EXP:
  case AMBIT_OP_LOG:
  case AMBIT_OP_SIN:
  case AMBIT_OP_COS:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
  case AMBIT_OP_TANH:
  case AMBIT_OP_ATAN: ambit_series_set(s, s->factor, slope_of(s, t->op[i], t->a[i])); break;
  case AMBIT_OP_ATAN2: angle_factors(s, t->a[i], t->b[i]); break;
  case AMBIT_OP_ABS: ambit_series_set(s, s->factor, (ambit_interval) { -1, 1 }); break;
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: ambit_series_set(s, s->factor, (ambit_interval) { 0, 1 }); break;
  default: break;
  }
}

static uint32_t scaled(ambit_series *s, uint32_t dst, uint32_t factor, uint32_t a) {
  return ambit_series_apply(s, dst, AMBIT_OP_MUL, factor, a);
}

/* | |u| - |u0| | <= |u - u0|; min and max have slopes (w, 1 - w), 0 <= w <= 1: for operands constant in time */
static void undecided(ambit_series *s, uint32_t i, uint32_t dst, uint32_t k, uint32_t a, uint32_t b) {
  if (k > 0)
    ambit_series_set(s, dst, AMBIT_ENTIRE);
  else if (s->tape->op[i] == AMBIT_OP_ABS)
    scaled(s, dst, s->factor, a);
  else
    ambit_series_apply(s, dst, AMBIT_OP_ADD, b, scaled(s, NEW, s->factor, sub(s, a, b)));
}

static void follow_branch(ambit_series *s, uint32_t i, uint32_t dst, uint32_t k, uint32_t a, uint32_t b) {
  int8_t branch = s->centre && s->centre->branch[i] != s->branch[i] ? 0 : s->branch[i]; /* box and centre agree */
  if (branch == 0)
    undecided(s, i, dst, k, a, b);
  else if (s->tape->op[i] == AMBIT_OP_ABS && branch < 0)
    ambit_series_apply(s, dst, AMBIT_OP_NEG, a, a);
  else
    ambit_series_apply(s, dst, AMBIT_OP_ADD, branch > 0 ? a : b, s->zero);
}

/* elementary functions */
static void function(
    ambit_series *s, uint32_t i, uint32_t dst, uint32_t k, operand a, operand b, operand y, operand aux) {
  if (k == 0) {
    uint32_t first = scaled(s, s->tape->op[i] == AMBIT_OP_ATAN2 ? NEW : dst, s->factor, a.slope.first);
    if (s->tape->op[i] != AMBIT_OP_ATAN2) return;
    ambit_series_apply(s, dst, AMBIT_OP_ADD, first, scaled(s, NEW, s->factor + 1, b.slope.first));
    return;
  }
  switch (s->tape->op[i]) {
  case AMBIT_OP_EXP: primitive(s, dst, a, y, k, false); break;
  case AMBIT_OP_SIN:
  case AMBIT_OP_SINH:
  case AMBIT_OP_COSH:
  case AMBIT_OP_TANH: primitive(s, dst, a, aux, k, false); break;
  case AMBIT_OP_COS: primitive(s, dst, a, aux, k, true); break;
  case AMBIT_OP_LOG: logarithm(s, dst, a, y, a, k); break;
  case AMBIT_OP_ATAN: logarithm(s, dst, a, y, aux, k); break;
  default: angle(s, dst, a, b, y, aux, k); break;
  }
}

void ambit_series_slope(ambit_series *s, uint32_t i, uint32_t k, uint32_t d) {
  const ambit_tape *t = s->tape;
  uint32_t op = t->op[i], slot = t->dst[i];
  operand a = operand_of(s, t->a[i], d), b = operand_of(s, t->b[i], d), y = operand_of(s, slot, d);
  uint32_t dst = y.slope.first + k, ak = ambit_series_at(s, a.slope, k), bk = ambit_series_at(s, b.slope, k);
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_NEG: ambit_series_apply(s, dst, op, ak, bk); break;
  case AMBIT_OP_MUL: ambit_series_apply(s, dst, AMBIT_OP_ADD, product(s, a, b, k), s->zero); break;
  case AMBIT_OP_SQR: {
    uint32_t once = ambit_series_convolve(s, NEW, a.mean, a.slope, 0, k, k);
    ambit_series_apply(s, dst, AMBIT_OP_ADD, once, once);
    break;
  }
  case AMBIT_OP_DIV: quotient(s, dst, a, b, y, k); break;
  case AMBIT_OP_SQRT: root(s, dst, a, y, k); break;
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: follow_branch(s, i, dst, k, ak, bk); break;
  default: function(s, i, dst, k, a, b, y, t->aux[i] == AMBIT_NO_SLOT ? y : operand_of(s, t->aux[i], d)); break;
  }
}
