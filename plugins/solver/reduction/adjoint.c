/* adjoint.c -- the effect of each candidate on the outputs to first order, by the adjoint equation.
**
** Cutting candidate k changes x by d with d' = J d + g, d(0) = 0, g = f^k - f along the reference, up to terms of
** second order. For the output y = C x at time T: y(T) changes by the integral of lambda . g over [0, T], where
** lambda' = -J^T lambda runs backwards from lambda(T) = C(T)^T: one solution serves all candidates. What counts is the
** greatest change over all times, so there are `ends` times T, spread over the nodes; their solutions run together.
**
** Steps are those of Alexander's L-stable method SDIRK2 (SIAM J. Numer. Anal. 14, 1977), which damps what decays fast
** against the nodes' distance and keeps the quasi-stationary rest; J is the mean over the step, g runs linearly. The
** adjoint is that of the discrete steps (Hager, Numer. Math. 87, 2000): with A = (I - gamma h J)^-1, u = A^T w and
** v = A^T u, the functional w . d(t + h) is
**   (u + (1 - gamma)/gamma (v - u)) . d(t) + gamma h u . g(t + h) + (1 - gamma) h v . g(t + gamma h).
*/
#include "reduce.h"
#include <math.h>
#include <string.h>

#define GAMMA 0.29289321881345248 /* 1 - 1/sqrt 2 */

/* the node at which the functionals number e end, the last first */
static uint32_t end_node(const ambit_reference *at, uint32_t ends, uint32_t e) {
  return (uint32_t)((uint64_t)(at->ntime - 1) * (ends - e) / ends);
}

static void form_matrix(reducer *s, double h, const double *J) {
  double *M = s->duals.matrix;
  for (size_t i = 0; i < (size_t)s->nx * s->nx; i++) M[i] = -0.5 * GAMMA * h * (J[i] + s->duals.later_J[i]);
  for (uint32_t i = 0; i < s->nx; i++) M[(size_t)i * s->nx + i] += 1;
  factor_decompose(s->nx, M, s->duals.row);
}

/* x := that at the node before; adds the effects of the node behind, whose weight is complete then */
static void step_back(reducer *s, double h, const double *J, uint32_t count) {
  duals *d = &s->duals;
  form_matrix(s, h, J);
  factor_solve_transposed(s->nx, d, count, d->x, d->once);
  factor_solve_transposed(s->nx, d, count, d->once, d->twice);
  for (uint32_t i = 0; i < s->nx; i++) {
    double *x = d->x + (size_t)i * d->stride, *weight = d->weight + (size_t)i * d->stride;
    const double *u = d->once + (size_t)i * d->stride, *v = d->twice + (size_t)i * d->stride;
    for (uint32_t c = 0; c < count; c++) {
      weight[c] += h * GAMMA * (u[c] + (1 - GAMMA) * v[c]);
      x[c] = u[c] + (1 - GAMMA) / GAMMA * (v[c] - u[c]);
    }
  }
  dual_add(s, d->later_effect, count);
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t c = 0; c < count; c++)
      d->weight[(size_t)i * d->stride + c] = h * (1 - GAMMA) * (1 - GAMMA) * d->twice[(size_t)i * d->stride + c];
}

/* functionals [count, count + noutput) begin at a node */
static void begin(reducer *s, const double *C, uint32_t count) {
  duals *d = &s->duals;
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t o = 0; o < s->r.noutput; o++) {
      d->x[(size_t)i * d->stride + count + o] = C[(size_t)o * s->nx + i] / s->r.bound[o];
      d->weight[(size_t)i * d->stride + count + o] = 0;
    }
}

/* where the way back along a reference is */
typedef struct way {
  const ambit_reference *at;
  uint32_t ends, begun; /* functionals' ends: all, those behind */
} way;

static void visit(reducer *s, way *w, uint32_t j, uint32_t lane) {
  const ambit_reduction *r = &s->r;
  duals *d = &s->duals;
  const double *J = s->J + (size_t)lane * s->nx * s->nx;
  if (w->begun) step_back(s, w->at->time[j + 1] - w->at->time[j], J, w->begun * r->noutput);
  while (w->begun < w->ends && end_node(w->at, w->ends, w->begun) == j)
    begin(s, s->C + (size_t)lane * r->noutput * s->nx, w->begun++ * r->noutput);
  memcpy(d->later_J, J, (size_t)s->nx * s->nx * sizeof *J);
  memcpy(d->later_effect, table_at(&s->effect, lane), r->neffect * sizeof(double));
}

static void walk_back(reducer *s, const ambit_reference *at) {
  uint32_t ends = s->options.ends < at->ntime - 1 ? s->options.ends : at->ntime - 1;
  way w = { at, ends, 0 };
  for (uint32_t behind = at->ntime; behind > 0;) {
    uint32_t count = behind < s->width ? behind : s->width, first = behind - count;
    slope_load(s, at, first, count);
    table_load(&s->effect, at->in + (size_t)first * s->r.nin, count);
    for (uint32_t l = count; l-- > 0;) visit(s, &w, first + l, l);
    behind = first;
  }
  dual_add(s, s->duals.later_effect, ends * s->r.noutput); /* of the first node */
  dual_raise(s, s->value[AMBIT_RANK_ADJOINT], ends * s->r.noutput);
}

void adjoint_rank(reducer *s) {
  for (uint32_t k = 0; k < s->r.nreference; k++) {
    if (s->r.reference[k].ntime < 2) continue;
    dual_clear(s);
    walk_back(s, &s->r.reference[k]);
  }
}
