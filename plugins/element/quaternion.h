/* quaternion.h -- a joint whose orientation is a unit quaternion q = (w, x, y, z): no position is singular. It has one
** coordinate more than degrees of freedom; the speeds are the angular velocity u of `to` against `from`, in the axes of
** `to`, and with displacements (p, in the axes of `from`) their rates.
**
**   R = | 1 - 2 (y^2 + z^2)   2 (x y - w z)       2 (x z + w y)     |     q' = q (0, u) / 2:
**       | 2 (x y + w z)       1 - 2 (x^2 + z^2)   2 (y z - w x)     |     w' = -(x u1 + y u2 + z u3) / 2
**       | 2 (x z - w y)       2 (y z + w x)       1 - 2 (x^2 + y^2) |     x' = (w u1 + y u3 - z u2) / 2, ...
** [Featherstone 2008, 4.4 and table 4.2; Euler 1770]. R is a rotation where |q| = 1, and only there: it is not divided
** by |q|^2, because q' keeps |q| whatever u is (the matrix of u is skew), so that a motion that starts with |q| = 1
** never uses R elsewhere; each entry then has every component once, and its range over a box is exact. The row q.q - 1
** of the constraint port says so to whoever encloses the motion; its time derivative vanishes identically, so it has
** no multiplier. Where only positions are asked for, |q| = 1 is the asker's promise.
**
** In own axes (subscript 1: of `to`), with R as above:
**   w_1 = R^T w + u                       v_1 = R^T (v + w x p + p')
**   alpha_1 = R^T alpha + u' + w_1 x u    a_1 = R^T (a + alpha x p + w x (w x p) + 2 w x p' + p'')
** The wrench (t, f) at `to` acts on `from` as (R t + p x R f, R f); the balance of u is t, that of p' is R f, plus the
** efforts.
*/
#ifndef AMBIT_QUATERNION_H
#define AMBIT_QUATERNION_H
#include <ambit/spatial.h>

enum { QUATERNION_FROM, QUATERNION_TO, QUATERNION_JOINT, QUATERNION_NORM };

#define QUATERNION_PORTS(dof, what)                                                                                    \
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the joint" },                               \
      { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the frame that moves" },                                        \
      { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, AMBIT_DOF(dof, dof + 1), 0, what }, {                               \
    "norm", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, 1, 0, "the square of the quaternion's norm, minus 1"                \
  }

typedef struct quaternion {
  ambit_expr w;
  ambit_vector3 v; /* x, y, z */
} quaternion;

static inline quaternion quaternion_read(ambit_build *b) {
  quaternion q = { b->state(b, 0, 0, "1"), ambit_vector3_zero() };
  for (uint32_t i = 0; i < 3; i++) q.v.c[i] = b->state(b, 1 + i, 0, "1");
  return q;
}

static inline ambit_rotation quaternion_rotation(ambit_build *b, quaternion q) {
  ambit_rotation r;
  ambit_expr one = b->num(b, "1"), two = b->num(b, "2");
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    ambit_expr others = ambit_add(b, ambit_square(b, q.v.c[j]), ambit_square(b, q.v.c[k]));
    ambit_expr pair = ambit_multiply(b, q.v.c[i], q.v.c[j]), turn = ambit_multiply(b, q.w, q.v.c[k]);
    r.m[i][i] = ambit_subtract(b, one, ambit_multiply(b, two, others));
    r.m[i][j] = ambit_multiply(b, two, ambit_subtract(b, pair, turn));
    r.m[j][i] = ambit_multiply(b, two, ambit_add(b, pair, turn));
  }
  return r;
}

/* u (order 1) or u' (order 2), or with the displacements' first index 3: p' or p'' */
static inline ambit_vector3 quaternion_speed(ambit_build *b, uint32_t first, uint32_t order) {
  ambit_vector3 u;
  for (uint32_t i = 0; i < 3; i++) u.c[i] = b->speed(b, first + i, order, first ? "m/s" : "rad/s");
  return u;
}

