/* collocation.c -- Newton's method for the Radau system (collocation.h).
**
** The residual is computed in long double, so that the solution is good to its precision although corrections are not.
** The first guess is that of a linearly implicit Euler method from node to node. The matrix is factored again as long
** as corrections do not shrink fast.
*/
#include "collocation.h"
#include <ambit/matrix.h>
#include <float.h>
#include <string.h>

#define ITERATIONS 25
#define ACCURATE 1e-12L      /* of a correction, relative: beyond it Newton's method has failed */
#define SHARE 0.1            /* of a state's size that counts as moving */
#define SHARE_OF_FRAMES 1e-3 /* the same for frames */
#define SHARE_AHEAD 1e-10    /* of what a state will be, below which it counts as nothing */
#define TINY 1e-100
#define LOOKS 400
#define SHRINKS 0.03 /* a factor is kept while each correction is this much smaller than the last */

int collocation_open(const ambit_host *h, collocation *q) {
  size_t n = q->nx, m = n + q->np, N = q->N;
  q->x = h->alloc(h, m * sizeof *q->x);
  q->Z = h->alloc(h, N * n * sizeof *q->Z);
  q->c = h->alloc(h, (N + 1) * n * sizeof *q->c);
  q->size = h->alloc(h, m * sizeof *q->size);
  q->least = h->alloc(h, n * sizeof *q->least);
  q->lost = h->alloc(h, n * sizeof *q->lost);
  q->unit = h->alloc(h, n * sizeof *q->unit);
  q->scale = h->alloc(h, m * sizeof *q->scale);
  q->A = h->alloc(h, N * n * N * n * sizeof *q->A);
  q->residual = h->alloc(h, N * n * sizeof *q->residual);
  q->J = h->alloc(h, N * n * n * sizeof *q->J);
  q->f = h->alloc(h, n * sizeof *q->f);
  q->row = h->alloc(h, N * n * sizeof *q->row);
  for (size_t a = 0; q->least && a < n; a++) q->least[a] = TINY;
  return q->x && q->Z && q->c && q->size && q->least && q->lost && q->unit && q->scale && q->A && q->residual && q->J &&
         q->f && q->row;
}

static void put(const collocation *q, real *r, const long double *y, long double t) {
  memcpy(real_input(r, 0), y, q->nx * sizeof *y);
  memcpy(real_input(r, q->nx), q->x + q->nx, q->np * sizeof *y);
  if (q->uses_time) *real_input(r, q->nx + q->np) = t;
  real_run(r);
}

static void rate(collocation *q, const long double *y, long double t) {
  put(q, q->rhs, y, t);
  for (uint32_t i = 0; i < q->nx; i++) q->f[i] = real_output(q->rhs, i);
}

static void slope(collocation *q, const long double *y, long double t, double *J) {
  put(q, q->jacobian, y, t);
  for (uint32_t i = 0; i < q->nx * q->nx; i++) J[i] = (double)real_output(q->jacobian, i);
}

/* (I - dt J) step = dt f from node to node */
static int predict(collocation *q, double t, double half) {
  uint32_t n = q->nx, row[N_MAX];
  long double y[N_MAX];
  square A;
  double b[N_MAX];
  memcpy(y, q->x, n * sizeof *y);
  for (uint32_t i = 0; i < q->N; i++) {
    double dt = half * (double)(q->node[i + 1] - q->node[i]);
    long double at = t + half * (q->node[i + 1] + 1);
    rate(q, y, at);
    slope(q, y, at, q->J);
    for (uint32_t k = 0; k < n * n; k++) A[k] = (k % (n + 1) == 0) - dt * q->J[k];
    for (uint32_t k = 0; k < n; k++) b[k] = dt * (double)q->f[k];
    if (!ambit_matrix_factor(n, A, row)) return 0;
    ambit_matrix_solve(n, A, row, 1, b);
    for (uint32_t k = 0; k < n; k++) {
      y[k] += b[k];
      q->Z[i * n + k] = y[k] - q->x[k];
    }
  }
  return 1;
}

static int measure(collocation *q) {
  for (uint32_t a = 0; a < q->nx; a++) {
    long double most = fabsl(q->x[a]), moved = 0;
    for (uint32_t i = 0; i < q->N; i++) {
      moved = fmaxl(moved, fabsl(q->Z[i * q->nx + a]));
      most = fmaxl(most, fabsl(q->x[a] + q->Z[i * q->nx + a]));
    }
    if (!(most < 1e100L)) return 0;
    q->size[a] = fmax((double)most, fmax(q->least[a], q->lost[a]));
    q->unit[a] = (double)moved + SHARE * q->size[a];
    q->scale[a] = (double)moved + SHARE_OF_FRAMES * q->size[a];
  }
  return 1;
}

/* residual half f - D Z, in units, and the Jacobians at the nodes */
static void judge(collocation *q, double t, double half, int with_slopes) {
  uint32_t n = q->nx, N = q->N;
  long double y[N_MAX];
  for (uint32_t i = 0; i < N; i++) {
    long double at = t + half * (q->node[i + 1] + 1);
    for (uint32_t a = 0; a < n; a++) y[a] = q->x[a] + q->Z[i * n + a];
    rate(q, y, at);
    if (with_slopes) slope(q, y, at, q->J + (size_t)i * n * n);
    for (uint32_t a = 0; a < n; a++) {
      long double sum = half * q->f[a];
      for (uint32_t j = 0; j < N; j++) sum -= q->D[i][j + 1] * q->Z[j * n + a];
      q->residual[i * n + a] = (double)(sum / q->unit[a]);
    }
  }
}

