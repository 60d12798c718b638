/* spatial.h -- vectors, rotations, twists and wrenches of expressions, so that an element reads like its formulas.
**
** Everything is inline and goes through ambit_build, which folds: 0 and 1 vanish, rotations about one axis add their
** angles. Motion is that of rigid bodies in their own axes (Featherstone 2008, ch. 2; Kecskemethy & Hiller 1994);
** every formula is derived in docs/numerics/mechanics.md. R turns own axes into the axes of the frame before: columns
** of R are the own axes.
*/
#ifndef AMBIT_SPATIAL_H
#define AMBIT_SPATIAL_H
#include "element.h"

typedef struct ambit_vector3 {
  ambit_expr c[3];
} ambit_vector3;
typedef struct ambit_rotation {
  ambit_expr m[3][3]; /* rows */
} ambit_rotation;
typedef struct ambit_pose {
  ambit_rotation rotation; /* own axes -> world */
  ambit_vector3 position;  /* of the origin, world axes */
} ambit_pose;
/* twist, acceleration or wrench: of a frame, in its own axes, at its origin */
typedef struct ambit_screw {
  ambit_vector3 angular, linear;
} ambit_screw;

/* -- numbers */

static inline ambit_expr ambit_add(ambit_build *b, ambit_expr x, ambit_expr y) { return b->op(b, AMBIT_OP_ADD, x, y); }
static inline ambit_expr ambit_subtract(ambit_build *b, ambit_expr x, ambit_expr y) {
  return b->op(b, AMBIT_OP_SUB, x, y);
}
/* A component that a direction does not have stays 0, even beside a factor that is not proved to be defined. */
static inline ambit_expr ambit_multiply(ambit_build *b, ambit_expr x, ambit_expr y) {
  return x == 0 || y == 0 ? 0 : b->op(b, AMBIT_OP_MUL, x, y);
}
static inline ambit_expr ambit_divide(ambit_build *b, ambit_expr x, ambit_expr y) {
  return b->op(b, AMBIT_OP_DIV, x, y);
}
static inline ambit_expr ambit_negate(ambit_build *b, ambit_expr x) { return b->op(b, AMBIT_OP_NEG, x, x); }
static inline ambit_expr ambit_square(ambit_build *b, ambit_expr x) { return b->op(b, AMBIT_OP_SQR, x, x); }
static inline ambit_expr ambit_root(ambit_build *b, ambit_expr x) { return b->op(b, AMBIT_OP_SQRT, x, x); }

/* -- vectors */

static inline ambit_vector3 ambit_vector3_of(ambit_expr x, ambit_expr y, ambit_expr z) {
  ambit_vector3 v;
  v.c[0] = x, v.c[1] = y, v.c[2] = z;
  return v;
}

static inline ambit_vector3 ambit_vector3_zero(void) { return ambit_vector3_of(0, 0, 0); }
static inline ambit_vector3 ambit_vector3_read(const ambit_expr *e) { return ambit_vector3_of(e[0], e[1], e[2]); }

static inline ambit_vector3 ambit_vector3_add(ambit_build *b, ambit_vector3 u, ambit_vector3 v) {
  for (int i = 0; i < 3; i++) u.c[i] = ambit_add(b, u.c[i], v.c[i]);
  return u;
}

static inline ambit_vector3 ambit_vector3_negate(ambit_build *b, ambit_vector3 v) {
  for (int i = 0; i < 3; i++) v.c[i] = ambit_negate(b, v.c[i]);
  return v;
}

static inline ambit_vector3 ambit_vector3_scale(ambit_build *b, ambit_expr s, ambit_vector3 v) {
  for (int i = 0; i < 3; i++) v.c[i] = ambit_multiply(b, s, v.c[i]);
  return v;
}

static inline ambit_expr ambit_vector3_dot(ambit_build *b, ambit_vector3 u, ambit_vector3 v) {
  ambit_expr s = 0;
  for (int i = 0; i < 3; i++) s = ambit_add(b, s, ambit_multiply(b, u.c[i], v.c[i]));
  return s;
}

static inline ambit_vector3 ambit_vector3_cross(ambit_build *b, ambit_vector3 u, ambit_vector3 v) {
  ambit_vector3 w;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    w.c[i] = ambit_subtract(b, ambit_multiply(b, u.c[j], v.c[k]), ambit_multiply(b, u.c[k], v.c[j]));
  }
  return w;
}

