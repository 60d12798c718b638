/* rigid_body.c -- a body with mass m, centre of mass c and inertia I about c, all in the axes of the frame that
** carries it.
**
** Newton and Euler with d'Alembert, in the frame's axes:
**   a_c = a + alpha x c + w x (w x c),  force f = -m a_c,  torque t = -(I alpha + w x I w) + c x f
** Energy: (m v_c^2 + w.I w) / 2 and -m g.r_c. [Featherstone 2008, ch. 2]
*/
#include <ambit/spatial.h>

enum { AT };
enum { MASS, CENTRE, INERTIA };

static const ambit_port ports[] = { { "at", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0,
    "the frame that carries the body" } };
static const ambit_param params[] = {
  { "mass", "kg", "", NULL, "the mass" },
  { "centre", "m", "3", "0,0,0", "centre of mass, in the axes of the frame" },
  { "inertia", "kg m^2", "3x3", "",
      "moments of inertia about the centre of mass, in the axes of the frame; absent: a point" },
  { NULL, NULL, NULL, NULL, NULL },
};

/* I from the upper triangle: a symmetric matrix, also when both halves were given apart. */
static ambit_rotation symmetric(const ambit_expr *e) {
  ambit_rotation m;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m.m[i][j] = i <= j ? e[3 * i + j] : e[3 * j + i];
  return m;
}

/* Known numbers are checked: I is symmetric, and the second moments tr(I)/2 1 - I of a mass distribution form a
** positive semidefinite matrix [Traversaro et al. 2016], which contains the triangle inequality of the principal
** moments.
*/
static ambit_status check_inertia(ambit_build *b, const ambit_expr *e) {
  double x[9], s[9], hi;
  if (!e) return AMBIT_OK;
  for (int i = 0; i < 9; i++) {
    b->range(b, e[i], &x[i], &hi);
    if (!(hi - x[i] <= 1e-12 * (hi < 0 ? -x[i] : hi))) return AMBIT_OK; /* uncertain */
  }
  double trace = x[0] + x[4] + x[8], slack = 1e-9 * (trace < 0 ? -trace : trace);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double gap = x[3 * i + j] - x[3 * j + i];
      if (gap > slack || gap < -slack)
        return b->fail(b, AMBIT_INVALID,
            "the inertia is not symmetric: row %d, column %d is %g, row %d, column %d is %g", i + 1, j + 1,
            x[3 * i + j], j + 1, i + 1, x[3 * j + i]);
      s[3 * i + j] = (i == j ? trace / 2 : 0) - x[3 * i + j];
    }
  int good = trace >= 0;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3;
    good = good && s[4 * i] >= -slack && s[4 * i] * s[4 * j] - s[3 * i + j] * s[3 * i + j] >= -slack * trace;
  }
  double d =
      s[0] * (s[4] * s[8] - s[5] * s[7]) - s[1] * (s[3] * s[8] - s[5] * s[6]) + s[2] * (s[3] * s[7] - s[4] * s[6]);
  if (good && d >= -slack * trace * trace) return AMBIT_OK;
  return b->fail(b, AMBIT_INVALID,
      "no body has this inertia: of its principal moments one is negative, or larger than the sum of the other two");
}

static ambit_status check(ambit_build *b) {
  ambit_status status = ambit_check_mass(b, *b->param(b, MASS));
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, CENTRE), 3, "centre");
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, INERTIA), 9, "inertia");
  return status == AMBIT_OK ? check_inertia(b, b->param(b, INERTIA)) : status;
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
    ambit_rotation i = symmetric(inertia);
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
    ambit_vector3 spin = ambit_rotation_turn(b, symmetric(inertia), twist.angular);
    twice = ambit_add(b, twice, ambit_vector3_dot(b, twist.angular, spin));
  }
  out[0] = ambit_multiply(b, b->num(b, "0.5"), twice);
  return ambit_potential_energy(b, AT, m, c, &out[1]);
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int wrench = port == AT && quantity == AMBIT_WRENCH, energy = port == AMBIT_NO_PORT && quantity == AMBIT_ENERGY;
  if (!wrench && !energy) return AMBIT_UNABLE;
  ambit_status status = check(b);
  if (status != AMBIT_OK) return status;
  ambit_expr m = *b->param(b, MASS);
  ambit_vector3 c = ambit_vector3_read(b->param(b, CENTRE));
  return wrench ? express_wrench(b, m, c, out) : express_energy(b, m, c, out);
}

static const ambit_element element = { sizeof element, 1, ports, params, express };

AMBIT_ELEMENT_ENTRY("rigid_body", "1.0", "A body with mass, centre of mass and inertia, carried by a frame.", element)
