/* cycle.c -- discs of sampled systems: along the movement of a whole cycle, from after one jump to after the next.
**
** Steps are as short as a sampling period, so errors that left the history must not be boxed at each of them. They are
** in discs. After a jump these lie along V, in which the map of a cycle is as nearly diagonal as it can be without
** large vectors; at the end of a step along the images of V. No proof depends on V: map.c bounds what it leaves.
*/
#include "modes.h"
#include "proof.h"
#include "shared/real_schur.h"

#define LONGEST 10.0 /* part of one direction in another, that makes the map diagonal; what needs more stays as it is */
#define SMALLEST 1e-6 /* unit of a state by the largest one */
#define RENEW 8       /* cycles, after which V is found anew */

int cycle_open(zono *z) {
  if (!z->problem.njump) return 1;
  const ambit_host *h = z->host;
  cycle *c = z->modes->cycle = h->alloc(h, sizeof *c);
  size_t square = (size_t)z->nx * z->nx + 1;
  return c && (c->map = h->alloc(h, square * sizeof(double))) && (c->next = h->alloc(h, square * sizeof(double))) &&
         (c->V = h->alloc(h, square * sizeof(number))) && (c->T = h->alloc(h, square * sizeof(number))) &&
         (c->X = h->alloc(h, square * sizeof(number)));
}

/* map := what the step or jump makes of it */
static void extend(const zono *z) {
  cycle *c = z->modes->cycle;
  size_t n = z->nx;
  memset(c->next, 0, n * n * sizeof *c->next);
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      double y = modes_flow(z, i, k);
      for (uint32_t l = 0; l < n && y != 0; l++) c->next[i * n + l] += y * c->map[k * n + l];
    }
  double *old = c->map;
  c->map = c->next, c->next = old;
}

static void begin(const zono *z) {
  cycle *c = z->modes->cycle;
  memset(c->map, 0, (size_t)z->nx * z->nx * sizeof *c->map);
  for (uint32_t i = 0; i < z->nx; i++) c->map[(size_t)i * (z->nx + 1)] = 1;
}

void cycle_start(zono *z) {
  if (!z->modes->cycle) return;
  z->modes->cycle->turns = 0, z->modes->cycle->known = 0;
  begin(z);
}

/* -- V */

/* columns of pairs := the eigenvectors of their blocks of the Schur form t, in the basis q */
static void take_schur(const zono *z, const double *t, const double *q, number *V) {
  size_t n = z->nx;
  for (size_t i = 0; i < n * n; i++) V[i] = q[i];
  for (size_t k = 0; k + 1 < n; k++) {
    double b = t[k * n + k + 1], c = t[(k + 1) * n + k];
    if (c == 0) continue;
    number u = sqrt(fabs(b)), w = I * copysign(sqrt(fabs(c)), b);
    double length = sqrt(fabs(b) + fabs(c));
    for (size_t i = 0; i < n; i++) {
      number x = (q[i * n + k] * u + q[i * n + k + 1] * w) / length;
      V[i * n + k] = x, V[i * n + k + 1] = conj(x);
    }
    k++;
  }
}

/* X, upper triangular, such that T X is X times a matrix that is diagonal but for what would make X large */
static void separate(const zono *z, number *T, number *X) {
  size_t n = z->nx;
  for (size_t i = 0; i < n * n; i++) X[i] = i % (n + 1) == 0;
  for (size_t j = 1; j < n; j++)
    for (size_t i = j; i-- > 0;) {
      number rest = T[i * n + j];
      for (size_t k = i + 1; k < j; k++) rest += T[i * n + k] * X[k * n + j];
      number gap = T[j * n + j] - T[i * n + i];
      if (modulus(rest) <= LONGEST * modulus(gap) && modulus(gap) > 0) X[i * n + j] = rest / gap;
    }
}

/* sizes of the states; where waiting results only pass on, no other choice ends */
static void choose_units(const zono *z, double *scale) {
  double most = 0;
  for (uint32_t i = 0; i < z->nx; i++) {
    scale[i] = row_total(&z->shape, z->P + (size_t)i * z->shape.stride) + z->E[i];
    most = fmax(most, scale[i]);
  }
  for (uint32_t i = 0; i < z->nx; i++) scale[i] = fmax(scale[i], most > 0 ? SMALLEST * most : 1);
}

/* c->V from c->map; 0: none was found. Where something varies in between, its columns come at every step and go soon;
** discs along directions that a jump wipes out are wider than these, and feed them all. */
static int find_directions(zono *z) {
  modes *m = z->modes;
  cycle *c = m->cycle;
  size_t n = z->nx;
  double *a = m->work, *q = a + n * n, *scale = q + n * n, *work = scale + n;
  if (z->nvarying) return 0;
  for (size_t e = 0; e < n * n; e++)
    if (!isfinite(a[e] = c->map[e])) return 0;
  choose_units(z, scale);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++) a[i * n + k] *= scale[k] / scale[i];
  memcpy(c->next, a, n * n * sizeof *a);
  if (!real_schur(n, a, q, work)) return 0;
  take_schur(z, a, q, m->A);
  if (!modes_invert(n, m->A, m->B, m->C)) return 0;
  for (size_t e = 0; e < n * n; e++) m->C[e] = c->next[e];
  modes_product(n, m->C, m->A, c->X), modes_product(n, m->B, c->X, c->T);
  separate(z, c->T, c->X);
  modes_product(n, m->A, c->X, c->V);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++) c->V[i * n + k] *= scale[i];
  return 1;
}

/* -- the movement */

/* the discs at the end of a step or jump along V: 0: there are none */
static int lie_along(zono *z, const number *V) {
  modes *m = z->modes;
  discs *d = &m->now;
  size_t n = z->nx, square = n * n, mixed = z->shape.mixed * square;
  memcpy(d->V, V, square * sizeof *V);
  for (size_t e = 0; e < square; e++)
    if (!isfinite(creal(V[e])) || !isfinite(cimag(V[e]))) return 0;
  memset(d->U, 0, mixed * sizeof *d->U), memset(d->T, 0, mixed * sizeof *d->T);
  memset(d->S, 0, square * sizeof *d->S), memset(d->tilt, 0, square * sizeof *d->tilt);
  return modes_invert(n, d->V, d->W, m->A);
}

void cycle_step(zono *z) {
  modes *m = z->modes;
  size_t n = z->nx;
  extend(z);
  if (!m->old.any) return;
  memset(m->cycle->X, 0, n * n * sizeof *m->cycle->X);
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      double y = modes_flow(z, i, k);
      for (uint32_t l = 0; l < n && y != 0; l++) m->cycle->X[i * n + l] += y * m->old.V[k * n + l];
    }
  m->now.any = lie_along(z, m->cycle->X);
}

void cycle_jump(zono *z) {
  modes *m = z->modes;
  cycle *c = m->cycle;
  extend(z);
  if (c->turns > 0 && (c->turns - 1) % RENEW == 0 && find_directions(z)) c->known = 1;
  m->now.any = c->known && lie_along(z, c->V);
  c->turns++;
  begin(z);
}
