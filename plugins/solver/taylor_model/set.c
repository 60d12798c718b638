/* set.c -- bounds of a piece: the box of each of its sub-ranges, and the hull of all of them. */
#include "flow.h"

#define TOLERANCE 4e-4 /* of the hull, relative to its width */

void flow_boxes(worker *w, piece *p) {
  flow *f = w->flow;
  const space *s = &f->space;
  uint32_t nb = f->nx + f->np;
  for (uint32_t n = 0; n < f->ns; n++) {
    const double *about = f->sub_about + (size_t)n * f->m;
    zonotope z = zonotope_at(&w->shape, p->zonotope, n);
    for (uint32_t i = 0; i < nb; i++) {
      const double *c = i < f->nx ? p->x + i * s->size : p->p + (i - f->nx) * s->size;
      double low, high, error = polynomial_restrict(s, c, about, f->sub_reach, w->q);
      double rest = i < f->nx ? z.sum[i] : p->parameter_rad[i - f->nx];
      polynomial_bounds(s, w->q, &low, &high);
      size_t at = (size_t)n * nb + i;
      p->mid[at] = 0.5 * (low + high);
      p->rad[at] = larger(high - p->mid[at], p->mid[at] - low) + (error + rest);
    }
  }
}

/* from the boxes of the sub-ranges */
static void box_hull(const flow *f, const piece *p, uint32_t i, double *lo, double *hi) {
  *lo = INFINITY, *hi = -INFINITY;
  for (uint32_t n = 0; n < f->ns; n++) {
    size_t at = (size_t)n * (f->nx + f->np) + i;
    *lo = smaller(*lo, -(p->rad[at] - p->mid[at]));
    *hi = larger(*hi, p->mid[at] + p->rad[at]);
  }
}

/* remainders that differ by less than the tolerance are taken as one, over the whole piece */
static double highest(worker *w, const piece *p, uint32_t i, double sign, double tolerance) {
  const flow *f = w->flow;
  double most = 0, least = INFINITY;
  search_begin(&w->search, p->x + i * f->space.size, sign);
  for (uint32_t n = 0; n < f->ns; n++) {
    double rest = zonotope_at(&w->shape, p->zonotope, n).sum[i];
    most = larger(most, rest), least = smaller(least, rest);
  }
  if (most - least <= tolerance)
    search_add(&w->search, f->middle, f->whole, most);
  else
    for (uint32_t n = 0; n < f->ns; n++)
      search_add(
          &w->search, f->sub_about + (size_t)n * f->m, f->sub_reach, zonotope_at(&w->shape, p->zonotope, n).sum[i]);
  return search_maximum(&w->search, tolerance, 0);
}

void flow_hull(worker *w, piece *p) {
  for (uint32_t i = 0; i < w->flow->nx; i++) {
    double lo, hi;
    box_hull(w->flow, p, i, &lo, &hi);
    double tolerance = TOLERANCE * (hi - lo);
    p->hi[i] = smaller(hi, highest(w, p, i, 1, tolerance));
    p->lo[i] = larger(lo, -highest(w, p, i, -1, tolerance));
  }
}
