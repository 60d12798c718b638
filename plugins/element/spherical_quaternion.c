/* spherical_quaternion.c -- a ball joint, its orientation written as a unit quaternion (formulas: quaternion.h). */
#include "quaternion.h"

static const ambit_port ports[] = { QUATERNION_PORTS(3, "unit quaternion; angular velocity and torque, axes of `to`") };

QUATERNION_ELEMENT(3)
AMBIT_ELEMENT_ENTRY("spherical_quaternion", "1.0",
    "A ball joint without singular positions. Its coordinates are the unit quaternion NAME.1 (the cosine of half the "
    "angle) to NAME.4 (the axis times its sine); its speeds NAME'.1 to NAME'.3 are the angular velocity in the axes of "
    "`to`.",
    element)