/* `dof`: 3 for a ball joint; 6 with displacements */
static inline ambit_vector3 quaternion_offset(ambit_build *b, uint32_t dof) {
  ambit_vector3 p = ambit_vector3_zero();
  for (uint32_t i = 0; i < 3 && dof > 3; i++) p.c[i] = b->state(b, 4 + i, 0, "m");
  return p;
}

static inline ambit_vector3 quaternion_travel(ambit_build *b, uint32_t dof, uint32_t order) {
  return dof > 3 ? quaternion_speed(b, 3, order) : ambit_vector3_zero();
}

/* q' = q (0, u) / 2, then p' */
static inline void quaternion_coordinate_rate(ambit_build *b, uint32_t dof, ambit_expr *out) {
  quaternion q = quaternion_read(b);
  ambit_vector3 u = quaternion_speed(b, 0, 1), p = quaternion_travel(b, dof, 1),
                turned = ambit_vector3_scale(b, q.w, u);
  ambit_expr half = b->num(b, "0.5");
  turned = ambit_vector3_add(b, turned, ambit_vector3_cross(b, q.v, u));
  out[0] = ambit_negate(b, ambit_multiply(b, half, ambit_vector3_dot(b, q.v, u)));
  for (uint32_t i = 0; i < 3; i++) out[1 + i] = ambit_multiply(b, half, turned.c[i]);
  for (uint32_t i = 3; i < dof; i++) out[1 + i] = p.c[i - 3];
}

static inline void quaternion_joint(ambit_build *b, uint32_t dof, uint32_t quantity, ambit_expr *out) {
  if (quantity == AMBIT_COORDINATE_RATE) {
    quaternion_coordinate_rate(b, dof, out);
  } else if (quantity == AMBIT_COORDINATE) {
    for (uint32_t i = 0; i < dof + 1; i++) out[i] = b->state(b, i, 0, i < 4 ? "1" : "m");
  } else {
    for (uint32_t i = 0; i < dof; i++) out[i] = b->speed(b, i, quantity - AMBIT_COORDINATE, i < 3 ? "rad/s" : "m/s");
  }
}

static inline ambit_screw quaternion_twist(ambit_build *b, uint32_t dof, ambit_rotation r, ambit_screw s) {
  ambit_vector3 travel = quaternion_travel(b, dof, 1);
  s.linear = ambit_vector3_add(b, ambit_velocity_at(b, s, quaternion_offset(b, dof)), travel);
  s = ambit_screw_turn_back(b, r, s);
  s.angular = ambit_vector3_add(b, s.angular, quaternion_speed(b, 0, 1));
  return s;
}

/* `twist`: of `from` */
static inline ambit_screw quaternion_acceleration(
    ambit_build *b, uint32_t dof, ambit_rotation r, ambit_screw s, ambit_screw twist) {
  ambit_vector3 travel = quaternion_travel(b, dof, 1), u = quaternion_speed(b, 0, 1);
  ambit_vector3 coriolis = ambit_vector3_scale(b, b->num(b, "2"), ambit_vector3_cross(b, twist.angular, travel));
  s.linear = ambit_acceleration_at(b, s, twist.angular, quaternion_offset(b, dof));
  s.linear = ambit_vector3_add(b, ambit_vector3_add(b, s.linear, coriolis), quaternion_travel(b, dof, 2));
  s = ambit_screw_turn_back(b, r, s);
  ambit_vector3 gyration = ambit_vector3_cross(b, ambit_rotation_turn_back(b, r, twist.angular), u);
  s.angular = ambit_vector3_add(b, ambit_vector3_add(b, s.angular, quaternion_speed(b, 0, 2)), gyration);
  return s;
}

