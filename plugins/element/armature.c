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
  { "inertia", "kg m^2", "", "", "inertia felt by a joint that turns" },
  { "mass", "kg", "", "", "mass felt by a joint that slides" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status find_inertia(ambit_build *b, ambit_expr *j) {
  const ambit_expr *inertia = b->param(b, INERTIA), *mass = b->param(b, MASS);
  double lo, hi;
  if (!inertia == !mass) return b->fail(b, AMBIT_INVALID, "expected either `inertia` (kg m^2) or `mass` (kg)");
  *j = inertia ? *inertia : *mass;
  b->range(b, *j, &lo, &hi);
  if (hi < 0) return b->fail(b, AMBIT_INVALID, "the inertia is negative: %g", hi);
  return ambit_check_fixed(b, j, 1, inertia ? "inertia" : "mass");
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int effort = port == JOINT && quantity == AMBIT_EFFORT, energy = port == AMBIT_NO_PORT && quantity == AMBIT_ENERGY;
  ambit_expr j = 0;
  if (!effort && !energy) return AMBIT_UNABLE;
  ambit_status status = find_inertia(b, &j);
  const ambit_expr *rate = status == AMBIT_OK ? b->get(b, JOINT, effort ? AMBIT_RATE2 : AMBIT_RATE) : NULL;
  if (!rate) return AMBIT_INVALID;
  if (effort)
    out[0] = ambit_negate(b, ambit_multiply(b, j, *rate));
  else
    out[0] = ambit_multiply(b, ambit_multiply(b, b->num(b, "0.5"), j), ambit_square(b, *rate)), out[1] = 0;
  return AMBIT_OK;
}

static const ambit_element element = {
  .size = sizeof element, .nport = 1, .port = ports, .param = params, .express = express
};

AMBIT_ELEMENT_ENTRY("armature", "1.0",
    "Inertia on the coordinate of a joint: the rotor of its drive, multiplied by the square of the gear ratio.",
    element)
