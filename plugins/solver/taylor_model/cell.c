/* cell.c -- polynomials with a radius: sums and products, and what rounding and truncation add to the radius. */
#include "polynomial.h"
#include <string.h>

#define ULP 0x1p-52 /* of one operation in upward mode, relative */

void cell_clear(const space *s, cell x) {
  memset(x.c, 0, s->stride * sizeof(double));
  x.info[TOP] = -1;
}

/* norms by degree; coefficients behind a row's length are cleared */
static void measure(const space *s, cell x) {
  if (s->nrow == 1) {
    double *c = x.c + s->row[0].at;
    for (size_t j = s->row[0].length; j < s->degrees; j++) c[j] = 0;
    for (size_t j = 0; j < s->degrees; j++) x.deg[j] = fabs(c[j]);
    return;
  }
  memset(x.deg, 0, s->degrees * sizeof(double));
  for (uint32_t r = 0; r < s->nrow; r++) {
    const row *w = &s->row[r];
    double *c = x.c + w->at, *deg = x.deg + w->degree;
    for (uint32_t j = 0; j < w->length; j++) deg[j] += fabs(c[j]);
    for (uint32_t j = w->length; j < 4 * w->groups; j++) c[j] = 0;
  }
}

void cell_finish(const space *s, cell x, double rad) {
  measure(s, x);
  double rest = 0;
  int top = -1;
  x.suf[0] = 0;
  for (uint32_t j = 1; j <= s->d; j++) {
    double deg = x.deg[s->d + 1 - j];
    rest += deg;
    x.suf[j] = rest;
    if (top < 0 && deg != 0) top = (int)(s->d + 1 - j); /* NaN too */
  }
  if (top < 0 && x.deg[0] != 0) top = 0;
  x.info[NORM] = rest + x.deg[0];
  x.info[RAD] = rad;
  x.info[TOP] = top;
}

void cell_constant(const space *s, cell x, double mid, double rad) {
  cell_clear(s, x);
  x.c[s->row[0].at] = mid;
  x.deg[0] = fabs(mid);
  x.info[NORM] = fabs(mid);
  x.info[RAD] = rad;
  x.info[TOP] = mid != 0 ? 0 : -1;
}

void cell_copy(const space *s, cell to, cell from) { memcpy(to.c, from.c, s->stride * sizeof(double)); }

void cell_add(const space *s, cell to, cell a, cell b, double sign) {
  for (size_t j = 0; j < s->size; j += 4)
    *(four *)(to.c + j) = *(const four *)(a.c + j) + sign * *(const four *)(b.c + j);
  double rad = cell_rad(a) + cell_rad(b);
  cell_finish(s, to, rad);
  to.info[RAD] += ULP * cell_norm(to); /* zero plus zero is exact, and sums never underflow */
}

void cell_scale(const space *s, cell to, cell a, double factor) {
  double rad = fabs(factor) * cell_rad(a), size = fabs(factor) * cell_norm(a);
  for (size_t j = 0; j < s->size; j += 4) *(four *)(to.c + j) = factor * *(const four *)(a.c + j);
  cell_finish(s, to, rad + ULP * size + (size > 0 ? TINY : 0));
}

void cell_euler(const space *s, cell to, cell a) {
  for (uint32_t r = 0; r < s->nrow; r++) {
    const row *w = &s->row[r];
    for (uint32_t j = 0; j < w->length; j++) to.c[w->at + j] = (double)(w->degree + j) * a.c[w->at + j];
    for (uint32_t j = 0; j < 4; j++) to.c[w->at - 4 + j] = 0;
  }
  cell_finish(s, to, 0);
}

/* -- sums of products */

void sum_clear(const space *s, sum *x) {
  memset(x->c, 0, s->size * sizeof(double));
  x->cut = x->rad = x->weight = 0;
  x->count = 0;
}

void sum_add(const space *s, sum *x, double factor, cell a, cell b) {
  const series_part one = { a.c, b.c, 0, 0, 0, 0, factor };
  s->convolve(s, x, &one);
}

/* Each coefficient is a sum of at most terms * count products, each rounded twice; for the factor of sum_take one
** rounding more. Products that underflow: TINY. */
double sum_rounding(const space *s, const sum *x) {
  return gamma_of((double)s->terms * x->count + 4) * x->weight + (x->weight > 0 ? TINY : 0);
}

void sum_take(const space *s, const sum *x, double factor, cell to) {
  double rad = fabs(factor) * ((x->cut + x->rad) + sum_rounding(s, x)) + (x->weight > 0 ? TINY : 0);
  for (size_t j = 0; j < s->size; j += 4) *(four *)(to.c + j) = factor * *(const four *)(x->c + j);
  cell_finish(s, to, rad);
}
