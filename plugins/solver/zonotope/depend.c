/* depend.c -- how generators depend on the data.
**
** The step moves errors by Y + sum_j xi_j M_j. Errors e = (G + sum_j xi_j G_j) rho are
**   (Y G + sum_j xi_j (Y G_j + M_j G) + sum_ij xi_i xi_j M_i G_j) rho
** at its end. Only the last sum is new errors: without G_j the data could move old errors in another way at each step,
** and what a contracting system does to them would come up again and again.
*/
#include "depend.h"
#include "change.h"
#include "modes.h"
#include "proof.h"
#include "quartic.h"
#include "shared/real_schur.h"

#define ROOM 2e6 /* numbers of G_j, at most: more are not followed */

static int doubles(const ambit_host *h, size_t n, double **to) {
  *to = h->alloc(h, (n ? n : 1) * sizeof(double));
  return *to != NULL;
}

static double *row_of(const zono *z, double *G, uint32_t j, uint32_t i) {
  const depend *d = z->proof->depend;
  return G + ((size_t)j * z->nx + i) * d->stride;
}

int depend_open(zono *z) {
  const ambit_host *h = z->host;
  depend *d = z->proof->depend = h->alloc(h, sizeof *d);
  if (!d) return 0;
  size_t nx = z->nx;
  d->stride = (z->ngen_max + nx + 7) / 8 * 8;
  d->mixed = z->nvarying || z->problem.njump || (double)z->shape.m * (double)(nx * d->stride) > ROOM ? 0 : z->shape.m;
  size_t mixed = d->mixed, all = mixed * nx * d->stride, crosses = CROSSES * (size_t)z->shape.m;
  d->measure = measure_portable;
#if defined(__x86_64__)
  if (z->shape.sum == sum_avx2) d->measure = measure_avx2;
#endif
  d->is_there = h->alloc(h, mixed + 1), d->kept = h->alloc(h, (z->ngen_max + nx + 1) * sizeof *d->kept);
  return d->is_there && d->kept && doubles(h, all, &d->now) && doubles(h, all, &d->next) &&
         doubles(h, nx * d->stride, &d->depth) && doubles(h, nx, &d->size) && doubles(h, nx * nx, &d->axis) &&
         doubles(h, nx * nx, &d->inverse) && doubles(h, nx, &d->radius) && doubles(h, 2 * nx * nx + nx, &d->work) &&
         doubles(h, crosses * nx, &d->turn) && doubles(h, crosses, &d->along);
}

void depend_start(zono *z) {
  depend *d = z->proof->depend;
  d->any = 0;
  memset(d->size, 0, z->nx * sizeof *d->size);
}

double depend_size(const zono *z, uint32_t i) {
  const depend *d = z->proof->depend;
  return d->any ? d->size[i] : 0;
}

double depend_depth(const zono *z, uint32_t c, uint32_t i) {
  const depend *d = z->proof->depend;
  return d->any && c < z->ngen ? d->depth[i * d->stride + c] : 0;
}

void depend_begin(zono *z) {
  depend *d = z->proof->depend;
  size_t square = (size_t)z->nx * z->nx;
  if (d->any || !d->mixed) return;
  d->any = 1;
  memset(d->is_there, 0, z->shape.mixed);
  memset(d->size, 0, z->nx * sizeof *d->size), memset(d->radius, 0, z->nx * sizeof *d->radius);
  memset(d->axis, 0, square * sizeof *d->axis), memset(d->inverse, 0, square * sizeof *d->inverse);
}

/* of one datum; depth += its size */
static void move_datum(zono *z, uint32_t j) {
  depend *d = z->proof->depend;
  const shape *s = &z->shape;
  int any = d->is_there[j];
  for (uint32_t i = 0; i < z->nx && !any; i++) any = row_x(s, z->proof->end + (size_t)i * s->stride) > 0;
  d->is_there[j] = (uint8_t)any;
  for (uint32_t i = 0; i < z->nx && any; i++) {
    const double *end = z->proof->end + (size_t)i * s->stride, *y = end + s->eps, *m = end + s->mix + j * z->nx;
    double *to = row_of(z, d->next, j, i);
    memset(to, 0, d->stride * sizeof *to);
    for (uint32_t k = 0; k < z->nx; k++) {
      if (y[k] != 0) z->proof->quartic->add(to, y[k], row_of(z, d->now, j, k), z->ngen);
      if (row_x(s, end) > 0 && m[k] != 0)
        z->proof->quartic->add(to, m[k], z->proof->turned + k * mixed_stride(z), z->ngen);
    }
    for (uint32_t c = 0; c < z->ngen; c++) d->depth[i * d->stride + c] += fabs(to[c]);
  }
}

