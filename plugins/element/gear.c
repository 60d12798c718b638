/* gear.c -- two joints that turn in a fixed ratio (formulas: gear.h). */
#include "gear.h"

static const ambit_port ports[] = {
  { "driver", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0, "the joint whose angle is multiplied by `ratio`" },
  { "driven", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0, "the joint that turns along" },
  { "mesh", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, 1, 0, "angle that is missing, and the torque on `driven`" },
};
static const ambit_param params[] = {
  { "ratio", "1", "", NULL, "turns of `driven` for each of `driver`; negative: against it" },
  { "offset", "rad", "", "0", "angle of `driven` where `driver` is at 0" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  return gear_express(b, port, quantity, "N m", out);
}

static ambit_status check(ambit_build *b) { return gear_check(b, "ratio", "offset"); }

static const ambit_element element = { sizeof element, 3, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("gear", "1.0",
    "Keeps the angle of `driven` at `ratio` times that of `driver` plus `offset`, whatever either carries: a loop, "
    "closed by a torque. Where no torque of the mesh is asked for, a joint with `mimic` says the same in fewer "
    "equations.",
    element)
