/* joint_friction.c -- friction in a joint, smooth: effort -(g(q') tanh(q'/v0) + d q'), or with a straight step.
**
** Coulomb's law jumps at rest: it is no function there but a set, and its solutions are those of a differential
** inclusion, which a Taylor series cannot carry. tanh(q'/v0) differs from sign(q') by less than 2 exp(-2 |q'|/v0), so
** by less than 1 % where |q'| > 2.65 v0, and has derivatives of every order. What is proved is proved for this law. It
** creeps: a load below the friction moves it slowly instead of holding it, at about v0 load/c.
** The level g is c, or with Stribeck's effect [Stribeck 1902; Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica
** 30 (1994)] c + (s - c) exp(-(q'/vs)^2): from s at rest down to c.
** With `step` "straight" max(-1, min(1, q'/v0)) takes the place of tanh: with two kinks, but of the size of its slope
** everywhere, where a set of wide speeds leaves no bound of any derivative of tanh.
** The power is q' times the effort, never positive for g, d >= 0: q' tanh(q'/v0) >= 0.
*/
#include "dissipation.h"
#include "joint_law.h"

enum { COULOMB, VELOCITY, VISCOUS, STATIC, STRIBECK_VELOCITY, STEP };

static const ambit_param params[] = {
  { "coulomb", "N m|N", "", NULL, "torque or force of sliding friction, whatever the speed; not negative" },
  { "velocity", "rad/s|m/s", "", "0.01", "width v0 of the smooth step from -1 to 1, tanh(rate/v0); above 0" },
  { "viscous", "N m s/rad|N s/m", "", "0", "torque per angular velocity, or force per velocity; not negative" },
  { "static", "N m|N", "", "", "friction at rest, Stribeck's effect; absent: as `coulomb`" },
  { "stribeck_velocity", "rad/s|m/s", "", "0.1", "speed at which `static` has gone over to `coulomb`; above 0" },
  { "step", "1", "smooth|straight", "smooth",
      "from -1 to 1: tanh(rate/velocity), or max(-1, min(1, rate/velocity)), which wide sets cross" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check_positive(ambit_build *b, uint32_t param, const char *name) {
  double lo, hi;
  b->range(b, *b->param(b, param), &lo, &hi);
  if (hi > 0) return AMBIT_OK;
  return b->fail(b, AMBIT_INVALID, "`%s` is %g: expected a speed above 0", name, hi);
}

static ambit_status check(ambit_build *b) {
  ambit_status status = dissipation_check(b, b->param(b, COULOMB), 1, "coulomb");
  if (status == AMBIT_OK) status = dissipation_check(b, b->param(b, VISCOUS), 1, "viscous");
  if (status == AMBIT_OK) status = dissipation_check(b, b->param(b, STATIC), 1, "static");
  if (status == AMBIT_OK) status = check_positive(b, VELOCITY, "velocity");
  return status == AMBIT_OK ? check_positive(b, STRIBECK_VELOCITY, "stribeck_velocity") : status;
}

/* g */
static ambit_expr level(ambit_build *b, ambit_expr rate) {
  ambit_expr c = *b->param(b, COULOMB);
  const ambit_expr *at_rest = b->param(b, STATIC);
  if (!at_rest) return c;
  ambit_expr x = ambit_negate(b, ambit_square(b, ambit_divide(b, rate, *b->param(b, STRIBECK_VELOCITY))));
  ambit_expr fading = b->op(b, AMBIT_OP_EXP, x, x);
  return ambit_add(b, c, ambit_multiply(b, ambit_subtract(b, *at_rest, c), fading));
}

/* from -1 to 1 as the ratio of speed and v0 grows */
static ambit_expr step_of(ambit_build *b, ambit_expr ratio) {
  double straight, same;
  b->range(b, *b->param(b, STEP), &straight, &same);
  if (straight == 0) return b->op(b, AMBIT_OP_TANH, ratio, ratio);
  return b->op(b, AMBIT_OP_MAX, b->num(b, "-1"), b->op(b, AMBIT_OP_MIN, b->num(b, "1"), ratio));
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int effort = joint_law_is_effort(port, quantity);
  if (!effort && !joint_law_is(port, quantity, AMBIT_POWER)) return AMBIT_UNABLE;
  ambit_expr rate;
  if (!joint_law_read(b, AMBIT_RATE, &rate)) return AMBIT_INVALID;
  ambit_expr ratio = ambit_divide(b, rate, *b->param(b, VELOCITY));
  ambit_expr dry = ambit_multiply(b, level(b, rate), step_of(b, ratio));
  ambit_expr friction = ambit_add(b, dry, ambit_multiply(b, *b->param(b, VISCOUS), rate));
  *out = ambit_negate(b, effort ? friction : ambit_multiply(b, friction, rate));
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, joint_law_port, params, express, check };

AMBIT_ELEMENT_ENTRY("joint_friction", "1.0",
    "Smooth friction in a joint: -(coulomb tanh(rate/velocity) + viscous rate), with `static` also Stribeck's effect. "
    "A joint at rest creeps slowly under a load instead of sticking.",
    element)
