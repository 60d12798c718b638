/* sloppy_joint.c -- a hinge whose hole is wider than its pin: `to` turns by the given angle about n, displaced by up
** to `play` in any direction perpendicular to n (play.h).
*/
#include "play.h"

enum { AXIS, ANGLE, PLAY };

static const ambit_port ports[] = { PLAY_PORTS("the frame that carries the pin", "the frame with the hole") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis of the pin, in the axes of `from`" },
  { "angle", "rad", "", NULL, "by which `to` is turned" },
  { "play", "m", "", NULL, "largest displacement of the hole, in any direction perpendicular to the axis" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_expr play = *b->param(b, PLAY);
  ambit_vector3 n;
  ambit_status status = play_asked(b, port, quantity, "revolute");
  if (status == AMBIT_OK) status = ambit_vector3_unit(b, b->param(b, AXIS), &n);
  if (status != AMBIT_OK) return status;
  const ambit_expr *from = b->get(b, PLAY_FROM, AMBIT_POSE);
  if (!from) return AMBIT_INVALID;
  ambit_pose before = ambit_pose_read(from);
  ambit_pose pose = ambit_pose_after(b, before, ambit_rotation_about(b, n, *b->param(b, ANGLE)), ambit_vector3_zero());
  ambit_vector3 d = play_across(b, ambit_rotation_turn(b, before.rotation, n), play);
  pose.position = ambit_vector3_add(b, pose.position, d);
  ambit_pose_write(pose, out);
  return AMBIT_OK;
}

static ambit_status check(ambit_build *b) { return play_check(b, *b->param(b, PLAY)); }

static const ambit_element element = { sizeof element, 2, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("sloppy_joint", "1.0",
    "A hinge with play: turned by `angle` about `axis` and displaced by up to `play` in any direction perpendicular to "
    "it. Positions only.",
    element)