/* The unit vector along v; exact 0 and 1 for "x", "-z". Zero: fails. */
static inline ambit_status ambit_vector3_unit(ambit_build *b, const ambit_expr *v, ambit_vector3 *unit) {
  ambit_vector3 u = ambit_vector3_read(v);
  ambit_expr square = ambit_vector3_dot(b, u, u);
  double lo, hi;
  b->range(b, square, &lo, &hi);
  if (!(hi > 0)) return b->fail(b, AMBIT_INVALID, "the axis is zero: expected a direction");
  ambit_expr length = ambit_root(b, square);
  for (int i = 0; i < 3; i++) unit->c[i] = ambit_divide(b, u.c[i], length);
  return AMBIT_OK;
}

/* -- rotations */

static inline ambit_rotation ambit_rotation_identity(ambit_build *b) {
  ambit_rotation r;
  ambit_expr one = b->num(b, "1");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) r.m[i][j] = i == j ? one : 0;
  return r;
}

/* By the angle about the unit vector n (Rodrigues 1840): cos a 1 + (1 - cos a) n n^T + sin a [n x]. The diagonal is
** written n_i^2 + cos a (1 - n_i^2), in which cos a occurs once.
*/
static inline ambit_rotation ambit_rotation_about(ambit_build *b, ambit_vector3 n, ambit_expr angle) {
  ambit_rotation r;
  ambit_expr c = b->op(b, AMBIT_OP_COS, angle, angle), s = b->op(b, AMBIT_OP_SIN, angle, angle), one = b->num(b, "1");
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    ambit_expr square = ambit_square(b, n.c[i]), pair = ambit_multiply(b, n.c[i], n.c[j]);
    ambit_expr even = ambit_multiply(b, pair, ambit_subtract(b, one, c)), odd = ambit_multiply(b, n.c[k], s);
    r.m[i][i] = ambit_add(b, square, ambit_multiply(b, c, ambit_subtract(b, one, square)));
    r.m[i][j] = ambit_subtract(b, even, odd);
    r.m[j][i] = ambit_add(b, even, odd);
  }
  return r;
}

static inline ambit_rotation ambit_rotation_product(ambit_build *b, ambit_rotation p, ambit_rotation q) {
  ambit_rotation r;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r.m[i][j] = ambit_vector3_dot(b, ambit_vector3_read(p.m[i]), ambit_vector3_of(q.m[0][j], q.m[1][j], q.m[2][j]));
  return r;
}

/* R v: from own axes to those before */
static inline ambit_vector3 ambit_rotation_turn(ambit_build *b, ambit_rotation r, ambit_vector3 v) {
  ambit_vector3 w;
  for (int i = 0; i < 3; i++) w.c[i] = ambit_vector3_dot(b, ambit_vector3_read(r.m[i]), v);
  return w;
}

/* R^T v: from the axes before to own ones */
static inline ambit_vector3 ambit_rotation_turn_back(ambit_build *b, ambit_rotation r, ambit_vector3 v) {
  ambit_vector3 w;
  for (int j = 0; j < 3; j++) w.c[j] = ambit_vector3_dot(b, ambit_vector3_of(r.m[0][j], r.m[1][j], r.m[2][j]), v);
  return w;
}

/* -- what crosses the border */

static inline ambit_pose ambit_pose_read(const ambit_expr *e) {
  ambit_pose p;
  for (int i = 0; i < 9; i++) p.rotation.m[i / 3][i % 3] = e[i];
  p.position = ambit_vector3_read(e + 9);
  return p;
}

static inline void ambit_pose_write(ambit_pose p, ambit_expr *out) {
  for (int i = 0; i < 9; i++) out[i] = p.rotation.m[i / 3][i % 3];
  for (int i = 0; i < 3; i++) out[9 + i] = p.position.c[i];
}

static inline ambit_screw ambit_screw_read(const ambit_expr *e) {
  ambit_screw s;
  s.angular = ambit_vector3_read(e);
  s.linear = ambit_vector3_read(e + 3);
  return s;
}

static inline void ambit_screw_write(ambit_screw s, ambit_expr *out) {
  for (int i = 0; i < 3; i++) out[i] = s.angular.c[i], out[3 + i] = s.linear.c[i];
}

