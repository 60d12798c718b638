/* metzler.c -- the exponential of a Metzler matrix from above (metzler.h).
**
** exp of [[M, d], [0, 0]] length. With c >= -M_ii the matrix P = (M + c I) length / 2^k is nonnegative, all terms of
** its
** series are, and rounding up gives upper bounds; exp(M length) = (e^(-c length / 2^k) exp P)^(2^k). The terms beyond
** order K are at most R (P + P^2/2! + ...), R = P^K / K!, since (K + j)! >= K! j!; so X with R S + R X <= X bounds
** them.
** The squarings start with a row of the constant 1, scaled by sigma to keep P small.
*/
#include "metzler.h"
#include <string.h>

#define TERMS 18
#define HALVINGS_MAX 1000

double exp_above(const ambit_num_service *num, double x) {
  double a[2] = { x, x }, r[2];
  num->map(AMBIT_OP_EXP, 1, r, a, NULL, 0);
  return r[1];
}

/* S >= exp P [q x q], row sums of P at most 1/2 */
static int exponential(size_t q, const double *P, double *S) {
  square R, next, X;
  for (size_t i = 0; i < q * q; i++) S[i] = R[i] = i % (q + 1) == 0;
  for (int t = 1; t <= TERMS; t++) {
    bound_multiply(q, q, q, R, P, next);
    for (size_t i = 0; i < q * q; i++) R[i] = next[i] / t, S[i] += R[i];
  }
  bound_multiply(q, q, q, R, S, X);
  for (size_t i = 0; i < q * q; i++) X[i] *= 2;
  bound_multiply(q, q, q, R, X, next);
  for (size_t i = 0; i < q * q; i++)
    if (!(next[i] + 0.5 * X[i] <= X[i])) return 0; /* X / 2 is R S rounded up, exactly halved unless it underflows */
  for (size_t i = 0; i < q * q; i++) S[i] += X[i];
  return 1;
}

int metzler_exponential(const ambit_num_service *num, size_t n, const double *M, const double *d, double length,
    const double *first, double *last) {
  size_t q = n + 1;
  double shift = 0, sigma = 0, norm = 0, scale = length;
  int halvings = 0;
  square P, S, next;
  for (size_t i = 0; i < n; i++) shift = larger(shift, -M[i * n + i]), sigma = larger(sigma, d[i]);
  if (!(sigma > 0)) sigma = 1;
  memset(P, 0, q * q * sizeof *P);
  for (size_t i = 0; i < n; i++) {
    memcpy(P + i * q, M + i * n, n * sizeof *M);
    P[i * q + n] = d[i] / sigma;
  }
  for (size_t i = 0; i < q; i++) {
    P[i * q + i] += shift;
    double sum = 0;
    for (size_t j = 0; j < q; j++) sum += P[i * q + j];
    norm = larger(norm, sum);
  }
  if (!(norm < INFINITY)) return 0;
  for (; norm * scale > 0.5 || shift * scale > 0.5; scale *= 0.5)
    if (++halvings > HALVINGS_MAX) return 0;
  for (size_t i = 0; i < q * q; i++) P[i] *= scale;
  if (!exponential(q, P, S)) return 0;
  double decay = exp_above(num, -shift * scale); /* unary minus is exact: the product is -(shift scale), rounded up */
  for (size_t i = 0; i < q * q; i++) S[i] *= decay;
  for (int k = 0; k < halvings; k++) {
    bound_multiply(q, q, q, S, S, next);
    memcpy(S, next, q * q * sizeof *S);
  }
  for (size_t i = 0; i < n; i++) {
    last[i] = S[i * q + n] * sigma;
    for (size_t j = 0; j < n; j++) last[i] += S[i * q + j] * first[j];
    if (!(last[i] < INFINITY)) return 0;
  }
  return 1;
}
