/* free.c -- all six motions of a body in space: displacements along the axes of `from`, then three angles (as in
** spherical.c, with the same singular positions). As in a twist the angles are counted first; elimination then starts
** with the displacements, whose pivots are the mass.
*/
#include "euler.h"

enum { ORDER };

static const ambit_port ports[] = { STAGES_PORTS(6, "three angles and three displacements, torques and forces") };
static const ambit_param params[] = { EULER_PARAM, { NULL, NULL, NULL, NULL, NULL } };

static ambit_status list_stages(ambit_build *b, stages *s) {
  for (int i = 0; i < 3; i++) stages_push(s, stage_slide(b, stages_direction(b, i), 3 + (uint32_t)i));
  euler_push(b, s, ORDER, 0);
  return AMBIT_OK;
}

STAGES_ELEMENT(6, list_stages)
AMBIT_ELEMENT_ENTRY("free", "1.0",
    "No connection at all: `to` floats. Its states are the angles NAME.1 to NAME.3 in the given `order` of axes and "
    "the "
    "displacements NAME.4 to NAME.6 along the axes of `from`.",
    element)
