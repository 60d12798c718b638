/* joint_spring.c -- a linear spring on a joint: effort -k (q - q0), potential energy k (q - q0)^2 / 2.
**
** k and q0 may move (a servo is a spring whose rest position is the wanted motion). Then
**   d/dt [k (q - q0)^2 / 2] + effort q' = k' (q - q0)^2 / 2 - k (q - q0) q0',
** which whoever moves them puts in: the power. A negative stiffness is allowed (see dissipation.h).
*/
#include "joint_law.h"

enum { STIFFNESS, REST };

static const ambit_param params[] = {
  { "stiffness", "N m/rad|N/m", "", NULL,
      "torque per angle on a joint that turns, force per length on one that slides" },
  { "rest", "rad|m", "", "0", "coordinate of the joint at which the spring is slack; may move in time" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int effort = joint_law_is_effort(port, quantity), energy = joint_law_is(port, quantity, AMBIT_ENERGY);
  if (!effort && !energy && !joint_law_is(port, quantity, AMBIT_POWER)) return AMBIT_UNABLE;
  ambit_expr k = *b->param(b, STIFFNESS), rest = *b->param(b, REST), q, half = b->num(b, "0.5");
  if (!effort && !energy && b->diff_time(b, k) == 0 && b->diff_time(b, rest) == 0) return AMBIT_UNABLE;
  if (!joint_law_read(b, AMBIT_COORDINATE, &q)) return AMBIT_INVALID;
  ambit_expr stretch = ambit_subtract(b, q, rest), square = ambit_square(b, stretch);
  ambit_expr pull = ambit_multiply(b, k, stretch);
  if (effort)
    *out = ambit_negate(b, pull);
  else if (energy)
    out[0] = 0, out[1] = ambit_multiply(b, ambit_multiply(b, half, k), square);
  else
    *out = ambit_subtract(b, ambit_multiply(b, ambit_multiply(b, half, b->diff_time(b, k)), square),
        ambit_multiply(b, pull, b->diff_time(b, rest)));
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, joint_law_port, params, express, NULL };

AMBIT_ELEMENT_ENTRY("joint_spring", "1.0",
    "A linear spring on a joint: -stiffness (q - rest). A `rest` that moves in time makes it a servo.", element)
