/* dual.c -- what rankings by transposed systems share: effects weighted by what a change of each rate does. */
#include "reduce.h"
#include <math.h>
#include <string.h>

int dual_open(reducer *s, uint32_t stride) {
  duals *d = &s->duals;
  size_t square = (size_t)s->nx * s->nx, columns = (size_t)s->nx * stride;
  d->stride = stride;
  d->row = reduce_room(s, s->nx, sizeof *d->row);
  d->matrix = reduce_room(s, square, sizeof(double));
  d->later_J = reduce_room(s, square, sizeof(double));
  d->later_effect = reduce_room(s, s->r.neffect, sizeof(double));
  d->total = reduce_room(s, (size_t)s->r.ncandidate * stride, sizeof(double));
  double **const array[] = { &d->x, &d->once, &d->twice, &d->scratch, &d->weight };
  int good = d->row && d->matrix && d->later_J && d->later_effect && d->total;
  for (size_t i = 0; i < sizeof array / sizeof *array; i++)
    good = (*array[i] = reduce_room(s, columns, sizeof(double))) != NULL && good;
  return good;
}

void dual_clear(reducer *s) { memset(s->duals.total, 0, (size_t)s->r.ncandidate * s->duals.stride * sizeof(double)); }

void dual_add(reducer *s, const double *effect, uint32_t count) {
  const ambit_reduction *r = &s->r;
  const duals *d = &s->duals;
  for (uint32_t m = 0; m < r->neffect; m++) {
    if (effect[m] == 0) continue;
    const double *weight = d->weight + (size_t)r->effect_state[m] * d->stride;
    double *total = d->total + (size_t)r->effect_candidate[m] * d->stride;
    for (uint32_t c = 0; c < count; c++) total[c] += effect[m] * weight[c];
  }
}

void dual_raise(reducer *s, double *value, uint32_t count) {
  for (uint32_t k = 0; k < s->r.ncandidate; k++)
    for (uint32_t c = 0; c < count; c++) {
      double size = fabs(s->duals.total[(size_t)k * s->duals.stride + c]);
      if (!(size <= value[k])) value[k] = isfinite(size) ? size : INFINITY;
    }
}
