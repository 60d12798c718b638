/* size.c -- how large a state counts as, where tolerances are relative: guesses, which no proof rests on.
**
** A state is as large as it is, or as a term of its series is at the end of the step: one that starts at zero may begin
** to move by a high derivative. One that stays at zero must not ask for exactness: it counts as a small part of what
** the others could make of it in the time in which some state changes by its own size. Nothing here compares states,
** whose units may differ, but by the derivatives of the equations.
*/
#include "flow.h"
#include <string.h>

#define NEGLIGIBLE 1e-6 /* of what others make of a state */
#define HANDED_ON 16    /* times a size goes from one state to the next */

/* |df/dx| over the box of the whole piece, row by row; zeros where it is not bounded */
void flow_find_rates(worker *w, const piece *p) {
  flow *f = w->flow;
  uint32_t nx = f->nx, nb = nx + f->np;
  memset(w->rate, 0, (size_t)nx * nx * sizeof(double));
  memset(w->seed, 0, nx * sizeof(double));
  for (uint32_t i = 0; i < nb; i++) {
    const double *c = i < nx ? p->x + i * f->space.size : p->p + (i - nx) * f->space.size;
    double mid = c[f->space.row[0].at], rad = polynomial_norm(&f->space, c) - fabs(mid);
    if (i < nx) w->seed[i] = 1;
    f->jet->put(w->near, i, 0, mid, larger(rad, 0), i < nx ? w->seed : w->zero, w->zero);
    if (i < nx) w->seed[i] = 0;
  }
  if (f->problem.uses_time) f->jet->put(w->near, nb, 0, p->t, 0, NULL, NULL);
  if (f->jet->advance(w->near, 0)) return;
  for (uint32_t i = 0; i < nx; i++) {
    double mid, rad, *row = w->rate + (size_t)i * nx;
    f->jet->get(w->near, f->problem.rhs->out[i], 0, &mid, &rad, w->seed, row);
    for (uint32_t j = 0; j < nx; j++) row[j] += fabs(w->seed[j]);
  }
}

static double norm_of(const worker *w, uint32_t i, uint32_t k) {
  return cell_norm(series_cell(w->series, w->flow->problem.rhs->nconst + i, k));
}

/* in which some state changes by its own size, or two exchange theirs; at least the step */
static double natural_time(const worker *w) {
  uint32_t nx = w->flow->nx;
  double least = INFINITY;
  for (uint32_t i = 0; i < nx; i++) {
    double size = norm_of(w, i, 0), first = norm_of(w, i, 1), second = norm_of(w, i, 2);
    if (size > 0) least = smaller(least, smaller(size / first, sqrt(size / second)));
    for (uint32_t j = 0; j <= i; j++)
      least = smaller(least, 1 / sqrt(w->rate[(size_t)i * nx + j] * w->rate[(size_t)j * nx + i]));
  }
  return least < INFINITY ? larger(least, w->step.length) : w->step.length;
}

/* what has a size hands a share of it on, until no state is reached that had none */
static void fill(const worker *w, double *size) {
  uint32_t nx = w->flow->nx;
  double share = NEGLIGIBLE * natural_time(w), least = INFINITY;
  int more = 1;
  for (uint32_t sweep = 0; sweep < nx && more; sweep++) {
    more = 0;
    for (uint32_t i = 0; i < nx; i++) {
      double sum = 0;
      for (uint32_t j = 0; j < nx; j++) sum += share * w->rate[(size_t)i * nx + j] * size[j];
      if (!(sum > size[i] && sum < INFINITY)) continue;
      more |= size[i] == TINY;
      size[i] = sum;
    }
  }
  for (uint32_t i = 0; i < nx; i++)
    if (size[i] > TINY) least = smaller(least, size[i]);
  for (uint32_t i = 0; i < nx && least < INFINITY; i++) /* reached by second derivatives at most */
    if (size[i] == TINY) size[i] = NEGLIGIBLE * least;
}

void flow_find_units(const worker *w, double *unit) {
  uint32_t nx = w->flow->nx;
  double time = natural_time(w), *next = w->scratch;
  memcpy(unit, w->size, nx * sizeof *unit);
  for (uint32_t round = 0; round < nx && round < HANDED_ON; round++) {
    for (uint32_t i = 0; i < nx; i++) {
      next[i] = unit[i];
      for (uint32_t j = 0; j < nx; j++) next[i] += time * w->rate[(size_t)i * nx + j] * unit[j];
      next[i] = next[i] < INFINITY ? next[i] : unit[i];
    }
    memcpy(unit, next, nx * sizeof *unit);
  }
}

void flow_find_sizes(const worker *w, double *size) {
  for (uint32_t i = 0; i < w->flow->nx; i++) {
    double power = 1;
    size[i] = TINY;
    for (uint32_t k = 0; k <= w->flow->options.time_order; k++, power *= w->step.length)
      size[i] = larger(size[i], norm_of(w, i, k) * power);
  }
  fill(w, size);
}
