/* metzler_stiff.c -- stiff Metzler systems: fast components follow the others (metzler.h).
**
** Squaring an exponential of norm 1e14 would lose all digits. Components i with -M_ii length >= FAST are fast. With
** mu = -M_ii and b_i >= d_i + sum_j M_ij u_j over the whole interval, u_i(t) <= e^(-mu t) first_i + b_i / mu. In the
** system of the others they act as a constant, in d, and as A e^(-mu t), A = M_(.i) first_i, for which the solution
** is q(t) - rho e^(-mu t) with (mu + M) rho = A, q' = M q + d, q(0) = first + rho; |rho| <= (1 + K + K^2 + ...) A / mu,
** K = |M| / mu. (Proof: docs/numerics/stiff.md.)
*/
#include "metzler.h"
#include <string.h>

#define FAST 40.0

typedef struct parts {
  size_t n, slow, fast, at_slow[N_MAX], at_fast[N_MAX];
} parts;

static parts divide(const metzler *m) {
  parts p = { .n = m->n };
  for (size_t i = 0; i < m->n; i++)
    if (-m->M[i * m->n + i] * m->length >= FAST)
      p.at_fast[p.fast++] = i;
    else
      p.at_slow[p.slow++] = i;
  return p;
}

/* b_i / mu_i of each fast component, from what all are at most */
static void follow(const metzler *m, const parts *p, double *level) {
  for (size_t f = 0; f < p->fast; f++) {
    size_t i = p->at_fast[f];
    double sum = m->d[i];
    for (size_t j = 0; j < m->n; j++)
      if (j != i) sum += m->M[i * m->n + j] * m->most[j];
    level[f] = sum / -m->M[i * m->n + i];
  }
}

/* rho [slow] of fast component f */
static int transient(const metzler *m, const parts *p, size_t f, double *rho) {
  size_t i = p->at_fast[f], g = p->slow;
  double mu = -m->M[i * m->n + i];
  square K, X;
  K[0] = 0; /* there may be no slow ones */
  for (size_t a = 0; a < g * g; a++) K[a] = fabs(m->M[p->at_slow[a / g] * m->n + p->at_slow[a % g]]) / mu;
  if (!bound_neumann(g, K, X)) return 0;
  double A[N_MAX];
  for (size_t a = 0; a < g; a++) A[a] = m->M[p->at_slow[a] * m->n + i] * m->first[i] / mu;
  for (size_t a = 0; a < g; a++) {
    rho[a] = A[a];
    for (size_t b = 0; b < g; b++) rho[a] += X[a * g + b] * A[b];
  }
  return 1;
}

/* the slow ones with d, first and the transients' sum; growing: diagonals at least zero, so that the end is the most */
static int solve_slow(
    const metzler *m, const parts *p, const double *level, const double *begin, int growing, double *end) {
  size_t g = p->slow;
  square M;
  double d[N_MAX] = { 0 };
  for (size_t a = 0; a < g; a++) {
    size_t i = p->at_slow[a];
    d[a] = m->d[i];
    for (size_t f = 0; f < p->fast; f++) d[a] += m->M[i * m->n + p->at_fast[f]] * level[f];
    for (size_t b = 0; b < g; b++) M[a * g + b] = m->M[i * m->n + p->at_slow[b]];
    if (growing) M[a * g + a] = larger(M[a * g + a], 0);
  }
  return metzler_exponential(m->num, g, M, d, m->length, begin, end);
}

static int propagate_parts(const metzler *m, double *last) {
  parts p = divide(m);
  double level[N_MAX], begin[N_MAX] = { 0 }, end[N_MAX] = { 0 }, rho[N_MAX], left[N_MAX] = { 0 };
  for (size_t a = 0; a < p.slow; a++) begin[a] = m->first[p.at_slow[a]];
  for (size_t f = 0; f < p.fast; f++) {
    size_t i = p.at_fast[f];
    if (!transient(m, &p, f, rho)) return 0;
    double decay = exp_above(m->num, m->M[i * m->n + i] * m->length); /* rounded up */
    for (size_t a = 0; a < p.slow; a++) begin[a] += rho[a], left[a] += rho[a] * decay;
    last[i] = m->first[i] * decay;
  }
  follow(m, &p, level);
  if (p.fast) { /* once more with less */
    if (!solve_slow(m, &p, level, begin, 1, end)) return 0;
    for (size_t a = 0; a < p.slow; a++) {
      size_t i = p.at_slow[a];
      m->most[i] = smaller(m->most[i], end[a] + (begin[a] - m->first[i]));
    }
    for (size_t f = 0; f < p.fast; f++) {
      size_t i = p.at_fast[f];
      m->most[i] = smaller(m->most[i], m->first[i] + level[f]);
    }
    follow(m, &p, level);
  }
  if (!solve_slow(m, &p, level, begin, 0, end)) return 0;
  for (size_t a = 0; a < p.slow; a++) last[p.at_slow[a]] = end[a] + left[a];
  for (size_t f = 0; f < p.fast; f++) last[p.at_fast[f]] += level[f];
  return 1;
}

int metzler_propagate(const metzler *m, double *last) {
  return propagate_parts(m, last) || metzler_exponential(m->num, m->n, m->M, m->d, m->length, m->first, last);
}
