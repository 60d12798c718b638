/* bushing.c -- a rubber bush: springs and dampers against all six relative motions of two frames.
**
** In the axes of `from`, Q = R_from^T R_to and d = R_from^T (r_to - r_from) are the relative pose. Rotations are
** measured by theta = 2 tan(phi/2) n (twice Rodrigues' vector) for the rotation by phi about n: rational in Q,
**   theta = 2 vee(Q - Q^T) / (1 + tr Q),   vee(A) = (A_32, A_13, A_21),
** free of the order of axes, and phi (1 + phi^2/12 + ...): 1 % too large at 20 degrees, 5 % at 44. At 180 degrees it is
** infinite: a domain problem. With g = theta/2 and the relative angular velocity w in the axes of `from`
**   theta' = w - g x w + g (g.w)    [Shuster, J. Astronautical Sci. 41 (1993)]
**   d'     = Q v_to - v_from - w_from x d
** Loads m = K_r theta + D_r theta', f = K d + D d'. By virtual power `to` feels the force -f at its origin and the
** torque -(m + g x m + g (g.m)); `from` feels the opposite, the force along the same line. So the energy is
** (d.K d + theta.K_r theta)/2 exactly, whatever the rotation, and the power -(d'.D d' + theta'.D_r theta').
*/
#include "dissipation.h"
#include "points.h"

enum { FROM, TO };
enum { STIFFNESS, ROTATIONAL_STIFFNESS, DAMPING, ROTATIONAL_DAMPING };

static const ambit_port ports[] = {
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame whose axes the bush has" },
  { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the other frame; at rest the two coincide" },
};
static const ambit_param params[] = {
  { "stiffness", "N/m", "3", "0,0,0", "along the axes of `from`" },
  { "rotational_stiffness", "N m/rad", "3", "0,0,0", "about the axes of `from`" },
  { "damping", "N s/m", "3", "0,0,0", "along the axes of `from`; not negative" },
  { "rotational_damping", "N m s/rad", "3", "0,0,0", "about the axes of `from`; not negative" },
  { NULL, NULL, NULL, NULL, NULL },
};

typedef struct bush {
  ambit_rotation q;
  ambit_vector3 d, theta, g;
  ambit_vector3 d_rate, theta_rate; /* only when asked for */
} bush;

/* Stiffnesses that move would put in power of their own. */
static ambit_status check(ambit_build *b) {
  ambit_status status = dissipation_check(b, b->param(b, DAMPING), 3, "damping");
  if (status == AMBIT_OK) status = dissipation_check(b, b->param(b, ROTATIONAL_DAMPING), 3, "rotational_damping");
  if (status == AMBIT_OK) status = ambit_check_fixed(b, b->param(b, STIFFNESS), 3, "stiffness");
  if (status != AMBIT_OK) return status;
  return ambit_check_fixed(b, b->param(b, ROTATIONAL_STIFFNESS), 3, "rotational_stiffness");
}

static ambit_vector3 vector_param(ambit_build *b, uint32_t i) { return ambit_vector3_read(b->param(b, i)); }
static int turns(ambit_build *b) {
  return !vector_is_zero(vector_param(b, ROTATIONAL_STIFFNESS)) || !vector_is_zero(vector_param(b, ROTATIONAL_DAMPING));
}
static int damps(ambit_build *b) {
  return !vector_is_zero(vector_param(b, DAMPING)) || !vector_is_zero(vector_param(b, ROTATIONAL_DAMPING));
}

static ambit_status place(ambit_build *b, bush *s) {
  const ambit_expr *from = b->get(b, FROM, AMBIT_POSE), *to = from ? b->get(b, TO, AMBIT_POSE) : NULL;
  if (!to) return AMBIT_INVALID;
  ambit_pose p = ambit_pose_read(from), r = ambit_pose_read(to);
  s->d = ambit_rotation_turn_back(b, p.rotation, vector3_subtract(b, r.position, p.position));
  for (int j = 0; j < 3; j++) {
    ambit_vector3 column = ambit_vector3_of(r.rotation.m[0][j], r.rotation.m[1][j], r.rotation.m[2][j]);
    ambit_vector3 own = ambit_rotation_turn_back(b, p.rotation, column);
    for (int i = 0; i < 3; i++) s->q.m[i][j] = own.c[i];
  }
  s->theta = s->g = s->d_rate = s->theta_rate = ambit_vector3_zero();
  if (!turns(b)) return AMBIT_OK;
  ambit_expr trace = ambit_add(b, ambit_add(b, s->q.m[0][0], s->q.m[1][1]), s->q.m[2][2]);
  ambit_expr bottom = ambit_add(b, b->num(b, "1"), trace);
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    s->g.c[i] = ambit_divide(b, ambit_subtract(b, s->q.m[k][j], s->q.m[j][k]), bottom);
  }
  s->theta = ambit_vector3_scale(b, b->num(b, "2"), s->g);
  return AMBIT_OK;
}

