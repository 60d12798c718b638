/* frame.c -- many columns by a few of them.
**
** The axes are columns: the longest in units of the box of all of them, then the one that is longest beside it, and so
** on (QR with pivots). So directions that belong together stay together, and every column is a sum of axes and a rest,
** which is bounded whatever the axes are.
*/
#include "proof.h"
#include <stdlib.h>

#define FLAT 1e-10 /* of the longest column: not worth an axis */

/* column [nx] -= its part along q; returns that part */
static double take_along(uint32_t nx, const double *q, double *column) {
  double part = 0;
  for (uint32_t i = 0; i < nx; i++) part += q[i] * column[i];
  for (uint32_t i = 0; i < nx; i++) column[i] -= part * q[i];
  return part;
}

/* number of the longest of D [n x nx]; *length: its length */
static uint32_t find_longest(uint32_t nx, uint32_t n, const double *D, double *length) {
  double most = 0;
  uint32_t longest = 0;
  for (uint32_t c = 0; c < n; c++) {
    double square = 0;
    for (uint32_t i = 0; i < nx; i++) square += D[(size_t)c * nx + i] * D[(size_t)c * nx + i];
    if (square > most) most = square, longest = c;
  }
  *length = sqrt(most);
  return longest;
}

/* part [n x nx]: of each column along each axis, by Gram and Schmidt; returns the number of axes */
static uint32_t find_axes(frame *f, uint32_t nx, uint32_t n, const double *columns) {
  uint32_t rank = 0;
  double length, first = 0, *q = f->q;
  memset(f->unit, 0, nx * sizeof(double));
  for (size_t c = 0; c < (size_t)n * nx; c++) f->unit[c % nx] += fabs(columns[c]);
  for (size_t c = 0; c < (size_t)n * nx; c++) f->deflated[c] = f->unit[c % nx] > 0 ? columns[c] / f->unit[c % nx] : 0;
  for (; rank < nx; rank++) {
    f->axis[rank] = find_longest(nx, n, f->deflated, &length);
    first = fmax(first, length);
    if (!(length > FLAT * first)) break;
    for (uint32_t i = 0; i < nx; i++) q[i] = f->deflated[(size_t)f->axis[rank] * nx + i] / length;
    for (uint32_t c = 0; c < n; c++) f->part[(size_t)c * nx + rank] = take_along(nx, q, f->deflated + (size_t)c * nx);
  }
  return rank;
}

/* part of a column, by the axes as they are: R w = part, R the parts of the axes */
static void solve(const frame *f, uint32_t nx, const double *r, double *w) {
  for (uint32_t k = f->rank; k-- > 0;) {
    double sum = w[k];
    for (uint32_t l = k + 1; l < f->rank; l++) sum -= r[(size_t)l * nx + k] * w[l];
    w[k] = sum / r[(size_t)k * nx + k];
  }
}

void frame_find(frame *f, uint32_t nx, uint32_t n, const double *columns) {
  f->rank = find_axes(f, nx, n, columns);
  double *r = f->deflated; /* what is left there is not needed */
  for (uint32_t k = 0; k < f->rank; k++) memcpy(r + (size_t)k * nx, f->part + (size_t)f->axis[k] * nx, nx * sizeof *r);
  for (uint32_t c = 0; c < n; c++) solve(f, nx, r, f->part + (size_t)c * nx);
}

void frame_rest(const frame *f, uint32_t nx, uint32_t c, const double *columns, double *rest) {
  const double *g = columns + (size_t)c * nx, *w = f->part + (size_t)c * nx;
  for (uint32_t i = 0; i < nx; i++) {
    double left = g[i], size = fabs(g[i]);
    for (uint32_t k = 0; k < f->rank; k++) {
      double by = columns[(size_t)f->axis[k] * nx + i] * w[k];
      left -= by, size += fabs(by);
    }
    rest[i] = fabs(left) + 2 * (nx + 2) * UNIT * size;
  }
}
