/* residual.c -- the residual ranking: Mikelsons and Brandt 2009, equation 11.
**
** Along a reference F = x' - f(x, t) is zero, so F^k = f - f^k is what the candidate changes. Each row is divided by
** the scale of its state: the rows are then rates relative to how much the states vary, in 1/s, and metres or
** millimetres, newtons or rates of angles decide nothing. Over time the norm is the root mean square (or the maximum),
** over several references the maximum.
*/
#include "reduce.h"
#include <math.h>
#include <string.h>

/* A state that stays at 0 has no scale of its own: what the greatest change of its rate makes of it in that time. */
void residual_settle_scales(reducer *s) {
  const ambit_reduction *r = &s->r;
  memcpy(s->scale, r->scale, s->nx * sizeof *s->scale);
  for (uint32_t k = 0; k < r->nreference; k++) {
    const ambit_reference *at = &r->reference[k];
    double span = at->ntime > 1 ? at->time[at->ntime - 1] - at->time[0] : 1;
    for (uint32_t j = 0; j < at->ntime; j += s->width) {
      uint32_t count = at->ntime - j < s->width ? at->ntime - j : s->width;
      table_load(&s->effect, at->in + (size_t)j * r->nin, count);
      for (size_t m = 0; m < (size_t)count * r->neffect; m++) {
        uint32_t i = r->effect_state[m % r->neffect];
        double change = fabs(s->effect.value[m]) * span;
        if (!(r->scale[i] > 0) && isfinite(change)) s->scale[i] = fmax(s->scale[i], change);
      }
    }
  }
  for (uint32_t i = 0; i < s->nx; i++)
    if (!(s->scale[i] > 0)) s->scale[i] = 1;
}

/* part of the reference's time that node j stands for: the trapezoidal rule */
static double share(const ambit_reference *at, uint32_t j) {
  if (at->ntime == 1) return 1;
  double before = j ? at->time[j] - at->time[j - 1] : 0;
  double after = j + 1 < at->ntime ? at->time[j + 1] - at->time[j] : 0;
  return 0.5 * (before + after) / (at->time[at->ntime - 1] - at->time[0]);
}

/* sum [ncandidate] := squares of the relative residual at one node */
static void square(reducer *s, const double *effect) {
  const ambit_reduction *r = &s->r;
  memset(s->sum, 0, r->ncandidate * sizeof *s->sum);
  for (uint32_t m = 0; m < r->neffect; m++) {
    double relative = effect[m] / s->scale[r->effect_state[m]];
    s->sum[r->effect_candidate[m]] += relative * relative;
  }
}

/* own [ncandidate] := norm over the nodes of one reference, squared */
static void add_nodes(reducer *s, const ambit_reference *at, double *own) {
  const ambit_reduction *r = &s->r;
  memset(own, 0, r->ncandidate * sizeof *own);
  for (uint32_t j = 0; j < at->ntime; j += s->width) {
    uint32_t count = at->ntime - j < s->width ? at->ntime - j : s->width;
    table_load(&s->effect, at->in + (size_t)j * r->nin, count);
    for (uint32_t l = 0; l < count; l++) {
      square(s, table_at(&s->effect, l));
      double part = share(at, j + l);
      for (uint32_t k = 0; k < r->ncandidate; k++) {
        if (s->options.norm == NORM_RMS)
          own[k] += part * s->sum[k];
        else if (!(s->sum[k] <= own[k]))
          own[k] = s->sum[k]; /* NaN comes through, and stays */
      }
    }
  }
}

void residual_rank(reducer *s) {
  const ambit_reduction *r = &s->r;
  double *value = s->value[AMBIT_RANK_RESIDUAL];
  for (uint32_t i = 0; i < r->nreference; i++) {
    add_nodes(s, &r->reference[i], s->own);
    for (uint32_t k = 0; k < r->ncandidate; k++) {
      double norm = isfinite(s->own[k]) ? sqrt(s->own[k]) : INFINITY;
      if (norm > value[k]) value[k] = norm;
    }
  }
}
