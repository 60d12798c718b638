/* line.h -- the line between two points, one on each of two frames, and forces along it.
**
** With d from the first point to the second, world axes, and its derivative d':
**   length l = |d|,   rate l' = d.d' / l
** A force f along the line, positive where it pushes the points apart, is f d/l on the second point and -f d/l on the
** first: equal and opposite on one line, so that nothing is added to the momentum of the whole. Its power is f l'.
** Forces are written as a density f/l times d: where the density is a polynomial (a linear spring without rest
** length) no direction is needed and the formula holds at l = 0 too; anywhere else two points that coincide have no
** direction, and the quotient by l or l^2 is undefined there: a domain problem that the arithmetic reports.
*/
#ifndef AMBIT_LINE_H
#define AMBIT_LINE_H
#include "points.h"

enum { LINE_FROM, LINE_TO };
enum { LINE_FROM_OFFSET, LINE_TO_OFFSET, LINE_PARAMS };

#define LINE_PORTS                                                                                                     \
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the first point" },                         \
      { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the second point" },

#define LINE_PARAM                                                                                                     \
  { "from_offset", "m", "3", "0,0,0", "the first point, in the axes of `from`" },                                      \
      { "to_offset", "m", "3", "0,0,0", "the second point, in the axes of `to`" },

typedef struct line {
  ambit_vector3 d, rate; /* world axes; rate only when asked for */
  ambit_expr square;     /* d.d */
} line;

static inline ambit_vector3 line_offset(ambit_build *b, uint32_t port) {
  return ambit_vector3_read(b->param(b, port == LINE_FROM ? LINE_FROM_OFFSET : LINE_TO_OFFSET));
}

static inline ambit_status line_place(ambit_build *b, line *s) {
  ambit_vector3 first, second;
  ambit_status status = point_position(b, LINE_FROM, line_offset(b, LINE_FROM), &first);
  if (status == AMBIT_OK) status = point_position(b, LINE_TO, line_offset(b, LINE_TO), &second);
  if (status != AMBIT_OK) return status;
  s->d = vector3_subtract(b, second, first);
  s->square = ambit_vector3_dot(b, s->d, s->d);
  if (s->square) return AMBIT_OK;
  return b->fail(b, AMBIT_INVALID, "its two points are one and the same, so no line joins them");
}

/* A point that moves in its frame by itself would put in power, and add to the rate of the length. */
static inline ambit_status line_check(ambit_build *b) {
  ambit_status status = ambit_check_fixed(b, b->param(b, LINE_FROM_OFFSET), 3, "from_offset");
  return status == AMBIT_OK ? ambit_check_fixed(b, b->param(b, LINE_TO_OFFSET), 3, "to_offset") : status;
}

static inline ambit_status line_move(ambit_build *b, line *s) {
  ambit_vector3 first, second;
  ambit_status status = point_velocity(b, LINE_FROM, line_offset(b, LINE_FROM), &first);
  if (status == AMBIT_OK) status = point_velocity(b, LINE_TO, line_offset(b, LINE_TO), &second);
  if (status == AMBIT_OK) s->rate = vector3_subtract(b, second, first);
  return status;
}

static inline ambit_expr line_length(ambit_build *b, const line *s) { return ambit_root(b, s->square); }

/* l l' */
static inline ambit_expr line_half_square_rate(ambit_build *b, const line *s) {
  return ambit_vector3_dot(b, s->d, s->rate);
}

/* The wrench on the frame at `port` of a force of that density f/l. */
static inline ambit_status line_wrench(
    ambit_build *b, uint32_t port, const line *s, ambit_expr density, ambit_expr *out) {
  const ambit_expr *pose = b->get(b, port, AMBIT_POSE);
  if (!pose) return AMBIT_INVALID;
  ambit_vector3 force = ambit_vector3_scale(b, density, s->d);
  if (port == LINE_FROM) force = ambit_vector3_negate(b, force);
  ambit_vector3 own = ambit_rotation_turn_back(b, ambit_pose_read(pose).rotation, force);
  ambit_screw_write(force_at(b, line_offset(b, port), own), out);
  return AMBIT_OK;
}
#endif
