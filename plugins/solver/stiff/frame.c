/* frame.c -- the moving frame of a piece, chosen in round-to-nearest, and what must be known of it, in upward mode.
**
** U(s) = [(V0 + s V1) G(s), F0 + s F1]: both ends' directions, linear between, with slow columns moved as the slow part
** of the variational equation moves them, so that their errors stay put: with L the slow rows of [V0 F0]^-1, H = L V1,
** K_a the coefficients of L (eta/2) J (V0 + s V1), (l + 1) G_(l+1) = sum_a K_a G_(l-a) - (l + 1) H G_l.
*/
#include "stiff.h"
#include <string.h>

/* ends' mean and half their difference */
static void halves(size_t count, const double *from, const double *to, double *mean, double *turn) {
  for (size_t i = 0; i < count; i++) mean[i] = 0.5 * (from[i] + to[i]), turn[i] = 0.5 * (to[i] - from[i]);
}

/* G_0 .. G_(SLOPE_ORDER + 2) with G(-1) = I; V0, V1 [n x g], L [g x n] */
static int transport(const stiff *s, uint32_t g, const double *V0, const double *V1, const double *L, square *G) {
  uint32_t n = s->n, top = SLOPE_ORDER + 2;
  static const uint32_t last = SLOPE_ORDER + 1;
  double K[SLOPE_ORDER + 2][N_MAX * N_MAX];
  square H, X, sum, inverse;
  matrix_multiply(g, n, g, L, V1, H);
  for (uint32_t a = 0; a <= last; a++) {
    frame_apply_slopes(s, a, g, V0, X);
    matrix_multiply(g, n, g, L, X, K[a]);
    if (a == 0) continue;
    frame_apply_slopes(s, a - 1, g, V1, X);
    matrix_multiply(g, n, g, L, X, sum);
    matrix_add_scaled((size_t)g * g, K[a], 1, sum);
  }
  for (uint32_t i = 0; i < g * g; i++) G[0][i] = i % (g + 1) == 0;
  for (uint32_t l = 0; l < top; l++) {
    memset(sum, 0, (size_t)g * g * sizeof *sum);
    for (uint32_t a = 0; a <= l && a <= last; a++) {
      matrix_multiply(g, g, g, K[a], G[l - a], X);
      matrix_add_scaled((size_t)g * g, sum, 1.0 / (l + 1), X);
    }
    matrix_multiply(g, g, g, H, G[l], X);
    for (uint32_t i = 0; i < g * g; i++) G[l + 1][i] = sum[i] - X[i];
  }
  memset(sum, 0, (size_t)g * g * sizeof *sum);
  for (uint32_t l = 0; l <= top; l++) matrix_add_scaled((size_t)g * g, sum, l % 2 ? -1 : 1, G[l]);
  if (!matrix_inverse(g, sum, inverse)) return 0;
  for (uint32_t l = 0; l <= top; l++) {
    matrix_multiply(g, g, g, G[l], inverse, X);
    memcpy(G[l], X, (size_t)g * g * sizeof *X);
  }
  return 1;
}

/* columns from .. from + cols of r [n x n] += X [n x cols] */
static void place(uint32_t n, uint32_t from, uint32_t cols, const double *X, double *r) {
  for (uint32_t i = 0; i < n; i++) matrix_add_scaled(cols, r + i * n + from, 1, X + i * cols);
}

static void enlarge(const split *p, frame *r, uint32_t n) {
  uint32_t g = p->slow;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) r->G[i * n + k] = i < g && k < g ? p->G0[i * g + k] : i == k;
}

