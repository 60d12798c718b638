/* splitting.c -- fast and slow directions (splitting.h).
**
** The f most negative eigenvalues are fast. f is feasible if it cuts no complex pair, both ends' projectors are well
** conditioned, the frame changes by less than half over the piece, and the rate reduced to the slow space is at most
** REACH over it. The smallest feasible f is taken: what is moved along exactly exchanges nothing, while a direction
** that
** is called fast although it hardly decays exchanges its errors with the slow ones, bounded without signs.
*/
#include "splitting.h"
#include <math.h>
#include <string.h>

#define PROJECTOR_CONDITION 1e5
#define CARRIED_CONDITION 1e3 /* of slow columns beside fast ones, before they are chosen anew */
#define CARRIED_CONDITION_ALONE 100
#define EIGENVECTORS_CONDITION 50
#define FAST_CONDITION 1e3 /* beyond it the fast directions become Schur vectors */
#define FLAT 0.01
#define SLOW_TURN 0.25 /* of its decay: a pair that turns more slowly is two directions, a double root among them */
#define CHANGE 0.5
#define REACH 2.5

typedef struct attempt {
  const ends *e;
  const carried *b;
  split *r;
  square P0, P1; /* projectors on the slow space along the fast one */
  square S0;     /* slow eigenvectors at s = -1, orthonormal */
} attempt;

static void take_columns(size_t n, const double *A, size_t from, size_t count, double *r) {
  for (size_t i = 0; i < n; i++) memcpy(r + i * count, A + i * n + from, count * sizeof *A);
}

/* P := slow columns times slow rows of the inverse of [slow fast]; slow [n x g] and fast [n x f] orthonormal */
static int project(const ends *e, const spectrum *at, uint32_t f, double *P, double *slow) {
  uint32_t n = e->n, g = n - f;
  square fast, A, inverse;
  take_columns(n, at->V, 0, f, fast);
  take_columns(n, at->V, f, g, slow);
  if (!orthonormalise(n, f, fast, e->scale, NULL) || !orthonormalise(n, g, slow, e->scale, NULL)) return 0;
  join_columns(n, g, slow, f, fast, A);
  if (!(scaled_condition(n, A, e->scale) <= PROJECTOR_CONDITION) || !matrix_inverse(n, A, inverse)) return 0;
  matrix_multiply(n, g, n, slow, inverse, P); /* the first g rows of the inverse */
  return 1;
}

static int allowed(const ends *e, uint32_t f) {
  if (f == 0) return 1;
  if (!e->from->ok || !e->to->ok) return 0;
  if (f < e->n && (e->from->kind[f] == SECOND || e->to->kind[f] == SECOND)) return 0;
  return e->from->real[f - 1] < 0 && e->to->real[f - 1] < 0;
}

static int find_projectors(attempt *a, uint32_t f) {
  uint32_t n = a->e->n;
  square unused;
  if (f == n) { /* whatever its eigenvectors are */
    memset(a->P0, 0, (size_t)n * n * sizeof(double)), memset(a->P1, 0, (size_t)n * n * sizeof(double));
    return 1;
  }
  if (f > 0) return project(a->e, a->e->from, f, a->P0, a->S0) && project(a->e, a->e->to, f, a->P1, unused);
  for (uint32_t i = 0; i < n * n; i++) {
    a->P0[i] = a->P1[i] = i % (n + 1) == 0;
    a->S0[i] = i % (n + 1) == 0 ? a->e->scale[i / n] : 0;
  }
  return 1;
}

/* Columns of P0 B that move a parameter keep to themselves, so that a parameter stays one number with one bound; they
** come first. Their count. */
static uint32_t keep_parameters(const attempt *a, uint32_t g, const double *A, uint32_t *used, double *W) {
  const ends *e = a->e;
  uint32_t n = e->n, count = 0;
  for (uint32_t k = 0; k < n && count < g; k++) {
    int moves = 0;
    for (uint32_t i = e->states; i < n; i++) moves |= a->b->B[i * n + k] != 0;
    if (!moves) continue;
    for (uint32_t i = 0; i < n; i++) W[i * g + count] = A[i * n + k];
    used[k] = 1;
    count++;
  }
  return count;
}

