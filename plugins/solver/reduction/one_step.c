/* one_step.c -- the one-step ranking: Mikelsons and Brandt 2009, equation 12.
**
** From node j - 1 of the reference the reduced model makes one step of the implicit Euler method to node j, and
** Newton's iteration for it, started at the reference, makes one step: it moves by d = (I - h J)^-1 h (f^k - f)(x_j),
** with J of the detailed model. The outputs move by C d; relative to their bounds the greatest of these counts. With
** one transposed solution w = (I - h J)^-T h C^T for each output this is a scalar product for each candidate.
*/
#include "reduce.h"
#include <string.h>

static void form_matrix(reducer *s, double h, const double *J) {
  double *M = s->duals.matrix;
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t j = 0; j < s->nx; j++) M[(size_t)i * s->nx + j] = (i == j) - h * J[(size_t)i * s->nx + j];
  factor_decompose(s->nx, M, s->duals.row);
}

static void rank_node(reducer *s, double h, uint32_t lane, double *value) {
  const ambit_reduction *r = &s->r;
  duals *d = &s->duals;
  const double *C = s->C + (size_t)lane * r->noutput * s->nx;
  form_matrix(s, h, s->J + (size_t)lane * s->nx * s->nx);
  for (uint32_t i = 0; i < s->nx; i++)
    for (uint32_t o = 0; o < r->noutput; o++)
      d->x[(size_t)i * d->stride + o] = h * (C[(size_t)o * s->nx + i] / r->bound[o]);
  factor_solve_transposed(s->nx, d, r->noutput, d->x, d->weight);
  dual_clear(s);
  dual_add(s, table_at(&s->effect, lane), r->noutput);
  dual_raise(s, value, r->noutput);
}

void one_step_rank(reducer *s) {
  const ambit_reduction *r = &s->r;
  for (uint32_t k = 0; k < r->nreference; k++) {
    const ambit_reference *at = &r->reference[k];
    for (uint32_t j = 1; j < at->ntime; j += s->width) {
      uint32_t count = at->ntime - j < s->width ? at->ntime - j : s->width;
      slope_load(s, at, j, count);
      table_load(&s->effect, at->in + (size_t)j * r->nin, count);
      for (uint32_t l = 0; l < count; l++)
        rank_node(s, at->time[j + l] - at->time[j + l - 1], l, s->value[AMBIT_RANK_ONE_STEP]);
    }
  }
}
