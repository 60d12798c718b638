/* change.c -- what the slopes' dependence on the data makes of the distance within a step.
**
** z' = J_0 z + (J - J_0) z + lumps. Of J - J_0, what a datum does, xi_k J_k, is J_k = sum_r u_r w_r' + R_k, crosses
** through the largest entries: xi_k (w_r' z) is a lump of its own with the coefficient u_r. The bound of |w_r' z| keeps
** what lumps have in common: a lump moves all states together, and springs between them by little.
*/
#include "change.h"
#include "depend.h"
#include "proof.h"
#include "residual.h"

static int doubles(const ambit_host *h, size_t n, double **to) {
  *to = h->alloc(h, (n ? n : 1) * sizeof(double));
  return *to != NULL;
}

int change_open(zono *z) {
  const ambit_host *h = z->host;
  change *c = z->proof->change = h->alloc(h, sizeof *c);
  size_t nx = z->nx, m = z->proof->depend->mixed, all = CROSSES * m * nx;
  if (!c || !(c->lump = h->alloc(h, (all + 1) * sizeof *c->lump))) return 0;
  return doubles(h, z->proof->ntarget * nx * m, &c->slope) && doubles(h, all, &c->u) && doubles(h, all, &c->w) &&
         doubles(h, all, &c->mean) && doubles(h, all, &c->tilt) && doubles(h, CROSSES * m, &c->size) &&
         doubles(h, CROSSES * m, &c->flat) && doubles(h, nx * nx, &c->rest) && doubles(h, nx * nx, &c->work);
}

/* -- crosses */

/* B [nx x nx] := J_k; is it anything? rest -= |J_k| */
static int take_slope(const zono *z, uint32_t k, double *B) {
  const proof *p = z->proof;
  const change *c = p->change;
  int any = 0;
  for (uint32_t i = 0; i < z->nx; i++)
    for (uint32_t l = 0; l < z->nx; l++) {
      size_t e = (size_t)i * z->nx + l;
      B[e] = p->link[i] == LINK_STATE ? 0 : c->slope[((size_t)p->link_to[i] * z->nx + l) * z->m + k];
      any |= B[e] != 0, c->rest[e] -= fabs(B[e]);
    }
  return any;
}

static int find_pivot(const zono *z, const double *B, uint32_t *row, uint32_t *column) {
  const double *zeta = z->proof->zeta;
  double most = 0;
  for (uint32_t i = 0; i < z->nx; i++)
    for (uint32_t l = 0; l < z->nx; l++) {
      double size = fabs(B[(size_t)i * z->nx + l]) * zeta[l] / zeta[i];
      if (size > most) most = size, *row = i, *column = l;
    }
  return most > 0;
}

/* B -= u w'; rest += rounding */
static void split(const zono *z, double *B, uint32_t i, uint32_t l, double *u, double *w) {
  uint32_t n = z->nx;
  double pivot = B[(size_t)i * n + l];
  for (uint32_t k = 0; k < n; k++) u[k] = B[(size_t)k * n + l], w[k] = B[(size_t)i * n + k] / pivot;
  for (uint32_t a = 0; a < n; a++)
    for (uint32_t b = 0; b < n; b++) {
      double part = u[a] * w[b], *at = B + (size_t)a * n + b;
      z->proof->change->rest[(size_t)a * n + b] += 4 * UNIT * (fabs(*at) + fabs(part));
      *at -= part;
    }
}

/* w' mean, w' tilt */
static void turn(const zono *z, const double *w, double *mean, double *tilt) {
  const proof *p = z->proof;
  for (uint32_t k = 0; k < z->nx; k++) {
    mean[k] = tilt[k] = 0;
    for (uint32_t i = 0; i < z->nx; i++)
      mean[k] += w[i] * p->mean[(size_t)i * z->nx + k], tilt[k] += w[i] * p->tilt[(size_t)i * z->nx + k];
  }
}

void change_begin(zono *z) {
  proof *p = z->proof;
  change *c = p->change;
  size_t square = (size_t)z->nx * z->nx;
  uint32_t i = 0, l = 0;
  c->count = 0;
  if (!c->known || p->residual->used) return;
  memcpy(c->rest, p->dJ, square * sizeof *c->rest);
  for (uint32_t k = 0; k < z->m; k++) {
    if (!take_slope(z, k, c->work)) continue;
    for (int r = 0; r < CROSSES && find_pivot(z, c->work, &i, &l); r++) {
      size_t at = (size_t)c->count++ * z->nx;
      split(z, c->work, i, l, c->u + at, c->w + at);
      turn(z, c->w + at, c->mean + at, c->tilt + at);
    }
    for (size_t e = 0; e < square; e++) c->rest[e] += fabs(c->work[e]);
  }
  for (size_t e = 0; e < square; e++) c->rest[e] = fmax(c->rest[e], 0) + 1e-9 * p->dJ[e];
  memset(c->size, 0, c->count * sizeof *c->size), memset(c->flat, 0, c->count * sizeof *c->flat);
}

/* -- sizes */

void change_note(zono *z, const double *by, double rest) {
  change *c = z->proof->change;
  for (uint32_t r = 0; r < c->count; r++) {
    const double *mean = c->mean + (size_t)r * z->nx, *tilt = c->tilt + (size_t)r * z->nx;
    double a = 0, b = 0;
    for (uint32_t i = 0; i < z->nx; i++) a += mean[i] * by[i], b += tilt[i] * by[i];
    c->size[r] += fabs(z->h) * (fabs(a) + 0.5 * fabs(b)) * rest;
  }
}

void change_end(zono *z, const double *centre, const double *width) {
  proof *p = z->proof;
  change *c = p->change;
  uint32_t n = z->nx;
  if (c->count == 0) return;
  for (uint32_t i = 0; i < n; i++) {
    double ramp = 0, flat = 0;
    for (uint32_t l = 0; l < n; l++) {
      double other = width[l], reach = p->reach[(size_t)i * n + l];
      for (uint32_t k = 0; k < n; k++) other += p->dJ[(size_t)l * n + k] * p->zeta[k];
      ramp += reach * other, flat += (p->wobble[(size_t)i * n + l] + 16 * (n + 8) * UNIT * reach) * centre[l];
    }
    for (uint32_t r = 0; r < c->count; r++) {
      double w = fabs(c->w[(size_t)r * n + i]);
      c->size[r] += w * ramp, c->flat[r] += w * flat;
    }
  }
  for (uint32_t r = 0; r < c->count; r++) {
    double single = 0, ramp = 0;
    for (uint32_t i = 0; i < n; i++) {
      double w = fabs(c->w[(size_t)r * n + i]);
      single += w * p->zeta[i], ramp += w * p->ramp[i];
    }
    double most = fmin(c->size[r] + c->flat[r], single) * ABOVE;
    double mean = fmin(0.5 * c->size[r] + c->flat[r], fmin(0.5 * ramp, single)) * ABOVE;
    c->lump[r] = (lump) { most, most, mean, mean, 0.5 * mean };
  }
  memcpy(p->dJ, c->rest, (size_t)n * n * sizeof *p->dJ);
}
