/* dense.c -- one polynomial for the whole step, with a proved radius. Round-to-nearest.
**
** The step's Chebyshev polynomial is written in powers of the time since the step began, with doubles as coefficients;
** what these doubles say is then compared with each piece's P, as polynomials of the piece's own time.
*/
#include "stiff.h"
#include <string.h>

/* powers of sigma = (tau + 1) / 2 in T_k(tau), by T_(k+1) = 2 (2 sigma - 1) T_k - T_(k-1) */
static void next_chebyshev(uint32_t k, const dd *now, const dd *before, dd *next) {
  for (uint32_t l = 0; l <= k + 1; l++) {
    dd x = l <= k ? dd_scale(now[l], -2) : (dd) { 0, 0 };
    if (l > 0) x = dd_add(x, dd_scale(now[l - 1], 4));
    next[l] = l + 1 <= k ? dd_sub(x, before[l]) : x;
  }
}

void dense_start(stiff *s) {
  uint32_t N = s->q.N, w = N + 1;
  dd before[NODES_MAX + 2] = { { 1, 0 } }, now[NODES_MAX + 2] = { { -1, 0 }, { 2, 0 } }, next[NODES_MAX + 2];
  for (uint32_t i = 0; i < s->nx; i++) {
    for (uint32_t l = 0; l < w; l++) s->dense_sum[i * w + l] = (dd) { 0, 0 };
    s->dense_sum[i * w] = dd_of(s->q.x[i]);
  }
  for (uint32_t k = 1; k <= N; k++) {
    for (uint32_t i = 0; i < s->nx; i++) {
      dd c = dd_of(s->q.c[k * s->nx + i]), *sum = s->dense_sum + i * w;
      sum[0] = dd_add(sum[0], dd_scale(c, k % 2 ? 1 : -1));
      for (uint32_t l = 0; l <= k; l++) sum[l] = dd_add(sum[l], dd_mul(c, now[l]));
    }
    next_chebyshev(k, now, before, next);
    memcpy(before, now, sizeof before);
    memcpy(now, next, sizeof now);
  }
  for (uint32_t i = 0; i < s->nx; i++) {
    double unit = 1; /* h^l */
    for (uint32_t l = 0; l < w; l++, unit *= s->h.hi) {
      s->dense_mid[i * w + l] = s->dense_sum[i * w + l].hi / unit;
      s->dense_rad[i * w + l] = 0;
    }
  }
}

/* the time since the step began, along piece j: half (2 j + 1) + half s */
static void put_span(const stiff *s, poly *r, uint32_t j) {
  poly_set(r, 0, dd_scale(s->half, 2.0 * j + 1));
  poly_set(r, 1, s->half);
  r->n = 2;
  r->tail = 8 * DD_U * DD_U * fabs(r->hi[0]) * (1 + 0x1p-40) + DD_TINY;
}

void dense_piece(stiff *s, uint32_t j) {
  uint32_t N = s->q.N, w = N + 1;
  poly *scratch = s->rhs.scratch, *span = &scratch[0], *sum = &scratch[1], *product = &scratch[2], *term = &scratch[3];
  put_span(s, span, j);
  for (uint32_t i = 0; i < s->nx; i++) {
    poly_constant(sum, (dd) { s->dense_mid[i * w + N], 0 }, 0);
    for (uint32_t k = N; k-- > 0;) {
      poly_mul(product, 2 * N + 3, sum, span);
      poly_constant(term, (dd) { s->dense_mid[i * w + k], 0 }, 0);
      poly_add(sum, product, term, 1);
    }
    poly_add(sum, sum, &s->P[i], -1);
    double off = (poly_norm(sum) + s->radius[i] + (s->spread ? spread_reach(s, i) : 0)) * (1 + 0x1p-40);
    double *worst = &s->dense_rad[i * w];
    if (!(off <= *worst)) *worst = off; /* NaN is kept */
  }
}

int dense_is_good(const stiff *s) {
  for (uint32_t k = 0; k < s->nx * (s->q.N + 1); k++)
    if (!isfinite(s->dense_mid[k]) || !isfinite(s->dense_rad[k])) return 0;
  return 1;
}