/* columns of P0 B, by size times width, orthonormal: Lohner's choice */
static int choose_by_width(const attempt *a, uint32_t g, double *W) {
  const ends *e = a->e;
  uint32_t n = e->n, used[N_MAX] = { 0 };
  square A;
  matrix_multiply(n, n, n, a->P0, a->b->B, A);
  for (uint32_t r = keep_parameters(a, g, A, used, W); r < g; r++) {
    double most = -1, length = 0;
    uint32_t best = n;
    for (uint32_t k = 0; k < n; k++) {
      double sum = 0;
      for (uint32_t i = 0; i < n; i++) sum += (A[i * n + k] / e->scale[i]) * (A[i * n + k] / e->scale[i]);
      double weight = sqrt(sum) * (a->b->w[a->b->block[k]] + 1e-300);
      if (!used[k] && sum > 1e-24 && weight > most) most = weight, best = k, length = sqrt(sum);
    }
    if (best == n) return 0;
    used[best] = 1;
    for (uint32_t i = 0; i < n; i++) W[i * g + r] = A[i * n + best] / length;
    for (uint32_t k = 0; k < n; k++) {
      double share = 0;
      for (uint32_t i = 0; i < n; i++) share += W[i * g + r] * A[i * n + k] / (e->scale[i] * e->scale[i]);
      for (uint32_t i = 0; i < n; i++) A[i * n + k] -= share * W[i * g + r];
    }
  }
  square Q;
  memcpy(Q, W, (size_t)n * g * sizeof *W);
  matrix_multiply(n, n, g, a->P0, Q, W);
  return 1;
}

static double condition_beside(const ends *e, uint32_t g, const double *W, uint32_t f, const double *fast) {
  square A, F;
  memcpy(F, fast, (size_t)e->n * f * sizeof *F);
  if (!orthonormalise(e->n, f, F, e->scale, NULL)) return INFINITY;
  join_columns(e->n, g, W, f, F, A);
  return scaled_condition(e->n, A, e->scale);
}

static int all_real(const spectrum *at, uint32_t from, uint32_t to) {
  for (uint32_t k = from; k < to; k++)
    if (at->kind[k] != SINGLE) return 0;
  return 1;
}

/* W [n x g]: the carried columns, as long as they stay independent, else chosen anew */
static int choose_slow(const attempt *a, uint32_t f, double *W) {
  const ends *e = a->e;
  uint32_t n = e->n, g = n - f;
  square carried_slow, eigen;
  if (!a->b->valid) {
    memcpy(W, a->S0, (size_t)n * g * sizeof *W);
    return 1;
  }
  if (f == a->b->fast) {
    take_columns(n, a->b->B, 0, g, carried_slow);
    matrix_multiply(n, n, g, a->P0, carried_slow, W);
    double limit = f ? CARRIED_CONDITION : CARRIED_CONDITION_ALONE;
    if (condition_beside(e, g, W, f, a->r->fast0) <= limit) return 1;
  }
  if (!choose_by_width(a, g, W)) return 0;
  if (f == 0 || g == 1 || e->states < n || !all_real(e->from, f, n)) return 1;
  take_columns(n, e->from->V, f, g, eigen);
  if (condition_beside(e, g, eigen, f, a->r->fast0) < EIGENVECTORS_CONDITION)
    memcpy(W, eigen, (size_t)n * g * sizeof *W);
  return 1;
}

/* Where eigenvectors are nearly parallel: Schur vectors of the fast space, orthonormal. Each acts on those before it
** only, so all are blocks of their own but for pairs, whose second columns are stretched until the pair turns without
** growing. Between blocks errors pass one way, as in the equations, and are gone in the end. */
static int choose_schur(attempt *a, uint32_t f) {
  const ends *e = a->e;
  split *r = a->r;
  uint32_t n = e->n, g = n - f;
  square JF, reduced, Z, T, F;
  int second[N_MAX];
  for (uint32_t i = 0; f == n && i < n * n; i++) r->fast0[i] = i % (n + 1) == 0 ? e->scale[i / n] : 0;
  if (!orthonormalise(n, f, r->fast0, e->scale, NULL)) return 0;
  matrix_multiply(n, n, f, e->rate_from, r->fast0, JF);
  for (uint32_t i = 0; i < f; i++)
    for (uint32_t k = 0; k < f; k++) {
      double sum = 0;
      for (uint32_t j = 0; j < n; j++) sum += r->fast0[j * f + i] / e->scale[j] * (JF[j * f + k] / e->scale[j]);
      reduced[i * f + k] = sum;
    }
  if (!eigen_schur(f, reduced, Z, T, second)) return 0;
  r->blocks = g;
  for (uint32_t k = 0; k < f; k++) {
    double above = k ? T[(k - 1) * f + k] : 0, below = k ? T[k * f + k - 1] : 0, turn = sqrt(fabs(above * below));
    int pair = second[k] && above * below < 0 && turn > SLOW_TURN * fabs(T[k * f + k]);
    double stretch = pair ? sqrt(fabs(below / above)) : 1;
    r->block[g + k] = pair ? r->blocks - 1 : r->blocks++;
    r->decay[k] = fabs(T[k * f + k]);
    for (uint32_t j = 0; j < f; j++) Z[j * f + k] *= stretch;
  }
  matrix_multiply(n, f, f, r->fast0, Z, F);
  memcpy(r->fast0, F, (size_t)n * f * sizeof *F);
  return 1;
}

