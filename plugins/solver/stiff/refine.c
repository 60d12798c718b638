/* refine.c -- a frame whose directions are nearly those of solutions of the variational equation; approximate.
**
** In the frame U errors obey y' = Y y, Y = U^-1 ((eta/2) J U - U'). Ends' eigenvectors with straight lines between
** leave
** blocks Y_fs, Y_sf between fast and slow directions of the size of how fast eigenvectors turn, and bounds of what they
** exchange lose all cancellation. U (I + S) has Y + Y S - S Y - S' + O(S^2) instead. With L = Y_ff(0) the off-diagonal
** blocks vanish to first order for S' = L S + Y_fs and S' = -S L + Y_sf, whose polynomial solutions are
**   S_fs = -sum_q L^-(q+1) Y_fs^(q),   S_sf = sum_q (-1)^q Y_sf^(q) L^-(q+1)
** (slow manifold theory calls the repetition of this iteration the improvement of Fraser and Roussel); and S_ss is the
** integral of Y_ss from s = -1. Repeated as long as the blocks become smaller.
*/
#include "stiff.h"
#include <string.h>

#define TURNS 2
#define BETTER 0.5
#define ORDERS (FRAME_ORDER + 1)

typedef double series_of_matrices[ORDERS][N_MAX * N_MAX];

void frame_apply_slopes(const stiff *s, uint32_t l, uint32_t cols, const double *X, double *r) {
  uint32_t n = s->n;
  memset(r, 0, (size_t)n * cols * sizeof *r); /* rows of parameters stay zero */
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t k = 0; k < n; k++)
      if (l < s->slopes.count[i * n + k]) {
        double x = s->slopes.coefficient[(size_t)(i * n + k) * (SLOPE_ORDER + 1) + l];
        if (x != 0) matrix_add_scaled(cols, r + (size_t)i * cols, x, X + (size_t)k * cols);
      }
}

/* about C ((eta/2) J U - U'), which differs from Y by a factor near 1 */
static void find_rates(const stiff *s, const frame *r, series_of_matrices Y) {
  uint32_t n = s->n;
  size_t count = (size_t)n * n;
  square sum, X;
  for (uint32_t l = 0; l < ORDERS; l++) {
    memset(sum, 0, count * sizeof *sum);
    if (l < r->order) matrix_add_scaled(count, sum, -(l + 1.0), r->U[l + 1]);
    for (uint32_t a = 0; a <= l && a <= SLOPE_ORDER; a++) {
      if (l - a > r->order) continue;
      frame_apply_slopes(s, a, n, r->U[l - a], X);
      matrix_add_scaled(count, sum, 1, X);
    }
    matrix_multiply(n, n, n, r->C, sum, Y[l]);
  }
}

/* rows [i0, i1), columns [k0, k1) */
static void cut(uint32_t n, const double *Y, uint32_t i0, uint32_t i1, uint32_t k0, uint32_t k1, double *r) {
  for (uint32_t i = i0; i < i1; i++) memcpy(r + (i - i0) * (k1 - k0), Y + i * n + k0, (k1 - k0) * sizeof *r);
}

static void paste(
    uint32_t n, double *Y, uint32_t i0, uint32_t i1, uint32_t k0, uint32_t k1, double x, const double *a) {
  for (uint32_t i = i0; i < i1; i++) matrix_add_scaled(k1 - k0, Y + i * n + k0, x, a + (i - i0) * (k1 - k0));
}

/* how much directions exchange: what is slow over the piece, what is fast over its own decay */
static double exchange(const stiff *s, const frame *r, series_of_matrices Y) {
  uint32_t n = s->n, g = r->split.slow, f = n - g;
  square L, inverse, part;
  double decay = 0, sum = 0;
  if (f) {
    cut(n, Y[0], g, n, g, n, L);
    if (!matrix_inverse(f, L, inverse)) return INFINITY;
    decay = matrix_row_sum_norm(f, f, inverse);
  }
  for (uint32_t l = 0; l < ORDERS; l++) {
    cut(n, Y[l], 0, g, 0, g, part), sum += matrix_row_sum_norm(g, g, part);
    cut(n, Y[l], g, n, 0, g, part), sum += decay * matrix_row_sum_norm(f, g, part);
    cut(n, Y[l], 0, g, g, n, part), sum += decay * matrix_row_sum_norm(g, f, part);
  }
  return sum;
}

