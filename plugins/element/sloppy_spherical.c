/* sloppy_spherical.c -- a ball smaller than its socket: turned by three given angles, its centre displaced by up to
** `play` in any direction (play.h).
*/
#include "euler.h"
#include "play.h"

enum { ORDER, ANGLES, PLAY };

static const ambit_port ports[] = { PLAY_PORTS("the frame that carries the socket", "the frame of the ball") };
static const ambit_param params[] = {
  EULER_PARAM,
  { "angles", "rad", "3", NULL, "by which `to` is turned, one after the other" },
  { "play", "m", "", NULL, "largest displacement of the ball's centre, in any direction" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_expr play = *b->param(b, PLAY);
  stages s = { 0 };
  ambit_status status = play_asked(b, port, quantity, "spherical");
  if (status != AMBIT_OK) return status;
  const ambit_expr *from = b->get(b, PLAY_FROM, AMBIT_POSE), *angle = b->param(b, ANGLES);
  if (!from) return AMBIT_INVALID;
  ambit_pose pose = ambit_pose_read(from);
  euler_push(b, &s, ORDER, 0);
  for (int i = 0; i < 3; i++)
    pose.rotation =
        ambit_rotation_product(b, pose.rotation, ambit_rotation_about(b, s.list[i].axis, angle[s.list[i].coordinate]));
  pose.position = ambit_vector3_add(b, pose.position, play_around(b, play));
  ambit_pose_write(pose, out);
  return AMBIT_OK;
}

static ambit_status check(ambit_build *b) { return play_check(b, *b->param(b, PLAY)); }

static const ambit_element element = { sizeof element, 2, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("sloppy_spherical", "1.0",
    "A ball joint with play: turned by three `angles` in the given `order` of axes, its centre displaced by up to "
    "`play` in any direction. Positions only.",
    element)
