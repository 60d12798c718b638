/* free_quaternion.c -- all six motions of a body in space, its orientation written as a unit quaternion
** (formulas: quaternion.h).
*/
#include "quaternion.h"

static const ambit_port ports[] = { QUATERNION_PORTS(6,
    "unit quaternion and displacements; angular velocity and torque in the axes of `to`, rates and forces along "
    "those of `from`") };

QUATERNION_ELEMENT(6)
AMBIT_ELEMENT_ENTRY("free_quaternion", "1.0",
    "No connection at all: `to` floats, and no position is singular. Its coordinates are the unit quaternion NAME.1 to "
    "NAME.4 and the displacements NAME.5 to NAME.7 along the axes of `from`; its speeds are the angular velocity "
    "NAME'.1 to NAME'.3 in the axes of `to` and the rates NAME'.4 to NAME'.6 of the displacements.",
    element)
