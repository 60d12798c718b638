/* close.c -- the set at the end of the step.
**
** x(h) = Y(xi) + Y_eps eps + sum_j xi_j Y_j eps + z(h). Old generators move with Y_eps / E; what the mixed terms do to
** them is bounded column by column and put into a box, with rounding. Each lump is a new generator h rr_j mean(K) C_j:
** one symbol for all states. What K and C vary by goes into the box. Then generators are reduced [Girard 2005]: in units
** of the states' sizes, the columns that are nearest to an axis, or shortest, become a box.
*/
#include "proof.h"

/* -- the polynomials */

/* end := rows at h; box := what is rounded, and the end of the step itself */
static void find_end(zono *z) {
  proof *p = z->proof;
  const shape *s = &z->shape;
  for (uint32_t i = 0; i < z->nx; i++) {
    uint32_t slot = slot_x(z, i), out = slot_out(z)[i];
    double *to = p->end + (size_t)i * s->stride, power = 1, size = 0;
    memset(to, 0, s->stride * sizeof *to);
    for (uint32_t k = 0; k < orders(z, slot); k++, power *= z->h) {
      const double *row = row_at(z, slot, k);
      for (uint32_t v = 0; v < s->norms; v++) to[v] += power * row[v];
      size += fabs(power) * row_total(s, row);
    }
    row_norms(s, to);
    p->box[i] = 2 * (z->K + 3) * UNIT * size + z->h_error * (p->high[out] + p->delta[out]);
  }
}

/* -- old generators */

/* p->turned := G, state by state, in units of E */
static void turn(zono *z) {
  proof *p = z->proof;
  uint32_t n = z->ngen;
  for (uint32_t i = 0; i < z->nx; i++) {
    double scale = z->E[i] > 0 ? 1 / z->E[i] : 0, *to = p->turned + (size_t)i * n;
    for (uint32_t c = 0; c < n; c++) to[c] = z->G[(size_t)c * z->nx + i] * scale;
  }
}

/* sum over columns of |y G / E| */
static double through(const zono *z, const double *y, double *to) {
  const proof *p = z->proof;
  uint32_t n = z->ngen;
  double sum = 0;
  memset(to, 0, n * sizeof *to);
  for (uint32_t k = 0; k < z->nx; k++) {
    const double *from = p->turned + (size_t)k * n;
    if (y[k] == 0) continue;
    for (uint32_t c = 0; c < n; c++) to[c] += y[k] * from[c];
  }
  for (uint32_t c = 0; c < n; c++) sum += fabs(to[c]);
  return sum;
}

/* columns [ngen] at p->columns; box += mixed terms and rounding */
static void move_generators(zono *z) {
  proof *p = z->proof;
  const shape *s = &z->shape;
  double *moved = p->turned + (size_t)z->nx * z->ngen;
  turn(z);
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *y = p->end + (size_t)i * s->stride;
    double mixed = 0;
    for (uint32_t j = 0; j < s->mixed; j++) mixed += through(z, y + s->mix + (size_t)j * z->nx, moved);
    through(z, y + s->eps, moved);
    for (uint32_t c = 0; c < z->ngen; c++) p->columns[(size_t)c * z->nx + i] = moved[c];
    /* E is rounded up, so sums of |G| / E are at most 1 */
    double rounded = 2 * (z->nx + 4) * UNIT * (row_r(s, y) + row_x(s, y));
    p->box[i] += mixed * ABOVE + rounded;
    if (p->share) p->share[i].mixed = mixed;
  }
}

/* -- new generators */

/* x'_i's coefficient of the lump of slot j, and its half width */
static double weight_of(const zono *z, uint32_t i, uint32_t j) {
  const proof *p = z->proof;
  return p->link[i] == LINK_STATE ? 0 : p->C[(size_t)p->link_to[i] * z->nslot + j];
}
static double half_width(const zono *z, uint32_t i, uint32_t j) {
  const proof *p = z->proof;
  return p->link[i] == LINK_STATE ? 0 : p->dC[(size_t)p->link_to[i] * z->nslot + j];
}

typedef struct sums {
  double *centre, *width; /* [nx] of |C_j| rr_j, dC_j rr_j */
} sums;

/* one more column, h size mean c; returns their number */
static uint32_t add_lump(zono *z, uint32_t at, double size, const double *c, const sums *sum) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  double *to = p->columns + (size_t)at * nx, any = 0;
  for (uint32_t i = 0; i < nx; i++) any += fabs(c[i]), sum->centre[i] += fabs(c[i]) * size;
  if (any == 0) return at;
  for (uint32_t i = 0; i < nx; i++) {
    double x = 0;
    for (uint32_t l = 0; l < nx; l++)
      if (c[l] != 0) x += p->mean[(size_t)i * nx + l] * c[l];
    to[i] = z->h * size * x;
  }
  return at + 1;
}

static uint32_t add_lumps(zono *z, uint32_t at, const sums *sum) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  double *c = p->grow;
  for (uint32_t j = 0; j < z->nslot; j++) {
    if (z->rr[j] == 0) continue;
    for (uint32_t i = 0; i < nx; i++) c[i] = weight_of(z, i, j), sum->width[i] += half_width(z, i, j) * z->rr[j];
    at = add_lump(z, at, z->rr[j], c, sum);
  }
  for (uint32_t q = 0; q < z->na; q++) {
    double size = z->rr_out[nx + q];
    for (uint32_t i = 0; i < nx; i++) {
      size_t n = p->link[i] == LINK_STATE ? 0 : (size_t)p->link_to[i] * z->na + q;
      c[i] = p->link[i] == LINK_STATE ? 0 : p->L[n];
      sum->width[i] += p->link[i] == LINK_STATE ? 0 : p->dL[n] * size;
    }
    at = add_lump(z, at, size, c, sum);
  }
  for (uint32_t l = 0; l < nx; l++) {
    for (uint32_t i = 0; i < nx; i++) c[i] = i == l;
    at = add_lump(z, at, z->rr_out[l], c, sum);
  }
  return at;
}

