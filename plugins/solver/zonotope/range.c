/* range.c -- bounds of the set at the end of a step, and of the states over the step. */
#include "proof.h"

/* l v + d v^2 over [-1, 1] */
static void add_square(double l, double d, double *lo, double *hi) {
  double a = d + l, b = d - l, low = fmin(a, b), high = fmax(a, b);
  if (2 * fabs(d) > fabs(l)) {
    double top = -l * l / (4 * d);
    low = fmin(low, top), high = fmax(high, top);
  }
  *lo += low, *hi += high;
}

/* of a row without eps, +- rest */
static void row_range(const shape *s, const double *x, double rest, double *lo, double *hi) {
  double low = x[0], high = x[0], cross = rest, size = rest + row_total(s, x);
  for (uint32_t i = 0; i < s->m; i++) {
    uint32_t n = s->reach[i] > i ? s->reach[i] - i : 0;
    const double *pair = x + s->pair[i];
    add_square(x[1 + i], n ? pair[0] : 0, &low, &high);
    for (uint32_t j = 1; j < n; j++) cross += fabs(pair[j]);
  }
  cross = cross * ABOVE + (2 * s->m + 16) * 2 * UNIT * size + LEAST;
  *lo = low - cross, *hi = high + cross;
}

void zono_hull(zono *z) {
  for (uint32_t i = 0; i < z->nx; i++)
    row_range(&z->shape, z->P + (size_t)i * z->shape.stride, z->E[i], &z->lo[i], &z->hi[i]);
}

void zono_tube(zono *z) {
  const proof *p = z->proof;
  const forms *f = &p->forms.forms;
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *x = proof_form(&p->forms, p->forms.value, slot_x(z, i));
    double more = p->zeta[i];
    if (z->h_error > 0) more += z->h_error * (p->high[slot_out(z)[i]] + p->delta[slot_out(z)[i]]);
    double rest = (form_moving(f, x) + more) * ABOVE + 4 * UNIT * form_total(f, x) + LEAST;
    z->tube_lo[i] = x[0] - rest, z->tube_hi[i] = x[0] + rest;
  }
}
