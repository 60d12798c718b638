/* origin.c -- the initial set and the parameters as functions of the unknowns.
**
** u = u_c + r xi, r rounded up. The tape of the initial values is evaluated at u_c and its slopes over the box:
** x(t0) = x(u_c) + sum_j s_j r_j xi_j; the midpoints are coefficients of P, the rest is a box. Where there are no
** bounded slopes, all is box.
*/
#include "valencia.h"

static uint32_t evaluate(valencia *s, ambit_lane *lane, int only_middle, double *lo, double *hi) {
  const ambit_problem *p = &s->problem;
  for (uint32_t j = 0; j < s->nu; j++) {
    interval u = only_middle ? point(s->set_about[j]) : (interval) { p->u_lo[j], p->u_hi[j] };
    lane->arithmetic->set(lane->ctx, ambit_lane_at(lane, lane->tape->nconst + j), 1, &u.lo, &u.hi, (int32_t)j);
  }
  uint32_t flags = ambit_lane_run(lane);
  ambit_lane_slots(lane, flags, lo, hi);
  return flags & (AMBIT_F_PARTIAL | AMBIT_F_EMPTY | AMBIT_F_UNBOUNDED);
}

static void find_unknowns(valencia *s) {
  const ambit_problem *p = &s->problem;
  for (uint32_t j = 0; j < s->nu; j++) {
    double mid = middle((interval) { p->u_lo[j], p->u_hi[j] });
    s->set_about[j] = mid, s->set_scale[j] = larger(p->u_hi[j] - mid, mid - p->u_lo[j]);
  }
}

static double *row_of(valencia *s, uint32_t i, double **constant, double **rest) {
  if (i < s->nx) {
    *constant = s->p + (size_t)i * s->terms.n, *rest = s->w + i;
    return *constant + 1;
  }
  *constant = s->middle + (i - s->nx), *rest = s->loose + (i - s->nx);
  return s->reach + (size_t)(i - s->nx) * s->nu;
}

uint32_t valencia_origin(valencia *s, ambit_lane *initial, interval *range, interval *slope) {
  const ambit_tape *t = initial->tape;
  double *lo = (double *)(void *)range, *hi = lo + t->nslot, *low = s->scratch, *high = low + s->nx + s->np;
  find_unknowns(s);
  uint32_t flags = evaluate(s, initial, 1, lo, hi);
  for (uint32_t i = 0; i < t->nout; i++) low[i] = lo[t->out[i]], high[i] = hi[t->out[i]];
  flags |= evaluate(s, initial, 0, lo, hi);
  int has_slopes = valencia_slopes(s->num, t, s->nu, lo, hi, slope);
  for (uint32_t i = 0; i < t->nout; i++) {
    double *constant, *rest;
    double *row = row_of(s, i, &constant, &rest);
    interval x = has_slopes ? (interval) { low[i], high[i] } : (interval) { lo[t->out[i]], hi[t->out[i]] };
    *constant = middle(x);
    *rest = larger_or_nan(x.hi - *constant, *constant - x.lo);
    for (uint32_t j = 0; j < s->nu && has_slopes; j++) {
      interval by = scaled(slope[(size_t)t->out[i] * s->nu + j], s->set_scale[j]);
      row[j] = middle(by);
      *rest += larger_or_nan(by.hi - row[j], row[j] - by.lo);
    }
  }
  for (uint32_t i = 0; i < s->nx; i++) s->b[(size_t)i * s->nx + i] = 1;
  for (uint32_t j = 0; j < s->nu; j++)
    if (!(s->set_scale[j] > 0)) s->set_scale[j] = 1;
  return flags;
}
