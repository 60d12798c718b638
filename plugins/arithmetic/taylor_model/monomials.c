/* monomials.c -- building the tables, each entry from earlier ones.
**
** With l = last(m) and p = parent(m): m x_v is child(m) + v for v <= l, and otherwise (p x_v) x_l, where every variable
** of p x_v is at least l. A general product follows the word of its right factor: i j = (i parent(j)) x_last(j).
*/
#include "monomials.h"
#include <stdlib.h>

/* a monomial without x_0; its row has as many pairs as it has divisors */
typedef struct base {
  uint32_t index, degree, divisors;
} base;

double monomial_count(double nvar, uint32_t order) {
  double n = 1;
  for (uint32_t k = 1; k <= order; k++) n = n * (nvar + k) / k;
  return n;
}

static double row_pairs(uint32_t nvar, uint32_t order) { return monomial_count(2.0 * (nvar - 1.0), order); }

int monomials_has_rows(uint32_t nvar, uint32_t order) {
  return nvar > 0 && monomial_count(2.0 * nvar, order) >= 2 * row_pairs(nvar, order);
}

double monomials_bytes(uint32_t nvar, uint32_t order) {
  double count = monomial_count(nvar, order), products = monomial_count(2.0 * nvar, order);
  double each = 1 + 4 * sizeof(uint32_t) + sizeof(size_t) + sizeof(int64_t) + 1;
  double bytes = count * each + products * sizeof(uint32_t) + (order + 1.0) * 16 + 512;
  if (!monomials_has_rows(nvar, order)) return bytes;
  double rows = monomial_count(nvar - 1.0, order);
  return bytes + count * 3 * sizeof(uint32_t) + row_pairs(nvar, order) * sizeof(row_pair) +
         rows * (1 + sizeof(base) + 4 * sizeof(uint32_t) + MONOMIALS_ROW_GROUP * sizeof(row_pair));
}

typedef struct pool {
  char *next;
} pool;

static void *take(pool *p, size_t bytes) {
  void *place = p->next;
  p->next += (bytes + 7) / 8 * 8;
  return place;
}

static void lay_words(monomials *m, pool *p) {
  uint32_t *first = take(p, (m->order + 2u) * sizeof *first);
  uint8_t *degree = take(p, m->count);
  uint32_t *parent = take(p, m->count * sizeof *parent), *last = take(p, m->count * sizeof *last);
  uint32_t *child = take(p, m->count * sizeof *child), next = 1;
  first[0] = 0, first[1] = 1;
  degree[0] = 0, parent[0] = 0, last[0] = m->nvar - 1, child[0] = 0; /* the 1 may be followed by any variable */
  for (uint32_t q = 1; q <= m->order; q++) {
    for (uint32_t i = first[q - 1]; i < first[q]; i++) {
      child[i] = next;
      for (uint32_t v = 0; m->nvar > 0 && v <= last[i]; v++, next++)
        degree[next] = (uint8_t)q, parent[next] = i, last[next] = v, child[next] = 0;
    }
    first[q + 1] = next;
  }
  m->first = first, m->degree = degree, m->parent = parent, m->last = last, m->child = child;
}

static uint32_t by_variable(const monomials *m, const uint32_t *row_of_v, uint32_t i, uint32_t v) {
  if (i == 0 || v <= m->last[i]) return m->child[i] + v;
  return m->child[row_of_v[m->parent[i]]] + m->last[i];
}

static void lay_products(monomials *m, pool *p) {
  size_t *row = take(p, m->count * sizeof *row), next = 0;
  for (uint32_t i = 0; i < m->count; i++) row[i] = next, next += m->first[m->order - m->degree[i] + 1u];
  uint32_t *times = take(p, next * sizeof *times);
  for (uint32_t j = 0; j < m->count; j++) times[j] = j; /* the row of 1 */
  for (uint32_t i = 1; i < m->count; i++) {
    uint32_t *of = times + row[i], n = m->first[m->order - m->degree[i] + 1u];
    of[0] = i;
    for (uint32_t j = 1; j < n; j++)
      of[j] = m->degree[i] == 1 ? by_variable(m, of, j, i - 1) : times[row[1 + m->last[j]] + of[m->parent[j]]];
  }
  m->row = row, m->times = times, m->products = next;
}

/* number of times that the last variable occurs; *rest: the monomial without it */
static uint32_t last_power(const monomials *m, uint32_t i, uint32_t *rest) {
  uint32_t v = m->last[i], n = 0;
  for (; i && m->last[i] == v; i = m->parent[i]) n++;
  *rest = i;
  return n;
}

static void lay_kinds(monomials *m, pool *p) {
  uint8_t *uniform = take(p, m->blocks);
  int64_t *odd = take(p, m->blocks * MONOMIALS_BLOCK * sizeof *odd);
  uint32_t *divisors = take(p, m->count * sizeof *divisors);
  double *terms = take(p, (m->order + 1u) * sizeof *terms);
  for (uint32_t q = 0; q <= m->order; q++) terms[q] = 1;
  odd[0] = 0, divisors[0] = 1;
  for (uint32_t i = 1; i < m->count; i++) {
    uint32_t rest, n = last_power(m, i, &rest);
    odd[i] = n % 2 || odd[rest] ? -1 : 0;
    divisors[i] = divisors[rest] * (n + 1);
    if (terms[m->degree[i]] < divisors[i]) terms[m->degree[i]] = divisors[i];
  }
  for (uint32_t i = m->count; i < m->blocks * MONOMIALS_BLOCK; i++) odd[i] = 0;
  for (uint32_t b = 0; b < m->blocks; b++) {
    uint32_t end = (b + 1) * MONOMIALS_BLOCK, low = m->degree[b * MONOMIALS_BLOCK];
    uint32_t high = m->degree[(end < m->count ? end : m->count) - 1];
    uniform[b] = (uint8_t)(b > 0 && low == high ? low : MONOMIALS_MIXED);
  }
  m->uniform = uniform, m->odd = odd, m->terms = terms;
}

