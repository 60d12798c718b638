/* range.c -- bounds of the set at the end of a step, and of the states over the step.
**
** The highest value of a polynomial of degree 2 over the cube: a datum in which it is monotone over what is left of the
** cube is put to its end, which changes the linear parts of the others; again and again. What is left: linear and
** square terms of each datum exactly, terms of two data by size. Terms of degree 3 by size throughout.
*/
#include "proof.h"
#include "strip.h"

/* coefficient of xi_i xi_j */
static double pair_of(const shape *s, const double *x, uint32_t i, uint32_t j) {
  uint32_t low = i < j ? i : j, high = i < j ? j : i;
  return high < s->reach[low] ? x[s->pair[low] + high - low] : 0;
}

/* highest l v + d v^2 over [-1, 1] */
static double parabola(double l, double d) {
  double top = d + fabs(l);
  return d < 0 && -2 * d > fabs(l) ? l * l / (-4 * d) : top;
}

/* what terms with other free data may add to the slope in xi_i */
static double others(const shape *s, const double *x, uint32_t i, const double *is_free) {
  double sum = 0;
  for (uint32_t j = 0; j < s->m; j++)
    if (j != i && is_free[j] != 0) sum += fabs(pair_of(s, x, i, j));
  return sum;
}

/* of sign times a row without eps, but for rounding; l, is_free [m]: scratch */
static double highest(const shape *s, const double *x, double sign, double *l, double *is_free) {
  double sum = sign * x[0];
  int changed = 1;
  for (uint32_t i = 0; i < s->m; i++) l[i] = sign * x[1 + i], is_free[i] = 1;
  while (changed) {
    changed = 0;
    for (uint32_t i = 0; i < s->m; i++) {
      double own = sign * pair_of(s, x, i, i);
      if (is_free[i] == 0 || !(fabs(l[i]) > 2 * fabs(own) + others(s, x, i, is_free))) continue;
      double end = l[i] < 0 ? -1 : 1;
      is_free[i] = 0, changed = 1;
      sum += fabs(l[i]) + own;
      for (uint32_t j = 0; j < s->m; j++)
        if (is_free[j] != 0) l[j] += end * sign * pair_of(s, x, i, j);
    }
  }
  for (uint32_t i = 0; i < s->m; i++)
    if (is_free[i] != 0) sum += parabola(l[i], sign * pair_of(s, x, i, i)) + 0.5 * others(s, x, i, is_free);
  return sum;
}

void zono_hull(zono *z) {
  const shape *s = &z->shape;
  double *l = z->proof->range, *is_free = l + s->m;
  for (uint32_t i = 0; i < z->nx; i++) {
    const double *x = z->P + (size_t)i * s->stride;
    double rest = (z->E[i] + row_c(s, x)) * ABOVE + (8.0 * s->m + 32) * UNIT * (row_total(s, x) + z->E[i]) + LEAST;
    z->lo[i] = -highest(s, x, -1, l, is_free) - rest;
    z->hi[i] = highest(s, x, 1, l, is_free) + rest;
  }
  strip_within(z, z->lo, z->hi);
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
  strip_within(z, z->tube_lo, z->tube_hi);
}
