/* variant.h -- the kernels, written once and compiled for each instruction set.
**
** Results of different instruction sets differ in the last bits (fused or not, order of sums); the error bounds hold
** for all. In a product every term of a coefficient is rounded once when multiplied (not at all if fused) and once for
** each addition that follows: with n terms in up to four partial sums, at most n + 3 times. Sums that are cut off
** later may overflow; nobody reads them.
*/
#include "kernels.h"
#include "vector.h"

static inline int present(const uint64_t *mask_words, uint32_t block) {
  return block == 0 || (mask_words[block / 64] >> (block % 64) & 1);
}

/* -- norms and naive range: an even monomial is in [0, 1], any other in [-1, 1] */

typedef struct survey_sums {
  vector norm, down, up;
} survey_sums;

static inline void survey_vector(survey_sums *s, vector v, words odd) {
  vector n = negated(v);
  s->norm += magnitude(v);
  s->up += larger_each(v, (vector)((words)n & odd));
  s->down += larger_each(n, (vector)((words)v & odd));
}

static void survey_mixed(const monomials *m, uint32_t block, const double *c, double *norm, double *down, double *up) {
  uint32_t start = block * MONOMIALS_BLOCK, end = start + MONOMIALS_BLOCK, degree = m->degree[start];
  double sum = 0, below = 0, above = 0;
  if (end > m->count) end = m->count;
  for (uint32_t i = start; i < end; i++) {
    double size = c[i] < 0 ? -c[i] : c[i];
    if (m->degree[i] != degree) norm[degree] += sum, sum = 0, degree = m->degree[i];
    sum += size;
    above += i && (m->odd[i] || c[i] > 0) ? size : 0;
    below += i && (m->odd[i] || c[i] < 0) ? size : 0;
  }
  norm[degree] += sum, *down += below, *up += above;
}

static void survey(
    const monomials *m, const uint64_t *mask_words, const double *c, double *norm, double *down, double *up) {
  survey_sums s = { splat(0), splat(0), splat(0) };
  uint32_t degree = 0;
  *down = 0, *up = 0;
  for (uint32_t q = 0; q <= m->order; q++) norm[q] = 0;
  for (uint32_t b = 0; b < m->blocks; b++) {
    if (b % 64 == 0 && mask_words[b / 64] == 0 && b > 0) {
      b += 63;
      continue;
    }
    if (!present(mask_words, b)) continue;
    if (m->uniform[b] == MONOMIALS_MIXED) {
      survey_mixed(m, b, c, norm, down, up);
      continue;
    }
    if (m->uniform[b] != degree) norm[degree] += total(s.norm), s.norm = splat(0), degree = m->uniform[b];
    for (uint32_t i = b * MONOMIALS_BLOCK; i < (b + 1) * MONOMIALS_BLOCK; i += WIDTH)
      survey_vector(&s, load(c + i), load_mask(m->odd + i));
  }
  norm[degree] += total(s.norm);
  *down += total(s.down), *up += total(s.up);
}

/* -- sums: what rounding loses is computed exactly (Knuth's TwoSum, nearest mode, no underflow) */

static inline vector sum_vector(double *c, vector a, vector b) {
  vector s = a + b, t = s - a;
  store(c, s);
  return magnitude((a - (s - t)) + (b - t));
}

static inline double copy_block(double *c, const double *a, int negative) {
  for (int i = 0; i < MONOMIALS_BLOCK; i += WIDTH) store(c + i, negative ? negated(load(a + i)) : load(a + i));
  return 0;
}

static inline double sum_block(double *c, const double *a, const double *b, int subtract) {
  vector error = splat(0);
  for (int i = 0; i < MONOMIALS_BLOCK; i += WIDTH)
    error += sum_vector(c + i, load(a + i), subtract ? negated(load(b + i)) : load(b + i));
  return total(error);
}

