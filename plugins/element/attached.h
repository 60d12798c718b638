/* attached.h -- a frame rigidly attached to another: first moved by `offset` (axes of `from`), then turned by `angle`
** about `axis`.
**
** With rotation Q and offset p, in own axes (subscript 1: of `to`):
**   w_1 = Q^T w              v_1 = Q^T (v + w x p)
**   alpha_1 = Q^T alpha      a_1 = Q^T (a + alpha x p + w x (w x p))
** A wrench (t, f) at `to` acts on `from` as (Q t + p x Q f, Q f).
*/
#ifndef AMBIT_ATTACHED_H
#define AMBIT_ATTACHED_H
#include <ambit/spatial.h>

enum { ATTACHED_FROM, ATTACHED_TO };
enum { ATTACHED_OFFSET, ATTACHED_AXIS, ATTACHED_ANGLE };

static const ambit_port attached_port[] = {
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries this one" },
  { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the attached frame" },
};
static const ambit_param attached_param[] = {
  { "offset", "m", "3", "0,0,0", "from the origin of `from` to that of `to`, in the axes of `from`" },
  { "axis", "1", "axis", "z", "axis of the rotation, in the axes of `from`" },
  { "angle", "rad", "", "", "turns the axes of `from` into those of `to`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status attached_check(ambit_build *b) {
  ambit_status status = ambit_check_fixed(b, b->param(b, ATTACHED_OFFSET), 3, "offset");
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, ATTACHED_AXIS), 3, "axis");
  return status == AMBIT_OK ? ambit_check_fixed(b, b->param(b, ATTACHED_ANGLE), 1, "angle") : status;
}

static ambit_status attached_motion(
    ambit_build *b, uint32_t quantity, ambit_rotation q, ambit_vector3 p, ambit_expr *out) {
  const ambit_expr *from = b->get(b, ATTACHED_FROM, quantity);
  if (!from) return AMBIT_INVALID;
  if (quantity == AMBIT_POSE) {
    ambit_pose_write(ambit_pose_after(b, ambit_pose_read(from), q, p), out);
    return AMBIT_OK;
  }
  ambit_screw s = ambit_screw_read(from);
  s.linear = ambit_velocity_at(b, s, p);
  if (quantity == AMBIT_ACCEL && (p.c[0] || p.c[1] || p.c[2])) { /* without an offset nobody needs the twist */
    const ambit_expr *twist = b->get(b, ATTACHED_FROM, AMBIT_TWIST);
    if (!twist) return AMBIT_INVALID;
    s.linear = ambit_vector3_add(b, s.linear, ambit_centripetal(b, ambit_vector3_read(twist), p));
  }
  ambit_screw_write(ambit_screw_turn_back(b, q, s), out);
  return AMBIT_OK;
}

static ambit_status attached_express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_rotation q;
  ambit_vector3 p = ambit_vector3_read(b->param(b, ATTACHED_OFFSET));
  int force = port == ATTACHED_FROM && quantity == AMBIT_WRENCH,
      motion = port == ATTACHED_TO && quantity <= AMBIT_ACCEL;
  if (!force && !motion) return AMBIT_UNABLE;
  ambit_status status = ambit_rotation_param(b, ATTACHED_AXIS, ATTACHED_ANGLE, &q);
  if (status == AMBIT_OK && quantity != AMBIT_POSE) status = attached_check(b);
  if (status != AMBIT_OK) return status;
  if (motion) return attached_motion(b, quantity, q, p, out);
  const ambit_expr *wrench = b->get(b, ATTACHED_TO, AMBIT_WRENCH);
  if (!wrench) return AMBIT_INVALID;
  ambit_screw_write(ambit_wrench_before(b, ambit_screw_read(wrench), q, p), out);
  return AMBIT_OK;
}

static const ambit_element attached_element = { sizeof attached_element, 2, attached_port, attached_param,
  attached_express, NULL };
#endif
