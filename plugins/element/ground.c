/* ground.c -- a frame fixed in the world, apart from its origin: at rest; its proper acceleration is -R^T g. */
#include <ambit/spatial.h>

enum { TO };
enum { POSITION, AXIS, ANGLE };

static const ambit_port ports[] = { { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the fixed frame" } };
static const ambit_param params[] = {
  { "position", "m", "3", "0,0,0", "of its origin, in the world" },
  { "axis", "1", "axis", "z", "axis of its rotation" },
  { "angle", "rad", "", "", "turns the world's axes into those of the frame" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check(ambit_build *b) {
  ambit_status status = ambit_check_fixed(b, b->param(b, POSITION), 3, "position");
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, AXIS), 3, "axis");
  return status == AMBIT_OK ? ambit_check_fixed(b, b->param(b, ANGLE), 1, "angle") : status;
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_pose pose;
  if (port != TO || quantity > AMBIT_ACCEL) return AMBIT_UNABLE;
  ambit_status status = ambit_rotation_param(b, AXIS, ANGLE, &pose.rotation);
  if (status == AMBIT_OK && quantity != AMBIT_POSE) status = check(b);
  if (status != AMBIT_OK) return status;
  pose.position = ambit_vector3_read(b->param(b, POSITION));
  ambit_screw s = { ambit_vector3_zero(), ambit_vector3_zero() };
  if (quantity == AMBIT_ACCEL) {
    const ambit_expr *field = b->get(b, AMBIT_NO_PORT, AMBIT_FIELD);
    if (!field) return AMBIT_INVALID;
    s.linear = ambit_vector3_negate(b, ambit_rotation_turn_back(b, pose.rotation, ambit_vector3_read(field)));
  }
  if (quantity == AMBIT_POSE)
    ambit_pose_write(pose, out);
  else
    ambit_screw_write(s, out);
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, ports, params, express, NULL };

AMBIT_ELEMENT_ENTRY(
    "ground", "1.0", "A frame fixed in the world at `position`, perhaps turned by `angle` about `axis`.", element)