static inline ambit_status quaternion_motion(
    ambit_build *b, uint32_t dof, uint32_t quantity, ambit_rotation r, ambit_expr *out) {
  const ambit_expr *from = b->get(b, QUATERNION_FROM, quantity);
  if (!from) return AMBIT_INVALID;
  if (quantity == AMBIT_POSE) {
    ambit_pose_write(ambit_pose_after(b, ambit_pose_read(from), r, quaternion_offset(b, dof)), out);
    return AMBIT_OK;
  }
  const ambit_expr *twist = b->get(b, QUATERNION_FROM, AMBIT_TWIST);
  if (!twist) return AMBIT_INVALID;
  ambit_screw s = ambit_screw_read(from);
  s = quantity == AMBIT_TWIST ? quaternion_twist(b, dof, r, s)
                              : quaternion_acceleration(b, dof, r, s, ambit_screw_read(twist));
  ambit_screw_write(s, out);
  return AMBIT_OK;
}

static inline ambit_status quaternion_balance(ambit_build *b, uint32_t dof, ambit_rotation r, ambit_expr *out) {
  const ambit_expr *to = b->get(b, QUATERNION_TO, AMBIT_WRENCH);
  const ambit_expr *effort = to ? b->get(b, QUATERNION_JOINT, AMBIT_EFFORT) : NULL;
  if (!effort) return AMBIT_INVALID;
  ambit_screw wrench = ambit_screw_read(to);
  wrench.linear = ambit_rotation_turn(b, r, wrench.linear);
  for (uint32_t i = 0; i < dof; i++)
    out[i] = ambit_add(b, i < 3 ? wrench.angular.c[i] : wrench.linear.c[i - 3], effort[i]);
  return AMBIT_OK;
}

static inline ambit_status quaternion_wrench(ambit_build *b, uint32_t dof, ambit_rotation r, ambit_expr *out) {
  const ambit_expr *to = b->get(b, QUATERNION_TO, AMBIT_WRENCH);
  if (!to) return AMBIT_INVALID;
  ambit_screw_write(ambit_wrench_before(b, ambit_screw_read(to), r, quaternion_offset(b, dof)), out);
  return AMBIT_OK;
}

/* q.q - 1 */
static inline void quaternion_norm(ambit_build *b, ambit_expr *out) {
  quaternion q = quaternion_read(b);
  ambit_expr square = ambit_add(b, ambit_square(b, q.w), ambit_vector3_dot(b, q.v, q.v));
  *out = ambit_subtract(b, square, b->num(b, "1"));
}

static inline ambit_status quaternion_express(
    ambit_build *b, uint32_t dof, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int of_joint = port == QUATERNION_JOINT && quantity >= AMBIT_COORDINATE && quantity <= AMBIT_RATE2;
  if (of_joint || (port == QUATERNION_JOINT && quantity == AMBIT_COORDINATE_RATE)) {
    quaternion_joint(b, dof, quantity, out);
    return AMBIT_OK;
  }
  if (port == QUATERNION_NORM && quantity == AMBIT_RESIDUAL) {
    quaternion_norm(b, out);
    return AMBIT_OK;
  }
  ambit_rotation r = quaternion_rotation(b, quaternion_read(b));
  if (port == QUATERNION_TO && quantity <= AMBIT_ACCEL) return quaternion_motion(b, dof, quantity, r, out);
  if (port == QUATERNION_FROM && quantity == AMBIT_WRENCH) return quaternion_wrench(b, dof, r, out);
  if (port == QUATERNION_JOINT && quantity == AMBIT_BALANCE) return quaternion_balance(b, dof, r, out);
  return AMBIT_UNABLE;
}

#define QUATERNION_ELEMENT(dof)                                                                                        \
  static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {                     \
    return quaternion_express(b, dof, port, quantity, out);                                                            \
  }                                                                                                                    \
  static const ambit_param params[] = { { NULL, NULL, NULL, NULL, NULL } };                                            \
  static const ambit_element element = { sizeof element, 4, ports, params, express, NULL };
#endif
