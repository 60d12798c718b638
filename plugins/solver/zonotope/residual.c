/* residual.c -- lumps as what they leave in the equations for unknowns.
**
** A lump in an equation, and what its coefficient varies by, is a torque: there it is as large as what makes it.
** Divided by the matrix of the equations it is an acceleration of every joint, each as large as that of the lightest
** one, if what they have in common is forgotten. So it is bounded in the equations, and each equation gets one column:
** docs/numerics/zonotope.md, section 7c.
*/
#include "residual.h"
#include "basis.h"
#include "vary.h"

int residual_open(zono *z) {
  const ambit_host *h = z->host;
  size_t n = z->na, slots = n * z->nslot * sizeof(double);
  residual *r = z->proof->residual = h->alloc(h, sizeof *r);
  if (!r) return 0;
  r->used = z->nvarying && n;
  if (!r->used) return 1;
  r->W = h->alloc(h, slots), r->dW = h->alloc(h, slots);
  r->size = h->alloc(h, n * sizeof *r->size), r->miss = h->alloc(h, n * sizeof(double));
  r->lean = h->alloc(h, n * (n + z->nvarying) * z->nx * sizeof(double));
  r->row = h->alloc(h, z->nx * sizeof(double));
  return r->W && r->dW && r->size && r->miss && r->lean && r->row;
}

void residual_start(zono *z) {
  residual *r = z->proof->residual;
  memset(r->size, 0, z->na * sizeof *r->size), memset(r->miss, 0, z->na * sizeof *r->miss);
}

static double at(const zono *z, const double *matrix, uint32_t row, uint32_t slot) {
  return matrix[(size_t)row * z->nslot + slot];
}

/* |sum_q L_kq W_q,slot - c|, with rounding */
static double mismatch(const zono *z, uint32_t k, uint32_t slot, double c) {
  const residual *r = z->proof->residual;
  const double *L = z->proof->L + (size_t)k * z->na;
  double sum = -c, size = fabs(c);
  for (uint32_t q = 0; q < z->na; q++) {
    double part = L[q] * at(z, r->W, q, slot);
    sum += part, size += fabs(part);
  }
  return (fabs(sum) + 2 * (z->na + 2) * UNIT * size) * ABOVE;
}

/* which of the lists of `lean` slot j has; na + nvarying: none */
static uint32_t place_of(const zono *z, uint32_t j) {
  if (j >= slot_a(z, 0) && j < slot_a(z, 0) + z->na) return j - slot_a(z, 0);
  return z->na + (is_varying(z, j) ? j - vary_first(z) : z->nvarying);
}

static double *lean_of(const zono *z, uint32_t q, uint32_t place) {
  return z->proof->residual->lean + ((size_t)q * (z->na + z->nvarying) + place) * z->nx;
}

void residual_keep(zono *z, uint32_t q, uint32_t j, double middle, double width, const double *eps) {
  residual *r = z->proof->residual;
  uint32_t place = place_of(z, j);
  r->W[(size_t)q * z->nslot + j] = middle, r->dW[(size_t)q * z->nslot + j] = width;
  if (place < z->na + z->nvarying) memcpy(lean_of(z, q, place), eps, z->nx * sizeof *eps);
}

/* half width of an adjoint: errors are not independent of one another */
static double width_of(zono *z, uint32_t q, uint32_t j) {
  double *row = z->proof->residual->row, width = at(z, z->proof->residual->dW, q, j), single = 0;
  memcpy(row, lean_of(z, q, place_of(z, j)), z->nx * sizeof *row);
  for (uint32_t k = 0; k < z->nx; k++) single += fabs(row[k]);
  if (single == 0) return width;
  double together = basis_resolve(z, row);
  together += mixed_size(z, row);
  return fmin(width, (fmax(width - single, 0) + together) * ABOVE + (8 + z->nx) * UNIT * width);
}

static void add(lump *to, double by, lump size) {
  to->rest += by * size.rest, to->path += by * size.path;
  to->mean += by * size.mean, to->moment += by * size.moment;
}

void residual_add(zono *z, uint32_t j, lump size, int own) {
  residual *r = z->proof->residual;
  const double *C = z->proof->C;
  for (uint32_t q = 0; q < z->na; q++) {
    if (!own) add(&r->size[q], fabs(at(z, r->W, q, j)), size);
    add(&r->size[q], own ? width_of(z, q, j) : at(z, r->dW, q, j), quartic_none(size.most));
    r->miss[q] += mismatch(z, q, j, C[(size_t)q * z->nslot + j]) * size.most;
  }
}

/* of what is known of products of errors */
static double rounding_of(const zono *z, uint32_t q) {
  const quartic *k = z->proof->quartic;
  return (2.0 * k->count + 8 + z->nx) * UNIT * k->rounding[z->nx + q];
}

void residual_close(zono *z) {
  const proof *p = z->proof;
  residual *r = p->residual;
  for (uint32_t q = 0; q < z->na; q++) {
    double sum = 0;
    for (uint32_t i = 0; i < z->nx; i++) {
      uint32_t slot = slot_x(z, i);
      sum += at(z, r->dW, q, slot) * p->zeta[i];
      r->miss[q] += mismatch(z, q, slot, p->C[(size_t)q * z->nslot + slot]) * p->zeta[i];
    }
    for (uint32_t k = 0; k < z->na; k++) {
      sum += width_of(z, q, slot_a(z, k)) * p->alpha[k];
      r->miss[q] += mismatch(z, q, slot_a(z, k), q == k ? -1 : 0) * p->alpha[k];
    }
    add(&r->size[q], 1, quartic_none(sum));
    if (p->quartic->count == 0) continue;
    double known = (quartic_square(z, z->nx + q) + rounding_of(z, q)) * ABOVE;
    add(&r->size[q], 1, (lump) { known, known, known, known, 0 });
  }
}
