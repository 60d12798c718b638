/* rack_and_pinion.c -- a slider that a wheel moves: a gear between an angle and a displacement (formulas: gear.h). */
#include "gear.h"

static const ambit_port ports[] = {
  { "pinion", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0, "the joint that turns" },
  { "rack", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0, "the joint that slides" },
  { "mesh", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, 1, 0, "displacement that is missing, and the force on `rack`" },
};
static const ambit_param params[] = {
  { "radius", "m", "", NULL, "of the pinion's pitch circle: travel of the rack for each radian; negative: against it" },
  { "offset", "m", "", "0", "displacement of `rack` where `pinion` is at 0" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  return gear_express(b, port, quantity, "N", out);
}

static ambit_status check(ambit_build *b) { return gear_check(b, "radius", "offset"); }

static const ambit_element element = { sizeof element, 3, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("rack_and_pinion", "1.0",
    "Keeps the displacement of `rack` at `radius` times the angle of `pinion` plus `offset`: a loop, closed by a "
    "force.",
    element)
