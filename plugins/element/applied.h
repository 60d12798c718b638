/* applied.h -- a given vector on a frame, in its own axes or in those of the world; it is exerted from outside, so
** nothing bears the reaction.
*/
#ifndef AMBIT_APPLIED_H
#define AMBIT_APPLIED_H
#include "points.h"

enum { APPLIED_AT };
enum { APPLIED_VECTOR, APPLIED_AXES, APPLIED_PARAMS };

static const ambit_port applied_port[] = { { "at", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0,
    "the frame on which it acts" } };

#define APPLIED_AXES_PARAM                                                                                             \
  { "axes", "1", "world|body", "world", "whose axes the components refer to: the world's or those of the frame" }

/* The vector in the frame's own axes. */
static inline ambit_status applied_vector(ambit_build *b, ambit_vector3 *own) {
  double body, same;
  *own = ambit_vector3_read(b->param(b, APPLIED_VECTOR));
  b->range(b, *b->param(b, APPLIED_AXES), &body, &same);
  if (body > 0) return AMBIT_OK;
  const ambit_expr *pose = b->get(b, APPLIED_AT, AMBIT_POSE);
  if (!pose) return AMBIT_INVALID;
  *own = ambit_rotation_turn_back(b, ambit_pose_read(pose).rotation, *own);
  return AMBIT_OK;
}

/* The wrench, or its power. */
static inline ambit_status applied_write(ambit_build *b, uint32_t quantity, ambit_screw wrench, ambit_expr *out) {
  if (quantity == AMBIT_WRENCH) {
    ambit_screw_write(wrench, out);
    return AMBIT_OK;
  }
  const ambit_expr *at = b->get(b, APPLIED_AT, AMBIT_TWIST);
  if (!at) return AMBIT_INVALID;
  ambit_screw twist = ambit_screw_read(at);
  *out = ambit_add(
      b, ambit_vector3_dot(b, wrench.angular, twist.angular), ambit_vector3_dot(b, wrench.linear, twist.linear));
  return AMBIT_OK;
}

static inline int applied_know(uint32_t port, uint32_t quantity) {
  return (port == APPLIED_AT && quantity == AMBIT_WRENCH) || (port == AMBIT_NO_PORT && quantity == AMBIT_POWER);
}
#endif