static int factor(collocation *q, double half) {
  uint32_t n = q->nx, N = q->N;
  size_t m = (size_t)n * N;
  memset(q->A, 0, m * m * sizeof *q->A);
  for (uint32_t i = 0; i < N; i++)
    for (uint32_t a = 0; a < n; a++) {
      double *line = q->A + (i * n + a) * m;
      for (uint32_t j = 0; j < N; j++) line[j * n + a] += (double)q->D[i][j + 1];
      for (uint32_t b = 0; b < n; b++)
        line[i * n + b] -= half * q->J[((size_t)i * n + a) * n + b] * (q->unit[b] / q->unit[a]);
    }
  return ambit_matrix_factor(m, q->A, q->row);
}

/* the largest correction, relative */
static double correct(collocation *q) {
  uint32_t n = q->nx, N = q->N;
  double most = 0;
  ambit_matrix_solve((size_t)n * N, q->A, q->row, 1, q->residual);
  for (uint32_t i = 0; i < N; i++)
    for (uint32_t a = 0; a < n; a++) {
      double step = q->residual[i * n + a];
      q->Z[i * n + a] += (long double)step * q->unit[a];
      if (!(fabs(step) <= most)) most = fabs(step);
    }
  return most;
}

static void to_chebyshev(collocation *q) {
  uint32_t n = q->nx, N = q->N;
  q->error = 0;
  for (uint32_t a = 0; a < n; a++) {
    for (uint32_t k = 0; k < N; k++) {
      long double sum = 0;
      for (uint32_t j = 0; j < N; j++) sum += q->V[k][j] * q->Z[j * n + a];
      q->c[(k + 1) * n + a] = sum;
    }
    double last = (double)fabsl(q->c[N * n + a]), before = (double)fabsl(q->c[(N - 1) * n + a]);
    q->error = fmax(q->error, fmax(last, 0.3 * before) / q->unit[a]);
  }
}

/* What the equations are rounded by at the start of a step moves states by |(I - h J)^-1| h times as much. Where terms
** cancel (1 - cos t near 0; the speed of an overdamped mass that turns) that is more than the tolerance of a state's
** size, and no step would be good enough. */
static void find_lost(collocation *q, double t, double h) {
  uint32_t n = q->nx;
  square A, inverse;
  rate(q, q->x, t);
  real_terms(q->rhs);
  slope(q, q->x, t, q->J);
  for (uint32_t k = 0; k < n * n; k++) A[k] = (k % (n + 1) == 0) - h * q->J[k];
  memset(q->lost, 0, n * sizeof *q->lost);
  if (!matrix_inverse(n, A, inverse)) return;
  for (uint32_t a = 0; a < n; a++) {
    double sum = 0;
    for (uint32_t b = 0; b < n; b++)
      sum += fabs(inverse[a * n + b]) * fabs(h) * real_term(q->rhs, b) * (double)LDBL_EPSILON;
    q->lost[a] = sum < 1e100 ? sum / (SHARE * q->tolerance) : 0;
  }
}

int collocation_solve(collocation *q, double t, double h) {
  double half = 0.5 * h, last = INFINITY;
  int fresh = 1;
  find_lost(q, t, h);
  if (!predict(q, t, half)) return 0;
  for (int i = 0; i < ITERATIONS; i++) {
    if (!measure(q)) return 0;
    judge(q, t, half, fresh);
    if (fresh && !factor(q, half)) return 0;
    double now = correct(q);
    if (!(now < 1e6)) return 0;
    int done = now < 1e-18 || (now < 1e-15 && now > 0.1 * last) || (i > 8 && now < 1e-12 && now > 0.5 * last);
    fresh = now > SHRINKS * last;
    last = now;
    if (done) break;
  }
  if (!(last <= ACCURATE)) return 0;
  to_chebyshev(q);
  return 1;
}

void collocation_look_ahead(collocation *q, double t, double h, double last) {
  uint32_t n = q->nx;
  long double start[N_MAX];
  double most[N_MAX] = { 0 };
  memcpy(start, q->x, n * sizeof *start);
  for (int i = 0; i < LOOKS && (last - t) / h > 0; i++, h *= 2) {
    if (fabs(h) > fabs(last - t)) h = last - t;
    if (!predict(q, t, 0.5 * h) || !measure(q)) break;
    for (uint32_t a = 0; a < n; a++) {
      most[a] = fmax(most[a], q->size[a]);
      q->x[a] += q->Z[(q->N - 1) * n + a];
    }
    t += h;
  }
  memcpy(q->x, start, n * sizeof *start);
  for (uint32_t a = 0; a < n; a++) q->least[a] = fmax(TINY, SHARE_AHEAD * most[a]);
  collocation_outgrow(q);
}

void collocation_outgrow(collocation *q) {
  for (uint32_t a = 0; a < q->nx; a++)
    if (fabsl(q->x[a]) >= q->least[a]) q->least[a] = TINY;
}

int collocation_linearise(collocation *q, double t, double h) {
  if (!measure(q)) return 0;
  judge(q, t, 0.5 * h, 1);
  return factor(q, 0.5 * h);
}

void collocation_value(const collocation *q, long double tau, long double *y) {
  for (uint32_t a = 0; a < q->nx; a++) {
    long double before = 1, now = tau, sum = q->x[a], sign = -1;
    for (uint32_t k = 1; k <= q->N; k++, sign = -sign) {
      sum += q->c[k * q->nx + a] * (now - sign);
      long double next = 2 * tau * now - before;
      before = now, now = next;
    }
    y[a] = sum;
  }
}
