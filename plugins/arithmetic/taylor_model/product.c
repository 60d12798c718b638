/* product.c -- products of Taylor models, one or several at a time. Upward mode around, nearest mode in the
** polynomials.
**
** What is lost in the polynomial product, with A_p the sum of |a_i| over degree p, B_q likewise, u = 2^-53:
**   cutting    sum over p + q > limit of A_p B_q;
**   rounding   a coefficient of degree k is a sum of n products rounded at most n + 3 times each, so its error is at
**              most g sum |a_i b_j| with g = (n + 3) u / (1 - (n + 3) u)  [Higham 2002, 3.1], and the errors of degree
**              k together at most g sum over p + q = k of A_p B_q, n the largest number of terms in that degree;
**   underflow  2^-1074 for each product rounded, times the same 1 + g.
** Remainders: with v = p + e for both factors, v_a v_b - p_a p_b = e_a v_b + p_a e_b = v_a e_b + e_a p_b: both are
** bounded, the smaller is taken. [Makino & Berz 1996; Revol, Makino & Berz 2005 for the rounding.]
*/
#include "model.h"

#define ROUNDOFF 0x1.00001p-53 /* (n + 3) of them, for n + 3 < 2^32, exceed g */
#define UNDERFLOW 0x1p-1072

/* how a product of two polynomials is computed */
enum { SPARSE, DENSE, ROWS };

/* ns for a product of coefficients, about (tests/bench/taylor_model.c) */
static const double cost[] = { [SPARSE] = 1.2, [DENSE] = 0.5, [ROWS] = 0.15 };

static uint32_t blocks_of(const context *c, const model *x) {
  const uint64_t *mask = model_mask(c, x);
  uint32_t n = 0;
  for (uint32_t w = 0; w < c->m.words; w++) n += (uint32_t)__builtin_popcountll(mask[w] | (w == 0));
  return n;
}

static uint32_t list(const context *c, const model *x, uint32_t *index, double *value) {
  const uint64_t *mask = model_mask(c, x);
  const double *coef = model_coef(c, x);
  uint32_t n = 0;
  for (uint32_t w = 0; w < c->m.words; w++)
    for (uint64_t rest = mask[w] | (w == 0); rest; rest &= rest - 1) {
      uint32_t i = (w * 64 + (uint32_t)__builtin_ctzll(rest)) * MONOMIALS_BLOCK;
      for (uint32_t end = i + MONOMIALS_BLOCK; i < end && i < c->m.count; i++)
        if (coef[i] != 0) index[n] = i, value[n++] = coef[i];
    }
  return n;
}

/* number of products of two lists up to degree `limit` */
static double pairs(
    const context *c, uint32_t limit, const uint32_t *ia, uint32_t na, const uint32_t *ib, uint32_t nb) {
  double n = 0;
  uint32_t i = 0;
  for (uint32_t p = 0; p <= limit; p++) {
    uint32_t start = i;
    while (i < na && ia[i] < c->m.first[p + 1]) i++;
    while (nb && ib[nb - 1] >= c->m.first[limit - p + 1]) nb--;
    n += (double)(i - start) * nb;
  }
  return n;
}

static double error_bound(const context *c, const double *a, const double *b, uint32_t limit, double most_terms) {
  double above[MONOMIALS_ORDER_MAX + 2], rounding = 0, cut = 0;
  uint32_t order = c->m.order;
  above[order + 1] = 0;
  for (uint32_t q = order + 1; q-- > 0;) above[q] = above[q + 1] + b[q];
  for (uint32_t q = 0; q <= limit; q++) {
    double sum = 0, n = c->m.terms[q] < most_terms ? c->m.terms[q] : most_terms;
    for (uint32_t p = 0; p <= q; p++) sum += a[p] * b[q - p];
    rounding += (n + 3) * ROUNDOFF * sum;
  }
  for (uint32_t p = 0; p <= order; p++) cut += a[p] * above[p <= limit ? limit + 1 - p : 0];
  return rounding + cut + (double)c->m.products * UNDERFLOW;
}

static void pack(const context *c, const model *x, uint32_t limit, double *packed) {
  const uint64_t *mask = model_mask(c, x);
  const double *coef = model_coef(c, x);
  const uint32_t *place = c->m.rows.place;
  uint32_t count = c->m.first[limit + 1];
  for (uint32_t i = 0; i < count; i += MONOMIALS_BLOCK) {
    uint32_t block = i / MONOMIALS_BLOCK, end = i + MONOMIALS_BLOCK < count ? i + MONOMIALS_BLOCK : count;
    int there = block == 0 || (mask[block / 64] >> (block % 64) & 1);
    for (uint32_t k = i; k < end; k++) packed[place[k]] = there ? coef[k] : 0;
  }
}

