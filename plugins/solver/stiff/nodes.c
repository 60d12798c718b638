/* nodes.c -- the tables of Radau collocation (collocation.h), in long double. */
#include "nodes.h"
#include <math.h>

/* P_N - P_(N-1) and its derivative, by the three-term recurrence of Legendre polynomials */
static void radau(uint32_t N, long double t, long double *p, long double *slope) {
  long double p0 = 1, p1 = t, d0 = 0, d1 = 1;
  for (uint32_t k = 2; k <= N; k++) {
    long double p2 = ((2.0L * k - 1) * t * p1 - (k - 1.0L) * p0) / k;
    long double d2 = ((2.0L * k - 1) * (p1 + t * d1) - (k - 1.0L) * d0) / k;
    p0 = p1, p1 = p2, d0 = d1, d1 = d2;
  }
  *p = p1 - p0, *slope = d1 - d0;
}

/* Newton's method with the zeros found so far divided out, from right to left */
static void find_nodes(collocation *q) {
  const long double pi = 3.14159265358979323846264338327950288L;
  uint32_t N = q->N;
  q->node[0] = -1, q->node[N] = 1;
  for (uint32_t i = N - 1; i >= 1; i--) {
    long double t = -cosl(pi * (2 * i - 0.5L) / (2 * N));
    for (int turn = 0; turn < 100; turn++) {
      long double p, slope, sum = 0;
      radau(N, t, &p, &slope);
      for (uint32_t j = i + 1; j <= N; j++) sum += 1 / (t - q->node[j]);
      long double step = p / (slope - p * sum);
      t -= step;
      if (fabsl(step) < 1e-19L) break;
    }
    q->node[i] = t;
  }
}

/* barycentric differentiation [Berrut & Trefethen 2004] */
static void find_derivative(collocation *q) {
  uint32_t N = q->N;
  long double weight[NODES_MAX + 1];
  for (uint32_t i = 0; i <= N; i++) {
    weight[i] = 1;
    for (uint32_t j = 0; j <= N; j++)
      if (j != i) weight[i] /= (q->node[i] - q->node[j]) * 2;
  }
  for (uint32_t i = 1; i <= N; i++) {
    long double sum = 0;
    for (uint32_t j = 0; j <= N; j++) {
      if (j == i) continue;
      q->D[i - 1][j] = weight[j] / weight[i] / (q->node[i] - q->node[j]);
      sum += q->D[i - 1][j];
    }
    q->D[i - 1][i] = -sum;
  }
}

/* V := inverse of W, W_jk = T_(k+1)(node_(j+1)) - (-1)^(k+1), by doubles and then Newton's iteration V + V (I - W V) */
static int find_coefficients(collocation *q) {
  uint32_t N = q->N;
  long double W[NODES_MAX][NODES_MAX], rest[NODES_MAX][NODES_MAX];
  square A = { 0 }, inverse;
  for (uint32_t j = 0; j < N; j++)
    for (uint32_t k = 0; k < N; k++) {
      W[j][k] = cosl((k + 1) * acosl(q->node[j + 1])) - (k % 2 ? 1 : -1);
      A[j * N + k] = (double)W[j][k];
    }
  if (!matrix_inverse(N, A, inverse)) return 0;
  for (uint32_t i = 0; i < N * N; i++) q->V[i / N][i % N] = inverse[i];
  for (int turn = 0; turn < 2; turn++) {
    for (uint32_t i = 0; i < N * N; i++) {
      long double sum = i % (N + 1) == 0;
      for (uint32_t l = 0; l < N; l++) sum -= W[i / N][l] * q->V[l][i % N];
      rest[i / N][i % N] = sum;
    }
    long double next[NODES_MAX][NODES_MAX];
    for (uint32_t i = 0; i < N * N; i++) {
      long double sum = 0;
      for (uint32_t l = 0; l < N; l++) sum += q->V[i / N][l] * rest[l][i % N];
      next[i / N][i % N] = q->V[i / N][i % N] + sum;
    }
    for (uint32_t i = 0; i < N * N; i++) q->V[i / N][i % N] = next[i / N][i % N];
  }
  return 1;
}

int nodes_fill(collocation *q) {
  find_nodes(q);
  find_derivative(q);
  return find_coefficients(q);
}