/* -- rigid transport. All vectors in the axes of the frame; p: the other point, fixed in the frame. */

/* v_p = v + w x p */
static inline ambit_vector3 ambit_velocity_at(ambit_build *b, ambit_screw twist, ambit_vector3 p) {
  return ambit_vector3_add(b, twist.linear, ambit_vector3_cross(b, twist.angular, p));
}

/* w x (w x p), the centripetal acceleration */
static inline ambit_vector3 ambit_centripetal(ambit_build *b, ambit_vector3 w, ambit_vector3 p) {
  return ambit_vector3_cross(b, w, ambit_vector3_cross(b, w, p));
}

/* a_p = a + alpha x p + w x (w x p) */
static inline ambit_vector3 ambit_acceleration_at(ambit_build *b, ambit_screw accel, ambit_vector3 w, ambit_vector3 p) {
  return ambit_vector3_add(b, ambit_velocity_at(b, accel, p), ambit_centripetal(b, w, p));
}

/* Pose of a frame whose own axes are turned by q and whose origin is at p. */
static inline ambit_pose ambit_pose_after(ambit_build *b, ambit_pose before, ambit_rotation q, ambit_vector3 p) {
  ambit_pose r;
  r.rotation = ambit_rotation_product(b, before.rotation, q);
  r.position = ambit_vector3_add(b, before.position, ambit_rotation_turn(b, before.rotation, p));
  return r;
}

/* The screw in the axes that q turns into the present ones. */
static inline ambit_screw ambit_screw_turn_back(ambit_build *b, ambit_rotation q, ambit_screw s) {
  s.angular = ambit_rotation_turn_back(b, q, s.angular);
  s.linear = ambit_rotation_turn_back(b, q, s.linear);
  return s;
}

/* A wrench at a frame (q, p) as the wrench that it is at the frame before: force q f, torque q t + p x q f. */
static inline ambit_screw ambit_wrench_before(ambit_build *b, ambit_screw wrench, ambit_rotation q, ambit_vector3 p) {
  ambit_screw r;
  r.linear = ambit_rotation_turn(b, q, wrench.linear);
  r.angular = ambit_vector3_add(b, ambit_rotation_turn(b, q, wrench.angular), ambit_vector3_cross(b, p, r.linear));
  return r;
}

/* -- parameters */

/* The rotation that an element's `axis` and `angle` say (parameters of that number); angle absent: none. */
static inline ambit_status ambit_rotation_param(ambit_build *b, uint32_t axis, uint32_t angle, ambit_rotation *r) {
  const ambit_expr *a = b->param(b, angle);
  ambit_vector3 n;
  *r = ambit_rotation_identity(b);
  if (!a) return AMBIT_OK;
  ambit_status status = ambit_vector3_unit(b, b->param(b, axis), &n);
  if (status == AMBIT_OK) *r = ambit_rotation_about(b, n, *a);
  return status;
}

/* Data that do not move: anything else than a fixed value of parameter `name` fails. */
static inline ambit_status ambit_check_fixed(ambit_build *b, const ambit_expr *e, uint32_t n, const char *name) {
  for (uint32_t i = 0; e && i < n; i++)
    if (b->diff_time(b, e[i]) != 0)
      return b->fail(b, AMBIT_INVALID,
          "`%s` moves in time: it must be fixed; for a given motion use a revolute or prismatic joint", name);
  return AMBIT_OK;
}

/* A joint of one degree of freedom: its coordinate (order 0) or a time derivative of it, given by parameter `given`
** or a state.
*/
static inline ambit_expr ambit_joint_coordinate(ambit_build *b, uint32_t given, uint32_t order, const char *unit) {
  const ambit_expr *motion = b->param(b, given);
  if (!motion) return b->state(b, 0, order, unit);
  ambit_expr e = *motion;
  for (uint32_t k = 0; k < order; k++) e = b->diff_time(b, e);
  return e;
}

/* AMBIT_POWER of such a joint: a given motion puts in -balance ds/dt, the derivative at fixed coordinates. A joint that
** follows coordinates only (a gear) does no work of its own.
*/
static inline ambit_status ambit_drive_power(ambit_build *b, uint32_t joint, uint32_t given, ambit_expr *out) {
  const ambit_expr *motion = b->param(b, given);
  ambit_expr rate = motion ? b->partial_time(b, *motion) : 0;
  if (rate == 0) return AMBIT_UNABLE;
  const ambit_expr *balance = b->get(b, joint, AMBIT_BALANCE);
  if (!balance) return AMBIT_INVALID;
  *out = ambit_negate(b, ambit_multiply(b, *balance, rate));
  return AMBIT_OK;
}

