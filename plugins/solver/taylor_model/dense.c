/* dense.c -- the last step as polynomials in time with interval coefficients, and the set at its end as polynomials in
** the unknowns, for records that ask for them. Only while there is one piece. */
#include "flow.h"
#include <string.h>

void flow_describe(flow *f, const worker *w) {
  uint32_t order = f->options.time_order;
  for (uint32_t i = 0; i < f->nx; i++) {
    double rest = 0;
    for (uint32_t n = 0; n < w->groups; n++)
      rest = larger(rest, w->reach[(size_t)n * f->nx + i] + w->apart[(size_t)n * f->nx + i]);
    for (uint32_t k = 0; k <= order; k++) {
      cell c = series_cell(w->series, f->problem.rhs->nconst + i, k);
      double low, high, *mid = f->dense_mid + (size_t)i * (order + 1u) + k;
      polynomial_bounds(&f->space, c.c, &low, &high);
      *mid = 0.5 * (low + high);
      f->dense_rad[(size_t)i * (order + 1u) + k] = larger(high - *mid, *mid - low) + (k ? 0 : rest);
    }
  }
}

/* terms in unknowns of this solver alone go to the rest */
const ambit_set *flow_describe_set(flow *f, const piece *p) {
  const space *s = &f->space;
  uint32_t nu = f->problem.nu, terms = f->set.nterm, at = 0;
  for (uint32_t i = 0; i < f->nx; i++) {
    f->rest[i] = 0;
    for (uint32_t n = 0; n < f->ns; n++)
      f->rest[i] = larger(f->rest[i], zonotope_at(&f->worker[0].shape, p->zonotope, n).sum[i]);
  }
  for (uint32_t r = 0; r < s->nrow; r++) {
    int own = 0;
    for (uint32_t v = nu > 0 ? nu : 1; v < s->m; v++) own |= s->exponent[(size_t)r * s->m + v] != 0;
    for (uint32_t j = 0; j < s->row[r].length; j++) {
      int lost = own || (nu == 0 && j > 0);
      for (uint32_t i = 0; i < f->nx; i++) {
        double c = p->x[i * s->size + s->row[r].at + j];
        if (lost)
          f->rest[i] += fabs(c);
        else
          f->coefficient[(size_t)i * terms + at] = c;
      }
      at += !lost;
    }
  }
  return &f->set;
}
