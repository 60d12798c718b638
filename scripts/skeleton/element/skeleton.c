/* skeleton.c -- an element to start from: a spring without length between a frame and the origin of the world.
**
** It pulls the frame's origin home with the force -k r, r in the axes of the world, and stores k r^2 / 2. An element
** never computes a number: it writes formulas for the quantities that somebody asks for. <ambit/element.h> lists them,
** <ambit/spatial.h> has vectors, rotations and screws; `ambit check` compares what it expresses with what follows from
** its poses by differentiation and with the balance of power.
*/
#include <ambit/spatial.h>

enum { AT };        /* ports */
enum { STIFFNESS }; /* parameters */

static const ambit_port ports[] = { { "at", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that is pulled" } };
static const ambit_param params[] = {
  { "stiffness", "N/m", "", NULL, "force for each metre of distance" },
  { NULL, NULL, NULL, NULL, NULL },
};

/* a wrench is resolved in the frame's own axes */
static ambit_status express_wrench(ambit_build *b, ambit_expr k, ambit_pose pose, ambit_expr *out) {
  ambit_vector3 force = ambit_vector3_negate(b, ambit_vector3_scale(b, k, pose.position));
  ambit_screw wrench = { .angular = ambit_vector3_zero(), .linear = ambit_rotation_turn_back(b, pose.rotation, force) };
  ambit_screw_write(wrench, out);
  return AMBIT_OK;
}

static ambit_status express_energy(ambit_build *b, ambit_expr k, ambit_pose pose, ambit_expr *out) {
  ambit_expr square = ambit_vector3_dot(b, pose.position, pose.position);
  out[0] = 0; /* kinetic */
  out[1] = ambit_multiply(b, ambit_multiply(b, b->num(b, "0.5"), k), square);
  return AMBIT_OK;
}

/* UNABLE: this element has no such quantity */
static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int wrench = port == AT && quantity == AMBIT_WRENCH, energy = port == AMBIT_NO_PORT && quantity == AMBIT_ENERGY;
  if (!wrench && !energy) return AMBIT_UNABLE;
  ambit_expr k = *b->param(b, STIFFNESS);
  ambit_status status = ambit_check_fixed(b, &k, 1, "stiffness"); /* else energy would come from nowhere */
  const ambit_expr *pose = status == AMBIT_OK ? b->get(b, AT, AMBIT_POSE) : NULL;
  if (!pose) return AMBIT_INVALID; /* the message is recorded already */
  return wrench ? express_wrench(b, k, ambit_pose_read(pose), out) : express_energy(b, k, ambit_pose_read(pose), out);
}

static const ambit_element element = { sizeof element, 1, ports, params, express, NULL };

AMBIT_ELEMENT_ENTRY("skeleton", "0.1", "A spring without length between a frame and the origin of the world.", element)