void depend_move(zono *z) {
  depend *d = z->proof->depend;
  if (!d->any) return;
  memset(d->depth, 0, z->nx * d->stride * sizeof *d->depth);
  for (uint32_t j = 0; j < z->shape.mixed; j++) {
    if (!d->is_there[j]) memset(row_of(z, d->now, j, 0), 0, z->nx * d->stride * sizeof *d->now);
    move_datum(z, j);
  }
  for (size_t e = 0; e < z->nx * d->stride; e++) d->depth[e] *= ABOVE;
}

void depend_along(zono *z, const double *w, uint32_t count, double *along) {
  depend *d = z->proof->depend;
  memset(along, 0, count * sizeof *along);
  for (uint32_t j = 0; j < z->shape.mixed && d->any; j++)
    if (d->is_there[j]) d->measure(row_of(z, d->now, j, 0), d->stride, d->stride, z->nx, w, count, along);
}

/* -- bounds of sums */

/* covariance [nx x nx] of G_j, in units of the states' sets */
static void find_covariance(const zono *z, double *to) {
  const depend *d = z->proof->depend;
  uint32_t n = z->nx;
  memset(to, 0, (size_t)n * n * sizeof *to);
  for (uint32_t j = 0; j < z->shape.mixed; j++)
    for (uint32_t i = 0; i < n && d->is_there[j]; i++)
      for (uint32_t k = i; k < n; k++) {
        const double *a = row_of(z, d->now, j, i), *b = row_of(z, d->now, j, k);
        double sum[4] = { 0, 0, 0, 0 };
        for (size_t c = 0; c < d->stride; c += 4)
          for (size_t v = 0; v < 4; v++) sum[v] += a[c + v] * b[c + v];
        to[i * n + k] += (sum[0] + sum[1] + sum[2] + sum[3]) / (z->proof->spread[i] * z->proof->spread[k]);
      }
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < i; k++) to[i * n + k] = to[k * n + i];
}

/* those of the states if there are none */
void depend_axes(const zono *z, double *columns, double *inverse) {
  uint32_t n = z->nx;
  double *a = z->proof->depend->work, *q = a + (size_t)n * n;
  int found = real_schur(n, a, q, q + (size_t)n * n);
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      double part = found ? q[i * n + k] : i == k;
      columns[i * n + k] = part * z->proof->spread[i], inverse[k * n + i] = part / z->proof->spread[i];
    }
}

/* the axes of the covariance, and how far sums reach along them */
static void find_axes(zono *z) {
  depend *d = z->proof->depend;
  uint32_t n = z->nx;
  find_covariance(z, d->work);
  depend_axes(z, d->axis, d->inverse);
  depend_along(z, d->inverse, n, d->radius);
  for (uint32_t k = 0; k < n; k++)
    for (uint32_t i = 0; i < n; i++) d->radius[k] += 2 * (n + 4) * UNIT * fabs(d->inverse[k * n + i]) * d->size[i];
}

/* y = r inverse + q, r = y axis: |r_k| radius_k, and q by sizes */
double depend_through(const zono *z, const double *y) {
  const depend *d = z->proof->depend;
  uint32_t n = z->nx;
  double *r = d->work, single = 0, turned = 0;
  if (!d->any) return 0;
  for (uint32_t k = 0; k < n; k++) {
    r[k] = 0, single += fabs(y[k]) * d->size[k];
    for (uint32_t i = 0; i < n; i++) r[k] += y[i] * d->axis[i * n + k];
    turned += fabs(r[k]) * d->radius[k];
  }
  for (uint32_t i = 0; i < n; i++) {
    double rest = y[i], size = fabs(y[i]);
    for (uint32_t k = 0; k < n; k++) {
      double part = r[k] * d->inverse[k * n + i];
      rest -= part, size += fabs(part);
    }
    turned += (fabs(rest) + 2 * (n + 4) * UNIT * size) * d->size[i];
  }
  return fmin(single, turned) * ABOVE;
}

void depend_keep(zono *z, uint32_t count) {
  depend *d = z->proof->depend;
  double *old = d->now;
  if (!d->any) return;
  for (uint32_t j = 0; j < z->shape.mixed; j++)
    for (uint32_t i = 0; i < z->nx && d->is_there[j]; i++) {
      double *row = row_of(z, d->next, j, i);
      for (uint32_t c = 0; c < count; c++) row[c] = d->kept[c] < z->ngen ? row[d->kept[c]] : 0;
      memset(row + count, 0, (d->stride - count) * sizeof *row);
    }
  for (uint32_t i = 0; i < z->nx; i++) {
    d->size[i] = 0;
    for (uint32_t c = 0; c < count; c++) d->size[i] += depend_depth(z, d->kept[c], i);
    d->size[i] *= ABOVE;
  }
  d->now = d->next, d->next = old;
  find_axes(z);
}
