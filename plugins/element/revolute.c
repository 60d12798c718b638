/* revolute.c -- a hinge: `to` turns by the angle q about the axis n through the origin of `from` (stages.h). */
#include "stages.h"

enum { AXIS, ANGLE };

static const ambit_port ports[] = { STAGES_PORTS(1, "angle and torque of the joint") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis of rotation, in the axes of `from`" },
  { "angle", "rad", "", "", "given motion, which may depend on time; absent: the angle is a state" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_stages(ambit_build *b, stages *s) {
  ambit_vector3 n;
  ambit_status status = stages_axis(b, AXIS, "axis", &n);
  if (status != AMBIT_OK) return status;
  stage turn = stage_turn(b, n, 0);
  turn.given = ANGLE;
  stages_push(s, turn);
  return AMBIT_OK;
}

STAGES_ELEMENT(1, list_stages)
AMBIT_ELEMENT_ENTRY("revolute", "1.0",
    "A hinge that turns about `axis`. Without `angle` its angle is a state named after the joint.", element)
