/* kink.c -- which operation of the right-hand side is not smooth where a piece could not go on: no proof, only a name
** for the reason.
**
** |a| has its kink at a = 0, min and max of a and b at a = b. Either the series found that the set reaches one, or
** steps shrink to nothing before one: then the values at the start of the step are close, at the rates there.
*/
#include "flow.h"

#define NEAR 0x1p-20 /* of the run's time at the present rate */

/* bounds of order k of what is zero at the kink of instruction i */
static void distance(const worker *w, uint32_t i, uint32_t k, double *mid, double *rad) {
  const ambit_tape *t = w->flow->problem.rhs;
  double b = 0, more = 0;
  w->flow->jet->get(w->jet, t->a[i], k, mid, rad, NULL, NULL);
  if (t->op[i] != AMBIT_OP_ABS) w->flow->jet->get(w->jet, t->b[i], k, &b, &more, NULL, NULL);
  *mid -= b, *rad += more;
}

static int is_near(const worker *w, uint32_t i) {
  const double *time = w->flow->problem.time;
  double mid, rad, rate, change, span = fabs(time[w->flow->problem.ntime - 1] - time[0]);
  distance(w, i, 0, &mid, &rad), distance(w, i, 1, &rate, &change);
  return fabs(mid) - rad <= NEAR * span * (fabs(rate) + change);
}

const char *flow_kink(const worker *w) {
  const ambit_tape *t = w->flow->problem.rhs;
  if (!t->kink) return NULL;
  if (w->series->kink) return t->kink[w->series->kink - 1u];
  for (uint32_t i = 0; i < t->ninstr; i++)
    if (t->kink[i] && is_near(w, i)) return t->kink[i];
  return NULL;
}