int frame_choose(stiff *s, uint32_t j) {
  frame *r = &s->frame;
  split *p = &r->split;
  uint32_t n = s->n;
  r->natural = 0;
  memset(r->still, 0, sizeof r->still);
  const ends e = { n, s->nx, s->q.scale, &s->spectrum[j], &s->spectrum[j + 1], s->rate + (size_t)j * n * n,
    s->rate + (size_t)(j + 1) * n * n };
  if (!split_choose(&e, &s->carried, p)) return 0;
  uint32_t g = p->slow, f = p->fast;
  square V0, V1, F0, F1, A, inverse, X;
  square G[SLOPE_ORDER + 3];
  halves((size_t)n * g, p->slow0, p->slow1, V0, V1);
  halves((size_t)n * f, p->fast0, p->fast1, F0, F1);
  join_columns(n, g, V0, f, F0, A);
  if (!matrix_inverse(n, A, inverse) || (g && !transport(s, g, V0, V1, inverse, G))) return 0;
  r->order = g ? FRAME_ORDER : 1;
  for (uint32_t l = 0; l <= r->order; l++) {
    memset(r->U[l], 0, (size_t)n * n * sizeof(double));
    if (l < FRAME_ORDER && g) matrix_multiply(n, g, g, V0, G[l], X), place(n, 0, g, X, r->U[l]);
    if (l > 0 && g) matrix_multiply(n, g, g, V1, G[l - 1], X), place(n, 0, g, X, r->U[l]);
    if (l == 0) place(n, g, f, F0, r->U[l]);
    if (l == 1) place(n, g, f, F1, r->U[l]);
  }
  for (uint32_t i = 0; i < f; i++) r->decay[g + i] = p->decay[i];
  enlarge(p, r, n);
  if (!matrix_inverse(n, r->U[0], r->C) || !matrix_inverse(n, r->G, r->Gi)) return 0;
  frame_refine(s);
  return 1;
}

/* -- proved */

/* U(-1) or U(1) times diag(G0, I) */
static void end_of(const frame *r, uint32_t n, int at, iv *B) {
  iv U[N_MAX * N_MAX];
  for (uint32_t i = 0; i < n * n; i++) {
    U[i] = (iv) { 0, 0 };
    for (uint32_t l = r->order + 1; l-- > 0;) {
      double x = at < 0 && l % 2 ? -r->U[l][i] : r->U[l][i];
      U[i] = iv_add(U[i], iv_of(x));
    }
  }
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      iv sum = { 0, 0 };
      for (uint32_t l = 0; l < n; l++) sum = iv_fma(sum, U[i * n + l], r->G[l * n + k]);
      B[i * n + k] = sum;
    }
}

/* E from K >= |I - C U(s)|, summed over coefficients */
static int bound_inverse(frame *r, uint32_t n) {
  square K, T;
  memset(K, 0, (size_t)n * n * sizeof *K);
  for (uint32_t l = 0; l <= r->order; l++)
    for (uint32_t i = 0; i < n; i++) {
      double high[N_MAX], low[N_MAX];
      for (uint32_t k = 0; k < n; k++) high[k] = l == 0 && i == k ? -1 : 0, low[k] = -high[k];
      for (uint32_t a = 0; a < n; a++) {
        double x = r->C[i * n + a];
        const double *y = r->U[l] + a * n;
        for (uint32_t k = 0; k < n; k++) high[k] += x * y[k], low[k] += (-x) * y[k];
      }
      for (uint32_t k = 0; k < n; k++) K[i * n + k] += iv_mag((iv) { low[k], high[k] });
    }
  if (!bound_neumann(n, K, r->E)) return 0;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      iv sum = iv_of(i == k);
      for (uint32_t a = 0; a < n; a++) {
        double x = r->Gi[i * n + a], y = r->G[a * n + k];
        sum.high += (-x) * y, sum.low += x * y;
      }
      T[i * n + k] = iv_mag(sum);
    }
  return bound_neumann(n, T, r->EG);
}

int frame_verify(stiff *s) {
  frame *r = &s->frame;
  uint32_t n = s->n;
  square rest;
  if (!bound_inverse(r, n)) return 0;
  end_of(r, n, -1, r->start);
  end_of(r, n, 1, r->end);
  memset(r->size, 0, (size_t)n * n * sizeof *r->size);
  for (uint32_t l = 0; l <= r->order; l++)
    for (uint32_t i = 0; i < n * n; i++) r->size[i] += fabs(r->U[l][i]);
  for (uint32_t i = 0; i < n * n; i++) r->G_size[i] = fabs(r->G[i]), r->Gi_size[i] = fabs(r->Gi[i]);
  bound_multiply(n, n, n, r->size, r->G_size, r->reach);
  bound_multiply(n, n, n, r->EG, r->Gi_size, rest); /* |G^-1| = |(I - K)^-1 Gi| */
  for (uint32_t i = 0; i < n * n; i++) r->Gi_size[i] += rest[i];
  return 1;
}