/* marks the blocks up to degree `limit` and clears what is in the last of them beyond */
static void mark_dense(const context *c, model *x, uint32_t limit) {
  uint32_t count = c->m.first[limit + 1], blocks = (count + MONOMIALS_BLOCK - 1) / MONOMIALS_BLOCK;
  uint64_t *mask = model_mask(c, x);
  double *coef = model_coef(c, x);
  for (uint32_t w = 0; w < c->m.words; w++) {
    uint32_t before = w * 64, here = blocks <= before ? 0 : blocks - before;
    mask[w] = here >= 64 ? UINT64_MAX : ((uint64_t)1 << here) - 1;
  }
  for (uint32_t i = count; i < blocks * MONOMIALS_BLOCK; i++) coef[i] = 0;
}

static void expand(const context *c, const model *x, uint32_t limit, double *dense) {
  const uint64_t *mask = model_mask(c, x);
  const double *coef = model_coef(c, x);
  uint32_t count = c->m.first[limit + 1];
  for (uint32_t i = 0; i < count; i += MONOMIALS_BLOCK) {
    uint32_t block = i / MONOMIALS_BLOCK, n = i + MONOMIALS_BLOCK < count ? MONOMIALS_BLOCK : count - i;
    if (block == 0 || (mask[block / 64] >> (block % 64) & 1))
      memcpy(dense + i, coef + i, n * sizeof *dense);
    else
      memset(dense + i, 0, n * sizeof *dense);
  }
}

typedef struct plan {
  int way;
  uint32_t na, nb;
} plan;

/* the share of block pairs, of those up to degree `limit`, that are there */
static double filled(const context *c, const model *a, const model *b, uint32_t limit) {
  uint32_t blocks = (c->m.first[limit + 1] + MONOMIALS_BLOCK - 1) / MONOMIALS_BLOCK;
  return (double)blocks_of(c, a) / blocks * ((double)blocks_of(c, b) / blocks);
}

/* Looking for zeros in operands that are nearly full takes longer than multiplying them. */
static plan choose(const context *c, const model *a, const model *b, uint32_t limit) {
  int dense = c->m.rows.count ? ROWS : DENSE;
  if (filled(c, a, b, limit) > (c->m.rows.count ? 0.25 : 0.6)) return (plan) { dense, c->m.count, c->m.count };
  plan p = { SPARSE, list(c, a, c->index[0], c->value[0]), list(c, b, c->index[1], c->value[1]) };
  double n = pairs(c, limit, c->index[0], p.na, c->index[1], p.nb);
  double whole = (double)c->m.products * c->m.first[limit + 1] / c->m.count;
  if (n * cost[SPARSE] > whole * cost[dense]) p.way = dense;
  return p;
}

static AMBIT_WORKER void multiply_nearest(
    const context *c, model *dst, const model *a, const model *b, uint32_t limit, const plan *p) {
  const kernels *k = c->kernels;
  double *coef = model_coef(c, dst);
  ambit_rounding old = ambit_round_nearest();
  if (p->way == ROWS) {
    pack(c, a, limit, c->packed[0]);
    if (a != b) pack(c, b, limit, c->packed[1]);
    k->rows_product(&c->m, limit, coef, c->packed[0], c->packed[a != b]);
  } else if (p->way == DENSE) {
    expand(c, a, limit, c->value[0]), expand(c, b, limit, c->value[1]);
    k->dense_product(&c->m, limit, coef, c->value[0], c->value[1]);
  } else {
    uint64_t *mask = model_mask(c, dst);
    memset(mask, 0, c->m.words * sizeof *mask), mask[0] = 1;
    memset(coef, 0, MONOMIALS_BLOCK * sizeof *coef);
    k->sparse_product(&c->m, limit, coef, mask, c->value[0], c->index[0], p->na, c->value[1], c->index[1], p->nb);
  }
  ambit_rounding_restore(old);
  if (p->way != SPARSE) mark_dense(c, dst, limit);
}

AMBIT_WORKER double model_product(const context *c, model *dst, const model *a, const model *b, uint32_t limit) {
  plan p = choose(c, a, b, limit);
  multiply_nearest(c, dst, a, b, limit, &p);
  return error_bound(c, model_norm(c, a), model_norm(c, b), limit, p.na < p.nb ? p.na : p.nb);
}

static double larger_of(interval x) {
  double below = fabs(x.lo), above = fabs(x.hi);
  return below > above ? below : above;
}

/* what is beyond the product of the polynomials */
static double remainder_of(const context *c, const model *a, const model *b) {
  double va = larger_of(a->hull), vb = larger_of(b->hull);
  double pa = larger_of(model_range_naive(c, a)), pb = larger_of(model_range_naive(c, b));
  double first = a->rad * vb + pa * b->rad, second = va * b->rad + a->rad * pb;
  return first < second ? first : second;
}