/* one of the sums above, added to S, from the block [i0, i1) x [k0, k1) of Y; the fast side is that of rows or not */
static void solve_block(
    uint32_t n, uint32_t g, int fast_rows, const double *inverse, series_of_matrices Y, series_of_matrices S) {
  uint32_t i0 = fast_rows ? g : 0, i1 = fast_rows ? n : g, k0 = fast_rows ? 0 : g, k1 = fast_rows ? g : n;
  uint32_t rows = i1 - i0, cols = k1 - k0, f = n - g;
  square now, next;
  for (uint32_t top = 0; top < ORDERS; top++) { /* of the term s^top and its derivatives */
    double factor = fast_rows ? -1 : 1, size, before = INFINITY;
    cut(n, Y[top], i0, i1, k0, k1, now);
    for (uint32_t q = 0; q <= top; q++) {
      if (fast_rows)
        matrix_multiply(f, f, cols, inverse, now, next);
      else
        matrix_multiply(rows, f, f, now, inverse, next);
      size = fabs(factor) * matrix_row_sum_norm(rows, cols, next);
      if (!(size < before)) break; /* an asymptotic series ends where its terms begin to grow */
      before = size;
      paste(n, S[top - q], i0, i1, k0, k1, factor, next);
      memcpy(now, next, (size_t)rows * cols * sizeof *now);
      factor *= (fast_rows ? 1.0 : -1.0) * (top - q);
    }
  }
}

static void solve_slow(uint32_t n, uint32_t g, series_of_matrices Y, series_of_matrices S) {
  square part, start;
  memset(start, 0, (size_t)g * g * sizeof *start);
  for (uint32_t l = 0; l + 1 < ORDERS; l++) {
    cut(n, Y[l], 0, g, 0, g, part);
    paste(n, S[l + 1], 0, g, 0, g, 1.0 / (l + 1), part);
    matrix_add_scaled((size_t)g * g, start, (l % 2 ? 1 : -1) / (l + 1.0), part);
  }
  paste(n, S[0], 0, g, 0, g, -1, start);
}

/* to := U (I + S) */
static int turn(const stiff *s, const frame *r, series_of_matrices Y, frame *to) {
  uint32_t n = s->n, g = r->split.slow, f = n - g;
  size_t count = (size_t)n * n;
  series_of_matrices S;
  square L, inverse, X;
  for (uint32_t l = 0; l < ORDERS; l++) memset(S[l], 0, count * sizeof(double));
  if (f) {
    cut(n, Y[0], g, n, g, n, L);
    if (!matrix_inverse(f, L, inverse)) return 0;
    solve_block(n, g, 1, inverse, Y, S);
    solve_block(n, g, 0, inverse, Y, S);
  }
  solve_slow(n, g, Y, S);
  to->order = FRAME_ORDER;
  for (uint32_t l = 0; l < ORDERS; l++) {
    memset(to->U[l], 0, count * sizeof(double));
    if (l <= r->order) memcpy(to->U[l], r->U[l], count * sizeof(double));
    for (uint32_t a = 0; a <= l && a <= r->order; a++) {
      matrix_multiply(n, n, n, r->U[a], S[l - a], X);
      matrix_add_scaled(count, to->U[l], 1, X);
    }
  }
  return matrix_inverse(n, to->U[0], to->C);
}

static void take_over(frame *r, const frame *better, uint32_t n) {
  size_t bytes = (size_t)n * n * sizeof(double);
  r->order = better->order;
  for (uint32_t l = 0; l <= better->order; l++) memcpy(r->U[l], better->U[l], bytes);
  memcpy(r->C, better->C, bytes);
}

void frame_refine(stiff *s) {
  frame *r = &s->frame, *next = &s->refined;
  series_of_matrices Y;
  if (r->split.slow == 0) return;
  next->split.slow = r->split.slow;
  find_rates(s, r, Y);
  double now = exchange(s, r, Y);
  for (int i = 0; i < TURNS; i++) {
    if (!turn(s, r, Y, next)) return;
    find_rates(s, next, Y);
    double then = exchange(s, next, Y);
    if (!(then < BETTER * now)) return;
    take_over(r, next, s->n);
    now = then;
  }
}
