/* joint_damper.c -- viscous damping of a joint: effort -d q', power -d q'^2 (Rayleigh's dissipation function). */
#include "dissipation.h"
#include "joint_law.h"

enum { DAMPING };

static const ambit_param params[] = {
  { "damping", "N m s/rad|N s/m", "", NULL, "torque per angular velocity, or force per velocity; not negative" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check(ambit_build *b) { return dissipation_check(b, b->param(b, DAMPING), 1, "damping"); }

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int effort = joint_law_is_effort(port, quantity);
  if (!effort && !joint_law_is(port, quantity, AMBIT_POWER)) return AMBIT_UNABLE;
  ambit_expr rate;
  if (!joint_law_read(b, AMBIT_RATE, &rate)) return AMBIT_INVALID;
  ambit_expr along = effort ? rate : ambit_square(b, rate);
  *out = ambit_negate(b, ambit_multiply(b, *b->param(b, DAMPING), along));
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, joint_law_port, params, express, check };

AMBIT_ELEMENT_ENTRY("joint_damper", "1.0", "Viscous damping of a joint: -damping q'.", element)
