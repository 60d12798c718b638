/* point_mass.c -- a mass at the origin of a frame.
**
** d'Alembert: it exerts the inertial force -m a, no torque; a is the proper acceleration, so that the weight is in
** it. Energy: m v^2 / 2 and -m g.r; momentum m v, angular momentum r x m v.
*/
#include <ambit/spatial.h>

enum { AT };
enum { MASS };

static const ambit_port ports[] = { { "at", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0,
    "the frame that carries the mass" } };
static const ambit_param params[] = {
  { "mass", "kg", "", NULL, "the mass" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express_wrench(ambit_build *b, ambit_expr m, ambit_expr *out) {
  const ambit_expr *accel = b->get(b, AT, AMBIT_ACCEL);
  if (!accel) return AMBIT_INVALID;
  ambit_screw wrench;
  wrench.angular = ambit_vector3_zero();
  wrench.linear = ambit_vector3_negate(b, ambit_vector3_scale(b, m, ambit_screw_read(accel).linear));
  ambit_screw_write(wrench, out);
  return AMBIT_OK;
}

static ambit_status express_energy(ambit_build *b, ambit_expr m, ambit_expr *out) {
  const ambit_expr *twist = b->get(b, AT, AMBIT_TWIST);
  if (!twist) return AMBIT_INVALID;
  ambit_vector3 v = ambit_screw_read(twist).linear;
  out[0] = ambit_multiply(b, ambit_multiply(b, b->num(b, "0.5"), m), ambit_vector3_dot(b, v, v));
  return ambit_potential_energy(b, AT, m, ambit_vector3_zero(), &out[1]);
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_expr m = *b->param(b, MASS);
  if (port == AT && quantity == AMBIT_WRENCH) return express_wrench(b, m, out);
  if (port != AMBIT_NO_PORT) return AMBIT_UNABLE;
  if (quantity == AMBIT_ENERGY) return express_energy(b, m, out);
  if (quantity < AMBIT_MASS || quantity > AMBIT_MOMENTUM) return AMBIT_UNABLE;
  return ambit_express_mass(b, AT, quantity, m, ambit_vector3_zero(), ambit_vector3_zero(), out);
}

static ambit_status check(ambit_build *b) { return ambit_check_mass(b, *b->param(b, MASS)); }

static const ambit_element element = { sizeof element, 1, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("point_mass", "1.0", "A mass without extent at the origin of a frame.", element)