/* -- masses */

/* A fixed mass that may be positive. Zero is refused: a frame without mass needs no body, and a body of mass 0 is a
** slip of the pen, or of the program that wrote the file.
*/
static inline ambit_status ambit_check_mass(ambit_build *b, ambit_expr mass) {
  double lo, hi;
  b->range(b, mass, &lo, &hi);
  if (hi < 0) return b->fail(b, AMBIT_INVALID, "the mass is negative: %g kg; expected above 0", hi);
  if (hi == 0) return b->fail(b, AMBIT_INVALID, "the mass is zero: expected above 0 kg; leave out a body without mass");
  return ambit_check_fixed(b, &mass, 1, "mass");
}

/* Mass, first moment and momentum of a mass m whose centre is at c of the frame at an IN port (AMBIT_MASS,
** AMBIT_MASS_MOMENT, AMBIT_MOMENTUM); `spin`: its angular momentum about the centre, in the frame's axes.
*/
static inline ambit_status ambit_express_mass(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr m,
    ambit_vector3 c, ambit_vector3 spin, ambit_expr *out) {
  if (quantity == AMBIT_MASS) {
    *out = m;
    return AMBIT_OK;
  }
  const ambit_expr *at = b->get(b, port, AMBIT_POSE);
  const ambit_expr *twist = at && quantity == AMBIT_MOMENTUM ? b->get(b, port, AMBIT_TWIST) : NULL;
  if (!at || (quantity == AMBIT_MOMENTUM && !twist)) return AMBIT_INVALID;
  ambit_pose pose = ambit_pose_read(at);
  ambit_vector3 r = ambit_vector3_add(b, pose.position, ambit_rotation_turn(b, pose.rotation, c));
  if (quantity == AMBIT_MASS_MOMENT) {
    r = ambit_vector3_scale(b, m, r);
    for (int i = 0; i < 3; i++) out[i] = r.c[i];
    return AMBIT_OK;
  }
  ambit_vector3 v = ambit_velocity_at(b, ambit_screw_read(twist), c);
  ambit_screw s;
  s.linear = ambit_vector3_scale(b, m, ambit_rotation_turn(b, pose.rotation, v));
  s.angular = ambit_vector3_add(b, ambit_rotation_turn(b, pose.rotation, spin), ambit_vector3_cross(b, r, s.linear));
  ambit_screw_write(s, out);
  return AMBIT_OK;
}

/* Potential energy -m g.r of a mass whose centre is at c of the frame at an IN port; 0 where there is no field,
** without a pose.
*/
static inline ambit_status ambit_potential_energy(
    ambit_build *b, uint32_t port, ambit_expr mass, ambit_vector3 c, ambit_expr *e) {
  const ambit_expr *field = b->get(b, AMBIT_NO_PORT, AMBIT_FIELD);
  *e = 0;
  if (!field) return AMBIT_INVALID;
  if (field[0] == 0 && field[1] == 0 && field[2] == 0) return AMBIT_OK;
  const ambit_expr *at = b->get(b, port, AMBIT_POSE);
  if (!at) return AMBIT_INVALID;
  ambit_pose pose = ambit_pose_read(at);
  ambit_vector3 r = ambit_vector3_add(b, pose.position, ambit_rotation_turn(b, pose.rotation, c));
  *e = ambit_negate(b, ambit_multiply(b, mass, ambit_vector3_dot(b, ambit_vector3_read(field), r)));
  return AMBIT_OK;
}

/* -- the plugin itself */

static inline int32_t ambit_same_text(const char *a, const char *b) {
  while (*a && *a == *b) a++, b++;
  return *a == *b;
}

/* ambit_entry of a plugin that is one element. */
#define AMBIT_ELEMENT_ENTRY(name, version, doc, table)                                                                 \
  static const void *get_interface(const char *id) { return ambit_same_text(id, AMBIT_ELEMENT) ? &(table) : NULL; }    \
  const ambit_plugin ambit_entry = { sizeof(ambit_plugin), AMBIT_ABI, "element." name, version, doc, get_interface };
#endif