/* v +- g x v + g (g.v): the derivative of theta along v (minus), or its transpose (plus) */
static ambit_vector3 along(ambit_build *b, ambit_vector3 g, ambit_vector3 v, int transposed) {
  ambit_vector3 cross = ambit_vector3_cross(b, g, v);
  ambit_vector3 sum = transposed ? ambit_vector3_add(b, v, cross) : vector3_subtract(b, v, cross);
  return ambit_vector3_add(b, sum, ambit_vector3_scale(b, ambit_vector3_dot(b, g, v), g));
}

static ambit_status move(ambit_build *b, bush *s) {
  const ambit_expr *from = b->get(b, FROM, AMBIT_TWIST), *to = from ? b->get(b, TO, AMBIT_TWIST) : NULL;
  if (!to) return AMBIT_INVALID;
  ambit_screw p = ambit_screw_read(from), r = ambit_screw_read(to);
  ambit_vector3 v = ambit_rotation_turn(b, s->q, r.linear), w = ambit_rotation_turn(b, s->q, r.angular);
  s->d_rate = vector3_subtract(b, v, ambit_velocity_at(b, p, s->d));
  if (turns(b)) s->theta_rate = along(b, s->g, vector3_subtract(b, w, p.angular), 0);
  return AMBIT_OK;
}

/* K x + D x' */
static ambit_vector3 load(ambit_build *b, uint32_t stiffness, ambit_vector3 x, uint32_t damping, ambit_vector3 rate) {
  ambit_vector3 k = vector_param(b, stiffness), c = vector_param(b, damping), sum;
  for (int i = 0; i < 3; i++)
    sum.c[i] = ambit_add(b, ambit_multiply(b, k.c[i], x.c[i]), ambit_multiply(b, c.c[i], rate.c[i]));
  return sum;
}

static void write_wrench(ambit_build *b, uint32_t port, const bush *s, ambit_expr *out) {
  ambit_vector3 m = load(b, ROTATIONAL_STIFFNESS, s->theta, ROTATIONAL_DAMPING, s->theta_rate);
  ambit_screw w; /* what `from` feels */
  w.linear = load(b, STIFFNESS, s->d, DAMPING, s->d_rate);
  w.angular = turns(b) ? along(b, s->g, m, 1) : ambit_vector3_zero();
  if (port == FROM) {
    w.angular = ambit_vector3_add(b, w.angular, ambit_vector3_cross(b, s->d, w.linear));
  } else {
    w = ambit_screw_turn_back(b, s->q, w);
    w.linear = ambit_vector3_negate(b, w.linear);
    w.angular = ambit_vector3_negate(b, w.angular);
  }
  ambit_screw_write(w, out);
}

/* sum of c_i x_i^2 */
static ambit_expr weighted_squares(ambit_build *b, uint32_t weights, ambit_vector3 x) {
  ambit_vector3 c = vector_param(b, weights);
  for (int i = 0; i < 3; i++) x.c[i] = ambit_square(b, x.c[i]);
  return ambit_vector3_dot(b, c, x);
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  bush s;
  int wrench = port <= TO && quantity == AMBIT_WRENCH, power = port == AMBIT_NO_PORT && quantity == AMBIT_POWER;
  int energy = port == AMBIT_NO_PORT && quantity == AMBIT_ENERGY;
  if (!wrench && !energy && !power) return AMBIT_UNABLE;
  if (power && !damps(b)) return AMBIT_UNABLE;
  ambit_status status = place(b, &s);
  if (status == AMBIT_OK && !energy && damps(b)) status = move(b, &s);
  if (status != AMBIT_OK) return status;
  if (wrench) {
    write_wrench(b, port, &s, out);
  } else if (energy) {
    ambit_expr twice =
        ambit_add(b, weighted_squares(b, STIFFNESS, s.d), weighted_squares(b, ROTATIONAL_STIFFNESS, s.theta));
    out[0] = 0;
    out[1] = ambit_multiply(b, b->num(b, "0.5"), twice);
  } else {
    *out = ambit_negate(
        b, ambit_add(b, weighted_squares(b, DAMPING, s.d_rate), weighted_squares(b, ROTATIONAL_DAMPING, s.theta_rate)));
  }
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 2, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("bushing", "1.0",
    "A rubber bush between two frames that coincide at rest: springs and dampers along and about the axes of `from`. "
    "Rotations are measured by 2 tan(angle/2), close to the angle up to 20 degrees and infinite at 180.",
    element)
