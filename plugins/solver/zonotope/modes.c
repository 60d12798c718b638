/* modes.c -- directions in which movements stay apart: eigenvectors of the Jacobian, and how they depend on the data.
**
** No proof depends on anything here: discs.c bounds what any V, W and T leave.
*/
#include "modes.h"
#include "proof.h"
#include "shared/real_schur.h"

#define TURN 0.03 /* most that a datum may turn a mode by, */
#define TURNS 0.3 /* and all data together */

static int numbers_of(const ambit_host *h, size_t n, number **x) {
  return (*x = h->alloc(h, (n ? n : 1) * sizeof **x)) != NULL;
}
static int doubles_of(const ambit_host *h, size_t n, double **x) {
  return (*x = h->alloc(h, (n ? n : 1) * sizeof **x)) != NULL;
}
static int open_discs(const zono *z, discs *d) {
  const ambit_host *h = z->host;
  size_t nx = z->nx, square = nx * nx, mixed = z->shape.m * square;
  return numbers_of(h, square, &d->V) && numbers_of(h, square, &d->W) && numbers_of(h, mixed, &d->U) &&
         numbers_of(h, mixed, &d->T) && doubles_of(h, square, &d->S) && doubles_of(h, square, &d->tilt) &&
         doubles_of(h, nx, &d->b) && doubles_of(h, nx, &d->a);
}

int modes_open(zono *z) {
  const ambit_host *h = z->host;
  modes *m = z->modes = h->alloc(h, sizeof *m);
  size_t nx = z->nx, square = nx * nx;
  if (!m) return 0;
  modes_start(z);
  return open_discs(z, &m->now) && open_discs(z, &m->old) && doubles_of(h, nx, &m->in) && doubles_of(h, nx, &m->box) &&
         numbers_of(h, square, &m->A) && numbers_of(h, square, &m->B) && numbers_of(h, square, &m->C) &&
         numbers_of(h, z->shape.m * square, &m->D) && numbers_of(h, z->shape.m * square, &m->G) &&
         doubles_of(h, square, &m->rest) && doubles_of(h, square, &m->growth) &&
         doubles_of(h, 8 * square + 7 * nx, &m->work) && doubles_of(h, 2 * nx, &m->along) &&
         doubles_of(h, 3 * nx, &m->all) && doubles_of(h, nx, &m->rest_of_fourth) &&
         doubles_of(h, 8 * square, &m->sizes);
}

void modes_start(zono *z) { z->modes->now.any = z->modes->old.any = 0, z->modes->wait = 0, cycle_start(z); }

int modes_invert(size_t n, const number *V, number *W, number *A) {
  memcpy(A, V, n * n * sizeof *A);
  for (size_t i = 0; i < n * n; i++) W[i] = i % (n + 1) == 0;
  for (size_t k = 0; k < n; k++) {
    size_t pivot = k;
    for (size_t i = k; i < n; i++)
      if (modulus(A[i * n + k]) > modulus(A[pivot * n + k])) pivot = i;
    if (!(modulus(A[pivot * n + k]) > 0)) return 0;
    for (size_t j = 0; j < n; j++) {
      number a = A[k * n + j], w = W[k * n + j];
      A[k * n + j] = A[pivot * n + j], A[pivot * n + j] = a;
      W[k * n + j] = W[pivot * n + j], W[pivot * n + j] = w;
    }
    number by = 1 / A[k * n + k];
    for (size_t j = 0; j < n; j++) A[k * n + j] *= by, W[k * n + j] *= by;
    for (size_t i = 0; i < n; i++) {
      number f = A[i * n + k];
      if (i == k || f == 0) continue;
      for (size_t j = 0; j < n; j++) A[i * n + j] -= f * A[k * n + j], W[i * n + j] -= f * W[k * n + j];
    }
  }
  return 1;
}

