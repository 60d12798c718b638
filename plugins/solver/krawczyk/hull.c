/* hull.c -- interval hull of the solutions of A x = -b for an H-matrix [A], nearly (upward mode).
**
** Hansen, Bliek, Rohn, Ning & Kearfott, in Neumaier's form (Reliable Computing 5, 1999): with G = <A>^-1 >= 0,
**   x_i in (-b_i +- beta_i) / (A_ii +- alpha_i),  alpha_i = <A>_ii - 1/G_ii,  beta_i = sum_{j != i} G_ij |b_j| / G_ii,
** which eliminates the other unknowns from row i. G is bounded with an approximate inverse B of <A>: for R = <A> B - I
** and v > 0, w <= <A> v, w > 0 (bound.c), entry by entry
**   B_ij - v_i max_k R_kj^+ / w_k  <=  G_ij  <=  B_ij + v_i max_k (-R_kj)^+ / w_k,
** because <A> times the right-hand side is >= I, <A> times the left-hand side is <= I, and G >= 0.
*/
#include "krawczyk.h"
#include <ambit/matrix.h>
#include <ambit/rounding.h>
#include <math.h>

static double larger(double a, double b) { return a > b ? a : b; }

static double magnitude(double lo, double hi) { return larger(-lo, hi); }

/* <A>_ij with the sign wanted: its values are exact */
static double comparison(const krawczyk *k, uint32_t i, uint32_t j) {
  span d = k->diagonal[i];
  if (i == j) return d.lo > 0 ? d.lo : d.hi < 0 ? -d.hi : 0;
  size_t at = (size_t)i * k->n + j;
  return -magnitude(k->off.lo[at], k->off.hi[at]);
}

/* what is to be added to, and subtracted from, column j of B, per v */
static span correct(const krawczyk *k, uint32_t j) {
  span most = { 0, 0 };
  for (uint32_t i = 0; i < k->n; i++) {
    double above = i == j ? -1 : 0, below = i == j ? 1 : 0; /* R_ij, -R_ij from above */
    for (uint32_t l = 0; l < k->n; l++) {
      double a = comparison(k, i, l), B = k->B[(size_t)l * k->n + j];
      above += a * B;
      below += -a * B;
    }
    most.hi = larger(most.hi, below / k->margin[i]);
    most.lo = larger(most.lo, above / k->margin[i]);
  }
  return most;
}

/* z[i] := beta_i, off-diagonal parts of the sums; scale_lo, scale_hi := bounds of G_ii */
static AMBIT_WORKER void bound_inverse(const krawczyk *k, double *beta, span *diagonal) {
  uint32_t n = k->n;
  for (uint32_t i = 0; i < n; i++) beta[i] = 0;
  for (uint32_t j = 0; j < n; j++) {
    span extra = correct(k, j);
    double b = magnitude(k->b[j].lo, k->b[j].hi);
    for (uint32_t i = 0; i < n; i++) {
      double B = k->B[(size_t)i * n + j], high = B + k->scale[i] * extra.hi, low = -(-B + k->scale[i] * extra.lo);
      if (i == j)
        diagonal[i] = (span) { low, high };
      else
        beta[i] += larger(high, 0) * b;
    }
  }
}

/* row := -b +- beta, f := A_ii +- alpha; 0: G_ii is not known well enough */
static AMBIT_WORKER int set_quotients(const krawczyk *k, const double *beta, const span *diagonal) {
  for (uint32_t i = 0; i < k->n; i++) {
    double least = comparison(k, i, i);
    double low = larger(diagonal[i].lo, -(-1 / least)); /* G_ii >= 1 / <A>_ii */
    if (!(low > 0 && diagonal[i].hi < INFINITY)) return 0;
    double alpha = larger(least + -1 / diagonal[i].hi, 0), part = beta[i] / low;
    k->row[i] = (span) { -(k->b[i].hi + part), -k->b[i].lo + part };
    k->f[i] = (span) { -(-k->diagonal[i].lo + alpha), k->diagonal[i].hi + alpha };
    if (k->f[i].lo <= 0 && k->f[i].hi >= 0) return 0;
  }
  return 1;
}

static int is_finite(const krawczyk *k) {
  for (uint32_t i = 0; i < k->n; i++)
    if (!isfinite(k->f[i].lo) || !isfinite(k->f[i].hi) || !(k->row[i].lo <= k->row[i].hi)) return 0;
  return 1;
}

void krawczyk_hull_solution(krawczyk *k, span *z) {
  krawczyk_bound_solution(k, z);
  for (uint32_t i = 0; i < k->n; i++)
    for (uint32_t j = 0; j < k->n; j++) k->work[(size_t)i * k->n + j] = comparison(k, i, j);
  if (!ambit_matrix_invert(k->n, k->work, k->B)) return;
  ambit_rounding old = ambit_round_up();
  bound_inverse(k, k->best, k->hull);
  int good = set_quotients(k, k->best, k->hull);
  ambit_rounding_restore(old);
  if (!good || !is_finite(k)) return;
  krawczyk_map(k, AMBIT_OP_DIV, k->row, k->row, k->f, k->n);
  box_meet(k->n, z, k->row);
}