/* a pair one part of which is next to nothing: nearly a double root, whose eigenvectors are parallel */
static int is_flat(const ends *e, uint32_t f) {
  uint32_t n = e->n;
  for (uint32_t k = 1; k < f; k++) {
    double first = 0, second = 0;
    if (e->from->kind[k] != SECOND) continue;
    for (uint32_t i = 0; i < n; i++) {
      first = fmax(first, fabs(e->from->V[i * n + k - 1]) / e->scale[i]);
      second = fmax(second, fabs(e->from->V[i * n + k]) / e->scale[i]);
    }
    if (fmin(first, second) < FLAT * fmax(first, second)) return 1;
  }
  return 0;
}

/* fast0, fast1 and the blocks */
static void choose_fast(attempt *a, uint32_t f) {
  const ends *e = a->e;
  split *r = a->r;
  uint32_t n = e->n, g = n - f;
  square A, rest;
  r->blocks = g;
  for (uint32_t k = 0; k < g; k++) r->block[k] = k;
  for (uint32_t k = 0; k < f; k++) {
    r->block[g + k] = e->from->kind[k] == SECOND ? r->blocks - 1 : r->blocks++;
    r->decay[k] = fabs(e->from->real[k]);
  }
  take_columns(n, e->from->V, 0, f, r->fast0);
  join_columns(n, g, a->S0, f, r->fast0, A);
  if (!(scaled_condition(n, A, e->scale) <= FAST_CONDITION) || is_flat(e, f)) choose_schur(a, f);
  for (uint32_t i = 0; i < n * n; i++) rest[i] = (i % (n + 1) == 0) - a->P1[i];
  matrix_multiply(n, n, f, rest, r->fast0, r->fast1);
}

/* norm of (start)^-1 (end) - I */
static double change(const ends *e, const split *r) {
  uint32_t n = e->n;
  square A0, A1, inverse, Q;
  join_columns(n, r->slow, r->slow0, r->fast, r->fast0, A0);
  join_columns(n, r->slow, r->slow1, r->fast, r->fast1, A1);
  if (!matrix_inverse(n, A0, inverse)) return INFINITY;
  matrix_multiply(n, n, n, inverse, A1, Q);
  for (uint32_t i = 0; i < n; i++) Q[i * n + i] -= 1;
  return matrix_row_sum_norm(n, n, Q);
}

/* norm of the mean rate over the piece in an orthonormal basis of the slow space */
static double slow_rate(const ends *e, const split *r) {
  uint32_t n = e->n, g = r->slow;
  square slow, fast, A, inverse, J, JA, reduced;
  if (g == 0) return 0;
  for (uint32_t i = 0; i < n * g; i++) slow[i] = 0.5 * (r->slow0[i] + r->slow1[i]);
  for (uint32_t i = 0; i < n * r->fast; i++) fast[i] = 0.5 * (r->fast0[i] + r->fast1[i]);
  if (r->fast == 0)
    for (uint32_t i = 0; i < n * n; i++) slow[i] = i % (n + 1) == 0 ? e->scale[i / n] : 0;
  else if (!orthonormalise(n, g, slow, e->scale, NULL))
    return INFINITY;
  join_columns(n, g, slow, r->fast, fast, A);
  if (!matrix_inverse(n, A, inverse)) return INFINITY;
  for (uint32_t i = 0; i < n * n; i++) J[i] = e->rate_from[i] + e->rate_to[i]; /* over s in [-1, 1]: twice the mean */
  matrix_multiply(n, n, n, J, A, JA);
  matrix_multiply(n, n, n, inverse, JA, J);
  for (uint32_t i = 0; i < g; i++) memcpy(reduced + i * g, J + i * n, g * sizeof *J);
  return matrix_row_sum_norm(g, g, reduced);
}

static int try_split(attempt *a, uint32_t f, double reach) {
  const ends *e = a->e;
  split *r = a->r;
  uint32_t n = e->n, g = n - f;
  square W;
  if (!allowed(e, f) || !find_projectors(a, f)) return 0;
  r->fast = f, r->slow = g;
  choose_fast(a, f);
  if (!choose_slow(a, f, W)) return 0;
  memcpy(r->slow0, W, (size_t)n * g * sizeof *W);
  if (!orthonormalise(n, g, r->slow0, e->scale, r->G0)) return 0;
  matrix_multiply(n, n, g, a->P1, r->slow0, r->slow1);
  return change(e, r) < CHANGE && slow_rate(e, r) <= reach;
}

int split_choose(const ends *e, const carried *b, split *r) {
  attempt a = { .e = e, .b = b, .r = r };
  for (int generous = 0; generous < 2; generous++)
    for (uint32_t f = 0; f <= e->n; f++)
      if (try_split(&a, f, generous ? 2 * REACH : REACH)) return 1;
  return 0;
}
