/* space.c -- the monomials: rows, their neighbours, and which rows multiply into which. */
#include "polynomial.h"
#include <string.h>

uint64_t space_count(uint32_t m, uint32_t d) {
  uint64_t n = 1;
  for (uint32_t i = 1; i <= m && n < UINT32_MAX; i++) n = n * (d + i) / i; /* binomial (d + i, i) */
  return n;
}

static void *room(const ambit_host *h, size_t count, size_t size) { return h->alloc(h, count ? count * size : size); }

/* all exponents of the unknowns 1 .. m-1 of total degree <= d, by degree; returns how many, fills if there is room */
static uint32_t list_rows(space *s) {
  uint32_t e[UNKNOWNS_MAX] = { 0 }, n = 0, free = s->m > 1 ? s->m - 1 : 0;
  for (uint32_t degree = 0; degree <= (free ? s->d : 0); degree++) {
    memset(e, 0, sizeof e);
    if (free) e[1] = degree;
    for (;;) {
      if (s->row) {
        s->row[n] = (row) { .degree = degree, .length = s->d - degree + 1 };
        if (s->m) memcpy(s->exponent + (size_t)n * s->m, e, s->m * sizeof *e);
      }
      n++;
      /* the next composition of `degree`: move one from the last nonzero place before the end, sweep the end back */
      uint32_t at = free;
      while (at > 1 && e[at - 1] == 0) at--;
      if (at <= 1) break;
      uint32_t tail = e[free];
      e[at - 1]--;
      e[free] = 0;
      e[at] = tail + 1;
    }
  }
  return n;
}

static uint32_t find_row(const space *s, const uint32_t *e) {
  uint32_t degree = 0;
  for (uint32_t v = 1; v < s->m; v++) degree += e[v];
  if (degree > s->d) return NO_ROW;
  for (uint32_t r = 0; r < s->nrow; r++)
    if (s->row[r].degree == degree && memcmp(s->exponent + (size_t)r * s->m, e, s->m * sizeof *e) == 0) return r;
  return NO_ROW;
}

static void lay_out(space *s) {
  size_t at = 0;
  for (uint32_t r = 0; r < s->nrow; r++) {
    s->row[r].groups = (s->row[r].length + 3) / 4;
    s->row[r].at = (uint32_t)at + 4;
    at += 4 + 4 * s->row[r].groups;
    s->count += s->row[r].length;
  }
  s->size = at;
  s->degrees = (s->d + 4u) / 4 * 4;
  s->stride = s->size + 2 * s->degrees + 4;
}

static void find_neighbours(space *s) {
  uint32_t e[UNKNOWNS_MAX];
  for (uint32_t v = 1; v < s->m; v++)
    for (uint32_t r = 0; r < s->nrow; r++) {
      memcpy(e, s->exponent + (size_t)r * s->m, s->m * sizeof *e);
      e[v]++;
      s->next[(size_t)v * s->nrow + r] = find_row(s, e);
    }
}

/* the row of the product of rows a and b, by walking from a */
static uint32_t product_row(const space *s, uint32_t a, uint32_t b) {
  uint32_t r = a;
  for (uint32_t v = 1; v < s->m; v++)
    for (uint32_t k = s->exponent[(size_t)b * s->m + v]; k > 0 && r != NO_ROW; k--)
      r = s->next[(size_t)v * s->nrow + r];
  return r;
}

/* pairs sorted by the row of their product; count, then fill */
static int find_pairs(const ambit_host *h, space *s) {
  uint32_t *fill = room(h, s->nrow + 1u, sizeof *fill);
  s->pairs = room(h, s->nrow + 1u, sizeof *s->pairs);
  if (!fill || !s->pairs) return 0;
  for (int pass = 0; pass < 2; pass++) {
    for (uint32_t a = 0; a < s->nrow; a++)
      for (uint32_t b = 0; b < s->nrow && s->row[a].degree + s->row[b].degree <= s->d; b++) {
        uint32_t r = product_row(s, a, b);
        if (pass)
          s->pair[fill[r]++] = (pair) { a, b };
        else
          s->pairs[r + 1]++;
      }
    if (pass) return 1;
    for (uint32_t r = 0; r < s->nrow; r++) s->pairs[r + 1] += s->pairs[r], fill[r] = s->pairs[r];
    s->pair = room(h, s->pairs[s->nrow], sizeof *s->pair);
    if (!s->pair) return 0;
  }
  return 1;
}

/* a coefficient of a product is a sum over the divisors of its monomial */
static void count_terms(space *s) {
  for (uint32_t r = 0; r < s->nrow; r++) {
    uint32_t most = s->row[r].length;
    for (uint32_t v = 1; v < s->m; v++) most *= s->exponent[(size_t)r * s->m + v] + 1;
    if (most > s->terms) s->terms = most;
  }
}

ambit_status space_open(const ambit_host *h, space *s, uint32_t m, uint32_t d) {
  *s = (space) { .m = m, .d = m ? d : 0, .convolve = sum_convolve_portable };
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) s->convolve = sum_convolve_avx2;
#endif
  s->nrow = list_rows(s);
  s->exponent = room(h, (size_t)s->nrow * m, sizeof *s->exponent);
  s->next = room(h, (size_t)s->nrow * m, sizeof *s->next);
  row *rows = room(h, s->nrow, sizeof *rows);
  if (!s->exponent || !s->next || !rows) return AMBIT_NOMEM;
  s->row = rows;
  list_rows(s);
  lay_out(s);
  find_neighbours(s);
  count_terms(s);
  return find_pairs(h, s) ? AMBIT_OK : AMBIT_NOMEM;
}
