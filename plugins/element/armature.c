/* armature.c -- the inertia J of a rotor that turns with a joint, as the joint feels it: with a gear of ratio G, G^2
** times the rotor's own.
**
** effort -J q'', energy J q'^2 / 2. What the rotor's spin does to the frame that carries it (gyroscopic torque, its
** share of the link's inertia) is left out, as robot models do (Featherstone 2008, section 9.6); give a rotor as a
** rigid_body on a joint of its own where that matters.
*/
#include <ambit/spatial.h>

enum { JOINT };
enum { INERTIA, MASS };

static const ambit_port ports[] = { { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0,
    "the joint that the rotor turns with" } };
static const ambit_param params[] = {
  { "inertia", "kg m^2|", "", "", "inertia felt by a joint that turns" },
  { "mass", "|kg", "", "", "mass felt by a joint that slides" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check(ambit_build *b) {
  const ambit_expr *inertia = b->param(b, INERTIA), *mass = b->param(b, MASS);
  const char *name = inertia ? "inertia" : "mass";
  double lo, hi;
  if (!inertia == !mass) return b->fail(b, AMBIT_INVALID, "expected either `inertia` (kg m^2) or `mass` (kg)");
  b->range(b, inertia ? *inertia : *mass, &lo, &hi);
  if (hi < 0) return b->fail(b, AMBIT_INVALID, "the %s is negative: %g", name, hi);
  return ambit_check_fixed(b, inertia ? inertia : mass, 1, name);
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int effort = port == JOINT && quantity == AMBIT_EFFORT, energy = port == AMBIT_NO_PORT && quantity == AMBIT_ENERGY;
  if (!effort && !energy) return AMBIT_UNABLE;
  const ambit_expr *inertia = b->param(b, INERTIA), *rate = b->get(b, JOINT, effort ? AMBIT_RATE2 : AMBIT_RATE);
  if (!rate) return AMBIT_INVALID;
  ambit_expr j = inertia ? *inertia : *b->param(b, MASS);
  if (effort)
    out[0] = ambit_negate(b, ambit_multiply(b, j, *rate));
  else
    out[0] = ambit_multiply(b, ambit_multiply(b, b->num(b, "0.5"), j), ambit_square(b, *rate)), out[1] = 0;
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("armature", "1.0",
    "Inertia on the coordinate of a joint: the rotor of its drive, multiplied by the square of the gear ratio.",
    element)
