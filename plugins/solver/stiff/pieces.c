/* pieces.c -- from the step's polynomial in Chebyshev form to powers of a piece's own time.
**
** Piece j of m = 2^(level + 2) is tau = (X + s) / m, X = 2 j + 1 - m. By T_(k+1) = 2 tau T_k - T_(k-1) the powers of
** s in
** T_k(tau) m^k are integers; they are computed in double-double, once. Nothing here needs a proof: the piece's
** polynomial P is what comes out, and where P and its neighbours do not meet, the proof adds what is between them.
*/
#include "stiff.h"

static uint32_t pieces_before(uint32_t level) { return (4u << level) - 4u; }

size_t pieces_table_size(uint32_t N) { return (size_t)pieces_before(LEVELS) * (N + 1) * (N + 1); }

static dd *entry(dd *table, uint32_t N, uint32_t level, uint32_t j) {
  return table + (size_t)(pieces_before(level) + j) * (N + 1) * (N + 1);
}

static void fill(dd *T, uint32_t N, double X, double m) {
  uint32_t w = N + 1;
  for (uint32_t i = 0; i < w * w; i++) T[i] = (dd) { 0, 0 };
  T[0] = (dd) { 1, 0 };
  T[w] = (dd) { X / m, 0 }, T[w + 1] = (dd) { 1 / m, 0 };
  for (uint32_t k = 2; k <= N; k++)
    for (uint32_t l = 0; l <= k; l++) {
      dd next = dd_scale(T[(k - 1) * w + l], 2 * X / m);
      if (l) next = dd_add(next, dd_scale(T[(k - 1) * w + l - 1], 2 / m));
      T[k * w + l] = dd_sub(next, T[(k - 2) * w + l]);
    }
}

void pieces_fill(dd *table, uint32_t N) {
  for (uint32_t level = 0; level < LEVELS; level++) {
    uint32_t m = 4u << level;
    for (uint32_t j = 0; j < m; j++) fill(entry(table, N, level, j), N, 2.0 * j + 1 - m, m);
  }
}

const dd *pieces_table(const stiff *s, uint32_t level, uint32_t j) { return entry(s->table, s->q.N, level, j); }

void pieces_cut(stiff *s, uint32_t level, uint32_t j) {
  uint32_t N = s->q.N, w = N + 1, nx = s->nx;
  const dd *T = pieces_table(s, level, j);
  dd c[NODES_MAX + 1];
  for (uint32_t a = 0; a < s->inputs; a++) {
    poly *p = &s->P[a];
    p->n = a < nx ? N + 1 : 1, p->tail = 0;
    dd first = dd_of(s->q.x[a]);
    if (a < nx) first = dd_add(first, (dd) { s->below[a], 0 });
    for (uint32_t k = 1; k <= N && a < nx; k++) {
      c[k] = dd_of(s->q.c[k * nx + a]);
      first = dd_add(first, dd_mul(c[k], dd_add(T[k * w], (dd) { k % 2 ? 1 : -1, 0 })));
    }
    poly_set(p, 0, a < nx ? first : s->start[a]);
    for (uint32_t l = 1; l < p->n; l++) {
      dd sum = { 0, 0 };
      for (uint32_t k = l; k <= N; k++) sum = dd_add(sum, dd_mul(T[k * w + l], c[k]));
      poly_set(p, l, sum);
    }
  }
}
