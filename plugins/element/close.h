/* close.h -- elements that close a loop: the relative position of two frames `a` and `b` is restricted by residuals g,
** each kept at 0 by a multiplier.
**
** With the world's axes, r_a, r_b the origins, d = r_b - r_a, v and w the velocities of the origins and the angular
** velocities; m, n directions fixed in a and b:
**   world    g = e.d          dg/dt = e.(v_b - v_a)
**   along    g = m.d          dg/dt = m.(v_b - v_a) + w_a.(m x d)
**   square   g = m.n          dg/dt = (w_a - w_b).(m x n)
**   rod      g = (d.d - l^2) / (2 l)          dg/dt = d.(v_b - v_a) / l
** What stands beside v_b, v_a, w_a, w_b are the forces and torques per unit of the multiplier at the origins of b and
** a: so the virtual power of the element is sum of lambda_k dg_k/dt, whatever the motion (Lagrange; Haug,
** Computer-Aided Kinematics and Dynamics of Mechanical Systems, 1989, ch. 9). A row at 0 is in metres (multiplier: N)
** or the cosine of an angle (multiplier: N m).
**
** The rows say less than the joint that they are named after where they compare directions: m.n = 0 for all m across
** an axis holds for n along it and against it. Which of these assemblies is meant is said by the initial values.
*/
#ifndef AMBIT_CLOSE_H
#define AMBIT_CLOSE_H
#include <ambit/spatial.h>

#define CLOSE_ROWS 6

enum { CLOSE_A, CLOSE_B, CLOSE_LOOP };

typedef struct close_row {
  ambit_expr g;
  ambit_vector3 force;              /* on b at its origin per unit of the multiplier; a: the opposite */
  ambit_vector3 torque_a, torque_b; /* per unit of the multiplier; world axes */
  const char *unit;                 /* of the multiplier */
} close_row;

typedef struct closure {
  ambit_pose a, b;
  ambit_vector3 gap; /* d */
  uint32_t count;
  close_row row[CLOSE_ROWS];
} closure;

#define CLOSE_PORTS(rows, what)                                                                                        \
  { "a", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame at the end of one chain" },                                 \
      { "b", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that it meets" }, {                                     \
    "loop", AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT, rows, 0, what                                                       \
  }

static inline close_row *close_push(closure *s, ambit_expr g, const char *unit) {
  close_row *row = &s->row[s->count++];
  row->g = g;
  row->force = row->torque_a = row->torque_b = ambit_vector3_zero();
  row->unit = unit;
  return row;
}

/* The origins have the same coordinate i in the world. */
static inline void close_world(ambit_build *b, closure *s, int i) {
  close_row *row = close_push(s, s->gap.c[i], "N");
  row->force.c[i] = b->num(b, "1");
}

/* The origin of b does not leave that of a in the direction m, given in the axes of a. */
static inline void close_along(ambit_build *b, closure *s, ambit_vector3 m) {
  ambit_vector3 n = ambit_rotation_turn(b, s->a.rotation, m);
  close_row *row = close_push(s, ambit_vector3_dot(b, n, s->gap), "N");
  row->force = n;
  row->torque_a = ambit_vector3_cross(b, n, s->gap);
}

/* m, in the axes of a, stays perpendicular to n, in the axes of b. */
static inline void close_square(ambit_build *b, closure *s, ambit_vector3 m, ambit_vector3 n) {
  ambit_vector3 p = ambit_rotation_turn(b, s->a.rotation, m), q = ambit_rotation_turn(b, s->b.rotation, n);
  close_row *row = close_push(s, ambit_vector3_dot(b, p, q), "N m");
  row->torque_a = ambit_vector3_cross(b, p, q);
  row->torque_b = ambit_vector3_negate(b, row->torque_a);
}

/* The origins coincide. In the world's axes no rotation multiplies the sum of the links of either chain. */
static inline void close_origins(ambit_build *b, closure *s) {
  for (int i = 0; i < 3; i++) close_world(b, s, i);
}

/* Unit vectors u, v with u x v = n, for a unit vector n; along the axes if n is. */
static inline void close_across(ambit_build *b, ambit_vector3 n, ambit_vector3 *u, ambit_vector3 *v) {
  double size[3], hi;
  for (int i = 0; i < 3; i++) {
    b->range(b, n.c[i], &size[i], &hi);
    double mid = 0.5 * size[i] + 0.5 * hi;
    size[i] = mid < 0 ? -mid : mid;
  }
  int k = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  int least = size[(k + 1) % 3] < size[(k + 2) % 3] ? (k + 1) % 3 : (k + 2) % 3;
  ambit_vector3 e = ambit_vector3_zero();
  e.c[least] = b->num(b, "1");
  *u = ambit_vector3_cross(b, e, n);
  ambit_expr length = ambit_root(b, ambit_vector3_dot(b, *u, *u)), one = b->num(b, "1");
  *u = ambit_vector3_scale(b, ambit_divide(b, one, length), *u);
  *v = ambit_vector3_cross(b, n, *u);
}