/* the order of rows */
static int by_degree(const void *x, const void *y) {
  const base *a = x, *b = y;
  if (a->degree != b->degree) return a->degree < b->degree ? -1 : 1;
  if (a->divisors != b->divisors) return a->divisors < b->divisors ? -1 : 1;
  return a->index < b->index ? -1 : a->index > b->index;
}

static uint32_t divisors_of(const monomials *m, uint32_t i) {
  uint32_t rest = i, n = 1;
  while (rest) n *= last_power(m, rest, &rest) + 1;
  return n;
}

/* the monomials without x_0 */
static void list_bases(const monomials *m, base *bases) {
  uint32_t row = 0;
  for (uint32_t i = 0; i < m->count; i++)
    if (i == 0 || m->last[i] != 0) bases[row++] = (base) { i, m->degree[i], divisors_of(m, i) };
  qsort(bases, row, sizeof *bases, by_degree);
}

static void lay_items(monomials *m, pool *p, uint32_t count, const base *bases, uint32_t *start, uint32_t *number) {
  uint8_t *degree = take(p, count);
  uint32_t *item = take(p, (count + 1) * sizeof *item), *index = take(p, m->count * sizeof *index);
  uint32_t *place = take(p, m->count * sizeof *place), items = 0, packed = 0;
  for (uint32_t row = 0; row < count; row++) {
    uint32_t i = bases[row].index, powers = m->order - bases[row].degree;
    degree[row] = (uint8_t)bases[row].degree, item[row] = items, start[row] = packed, number[i] = row;
    for (uint32_t k = 0, j = i; k <= powers; k++, j = m->child[j]) index[items++] = j, place[j] = packed + k;
    packed += (powers + MONOMIALS_ROW_PAD) / MONOMIALS_ROW_PAD * MONOMIALS_ROW_PAD;
  }
  item[count] = items;
  m->rows.degree = degree, m->rows.item = item, m->rows.index = index, m->rows.place = place;
  m->rows.packed = packed;
}

/* number: the row of each monomial without x_0; the pairs of a row are as many as the divisors of its monomial */
static void lay_pairs(
    monomials *m, pool *p, uint32_t count, const base *bases, const uint32_t *start, const uint32_t *number) {
  uint32_t *pairs = take(p, (count + 1) * sizeof *pairs), *fill = take(p, count * sizeof *fill), total = 0;
  for (uint32_t t = 0; t < count; t++) {
    pairs[t] = fill[t] = total;
    total += (bases[t].divisors + MONOMIALS_ROW_GROUP - 1) / MONOMIALS_ROW_GROUP * MONOMIALS_ROW_GROUP;
  }
  pairs[count] = total;
  row_pair *pair = take(p, total * sizeof *pair);
  for (uint32_t k = 0; k < total; k++) pair[k] = (row_pair) { m->rows.packed, m->rows.packed };
  for (uint32_t r = 0; r < count; r++)
    for (uint32_t s = 0; s < count && bases[r].degree + bases[s].degree <= m->order; s++)
      pair[fill[number[monomials_product(m, bases[r].index, bases[s].index)]]++] = (row_pair) { start[r], start[s] };
  m->rows.pairs = pairs, m->rows.pair = pair;
}

static void lay_rows(monomials *m, pool *p) {
  uint32_t count = (uint32_t)(monomial_count(m->nvar - 1.0, m->order) + 0.5);
  base *bases = take(p, count * sizeof *bases);
  uint32_t *start = take(p, count * sizeof *start), *number = take(p, m->count * sizeof *number);
  list_bases(m, bases);
  lay_items(m, p, count, bases, start, number);
  lay_pairs(m, p, count, bases, start, number);
  m->rows.count = count;
}

void monomials_lay(monomials *m, uint32_t nvar, uint32_t order, void *room) {
  pool p = { room };
  *m = (monomials) { .nvar = nvar, .order = nvar ? order : 0 };
  m->count = (uint32_t)(monomial_count(nvar, m->order) + 0.5);
  m->blocks = (m->count + MONOMIALS_BLOCK - 1) / MONOMIALS_BLOCK, m->words = (m->blocks + 63) / 64;
  lay_words(m, &p);
  lay_products(m, &p);
  lay_kinds(m, &p);
  if (monomials_has_rows(nvar, m->order)) lay_rows(m, &p);
}

void monomials_exponents(const monomials *m, uint32_t i, uint32_t *exponent) {
  for (uint32_t v = 0; v < m->nvar; v++) exponent[v] = 0;
  for (; i; i = m->parent[i]) exponent[m->last[i]]++;
}

uint32_t monomials_index(const monomials *m, const uint32_t *exponent) {
  uint32_t i = 0, degree = 0;
  for (uint32_t v = m->nvar; v-- > 0;)
    for (uint32_t k = 0; k < exponent[v]; k++) {
      if (++degree > m->order) return UINT32_MAX;
      i = m->child[i] + v;
    }
  return i;
}
