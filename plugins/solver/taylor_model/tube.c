/* tube.c -- where states are during a step, from the polynomials.
**
** x(t) = y(t; xi) + e(t) + J(t) z, y polynomials. Between nodes d apart, y is off its linear interpolation by
** d^2 / 8 max |y''| at most, and that lies between the bounds of y at the nodes. proof.c bounds the tube by series over
** boxes, which forget that all states depend on the same xi: worse over long steps and with many unknowns, better where
** one unknown is cut into many sub-ranges. Both hold.
*/
#include "flow.h"

#define PARTS 8

/* >= |y''| over the step */
static double bend(const worker *w, uint32_t i) {
  uint32_t order = w->flow->options.time_order, slot = w->flow->problem.rhs->nconst + i;
  double H = w->step.length, power = 1, sum = 0;
  for (uint32_t k = 2; k <= order; k++, power *= H)
    sum += (double)k * (k - 1.0) * cell_norm(series_cell(w->series, slot, k)) * power;
  return sum;
}

/* >= |e + J z| during the step, over all sub-ranges */
static double rest(const worker *w, const piece *p, uint32_t i) {
  uint32_t nx = w->flow->nx;
  double most = 0;
  for (uint32_t n = 0; n < w->flow->ngroup[p->level]; n++)
    most = larger(most, w->apart[(size_t)n * nx + i] + w->reach[(size_t)n * nx + i]);
  return most;
}

void flow_narrow_tube(worker *w, const piece *p) {
  const flow *f = w->flow;
  double apart = w->step.length / PARTS * (1 + 0x1p-40); /* of the nodes, whatever h j / PARTS is rounded to */
  for (uint32_t i = 0; i < f->nx; i++) {
    double off = rest(w, p, i) + 0.125 * apart * apart * bend(w, i), lo = INFINITY, hi = -INFINITY;
    for (uint32_t j = 0; j <= PARTS; j++) {
      span t = { w->step.h * j / PARTS, w->step.error, 0 };
      t.length = fabs(t.h) + t.error;
      double low, high, error = flow_evaluate(w, &t, i, w->q);
      polynomial_bounds(&f->space, w->q, &low, &high);
      lo = smaller(lo, -(error - low)), hi = larger(hi, high + error);
    }
    w->tube_lo[i] = larger(w->tube_lo[i], -(off - lo));
    w->tube_hi[i] = smaller(w->tube_hi[i], hi + off);
  }
}
