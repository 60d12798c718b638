/* basis.c -- which errors eps stand for: e = basis eps, |eps_k| <= 1.
**
** States one by one, or the directions of modes. A stiff spring between two bodies has no part in errors that move both
** alike; if these are known state by state only, all that bounds sizes takes them for errors of its length.
*/
#include "basis.h"
#include "depend.h"
#include "modes.h"
#include "quartic.h"

#define WORTH 0.5    /* of the forces that errors state by state would make */
#define ROOM 1.001   /* of the basis over the errors, */
#define ROUNDED 5e-4 /* and for its inverse being rounded */

int basis_open(zono *z) {
  const ambit_host *h = z->host;
  basis *b = z->basis = h->alloc(h, sizeof *b);
  size_t square = ((size_t)z->nx * z->nx + 1) * sizeof(double);
  return b && (b->columns = h->alloc(h, square)) && (b->inverse = h->alloc(h, square)) &&
         (b->work = h->alloc(h, (z->nx + 1u) * sizeof(double)));
}

double basis_resolve(const zono *z, double *y) {
  const basis *b = z->basis;
  uint32_t n = z->nx;
  double left = 0, *by = b->work;
  if (!b->is_turned) {
    for (uint32_t k = 0; k < n; k++) left += 2 * UNIT * fabs(y[k]), y[k] = z->E[k] > 0 ? y[k] / z->E[k] : 0;
    return left;
  }
  memset(by, 0, n * sizeof *by);
  for (uint32_t k = 0; k < n; k++)
    for (uint32_t l = 0; l < n && y[k] != 0; l++) by[l] += y[k] * b->inverse[(size_t)k * n + l];
  for (uint32_t k = 0; k < n; k++) {
    double rest = y[k], size = fabs(y[k]);
    for (uint32_t l = 0; l < n; l++) {
      double part = by[l] * b->columns[(size_t)l * n + k];
      rest -= part, size += fabs(part);
    }
    left += fabs(rest) + 2 * (n + 4) * UNIT * size;
  }
  memcpy(y, by, n * sizeof *y);
  return left * ABOVE;
}

/* columns and inverse along modes, in any unit; 0: they come in no pairs */
static int take_modes(zono *z) {
  const discs *d = &z->modes->now;
  basis *b = z->basis;
  size_t n = z->nx;
  for (size_t k = 0; k < n; k++) {
    int turns = 0, paired = k + 1 < n;
    for (size_t i = 0; i < n; i++) turns |= cimag(d->V[i * n + k]) != 0;
    for (size_t i = 0; i < n && paired; i++) paired = d->V[i * n + k + 1] == conj(d->V[i * n + k]);
    if (turns && !paired) return 0;
    for (size_t i = 0; i < n; i++) {
      number v = d->V[i * n + k], w = d->W[k * n + i];
      b->columns[i * n + k] = creal(v), b->inverse[k * n + i] = turns ? 2 * creal(w) : creal(w);
      if (turns) b->columns[i * n + k + 1] = cimag(v), b->inverse[(k + 1) * n + i] = -2 * cimag(w);
    }
    k += (size_t)turns;
  }
  return 1;
}

/* along the principal axes of generators that depend on the data */
static int take_axes(zono *z) {
  double *a = z->proof->depend->work;
  uint32_t n = z->nx;
  memset(a, 0, (size_t)n * n * sizeof *a);
  for (uint32_t c = 0; c < z->ngen; c++)
    for (uint32_t i = 0; i < n; i++)
      for (uint32_t k = 0; k < n; k++) {
        const double *g = z->G + (size_t)c * n, *unit = z->proof->spread;
        a[i * n + k] += g[i] / unit[i] * (g[k] / unit[k]);
      }
  depend_axes(z, z->basis->columns, z->basis->inverse);
  return 1;
}

static int take_directions(zono *z) {
  return z->modes->now.any ? take_modes(z) : z->proof->depend->any ? take_axes(z) : 0;
}

double basis_along(zono *z, const double *y) {
  uint32_t n = z->nx;
  double sum = 0, rounded = 0;
  for (uint32_t c = 0; c < z->ngen; c++) {
    double part = 0;
    for (uint32_t i = 0; i < n; i++) part += y[i] * z->G[(size_t)c * n + i];
    sum += fabs(part);
  }
  for (uint32_t i = 0; i < n; i++) rounded += fabs(y[i]) * z->E[i];
  sum += depend_through(z, y);
  return (sum + quartic_through(z, y) + discs_along(z, &z->modes->now, y) + 2 * (n + 4) * UNIT * rounded) * ABOVE;
}

/* the unit of each direction: as long as errors are there */
static int scale(zono *z) {
  basis *b = z->basis;
  uint32_t n = z->nx;
  double largest = 0;
  for (uint32_t k = 0; k < n; k++) {
    double *row = b->inverse + (size_t)k * n, size = basis_along(z, row) * ROOM;
    if (!(size > 0 && size < INFINITY)) return 0;
    for (uint32_t i = 0; i < n; i++) row[i] /= size, b->columns[(size_t)i * n + k] *= size;
  }
  for (uint32_t k = 0; k < n; k++) { /* |I - inverse columns| */
    double sum = 0;
    for (uint32_t l = 0; l < n; l++) {
      double left = k == l, size = left;
      for (uint32_t i = 0; i < n; i++) {
        double part = b->inverse[(size_t)k * n + i] * b->columns[(size_t)i * n + l];
        left -= part, size += fabs(part);
      }
      sum += fabs(left) + 2 * (n + 4) * UNIT * size;
    }
    largest = fmax(largest, sum);
  }
  return largest < ROUNDED;
}

/* what errors do to the states' rates, in units of the states: state by state, and along the basis */
static int is_worth_it(const zono *z) {
  const basis *b = z->basis;
  uint32_t n = z->nx;
  double single = 0, turned = 0;
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < n; k++) {
      const double *J = z->proof->J + (size_t)i * n;
      double sum = 0;
      for (uint32_t l = 0; l < n; l++) sum += J[l] * b->columns[(size_t)l * n + k];
      turned += fabs(sum) / z->proof->spread[i], single += fabs(J[k]) * z->E[k] / z->proof->spread[i];
    }
  return turned < WORTH * single;
}

void basis_choose(zono *z) { z->basis->is_turned = take_directions(z) && scale(z) && is_worth_it(z); }
