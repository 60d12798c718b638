/* improve.c -- a piece's polynomial with a smaller defect; approximate, in round-to-nearest.
**
** With d the defect of P and e = P* - P the error of the polynomial, e' = (eta/2) J e - d; in the frame U, where that
** matrix is nearly 0 for slow and L for fast directions, z = U^-1 e has, with v = U^-1 d, polynomial solutions
**   z_s = -integral of v_s from s = -1,   z_f = sum_q L^-(q+1) v_f^(q),
** and P + U z has a defect that is smaller by what is left of the approximations. In double-double this goes on below
** the rounding of the collocation's long double.
*/
#include "stiff.h"
#include <string.h>

#define DEGREE_MAX NODES_MAX

static inline double row_times(uint32_t n, const double *row, const double *x) {
  double sum = 0;
  for (uint32_t a = 0; a < n; a++) sum += row[a] * x[a];
  return sum;
}

/* v := U^-1 d to degree top: v_k = (C d)_k - sum_l (C U_l) v_(k-l), as C U_0 is about I */
static void through(const stiff *s, uint32_t top, double v[][N_MAX]) {
  const frame *f = &s->frame;
  uint32_t n = s->n, w = (s->q.N + 1) * (s->spread ? s->terms.count : 1);
  square turned[FRAME_ORDER + 1];
  for (uint32_t l = 1; l <= f->order; l++) matrix_multiply(n, n, n, f->C, f->U[l], turned[l]);
  for (uint32_t k = 0; k <= top; k++)
    for (uint32_t i = 0; i < n; i++) {
      double sum = 0;
      for (uint32_t a = 0; a < s->nx; a++) sum += f->C[i * n + a] * s->defect[a * w + k];
      for (uint32_t l = 1; l <= k && l <= f->order; l++) sum -= row_times(n, turned[l] + i * n, v[k - l]);
      v[k][i] = sum;
    }
}

static void solve_slow(uint32_t g, uint32_t top, double d[][N_MAX], double z[][N_MAX]) {
  for (uint32_t k = 0; k < top; k++)
    for (uint32_t i = 0; i < g; i++) {
      z[k + 1][i] -= d[k][i] / (k + 1);
      z[0][i] += (k % 2 ? 1 : -1) * d[k][i] / (k + 1);
    }
}

/* as far as the terms become smaller */
static int solve_fast(const stiff *s, uint32_t top, double d[][N_MAX], double z[][N_MAX]) {
  uint32_t n = s->n, g = s->frame.split.slow, f = n - g;
  square L, inverse, X, Y;
  if (f == 0) return 1;
  frame_apply_slopes(s, 0, n, s->frame.U[0], X);
  matrix_multiply(n, n, n, s->frame.C, X, Y);
  for (uint32_t i = 0; i < f * f; i++) L[i] = Y[(g + i / f) * n + g + i % f];
  if (!matrix_inverse(f, L, inverse)) return 0;
  for (uint32_t k = 0; k <= top; k++) {
    double now[N_MAX], next[N_MAX], factor = 1, before = INFINITY;
    memcpy(now, d[k] + g, f * sizeof *now);
    for (uint32_t q = 0; q <= k; q++) {
      matrix_multiply(f, f, 1, inverse, now, next);
      double size = fabs(factor) * matrix_row_sum_norm(1, f, next);
      if (!(size < before)) break;
      before = size;
      for (uint32_t i = 0; i < f; i++) z[k - q][g + i] += factor * next[i];
      memcpy(now, next, f * sizeof *now);
      factor *= k - q;
    }
  }
  return 1;
}

void improve_piece(stiff *s) {
  uint32_t n = s->n, top = s->q.N;
  double d[DEGREE_MAX + 1][N_MAX], z[DEGREE_MAX + 2][N_MAX] = { { 0 } };
  through(s, top, d);
  solve_slow(s->frame.split.slow, top, d, z);
  if (!solve_fast(s, top, d, z)) return;
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t k = 0; k <= top; k++) {
      double sum = 0;
      for (uint32_t l = 0; l <= k && l <= s->frame.order; l++) sum += row_times(n, s->frame.U[l] + i * n, z[k - l]);
      if (!(fabs(sum) < INFINITY)) continue;
      s->shift[i] += fabs(sum);
      poly_set(&s->P[i], k, dd_add(poly_get(&s->P[i], k), (dd) { sum, 0 }));
    }
  for (uint32_t i = 0; i < s->nx; i++) s->shift[i] *= 1 + 0x1p-40;
}
