/* distance.c -- what the distance z(h) from the polynomials adds to the set.
**
** Each lump is two new generators (kernel.c): one symbol for all states. What is known of lumps is a polynomial
** (quartic.c). What K and C vary by besides, and what slopes vary by, goes into the box.
*/
#include "basis.h"
#include "change.h"
#include "modes.h"
#include "quartic.h"
#include "residual.h"
#include "vary.h"

/* -- columns */

/* x'_i's coefficient of the lump of slot j, and its half width */
static double weight_of(const zono *z, uint32_t i, uint32_t j) {
  const proof *p = z->proof;
  return p->link[i] == LINK_STATE ? 0 : p->C[(size_t)p->link_to[i] * z->nslot + j];
}
/* half widths before sweep.c closed them by rho */
static const double *raw(const zono *z, const double *closed, const double *before) { return z->na ? before : closed; }
static double half_width(const zono *z, uint32_t i, uint32_t j) {
  const proof *p = z->proof;
  return p->link[i] == LINK_STATE ? 0 : raw(z, p->dC, p->dC_new)[(size_t)p->link_to[i] * z->nslot + j];
}

typedef struct sums {
  double *centre, *path, *width; /* [nx] of |C_j| times what is left of lumps, of their integrals; of dC_j rr_j */
} sums;

static double times(const zono *z, const double *matrix, uint32_t i, const double *c) {
  double sum = 0;
  for (uint32_t l = 0; l < z->nx; l++) sum += matrix[(size_t)i * z->nx + l] * c[l];
  return sum;
}

/* Two more columns, for the integrals of theta and of theta (2 tau - 1), of what is not known of theta: h size mean c
** and h moment tilt c. Returns the number of columns then. */
static uint32_t add_lump(zono *z, uint32_t at, lump size, const double *c, const sums *sum, enum origin from) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  double *mean = p->columns + (size_t)at * nx, *tilt = mean + nx, any = 0, tilted = 0;
  for (uint32_t i = 0; i < nx; i++)
    any += fabs(c[i]), sum->centre[i] += fabs(c[i]) * size.rest, sum->path[i] += fabs(c[i]) * size.path;
  if (any == 0) return at;
  change_note(z, c, size.rest);
  for (uint32_t i = 0; i < nx; i++) {
    mean[i] = z->h * size.mean * times(z, p->mean, i, c);
    tilt[i] = z->h * size.moment * times(z, p->tilt, i, c);
    tilted += fabs(tilt[i]);
  }
  p->origin[at] = p->origin[at + 1] = (uint8_t)from, p->source[at] = p->source[at + 1] = 0;
  return at + 1 + (tilted > 0);
}

static enum origin origin_of(const zono *z, uint32_t j) {
  double r = z->r[j], square = z->rr[j] - r, late = z->proof->late[j];
  return square > r ? FROM_SQUARE : 2 * late > r ? FROM_TIME : FROM_DEGREE;
}

/* what is known of lumps: terms of degree 4 go into the set's own (quartic_end); one column for each x'_l for those of
** degree 2 in the data and 1 in eps */
static uint32_t add_known(zono *z, uint32_t at, const sums *sum) {
  proof *p = z->proof;
  double *c = p->grow;
  int carried = discs_carry(z);
  for (uint32_t l = 0; l < z->nx; l++) {
    double size = quartic_square(z, l), known = quartic_sum(z, l), kept = size, resolved = 0;
    if (p->link[l] == LINK_STATE) continue;
    for (uint32_t n = 0; n < p->quartic->pairs; n++) resolved += basis_resolve(z, quartic_near(z, l, n));
    double few, all = mixed_sizes(z, quartic_near(z, l, 0), p->quartic->pairs, &few);
    size += resolved + all, kept += resolved + (carried ? few : all);
    size *= ABOVE, kept *= ABOVE;
    for (uint32_t i = 0; i < z->nx; i++) c[i] = i == l;
    sum->centre[l] += known, sum->path[l] += known;
    change_note(z, c, known);
    at = add_lump(z, at, (lump) { 0, size, size, kept, 0 }, c, sum, FROM_MIXED);
  }
  if (carried && p->quartic->count > 0) map_pairs(z);
  return at;
}

