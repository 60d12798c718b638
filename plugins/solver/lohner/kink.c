/* kink.c -- which operation of the right-hand side is not smooth where a run could not go on: no proof, only a name for
** the reason.
**
** |a| has its kink at a = 0, min and max of a and b at a = b. Series over the set have been tried at the start of the
** step, so values are known at order 0 and rates at order 1. A kink is met if the set's range reaches it; steps that
** shrink to nothing before it show that it is near.
*/
#include "lohner.h"

#define NEAR 0x1p-20 /* of the run's time at the present rate */

/* order k of what is zero at the kink of instruction i */
static ball distance(const field *f, const flow *phi, uint32_t i, uint32_t k) {
  const ambit_tape *t = f->problem.rhs;
  ball a, b = { 0, 0 };
  f->jet->get(phi->box_jet, t->a[i], k, &a.mid, &a.rad, NULL, NULL);
  if (t->op[i] != AMBIT_OP_ABS) f->jet->get(phi->box_jet, t->b[i], k, &b.mid, &b.rad, NULL, NULL);
  return (ball) { a.mid - b.mid, a.rad + b.rad };
}

static int is_near(const field *f, const flow *phi, uint32_t i, int met) {
  ball at = distance(f, phi, i, 0);
  if (met) return fabs(at.mid) <= at.rad;
  ball rate = distance(f, phi, i, 1);
  return fabs(at.mid) - at.rad <= NEAR * field_span(f) * (fabs(rate.mid) + rate.rad);
}

const char *lohner_kink(const field *f, const flow *phi, int met) {
  const ambit_tape *t = f->problem.rhs;
  for (uint32_t i = 0; i < t->ninstr && t->kink; i++)
    if (t->kink[i] && is_near(f, phi, i, met)) return t->kink[i];
  return NULL;
}
