/* prismatic.c -- a slider: `to` keeps the axes of `from` and is displaced by s along the axis n.
**
** With p = n s, in own axes (subscript 1: of `to`):
**   w_1 = w          v_1 = v + w x p + n s'
**   alpha_1 = alpha  a_1 = a + alpha x p + w x (w x p) + 2 w x n s' + n s''
** The wrench (t, f) at `to` acts on `from` as (t + p x f, f); along the motion n.f + effort = 0. [Featherstone 2008,
** ch. 4]
*/
#include <ambit/spatial.h>

enum { FROM, TO, JOINT };
enum { AXIS, DISPLACEMENT };

static const ambit_port ports[] = {
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the joint" },
  { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the frame that slides" },
  { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, 1, 0, "displacement and force of the joint" },
};
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "direction of motion, in the axes of `from`" },
  { "displacement", "m", "", "", "given motion, which may depend on time; absent: the displacement is a state" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_vector3 along(ambit_build *b, ambit_vector3 n, uint32_t order) {
  return ambit_vector3_scale(b, ambit_joint_coordinate(b, DISPLACEMENT, order, "m"), n);
}

static ambit_status express_motion(ambit_build *b, uint32_t quantity, ambit_vector3 n, ambit_expr *out) {
  const ambit_expr *from = b->get(b, FROM, quantity);
  if (!from) return AMBIT_INVALID;
  ambit_vector3 p = along(b, n, 0);
  if (quantity == AMBIT_POSE) {
    ambit_pose_write(ambit_pose_after(b, ambit_pose_read(from), ambit_rotation_identity(b), p), out);
    return AMBIT_OK;
  }
  ambit_screw s = ambit_screw_read(from);
  if (quantity == AMBIT_TWIST) {
    s.linear = ambit_vector3_add(b, ambit_velocity_at(b, s, p), along(b, n, 1));
  } else {
    const ambit_expr *twist = b->get(b, FROM, AMBIT_TWIST);
    if (!twist) return AMBIT_INVALID;
    ambit_vector3 w = ambit_vector3_read(twist), coriolis = ambit_vector3_cross(b, w, along(b, n, 1));
    s.linear =
        ambit_vector3_add(b, ambit_acceleration_at(b, s, w, p), ambit_vector3_scale(b, b->num(b, "2"), coriolis));
    s.linear = ambit_vector3_add(b, s.linear, along(b, n, 2));
  }
  ambit_screw_write(s, out);
  return AMBIT_OK;
}

static ambit_status express_force(ambit_build *b, uint32_t port, ambit_vector3 n, ambit_expr *out) {
  const ambit_expr *wrench = b->get(b, TO, AMBIT_WRENCH);
  const ambit_expr *effort = wrench && port == JOINT ? b->get(b, JOINT, AMBIT_EFFORT) : NULL;
  if (!wrench || (port == JOINT && !effort)) return AMBIT_INVALID;
  ambit_screw s = ambit_screw_read(wrench);
  if (port == JOINT)
    *out = ambit_add(b, ambit_vector3_dot(b, n, s.linear), *effort);
  else
    ambit_screw_write(ambit_wrench_before(b, s, ambit_rotation_identity(b), along(b, n, 0)), out);
  return AMBIT_OK;
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_vector3 n;
  if (port == JOINT && quantity >= AMBIT_COORDINATE && quantity <= AMBIT_RATE2) {
    *out = ambit_joint_coordinate(b, DISPLACEMENT, quantity - AMBIT_COORDINATE, "m");
    return AMBIT_OK;
  }
  ambit_status status = ambit_vector3_unit(b, b->param(b, AXIS), &n);
  if (status == AMBIT_OK && quantity != AMBIT_POSE) status = ambit_check_fixed(b, b->param(b, AXIS), 3, "axis");
  if (status != AMBIT_OK) return status;
  if (port == TO && quantity <= AMBIT_ACCEL) return express_motion(b, quantity, n, out);
  if (port == FROM && quantity == AMBIT_WRENCH) return express_force(b, port, n, out);
  if (port == JOINT && quantity == AMBIT_BALANCE) return express_force(b, port, n, out);
  return AMBIT_UNABLE;
}

static const ambit_element element = { sizeof element, 3, ports, params, express };

AMBIT_ELEMENT_ENTRY("prismatic", "1.0",
    "A slider along `axis`. Without `displacement` its displacement is a state named after the joint.", element)
