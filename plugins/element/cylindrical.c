/* cylindrical.c -- `to` slides along an axis and turns about it. */
#include "stages.h"

enum { AXIS };

static const ambit_port ports[] = { STAGES_PORTS(2, "displacement and angle, force and torque") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis of both motions, in the axes of `from`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_stages(ambit_build *b, stages *s) {
  ambit_vector3 n;
  ambit_status status = stages_axis(b, AXIS, "axis", &n);
  if (status != AMBIT_OK) return status;
  stages_push(s, stage_slide(b, n, 0));
  stages_push(s, stage_turn(b, n, 1));
  return AMBIT_OK;
}

STAGES_ELEMENT(2, list_stages)
AMBIT_ELEMENT_ENTRY("cylindrical", "1.0",
    "A joint that slides along `axis` and turns about it. Its states are the displacement NAME.1 and the angle NAME.2.",
    element)
