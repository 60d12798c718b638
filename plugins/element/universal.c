/* universal.c -- a Cardan joint: `to` turns about the first axis and then about the second, which is carried along. */
#include "stages.h"

enum { FIRST, SECOND };

static const ambit_port ports[] = { STAGES_PORTS(2, "angles and torques about the first and the second axis") };
static const ambit_param params[] = {
  { "first", "1", "axis", "x", "axis fixed in `from`" },
  { "second", "1", "axis", "y", "axis fixed in `to`, in the axes of `from` when the first angle is 0" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_stages(ambit_build *b, stages *s) {
  ambit_vector3 first, second;
  ambit_status status = stages_axis(b, FIRST, "first", &first);
  if (status == AMBIT_OK) status = stages_axis(b, SECOND, "second", &second);
  if (status != AMBIT_OK) return status;
  stages_push(s, stage_turn(b, first, 0));
  stages_push(s, stage_turn(b, second, 1));
  return AMBIT_OK;
}

STAGES_ELEMENT(2, list_stages)
AMBIT_ELEMENT_ENTRY("universal", "1.0",
    "A Cardan joint: turns about `first` and then about `second`. Its states are the angles NAME.1 and NAME.2.",
    element)