/* What V_R does to x'_i, with coefficients at their middles: V_R is known, so its constants add up with their signs. */
static double equations_size(const zono *z, uint32_t i) {
  const proof *p = z->proof;
  double all = 0, rounded = 0, power = 1;
  if (p->link[i] == LINK_STATE) return 0;
  const double *L = p->L + (size_t)p->link_to[i] * z->na;
  for (uint32_t k = 0; k <= z->K; k++, power *= fabs(z->h)) {
    double sum = 0, size = 0;
    for (uint32_t q = 0; q < z->na; q++) {
      uint32_t slot = slot_out(z)[z->nx + q];
      if (k >= orders(z, slot)) continue;
      const double *row = row_at(z, slot, k);
      sum += L[q] * row[0], size += fabs(L[q]) * row_moving(&z->shape, row);
    }
    all += power * (fabs(sum) + size);
  }
  for (uint32_t q = 0; q < z->na; q++) rounded += fabs(L[q]) * z->rr_out[z->nx + q];
  return (all + 2 * (z->na + 2) * UNIT * rounded) * ABOVE;
}

/* one column for what is left in each equation; widths are those of residual.c from then on, slopes' among them */
static uint32_t add_equations(zono *z, uint32_t at, const sums *sum) {
  proof *p = z->proof;
  const residual *r = p->residual;
  double *c = p->grow;
  residual_close(z);
  for (uint32_t q = 0; q < z->na; q++) {
    for (uint32_t i = 0; i < z->nx; i++) c[i] = p->link[i] == LINK_UNKNOWN ? p->L[p->link_to[i] * z->na + q] : 0;
    uint32_t end = add_lump(z, at, r->size[q], c, sum, FROM_SLOPE);
    vary_mark(z, z->nvarying + q, at, end);
    at = end;
  }
  for (uint32_t i = 0; i < z->nx; i++) {
    if (p->link[i] != LINK_UNKNOWN) continue;
    sum->width[i] = r->miss[p->link_to[i]];
    memset(p->dJ + (size_t)i * z->nx, 0, z->nx * sizeof(double));
  }
  return at;
}

static uint32_t add_lumps(zono *z, uint32_t at, const sums *sum) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  double *c = p->grow;
  int known = quartic_begin(z);
  if (p->residual->used) residual_start(z);
  for (uint32_t j = 0; j < z->nslot; j++) {
    if (z->rr[j] == 0) continue;
    lump size = quartic_lump(z, j);
    if (size.most == 0) continue;
    for (uint32_t i = 0; i < nx; i++) c[i] = weight_of(z, i, j), sum->width[i] += half_width(z, i, j) * size.most;
    if (p->residual->used) {
      residual_add(z, j, size, is_varying(z, j));
      for (uint32_t i = 0; i < nx && !is_varying(z, j); i++)
        if (p->link[i] == LINK_UNKNOWN) c[i] = 0;
    }
    uint32_t end = add_lump(z, at, size, c, sum, is_varying(z, j) ? FROM_VARYING : origin_of(z, j));
    if (is_varying(z, j)) vary_mark(z, j - vary_first(z), at, end);
    at = end;
  }
  if (p->residual->used) at = add_equations(z, at, sum);
  for (uint32_t l = 0; l < nx; l++) {
    double left = equations_size(z, l);
    for (uint32_t i = 0; i < nx; i++) c[i] = i == l;
    at = add_lump(z, at, quartic_none(z->rr_out[l] + left), c, sum, left > z->rr_out[l] ? FROM_START : FROM_TIME);
    if (p->link[l] == LINK_STATE) continue;
    if (p->residual->used && p->link[l] == LINK_UNKNOWN) continue;
    const double *dL = raw(z, p->dL, p->dL_new) + (size_t)p->link_to[l] * z->na;
    for (uint32_t q = 0; q < z->na; q++) sum->width[l] += dL[q] * z->rr_out[nx + q];
  }
  return known ? add_known(z, at, sum) : at;
}

/* -- bounds of what has no column */

/* what unknown k is off by, by lumps, with the coefficients that sweeps gave */
static double unknown_size(const zono *z, uint32_t k, const sums *sum) {
  const proof *p = z->proof;
  for (uint32_t i = 0; i < z->nx && !p->residual->used; i++)
    if (p->link[i] == LINK_UNKNOWN && p->link_to[i] == k) return sum->centre[i] + sum->width[i];
  const double *C = p->C + (size_t)k * z->nslot, *dC = p->dC + (size_t)k * z->nslot;
  const double *L = p->L + (size_t)k * z->na, *dL = p->dL + (size_t)k * z->na;
  double size = 0;
  for (uint32_t j = 0; j < z->nslot; j++) size += (fabs(C[j]) + dC[j]) * z->rr[j];
  for (uint32_t q = 0; q < z->na; q++) size += (fabs(L[q]) + dL[q]) * z->rr_out[z->nx + q];
  return size;
}

