/* prismatic.c -- a slider: `to` keeps the axes of `from` and is displaced by s along the axis n (stages.h). */
#include "stages.h"

enum { AXIS, DISPLACEMENT };

static const ambit_port ports[] = { STAGES_PORTS(1, "displacement and force of the joint") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "direction of motion, in the axes of `from`" },
  { "displacement", "m", "", "", "given motion, which may depend on time; absent: the displacement is a state" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_stages(ambit_build *b, stages *s) {
  ambit_vector3 n;
  ambit_status status = stages_axis(b, AXIS, "axis", &n);
  if (status != AMBIT_OK) return status;
  stage slide = stage_slide(b, n, 0);
  slide.given = DISPLACEMENT;
  stages_push(s, slide);
  return AMBIT_OK;
}

STAGES_ELEMENT(1, list_stages)
AMBIT_ELEMENT_ENTRY("prismatic", "1.0",
    "A slider along `axis`. Without `displacement` its displacement is a state named after the joint.", element)
