/* spherical.c -- a ball joint, its orientation written as three angles. The angles are no coordinates where the middle
** one makes the outer axes parallel (zyx, xyz: +-90 degrees; zxz, zyz: 0): the mass matrix is singular there.
*/
#include "euler.h"

enum { ORDER };

static const ambit_port ports[] = { STAGES_PORTS(3, "three angles, and the torques about their axes") };
static const ambit_param params[] = { EULER_PARAM, { NULL, NULL, NULL, NULL, NULL } };

static ambit_status list_stages(ambit_build *b, stages *s) {
  euler_push(b, s, ORDER, 0);
  return AMBIT_OK;
}

STAGES_ELEMENT(3, list_stages)
AMBIT_ELEMENT_ENTRY("spherical", "1.0",
    "A ball joint: turns by three angles one after the other, in the given `order` of axes. Its states are the angles "
    "NAME.1, NAME.2 and NAME.3; they fail where the outer axes become parallel.",
    element)
