/* planar.c -- `to` slides in a plane of `from` and turns about its normal. */
#include "stages.h"

enum { FIRST, SECOND };

static const ambit_port ports[] = { STAGES_PORTS(3, "two displacements and an angle, two forces and a torque") };
static const ambit_param params[] = {
  { "first", "1", "axis", "x", "direction of the first displacement, in the axes of `from`" },
  { "second", "1", "axis", "y", "direction of the second displacement; the rotation is about first x second" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_stages(ambit_build *b, stages *s) {
  ambit_vector3 first, second, normal;
  ambit_status status = stages_axis(b, FIRST, "first", &first);
  if (status == AMBIT_OK) status = stages_axis(b, SECOND, "second", &second);
  if (status != AMBIT_OK) return status;
  ambit_vector3 across = ambit_vector3_cross(b, first, second);
  double lo, hi;
  b->range(b, ambit_vector3_dot(b, across, across), &lo, &hi);
  if (!(hi > 0)) return b->fail(b, AMBIT_INVALID, "`first` and `second` are parallel: they span no plane");
  status = ambit_vector3_unit(b, across.c, &normal);
  if (status != AMBIT_OK) return status;
  stages_push(s, stage_slide(b, first, 0));
  stages_push(s, stage_slide(b, second, 1));
  stages_push(s, stage_turn(b, normal, 2));
  return AMBIT_OK;
}

STAGES_ELEMENT(3, list_stages)
AMBIT_ELEMENT_ENTRY("planar", "1.0",
    "A joint that slides in the plane of `first` and `second` and turns about its normal. Its states are the "
    "displacements NAME.1 and NAME.2 and the angle NAME.3.",
    element)
