/* points.h -- a point fixed in the frame at an IN port, and a force that acts there.
**
** With the frame's pose (R, r) and twist (w, v), own axes, and the point at c of the frame: it is at r + R c and has
** the velocity R (v + w x c), world axes. A force F in world axes that acts there is the wrench (c x R^T F, R^T F) of
** the frame. [Featherstone 2008, ch. 2]
*/
#ifndef AMBIT_POINTS_H
#define AMBIT_POINTS_H
#include <ambit/spatial.h>

/* A vector of length 0 in the graph: no point needs to be looked for. */
static inline int vector_is_zero(ambit_vector3 v) { return v.c[0] == 0 && v.c[1] == 0 && v.c[2] == 0; }

static inline ambit_status point_position(ambit_build *b, uint32_t port, ambit_vector3 c, ambit_vector3 *position) {
  const ambit_expr *pose = b->get(b, port, AMBIT_POSE);
  if (!pose) return AMBIT_INVALID;
  ambit_pose p = ambit_pose_read(pose);
  *position = ambit_vector3_add(b, p.position, ambit_rotation_turn(b, p.rotation, c));
  return AMBIT_OK;
}

/* in world axes */
static inline ambit_status point_velocity(ambit_build *b, uint32_t port, ambit_vector3 c, ambit_vector3 *velocity) {
  const ambit_expr *twist = b->get(b, port, AMBIT_TWIST), *pose = twist ? b->get(b, port, AMBIT_POSE) : NULL;
  if (!pose) return AMBIT_INVALID;
  ambit_vector3 own = ambit_velocity_at(b, ambit_screw_read(twist), c);
  *velocity = ambit_rotation_turn(b, ambit_pose_read(pose).rotation, own);
  return AMBIT_OK;
}

/* the wrench of a force that acts at c, both in the frame's axes */
static inline ambit_screw force_at(ambit_build *b, ambit_vector3 c, ambit_vector3 force) {
  ambit_screw s = { ambit_vector3_cross(b, c, force), force };
  return s;
}

static inline ambit_vector3 vector3_subtract(ambit_build *b, ambit_vector3 u, ambit_vector3 v) {
  for (int i = 0; i < 3; i++) u.c[i] = ambit_subtract(b, u.c[i], v.c[i]);
  return u;
}
#endif