static double sum(const monomials *m, double *c, uint64_t *mc, const double *a, const uint64_t *ma, const double *b,
    const uint64_t *mb, int subtract) {
  double error = 0;
  for (uint32_t w = 0; w < m->words; w++) {
    uint64_t base = w == 0;
    mc[w] = ma[w] | mb[w] | base;
    for (uint64_t rest = mc[w]; rest; rest &= rest - 1) {
      uint64_t bit = rest & -rest;
      size_t i = ((size_t)w * 64 + (size_t)__builtin_ctzll(rest)) * MONOMIALS_BLOCK;
      if (!((mb[w] | base) & bit))
        copy_block(c + i, a + i, 0);
      else if (!((ma[w] | base) & bit))
        copy_block(c + i, b + i, subtract);
      else
        error += sum_block(c + i, a + i, b + i, subtract);
    }
  }
  return error;
}

/* -- products */

#define UNROLL _Pragma("GCC unroll 8")

/* A row of n powers from pairs of rows: power i of the left times all powers of the right has sums of its own, over all
** pairs, which are shifted into place only at the end; so nothing is loaded at odd places. A right row is one or two
** vectors, the second of which only i < n - ROW_WIDTH need. `sets`: sums by turns, as an addition has to wait for the
** one before. n and sets are known to the compiler. */
static inline __attribute__((always_inline)) void add_pair(
    row_vector *low, row_vector *high, const double *left, const double *right, int n) {
  row_vector first = row_load(right), second = n > ROW_WIDTH ? row_load(right + ROW_WIDTH) : first;
  UNROLL for (int i = 0; i < n; i++) {
    row_vector factor = row_splat(left[i]);
    low[i] = row_multiply_add(factor, first, low[i]);
    if (i < n - ROW_WIDTH) high[i] = row_multiply_add(factor, second, high[i]);
  }
}

static inline __attribute__((always_inline)) void row_of(
    const row_pair *p, const row_pair *end, const double *a, const double *b, double *out, int n, int sets) {
  row_vector low[4][2 * ROW_WIDTH], high[4][ROW_WIDTH];
  double sum[2 * ROW_WIDTH][2 * ROW_WIDTH];
  UNROLL for (int k = 0; k < sets; k++) {
    UNROLL for (int i = 0; i < n; i++) low[k][i] = row_splat(0);
    UNROLL for (int i = 0; i < n - ROW_WIDTH; i++) high[k][i] = row_splat(0);
  }
  for (; p < end; p += sets) {
    UNROLL for (int k = 0; k < sets; k++) add_pair(low[k], high[k], a + p[k].left, b + p[k].right, n);
  }
  UNROLL for (int i = 0; i < n; i++) {
    UNROLL for (int k = 1; k < sets; k++) low[0][i] += low[k][i];
    row_store(sum[i], low[0][i]);
    if (i >= n - ROW_WIDTH) continue;
    UNROLL for (int k = 1; k < sets; k++) high[0][i] += high[k][i];
    row_store(sum[i] + ROW_WIDTH, high[0][i]);
  }
  UNROLL for (int k = 0; k < n; k++) {
    double x = sum[0][k];
    UNROLL for (int i = 1; i <= k; i++) x += sum[i][k - i];
    out[k] = x;
  }
}

/* out[o ..] += products of ROW_WIDTH powers on either side, for rows that are longer */
static void add_tile(const row_pair *p, const row_pair *end, const double *a, const double *b, double *out) {
  row_vector s[ROW_WIDTH];
  double sum[ROW_WIDTH];
  UNROLL for (int i = 0; i < ROW_WIDTH; i++) s[i] = row_splat(0);
  for (; p < end; p++) {
    row_vector right = row_load(b + p->right);
    UNROLL for (int i = 0; i < ROW_WIDTH; i++) s[i] =
        row_multiply_add(row_splat(a[p->left + (uint32_t)i]), right, s[i]);
  }
  UNROLL for (int i = 0; i < ROW_WIDTH; i++) {
    row_store(sum, s[i]);
    for (int k = 0; k < ROW_WIDTH; k++) out[i + k] += sum[k];
  }
}

static void long_row(
    const row_pair *p, const row_pair *end, const double *a, const double *b, double *out, uint32_t powers) {
  memset(out, 0, (powers + 2 * ROW_WIDTH) * sizeof *out);
  for (uint32_t i = 0; i < powers; i += ROW_WIDTH)
    for (uint32_t j = 0; i + j < powers; j += ROW_WIDTH) add_tile(p, end, a + i, b + j, out + i + j);
}

