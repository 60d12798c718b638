/* dense.c -- the last step as polynomials in time, where the receiver asks for it: a column for each datum and for each
** eps, the squares of data as half a column about the other half, what is left of each order as a radius, and zeta.
*/
#include "proof.h"

int dense_open(zono *z) {
  proof *p = z->proof;
  const ambit_host *h = z->host;
  size_t orders = z->K_max + 1u, columns = z->m + (size_t)z->nx;
  p->dense_mid = h->alloc(h, z->nx * orders * sizeof(double));
  p->dense_rad = h->alloc(h, z->nx * orders * sizeof(double));
  p->dense_column = h->alloc(h, z->nx * columns * orders * sizeof(double));
  return p->dense_mid && p->dense_rad && p->dense_column;
}

static void describe(const zono *z, uint32_t i, uint32_t k, uint32_t order, uint32_t columns) {
  const proof *p = z->proof;
  const shape *s = &z->shape;
  const double *row = row_at(z, slot_x(z, i), k);
  double mid = row[0], rad = row_x(s, row) + row_c(s, row), *column = p->dense_column + (size_t)i * columns * order;
  for (uint32_t v = 0; v < columns; v++)
    column[(size_t)v * order + k] = v < s->m ? row[1 + v] : row_r(s, row) > 0 ? row[s->eps + v - s->m] : 0;
  for (uint32_t a = 0; a < s->m; a++)
    for (uint32_t b = a; b < s->reach[a] && row_q(s, row) > 0; b++) {
      double c = row[s->pair[a] + b - a];
      if (a == b) mid += 0.5 * c;
      rad += a == b ? 0.5 * fabs(c) : fabs(c);
    }
  p->dense_mid[(size_t)i * order + k] = mid;
  p->dense_rad[(size_t)i * order + k] = rad * ABOVE + 2 * (s->m + 4) * UNIT * row_total(s, row) + LEAST;
}

void zono_describe_dense(zono *z, ambit_record *r) {
  proof *p = z->proof;
  uint32_t order = z->K + 1, columns = z->m + z->nx;
  memset(p->dense_mid, 0, (size_t)z->nx * order * sizeof(double));
  memset(p->dense_rad, 0, (size_t)z->nx * order * sizeof(double));
  memset(p->dense_column, 0, (size_t)z->nx * columns * order * sizeof(double));
  for (uint32_t i = 0; i < z->nx; i++) {
    uint32_t out = slot_out(z)[i];
    for (uint32_t k = 0; k < orders(z, slot_x(z, i)); k++) describe(z, i, k, order, columns);
    p->dense_rad[(size_t)i * order] += (p->zeta[i] + z->h_error * (p->high[out] + p->delta[out])) * ABOVE;
  }
  r->ndense = r->ncoef_column = order;
  r->ncolumn = columns;
  r->dense_mid = p->dense_mid, r->dense_rad = p->dense_rad, r->dense_column = p->dense_column;
}
