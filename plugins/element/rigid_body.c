/* rigid_body.c -- a body with mass m, centre of mass c and inertia I about c, all in the axes of the frame that
** carries it.
**
** Newton and Euler with d'Alembert, in the frame's axes:
**   a_c = a + alpha x c + w x (w x c),  force f = -m a_c,  torque t = -(I alpha + w x I w) + c x f
** Energy: (m v_c^2 + w.I w) / 2 and -m g.r_c; momentum m v_c, angular momentum r_c x m v_c + I w.
** [Featherstone 2008, ch. 2]
*/
#include "inertia.h"

enum { AT };
enum { MASS, CENTRE, INERTIA, PHYSICAL };

static const ambit_port ports[] = { { "at", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0,
    "the frame that carries the body" } };
static const ambit_param params[] = {
  { "mass", "kg", "", NULL, "the mass" },
  { "centre", "m", "3", "0,0,0", "centre of mass, in the axes of the frame" },
  { "inertia", "kg m^2", "3x3", "",
      "moments of inertia about the centre of mass, in the axes of the frame; absent: a point" },
  { "physical", "1", "flag", "true",
      "false: take mass and inertia as they are, even if no body has them (identified or published parameters)" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check(ambit_build *b) {
  double lo, hi;
  b->range(b, *b->param(b, PHYSICAL), &lo, &hi);
  ambit_status status =
      hi == 0 ? ambit_check_fixed(b, b->param(b, MASS), 1, "mass") : ambit_check_mass(b, *b->param(b, MASS));
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, CENTRE), 3, "centre");
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, INERTIA), 9, "inertia");
  return status == AMBIT_OK ? inertia_check(b, b->param(b, INERTIA), hi != 0) : status;
}

static ambit_status express_wrench(ambit_build *b, ambit_expr m, ambit_vector3 c, ambit_expr *out) {
  const ambit_expr *inertia = b->param(b, INERTIA), *at = b->get(b, AT, AMBIT_ACCEL);
  int extended = inertia || c.c[0] || c.c[1] || c.c[2];
  const ambit_expr *twist = at && extended ? b->get(b, AT, AMBIT_TWIST) : NULL;
  if (!at || (extended && !twist)) return AMBIT_INVALID;
  ambit_screw accel = ambit_screw_read(at), wrench;
  ambit_vector3 w = twist ? ambit_vector3_read(twist) : ambit_vector3_zero();
  wrench.linear = ambit_vector3_negate(b, ambit_vector3_scale(b, m, ambit_acceleration_at(b, accel, w, c)));
  wrench.angular = ambit_vector3_cross(b, c, wrench.linear);
  if (inertia) {
    ambit_rotation i = inertia_matrix(inertia);
    ambit_vector3 gyration = ambit_vector3_cross(b, w, ambit_rotation_turn(b, i, w));
    ambit_vector3 torque = ambit_vector3_add(b, ambit_rotation_turn(b, i, accel.angular), gyration);
    wrench.angular = ambit_vector3_add(b, wrench.angular, ambit_vector3_negate(b, torque));
  }
  ambit_screw_write(wrench, out);
  return AMBIT_OK;
}

static ambit_status express_energy(ambit_build *b, ambit_expr m, ambit_vector3 c, ambit_expr *out) {
  const ambit_expr *inertia = b->param(b, INERTIA), *at = b->get(b, AT, AMBIT_TWIST);
  if (!at) return AMBIT_INVALID;
  ambit_screw twist = ambit_screw_read(at);
  ambit_vector3 v = ambit_velocity_at(b, twist, c);
  ambit_expr twice = ambit_multiply(b, m, ambit_vector3_dot(b, v, v));
  if (inertia) {
    ambit_vector3 spin = ambit_rotation_turn(b, inertia_matrix(inertia), twist.angular);
    twice = ambit_add(b, twice, ambit_vector3_dot(b, twist.angular, spin));
  }
  out[0] = ambit_multiply(b, b->num(b, "0.5"), twice);
  return ambit_potential_energy(b, AT, m, c, &out[1]);
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_expr m = *b->param(b, MASS);
  ambit_vector3 c = ambit_vector3_read(b->param(b, CENTRE)), spin = ambit_vector3_zero();
  if (port == AT && quantity == AMBIT_WRENCH) return express_wrench(b, m, c, out);
  if (port != AMBIT_NO_PORT) return AMBIT_UNABLE;
  if (quantity == AMBIT_ENERGY) return express_energy(b, m, c, out);
  if (quantity < AMBIT_MASS || quantity > AMBIT_MOMENTUM) return AMBIT_UNABLE;
  const ambit_expr *inertia = b->param(b, INERTIA), *twist = NULL;
  if (quantity == AMBIT_MOMENTUM && inertia) {
    twist = b->get(b, AT, AMBIT_TWIST);
    if (!twist) return AMBIT_INVALID;
    spin = ambit_rotation_turn(b, inertia_matrix(inertia), ambit_vector3_read(twist));
  }
  return ambit_express_mass(b, AT, quantity, m, c, spin, out);
}

static const ambit_element element = { sizeof element, 1, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("rigid_body", "1.0", "A body with mass, centre of mass and inertia, carried by a frame.", element)