/* width += what the true coefficients of all lumps together differ by from those of the sweeps: rho (I - rho)^-1 */
static void close_sums(zono *z, const sums *sum) {
  proof *p = z->proof;
  for (uint32_t k = 0; k < z->na; k++) p->alpha_new[k] = unknown_size(z, k, sum);
  for (uint32_t i = 0; i < z->nx; i++) {
    if (p->link[i] == LINK_STATE || (p->residual->used && p->link[i] == LINK_UNKNOWN)) continue;
    const double *by = p->close + (size_t)p->link_to[i] * z->na;
    for (uint32_t k = 0; k < z->na; k++) sum->width[i] += by[k] * p->alpha_new[k] * ABOVE;
  }
}

/* zeta again, from what is left of lumps: its integral Theta, by parts, adds Theta + int K J Theta, too */
static void refine(zono *z, const sums *sum) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  memcpy(p->ramp, p->zeta, nx * sizeof(double));
  for (int turn = 0; turn < 2; turn++) {
    for (uint32_t i = 0; i < nx; i++) {
      double rate = sum->width[i], turned = 0;
      for (uint32_t j = 0; j < nx; j++) {
        rate += p->dJ[(size_t)i * nx + j] * p->zeta[j];
        turned += p->jacobian_size[(size_t)i * nx + j] * sum->path[j];
      }
      p->grow[i] = rate + sum->centre[i], p->grow_path[i] = rate + fabs(z->h) * turned;
    }
    for (uint32_t i = 0; i < nx; i++) {
      double most = LEAST, path = fabs(z->h) * sum->path[i];
      for (uint32_t l = 0; l < nx; l++) {
        double reach = p->reach[(size_t)i * nx + l];
        most += reach * p->grow[l], path += reach * p->grow_path[l];
      }
      p->ramp[i] = fmin(p->ramp[i], most * ABOVE);
      p->zeta_new[i] = fmin(p->zeta[i], fmin(most, path) * ABOVE);
    }
    memcpy(p->zeta, p->zeta_new, nx * sizeof(double));
  }
}

/* the columns of the slopes' dependence on the data */
static uint32_t add_changes(zono *z, uint32_t at, const sums *sum) {
  change *c = z->proof->change;
  uint32_t count = c->count;
  change_end(z, sum->centre, sum->width);
  c->count = 0; /* no more is noted */
  for (uint32_t r = 0; r < count; r++) at = add_lump(z, at, c->lump[r], c->u + (size_t)r * z->nx, sum, FROM_JACOBIAN);
  return at;
}

uint32_t distance_add(zono *z, uint32_t at) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  if (is_certain(z)) {
    for (uint32_t i = 0; i < nx; i++) *box(z, FROM_TIME, i) += p->zeta[i];
    return at;
  }
  sums sum = { p->work, p->work + 3 * (size_t)nx, p->work + nx };
  memset(p->work, 0, 4 * nx * sizeof(double));
  change_begin(z);
  at = add_lumps(z, at, &sum);
  double *square = p->work + 2 * (size_t)nx;
  close_sums(z, &sum);
  refine(z, &sum);
  at = add_changes(z, at, &sum);
  for (uint32_t i = 0; i < nx; i++)
    for (uint32_t j = 0; j < nx; j++) square[i] += p->dJ[(size_t)i * nx + j] * fmin(p->zeta[j], 0.5 * p->ramp[j]);
  for (uint32_t i = 0; i < nx; i++) {
    double kernel = 0, slope = 0, second = 0, size = 0;
    for (uint32_t l = 0; l < nx; l++) p->grow[l] = z->h * p->mean[(size_t)i * nx + l];
    *box(z, FROM_START, i) += quartic_end(z, i, p->grow, p->reach + (size_t)i * nx);
    for (uint32_t l = 0; l < nx; l++) {
      double reach = p->reach[(size_t)i * nx + l];
      kernel += p->wobble[(size_t)i * nx + l] * sum.centre[l];
      slope += reach * sum.width[l], second += reach * square[l], size += reach * sum.centre[l];
    }
    *box(z, FROM_KERNEL, i) += (kernel + 4 * (nx + 4) * UNIT * size) * ABOVE;
    *box(z, FROM_SLOPE, i) += slope * ABOVE;
    *box(z, FROM_JACOBIAN, i) += second * ABOVE;
  }
  return at;
}
