/* play.h -- displacements that nobody knows, up to `play` in size: what makes a joint sloppy [Auer, Kecskemethy, Taendl
** & Traczinski, SmartMOBILE 2007].
**
** The set of displacements is a disc about the unit vector n (across it), or a ball. A disc turns with the joint into a
** disc, whose projection on the world's axis i is play sqrt(1 - n_i^2) [-1, 1], n in world axes; that of the ball is
** play [-1, 1]. So the displacement is written in world axes, component i as that half-width times a fresh unknown in
** [-1, 1]: the box contains the set, and each component costs exactly the play, however often the mechanism turns it.
** 1 - n_i^2 is written as the sum of the other two squares: it cannot become negative.
**
** The play may jump, so velocities and forces of such joints are not defined.
*/
#ifndef AMBIT_PLAY_H
#define AMBIT_PLAY_H
#include <ambit/spatial.h>

enum { PLAY_FROM, PLAY_TO };

#define PLAY_PORTS(carrier, carried)                                                                                   \
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, carrier }, { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, carried }

static inline ambit_expr play_component(ambit_build *b, ambit_expr half) {
  return half ? ambit_multiply(b, half, b->unknown(b, "-1", "1")) : 0;
}

/* In any direction perpendicular to n. */
static inline ambit_vector3 play_across(ambit_build *b, ambit_vector3 n, ambit_expr play) {
  ambit_vector3 d;
  for (int i = 0; i < 3; i++) {
    ambit_expr squares = ambit_add(b, ambit_square(b, n.c[(i + 1) % 3]), ambit_square(b, n.c[(i + 2) % 3]));
    d.c[i] = play_component(b, ambit_multiply(b, play, ambit_root(b, squares)));
  }
  return d;
}

/* In any direction. */
static inline ambit_vector3 play_around(ambit_build *b, ambit_expr play) {
  ambit_vector3 d;
  for (int i = 0; i < 3; i++) d.c[i] = play_component(b, play);
  return d;
}

/* OK: the pose is asked for. `instead`: the joint that has velocities. */
static inline ambit_status play_asked(ambit_build *b, uint32_t port, uint32_t quantity, const char *instead) {
  if (port > PLAY_TO || quantity > AMBIT_WRENCH) return AMBIT_UNABLE;
  if (quantity == AMBIT_POSE) return AMBIT_OK;
  return b->fail(b, AMBIT_INVALID,
      "the play may jump, so there are no velocities and forces; use a %s joint for dynamics", instead);
}

/* A play that is not certainly negative. */
static inline ambit_status play_check(ambit_build *b, ambit_expr play) {
  double lo, hi;
  b->range(b, play, &lo, &hi);
  return hi < 0 ? b->fail(b, AMBIT_INVALID, "the play is negative: %g m", hi) : AMBIT_OK;
}
#endif
