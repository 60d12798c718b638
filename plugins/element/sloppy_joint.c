/* sloppy_joint.c -- a hinge whose hole is wider than its pin: `to` turns by the given angle about n, displaced by up
** to `play` in any direction perpendicular to n [Auer, Kecskemethy, Taendl & Traczinski, SmartMOBILE 2007].
**
** The set of displacements is a disc about n. The disc turns with the joint into a disc, whose projection on the
** world's axis i is play sqrt(1 - n_i^2) [-1, 1], n in world axes; so the displacement is written in world axes,
** component i as that half-width times a fresh unknown in [-1, 1]. The box contains the disc, and each component
** costs exactly the play, however often the mechanism turns it. 1 - n_i^2 is written as the sum of the other two
** squares: it cannot become negative.
**
** The play may jump, so velocities and forces of this joint are not defined.
*/
#include <ambit/spatial.h>

enum { FROM, TO };
enum { AXIS, ANGLE, PLAY };

static const ambit_port ports[] = {
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the pin" },
  { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the frame with the hole" },
};
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis of the pin, in the axes of `from`" },
  { "angle", "rad", "", NULL, "by which `to` is turned" },
  { "play", "m", "", NULL, "largest displacement of the hole, in any direction perpendicular to the axis" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_vector3 displacement(ambit_build *b, ambit_vector3 n, ambit_expr play) {
  ambit_vector3 d;
  for (int i = 0; i < 3; i++) {
    ambit_expr across =
        ambit_root(b, ambit_add(b, ambit_square(b, n.c[(i + 1) % 3]), ambit_square(b, n.c[(i + 2) % 3])));
    ambit_expr half = ambit_multiply(b, play, across);
    d.c[i] = half ? ambit_multiply(b, half, b->unknown(b, "-1", "1")) : 0;
  }
  return d;
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port > TO || quantity > AMBIT_WRENCH) return AMBIT_UNABLE;
  if (quantity != AMBIT_POSE)
    return b->fail(b, AMBIT_INVALID,
        "the play may jump, so there are no velocities and forces; use a revolute joint for dynamics");
  ambit_expr play = *b->param(b, PLAY);
  ambit_vector3 n;
  double lo, hi;
  b->range(b, play, &lo, &hi);
  if (hi < 0) return b->fail(b, AMBIT_INVALID, "the play is negative: %g m", hi);
  ambit_status status = ambit_vector3_unit(b, b->param(b, AXIS), &n);
  const ambit_expr *from = status == AMBIT_OK ? b->get(b, FROM, AMBIT_POSE) : NULL;
  if (!from) return AMBIT_INVALID;
  ambit_pose before = ambit_pose_read(from);
  ambit_pose pose = ambit_pose_after(b, before, ambit_rotation_about(b, n, *b->param(b, ANGLE)), ambit_vector3_zero());
  pose.position =
      ambit_vector3_add(b, pose.position, displacement(b, ambit_rotation_turn(b, before.rotation, n), play));
  ambit_pose_write(pose, out);
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 2, ports, params, express };

AMBIT_ELEMENT_ENTRY("sloppy_joint", "1.0",
    "A hinge with play: turned by `angle` about `axis` and displaced by up to `play` in any direction perpendicular to "
    "it. Positions only.",
    element)