/* eigenvectors of a [nx x nx], which is overwritten */
static int find_vectors(zono *z, double *a) {
  modes *m = z->modes;
  size_t n = z->nx;
  double *q = a + n * n, *v = q + n * n, *re = v + n * n, *im = re + n, *work = im + n, *scale = work + 2 * n;
  for (size_t e = 0; e < n * n; e++)
    if (!isfinite(a[e])) return 0;
  balance_matrix(n, a, scale);
  if (!real_schur(n, a, q, work)) return 0;
  real_schur_vectors(n, a, q, re, im, v, work);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++) {
      size_t first = im[k] < 0 ? k - 1 : k;
      number x = v[i * n + first] + (im[k] != 0 ? v[i * n + first + 1] : 0) * I;
      m->now.V[i * n + k] = scale[i] * (im[k] < 0 ? conj(x) : x);
    }
  return 1;
}

void modes_product(size_t n, const number *a, const number *b, number *to) {
  memset(to, 0, n * n * sizeof *to);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++) {
      number x = a[i * n + k];
      for (size_t j = 0; j < n && x != 0; j++) to[i * n + j] += x * b[k * n + j];
    }
}

double modes_flow(const zono *z, uint32_t i, uint32_t k) {
  return z->proof->end[(size_t)i * z->shape.stride + z->shape.eps + k];
}

double modes_mixed(const zono *z, uint32_t j, uint32_t i, uint32_t k) {
  size_t at = (size_t)i * z->shape.stride + z->shape.mix + (size_t)j * z->nx + k;
  return z->proof->end[at];
}

/* Turn T_j,ik of W M_j V by the difference of the multipliers of modes i and k: (I + sum_j xi_j T_j) makes the modes of
** the step's map at each xi. Turns above `most` are left out. Returns the largest sum of a row of sum_j |T_j|. */
static double find_turns(zono *z, double most) {
  modes *m = z->modes;
  size_t n = z->nx, square = n * n;
  double largest = 0;
  memset(m->now.tilt, 0, square * sizeof *m->now.tilt);
  for (uint32_t j = 0; j < z->shape.mixed; j++)
    for (size_t e = 0; e < square; e++) {
      number *t = m->now.T + j * square + e;
      if (modulus(*t) > most) *t = 0;
      m->now.tilt[e] += modulus(*t) * ABOVE;
    }
  for (size_t i = 0; i < n; i++) {
    double sum = 0;
    for (size_t k = 0; k < n; k++) sum += m->now.tilt[i * n + k];
    largest = fmax(largest, sum);
  }
  return largest;
}

static void divide_turns(zono *z) {
  modes *m = z->modes;
  size_t n = z->nx, square = n * n;
  number *mu = (number *)(void *)m->work;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) m->A[i * n + k] = modes_flow(z, i, k);
  modes_product(n, m->A, m->now.V, m->B), modes_product(n, m->now.W, m->B, m->A);
  for (size_t k = 0; k < n; k++) mu[k] = m->A[k * n + k];
  for (uint32_t j = 0; j < z->shape.mixed; j++) {
    number *T = m->now.T + j * square;
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t k = 0; k < n; k++) m->A[i * n + k] = modes_mixed(z, j, i, k);
    modes_product(n, m->A, m->now.V, m->B), modes_product(n, m->now.W, m->B, T);
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < n; k++) {
        number *t = T + i * n + k, apart = mu[k] - mu[i];
        *t = i != k && modulus(*t) < modulus(apart) ? *t / apart : 0;
      }
  }
}

/* T and U; the largest turns are left out until (I + sum_j xi_j T_j) has an inverse for certain */
static void turn_by_data(zono *z) {
  modes *m = z->modes;
  size_t n = z->nx, square = n * n;
  double most = TURN;
  divide_turns(z);
  while (find_turns(z, most) > TURNS) most *= 0.5;
  memset(m->now.S, 0, square * sizeof *m->now.S);
  for (uint32_t j = 0; j < z->shape.mixed; j++) {
    number *U = m->now.U + j * square;
    modes_product(n, m->now.V, m->now.T + j * square, U);
    for (size_t i = 0; i < square; i++) m->now.S[i] += modulus(U[i]) * ABOVE;
  }
}

int modes_find(zono *z) {
  modes *m = z->modes;
  size_t n = z->nx;
  for (size_t i = 0; i < n; i++)
    if (!(z->E[i] > 0)) return 0; /* the map is not known */
  memcpy(m->work, z->proof->J, n * n * sizeof(double));
  if (!find_vectors(z, m->work) || !modes_invert(n, m->now.V, m->now.W, m->A)) return 0;
  turn_by_data(z);
  return 1;
}
