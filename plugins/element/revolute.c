/* revolute.c -- a hinge: `to` turns by the angle q about the axis n through the origin of `from`.
**
** With Q = Rot(n, q), in own axes (subscript 1: of `to`):
**   w_1 = Q^T w + n q'                                v_1 = Q^T v
**   alpha_1 = Q^T alpha + n q'' + (Q^T w) x n q'      a_1 = Q^T a
** The wrench (t, f) at `to` acts on `from` as (Q t, Q f); along the motion n.t + effort = 0. [Featherstone, Rigid Body
** Dynamics Algorithms, 2008, ch. 4]
*/
#include <ambit/spatial.h>

enum { FROM, TO, JOINT };
enum { AXIS, ANGLE };

static const ambit_port ports[] = {
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the joint" },
  { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the frame that turns" },
  { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, 1, 0, "angle and torque of the joint" },
};
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis of rotation, in the axes of `from`" },
  { "angle", "rad", "", "", "given motion, which may depend on time; absent: the angle is a state" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express_motion(
    ambit_build *b, uint32_t quantity, ambit_vector3 n, ambit_rotation q, ambit_expr *out) {
  const ambit_expr *from = b->get(b, FROM, quantity);
  if (!from) return AMBIT_INVALID;
  if (quantity == AMBIT_POSE) {
    ambit_pose_write(ambit_pose_after(b, ambit_pose_read(from), q, ambit_vector3_zero()), out);
    return AMBIT_OK;
  }
  ambit_screw s = ambit_screw_turn_back(b, q, ambit_screw_read(from));
  ambit_vector3 rate = ambit_vector3_scale(b, ambit_joint_coordinate(b, ANGLE, 1, "rad"), n);
  if (quantity == AMBIT_TWIST) {
    s.angular = ambit_vector3_add(b, s.angular, rate);
  } else {
    const ambit_expr *twist = b->get(b, FROM, AMBIT_TWIST);
    if (!twist) return AMBIT_INVALID;
    ambit_vector3 w = ambit_rotation_turn_back(b, q, ambit_vector3_read(twist));
    ambit_vector3 rate2 = ambit_vector3_scale(b, ambit_joint_coordinate(b, ANGLE, 2, "rad"), n);
    s.angular = ambit_vector3_add(b, ambit_vector3_add(b, s.angular, rate2), ambit_vector3_cross(b, w, rate));
  }
  ambit_screw_write(s, out);
  return AMBIT_OK;
}

static ambit_status express_balance(ambit_build *b, ambit_vector3 n, ambit_expr *out) {
  const ambit_expr *wrench = b->get(b, TO, AMBIT_WRENCH);
  const ambit_expr *effort = wrench ? b->get(b, JOINT, AMBIT_EFFORT) : NULL;
  if (!effort) return AMBIT_INVALID;
  *out = ambit_add(b, ambit_vector3_dot(b, n, ambit_vector3_read(wrench)), *effort);
  return AMBIT_OK;
}

static ambit_status express_wrench(ambit_build *b, ambit_rotation q, ambit_expr *out) {
  const ambit_expr *wrench = b->get(b, TO, AMBIT_WRENCH);
  if (!wrench) return AMBIT_INVALID;
  ambit_screw_write(ambit_wrench_before(b, ambit_screw_read(wrench), q, ambit_vector3_zero()), out);
  return AMBIT_OK;
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_vector3 n;
  if (port == JOINT && quantity >= AMBIT_COORDINATE && quantity <= AMBIT_RATE2) {
    *out = ambit_joint_coordinate(b, ANGLE, quantity - AMBIT_COORDINATE, "rad");
    return AMBIT_OK;
  }
  ambit_status status = ambit_vector3_unit(b, b->param(b, AXIS), &n);
  if (status == AMBIT_OK && quantity != AMBIT_POSE) status = ambit_check_fixed(b, b->param(b, AXIS), 3, "axis");
  if (status != AMBIT_OK) return status;
  if (port == JOINT && quantity == AMBIT_BALANCE) return express_balance(b, n, out);
  ambit_rotation q = ambit_rotation_about(b, n, ambit_joint_coordinate(b, ANGLE, 0, "rad"));
  if (port == TO && quantity <= AMBIT_ACCEL) return express_motion(b, quantity, n, q, out);
  if (port == FROM && quantity == AMBIT_WRENCH) return express_wrench(b, q, out);
  return AMBIT_UNABLE;
}

static const ambit_element element = { sizeof element, 3, ports, params, express };

AMBIT_ELEMENT_ENTRY("revolute", "1.0",
    "A hinge that turns about `axis`. Without `angle` its angle is a state named after the joint.", element)
