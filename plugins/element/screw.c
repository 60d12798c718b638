/* screw.c -- `to` advances along an axis while it turns about it: by `pitch` for each full turn. */
#include "stages.h"

enum { AXIS, PITCH, ANGLE };

static const ambit_port ports[] = { STAGES_PORTS(1, "angle and torque") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis of both motions, in the axes of `from`" },
  { "pitch", "m", "", NULL, "advance for one full turn; negative: left-handed" },
  { "angle", "rad", "", "", "given motion, which may depend on time; absent: the angle is a state" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_stages(ambit_build *b, stages *s) {
  ambit_vector3 n;
  ambit_status status = stages_axis(b, AXIS, "axis", &n);
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, PITCH), 1, "pitch");
  if (status != AMBIT_OK) return status;
  stage advance = stage_slide(b, n, 0), turn = stage_turn(b, n, 0);
  ambit_expr full_turn = ambit_multiply(b, b->num(b, "2"), b->num(b, "pi"));
  advance.coefficient = ambit_divide(b, *b->param(b, PITCH), full_turn);
  advance.unit = turn.unit;
  advance.given = turn.given = ANGLE;
  stages_push(s, advance);
  stages_push(s, turn);
  return AMBIT_OK;
}

STAGES_ELEMENT(1, list_stages)
AMBIT_ELEMENT_ENTRY("screw", "1.0",
    "A screw: turns about `axis` and advances along it by `pitch` for each turn. Without `angle` its angle is a state "
    "named after the joint.",
    element)