static void rows_product(const monomials *m, uint32_t limit, double *c, const double *a, const double *b) {
  const monomial_rows *r = &m->rows;
  double out[MONOMIALS_ORDER_MAX + 1 + 2 * ROW_WIDTH];
  for (uint32_t t = 0; t < r->count && r->degree[t] <= limit; t++) {
    uint32_t powers = limit - r->degree[t] + 1u;
    const uint32_t *index = r->index + r->item[t];
    const row_pair *p = r->pair + r->pairs[t], *end = r->pair + r->pairs[t + 1];
    switch (powers) {
    case 1: row_of(p, end, a, b, out, 1, 4); break;
    case 2: row_of(p, end, a, b, out, 2, 4); break;
    case 3: row_of(p, end, a, b, out, 3, 2); break;
    case 4: row_of(p, end, a, b, out, 4, ROW_WIDTH < 4 ? 1 : 2); break;
#if ROW_WIDTH > 2
    case 5: row_of(p, end, a, b, out, 5, 1); break;
    case 6: row_of(p, end, a, b, out, 6, 1); break;
    case 7: row_of(p, end, a, b, out, 7, 1); break;
    case 8: row_of(p, end, a, b, out, 8, 1); break;
#endif
    default: long_row(p, end, a, b, out, powers); break;
    }
    for (uint32_t k = 0; k < powers; k++) c[index[k]] = out[k];
  }
}

static void dense_product(const monomials *m, uint32_t limit, double *c, const double *a, const double *b) {
  uint32_t count = m->first[limit + 1];
  memset(c, 0, count * sizeof *c);
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t *times = m->times + m->row[i];
    uint32_t n = m->first[limit - m->degree[i] + 1u];
    double x = a[i];
    for (uint32_t j = 0; j < n; j++) c[times[j]] = multiply_add_one(x, b[j], c[times[j]]);
  }
}

static inline void touch(double *c, uint64_t *mc, uint32_t index) {
  uint32_t block = index / MONOMIALS_BLOCK;
  uint64_t bit = (uint64_t)1 << (block % 64);
  if (mc[block / 64] & bit) return;
  mc[block / 64] |= bit;
  memset(c + (size_t)block * MONOMIALS_BLOCK, 0, MONOMIALS_BLOCK * sizeof *c);
}

/* how many of the n sorted monomials have at most this degree */
static inline uint32_t within(const monomials *m, const uint32_t *index, uint32_t n, uint32_t degree) {
  uint32_t end = m->first[degree + 1];
  while (n && index[n - 1] >= end) n--;
  return n;
}

static void sparse_product(const monomials *m, uint32_t limit, double *c, uint64_t *mc, const double *a,
    const uint32_t *ia, uint32_t na, const double *b, const uint32_t *ib, uint32_t nb) {
  na = within(m, ia, na, limit);
  for (uint32_t i = 0; i < na; i++) {
    const uint32_t *times = m->times + m->row[ia[i]];
    nb = within(m, ib, nb, limit - m->degree[ia[i]]);
    for (uint32_t j = 0; j < nb; j++) {
      uint32_t k = times[ib[j]];
      touch(c, mc, k);
      c[k] = multiply_add_one(a[i], b[j], c[k]);
    }
  }
}

static void lanes_product(const monomials *m, uint32_t limit, double *c, const double *a, const uint32_t *ia,
    uint32_t na, const double *b, const uint32_t *ib, uint32_t nb) {
  memset(c, 0, (size_t)m->blocks * MONOMIALS_BLOCK * WIDTH * sizeof *c);
  na = within(m, ia, na, limit);
  for (uint32_t i = 0; i < na; i++) {
    const uint32_t *times = m->times + m->row[ia[i]];
    vector x = load(a + (size_t)i * WIDTH);
    nb = within(m, ib, nb, limit - m->degree[ia[i]]);
    for (uint32_t j = 0; j < nb; j++) {
      double *place = c + (size_t)times[ib[j]] * WIDTH;
      store(place, multiply_add(x, load(b + (size_t)j * WIDTH), load(place)));
    }
  }
}

const kernels VARIANT = { WIDTH, survey, sum, rows_product, dense_product, sparse_product, lanes_product };