static uint32_t hull_of(const context *c, interval *hull, const model *a, const model *b) {
  return model_hull(c, a == b ? AMBIT_OP_SQR : AMBIT_OP_MUL, hull, a->hull, b->hull, 0);
}

AMBIT_WORKER uint32_t model_multiply(const context *c, model *dst, const model *a, const model *b) {
  interval hull;
  hull_of(c, &hull, a, b);
  if (!model_is_polynomial(a) || !model_is_polynomial(b)) return model_finish_interval(c, dst, hull);
  double lost = model_product(c, dst, a, b, c->m.order);
  dst->rad = lost + remainder_of(c, a, b);
  return model_finish(c, dst, hull);
}

/* -- several at once: operands side by side, so that each vector holds one coefficient of every product */

/* How many of the n operands have block b? */
static size_t having(const context *c, size_t n, const model *const *x, uint32_t b) {
  size_t count = 0;
  for (size_t l = 0; l < n; l++) count += b == 0 || (model_mask(c, x[l])[b / 64] >> (b % 64) & 1);
  return count;
}

/* Coefficients [from, end) of lane l, `lanes` apart. */
static void spread(double *value, uint32_t lanes, const context *c, const model *x, uint32_t from, uint32_t end) {
  const double *coef = model_coef(c, x);
  for (uint32_t i = from; i < end; i++, value += lanes) *value = coef[i];
}

/* monomials that any of the operands has, and their coefficients lane by lane */
static uint32_t interleave(
    const context *c, size_t n, const model *const *x, uint32_t lanes, uint32_t *index, double *value) {
  uint32_t terms = 0;
  for (uint32_t b = 0; b < c->m.blocks; b++) {
    size_t there = having(c, n, x, b);
    if (there == 0) continue;
    uint32_t from = b * MONOMIALS_BLOCK,
             end = from + MONOMIALS_BLOCK < c->m.count ? from + MONOMIALS_BLOCK : c->m.count;
    double *place = value + (size_t)terms * lanes;
    if (there < lanes) memset(place, 0, (end - from) * (size_t)lanes * sizeof *place);
    for (size_t l = 0; l < n; l++)
      if (there == n || having(c, 1, &x[l], b)) spread(place + l, lanes, c, x[l], from, end);
    for (uint32_t i = from; i < end; i++) index[terms++] = i;
  }
  return terms;
}

static void separate(const context *c, size_t n, model *const *dst, uint32_t lanes) {
  const double *from = c->lanes[2];
  for (size_t l = 0; l < n; l++) {
    double *to = model_coef(c, dst[l]);
    for (size_t i = 0; i < c->m.count; i++) to[i] = from[i * lanes + l];
    mark_dense(c, dst[l], c->m.order);
  }
}

static AMBIT_WORKER void lanes_nearest(const context *c, uint32_t na, uint32_t nb) {
  ambit_rounding old = ambit_round_nearest();
  c->kernels->lanes_product(&c->m, c->m.order, c->lanes[2], c->lanes[0], c->index[0], na, c->lanes[1], c->index[1], nb);
  ambit_rounding_restore(old);
}

static void multiply_lanes(
    const context *c, size_t n, model *const *dst, const model *const *a, const model *const *b, double *lost) {
  uint32_t lanes = c->kernels->lanes;
  uint32_t na = interleave(c, n, a, lanes, c->index[0], c->lanes[0]);
  uint32_t nb = interleave(c, n, b, lanes, c->index[1], c->lanes[1]);
  lanes_nearest(c, na, nb);
  separate(c, n, dst, lanes);
  for (size_t l = 0; l < n; l++)
    lost[l] = error_bound(c, model_norm(c, a[l]), model_norm(c, b[l]), c->m.order, na < nb ? na : nb);
}

AMBIT_WORKER uint32_t model_multiply_many(
    const context *c, size_t n, model *const *dst, const model *const *a, const model *const *b) {
  double lost[MONOMIALS_ROW_PAD];
  uint32_t flags = 0;
  int together = c->lanes[0] && 2 * n > c->kernels->lanes;
  for (size_t l = 0; l < n && together; l++)
    together = model_is_polynomial(a[l]) && model_is_polynomial(b[l]) && filled(c, a[l], b[l], c->m.order) > 0.5;
  if (together) multiply_lanes(c, n, dst, a, b, lost);
  for (size_t l = 0; l < n; l++) {
    if (!together) {
      flags |= model_multiply(c, dst[l], a[l], b[l]);
      continue;
    }
    interval hull;
    hull_of(c, &hull, a[l], b[l]);
    dst[l]->rad = lost[l] + remainder_of(c, a[l], b[l]);
    flags |= model_finish(c, dst[l], hull);
  }
  return flags;
}
