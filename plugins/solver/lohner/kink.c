/* kink.c -- which operation of the right-hand side is not smooth where a run could not go on: no proof, only a name for
** the reason.
**
** |a| has its kink at a = 0, min and max of a and b at a = b. Series over the set have been tried at the start of the
** step, so values are known at order 0 and rates at order 1. A kink is met if the set's range reaches it; steps that
** shrink to nothing before it show that it is near.
*/
#include "lohner.h"

#define NEAR 0x1p-20 /* of the run's time at the present rate */

typedef struct gap {
  double mid, rad;
} gap;

/* order k of what is zero at the kink of instruction i */
static gap distance(const lohner *s, uint32_t i, uint32_t k) {
  const ambit_tape *t = s->problem.rhs;
  gap a, b = { 0, 0 };
  s->jet->get(s->box_jet, t->a[i], k, &a.mid, &a.rad, NULL, NULL);
  if (t->op[i] != AMBIT_OP_ABS) s->jet->get(s->box_jet, t->b[i], k, &b.mid, &b.rad, NULL, NULL);
  return (gap) { a.mid - b.mid, a.rad + b.rad };
}

static int is_near(const lohner *s, uint32_t i, int met) {
  const double *time = s->problem.time;
  gap at = distance(s, i, 0);
  if (met) return fabs(at.mid) <= at.rad;
  gap rate = distance(s, i, 1);
  double span = fabs(time[s->problem.ntime - 1] - time[0]);
  return fabs(at.mid) - at.rad <= NEAR * span * (fabs(rate.mid) + rate.rad);
}

const char *lohner_kink(const lohner *s, int met) {
  const ambit_tape *t = s->problem.rhs;
  for (uint32_t i = 0; i < t->ninstr && t->kink; i++)
    if (t->kink[i] && is_near(s, i, met)) return t->kink[i];
  return NULL;
}