/* b's direction n stays parallel to a's axis. */
static inline void close_parallel(ambit_build *b, closure *s, ambit_vector3 axis, ambit_vector3 n) {
  ambit_vector3 u, v;
  close_across(b, axis, &u, &v);
  close_square(b, s, u, n);
  close_square(b, s, v, n);
}

/* The origin of b stays on the line through that of a along the axis. */
static inline void close_line(ambit_build *b, closure *s, ambit_vector3 axis) {
  ambit_vector3 u, v;
  close_across(b, axis, &u, &v);
  close_along(b, s, u);
  close_along(b, s, v);
}

/* The axes of b are those of a: three cosines vanish. Their derivatives at the assembled position are the three
** components of the relative angular velocity.
*/
static inline void close_axes(ambit_build *b, closure *s) {
  ambit_vector3 e[3];
  for (int i = 0; i < 3; i++) {
    e[i] = ambit_vector3_zero();
    e[i].c[i] = b->num(b, "1");
  }
  for (int i = 0; i < 3; i++) close_square(b, s, e[(i + 1) % 3], e[(i + 2) % 3]);
}

/* The unit vector that parameter `index` says, fixed in its frame; absent: that of parameter `instead`. */
static inline ambit_status close_axis(
    ambit_build *b, uint32_t index, uint32_t instead, const char *name, ambit_vector3 *n) {
  const ambit_expr *e = b->param(b, index);
  if (!e) e = b->param(b, instead);
  ambit_status status = ambit_check_fixed(b, e, 3, name);
  return status == AMBIT_OK ? ambit_vector3_unit(b, e, n) : status;
}

static inline ambit_status close_read(ambit_build *b, closure *s) {
  const ambit_expr *a = b->get(b, CLOSE_A, AMBIT_POSE), *e = a ? b->get(b, CLOSE_B, AMBIT_POSE) : NULL;
  if (!e) return AMBIT_INVALID;
  s->a = ambit_pose_read(a);
  s->b = ambit_pose_read(e);
  s->gap = ambit_vector3_add(b, s->b.position, ambit_vector3_negate(b, s->a.position));
  s->count = 0;
  return AMBIT_OK;
}

/* The sum of the rows' forces and torques on a or b, in its own axes. */
static inline void close_wrench(ambit_build *b, const closure *s, uint32_t port, ambit_expr *out) {
  ambit_vector3 force = ambit_vector3_zero(), torque = ambit_vector3_zero();
  for (uint32_t k = 0; k < s->count; k++) {
    const close_row *row = &s->row[k];
    ambit_expr lambda = b->multiplier(b, k, row->unit);
    force = ambit_vector3_add(b, force, ambit_vector3_scale(b, lambda, row->force));
    ambit_vector3 t = port == CLOSE_A ? row->torque_a : row->torque_b;
    torque = ambit_vector3_add(b, torque, ambit_vector3_scale(b, lambda, t));
  }
  if (port == CLOSE_A) force = ambit_vector3_negate(b, force);
  ambit_rotation r = port == CLOSE_A ? s->a.rotation : s->b.rotation;
  ambit_screw wrench;
  wrench.angular = ambit_rotation_turn_back(b, r, torque);
  wrench.linear = ambit_rotation_turn_back(b, r, force);
  ambit_screw_write(wrench, out);
}

/* What every element here expresses; `list(b, &closure)` lists its rows. */
static inline ambit_status close_express(ambit_build *b, ambit_status (*list)(ambit_build *b, closure *s), closure *s,
    uint32_t port, uint32_t quantity, ambit_expr *out) {
  int wrench = (port == CLOSE_A || port == CLOSE_B) && quantity == AMBIT_WRENCH;
  int rows = port == CLOSE_LOOP && quantity == AMBIT_RESIDUAL;
  if (!wrench && !rows) return AMBIT_UNABLE;
  ambit_status status = close_read(b, s);
  if (status == AMBIT_OK) status = list(b, s);
  if (status != AMBIT_OK) return status;
  if (wrench) close_wrench(b, s, port, out);
  for (uint32_t k = 0; rows && k < s->count; k++) out[k] = s->row[k].g;
  return AMBIT_OK;
}

#define CLOSE_ELEMENT(list)                                                                                            \
  static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {                     \
    closure s;                                                                                                         \
    return close_express(b, list, &s, port, quantity, out);                                                            \
  }                                                                                                                    \
  static const ambit_element element = { sizeof element, 3, ports, params, express, NULL };
#endif