/* generators and the box of what they do not hold; returns the number of columns */
static uint32_t add_distance(zono *z, uint32_t at) {
  proof *p = z->proof;
  uint32_t nx = z->nx;
  sums sum = { p->work, p->work + nx };
  memset(p->work, 0, 3 * nx * sizeof(double));
  at = add_lumps(z, at, &sum);
  double *square = p->work + 2 * (size_t)nx;
  for (uint32_t i = 0; i < nx; i++)
    for (uint32_t j = 0; j < nx; j++) square[i] += p->dJ[(size_t)i * nx + j] * p->zeta[j];
  for (uint32_t i = 0; i < nx; i++) {
    double kernel = 0, slope = 0, second = 0, size = 0;
    for (uint32_t l = 0; l < nx; l++) {
      double reach = p->reach[(size_t)i * nx + l];
      kernel += p->wobble[(size_t)i * nx + l] * sum.centre[l];
      slope += reach * sum.width[l], second += reach * square[l], size += reach * sum.centre[l];
    }
    p->box[i] += (kernel + slope + second + 4 * (nx + 4) * UNIT * size) * ABOVE;
    if (p->share)
      p->share[i].kernel = kernel, p->share[i].slope = slope, p->share[i].square = second, p->share[i].cubic = size;
  }
  return at;
}

/* -- reduction */

/* the k-th largest of x [n], which is rearranged */
static double ranked(double *x, uint32_t n, uint32_t k) {
  uint32_t from = 0, to = n - 1;
  while (from < to) {
    double pivot = x[from + (to - from) / 2];
    uint32_t i = from, j = to;
    while (i <= j) {
      while (x[i] > pivot) i++;
      while (x[j] < pivot) j--;
      if (i > j) break;
      double old = x[i];
      x[i++] = x[j], x[j] = old;
      if (j == 0) break;
      j--;
    }
    if (k <= j)
      to = j;
    else if (k >= i)
      from = i;
    else
      break;
  }
  return x[k];
}

static void find_scores(const zono *z, uint32_t n) {
  const proof *p = z->proof;
  for (uint32_t c = 0; c < n; c++) {
    const double *g = p->columns + (size_t)c * z->nx;
    double sum = 0, most = 0;
    for (uint32_t i = 0; i < z->nx; i++) {
      double u = fabs(g[i]) / p->spread[i];
      sum += u, most = fmax(most, u);
    }
    p->score[c] = sum - most;
  }
}

/* sizes of the states' sets at the end, for scores */
static void find_spread(const zono *z, uint32_t n) {
  proof *p = z->proof;
  for (uint32_t i = 0; i < z->nx; i++) p->spread[i] = 0;
  for (uint32_t c = 0; c < n; c++)
    for (uint32_t i = 0; i < z->nx; i++) p->spread[i] += fabs(p->columns[(size_t)c * z->nx + i]);
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *y = p->end + (size_t)i * z->shape.stride;
    p->spread[i] += row_l(&z->shape, y) + row_q(&z->shape, y) + p->box[i];
    if (!(p->spread[i] > 0)) p->spread[i] = 1;
  }
}

/* G := the columns that count most, and the box with all others */
static void reduce(zono *z, uint32_t n) {
  proof *p = z->proof;
  uint32_t nx = z->nx, room = z->ngen_max - nx, kept = 0;
  double least = -1;
  find_spread(z, n);
  if (n > room) {
    find_scores(z, n);
    memcpy(p->sorted, p->score, n * sizeof(double));
    least = ranked(p->sorted, n, room - 1);
  }
  for (uint32_t c = 0; c < n; c++) {
    const double *g = p->columns + (size_t)c * nx;
    if (kept < room && (least < 0 || p->score[c] >= least))
      memcpy(z->G + (size_t)kept++ * nx, g, nx * sizeof *g);
    else
      for (uint32_t i = 0; i < nx; i++) {
        p->box[i] += fabs(g[i]);
        if (p->share) p->share[i].reduction += fabs(g[i]);
      }
  }
  for (uint32_t i = 0; i < nx; i++) {
    double *g = z->G + (size_t)kept * nx;
    if (p->box[i] == 0) continue;
    memset(g, 0, nx * sizeof *g);
    g[i] = p->box[i] * ABOVE;
    kept++;
  }
  z->ngen = kept;
}

static void find_sizes(zono *z) {
  for (uint32_t i = 0; i < z->nx; i++) {
    double sum = 0;
    for (uint32_t c = 0; c < z->ngen; c++) sum += fabs(z->G[(size_t)c * z->nx + i]);
    z->E[i] = sum * ABOVE;
  }
}

void zono_finish(zono *z) {
  proof *p = z->proof;
  const shape *s = &z->shape;
  if (p->share) memset(p->share, 0, z->nx * sizeof *p->share);
  find_end(z);
  move_generators(z);
  uint32_t n = add_distance(z, z->ngen);
  reduce(z, n);
  for (uint32_t i = 0; i < z->nx; i++) {
    double *to = z->P + (size_t)i * s->stride;
    memcpy(to, p->end + (size_t)i * s->stride, s->stride * sizeof *to);
    memset(to + s->eps, 0, z->nx * sizeof *to);
    memset(to + s->mix, 0, (s->norms - s->mix) * sizeof *to);
    row_norms(s, to);
  }
  find_sizes(z);
}
