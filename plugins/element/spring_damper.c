/* spring_damper.c -- a linear spring and damper along the line between two points (line.h).
**
** Force along the line, positive where it pushes apart: f = -k (l - l0) - d l'; so the density is
**   f/l = -k (1 - l0/l) - d (d.d')/l^2
** Energy k (l - l0)^2 / 2, power -d l'^2 + k' (l - l0)^2 / 2 - k (l - l0) l0' (k and l0 may move, as in
** joint_spring.c: a muscle or a winch). Without a rest length the spring is -k d and has no singular position; with
** one, or with a damper, the points must not coincide (line.h).
*/
#include "dissipation.h"
#include "line.h"

enum { STIFFNESS = LINE_PARAMS, LENGTH, DAMPING };

static const ambit_port ports[] = { LINE_PORTS };
static const ambit_param params[] = {
  LINE_PARAM { "stiffness", "N/m", "", "0", "force per length" },
  { "length", "m", "", "0", "rest length, at which the spring is slack; may move in time" },
  { "damping", "N s/m", "", "0", "force per rate of the length; not negative" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check(ambit_build *b) {
  double lo, hi;
  ambit_status status = line_check(b);
  if (status == AMBIT_OK) status = dissipation_check(b, b->param(b, DAMPING), 1, "damping");
  b->range(b, *b->param(b, LENGTH), &lo, &hi);
  if (status == AMBIT_OK && hi < 0)
    return b->fail(b, AMBIT_INVALID, "the rest length is negative: %g m; expected 0 or more", hi);
  return status;
}

/* k (1 - l0/l) */
static ambit_expr spring_density(ambit_build *b, const line *s) {
  ambit_expr k = *b->param(b, STIFFNESS), rest = *b->param(b, LENGTH);
  if (k == 0 || rest == 0) return k;
  ambit_expr slack = ambit_divide(b, rest, line_length(b, s));
  return ambit_multiply(b, k, ambit_subtract(b, b->num(b, "1"), slack));
}

static ambit_status express_wrench(ambit_build *b, uint32_t port, line *s, ambit_expr *out) {
  ambit_expr damping = *b->param(b, DAMPING), density = spring_density(b, s);
  if (damping) {
    ambit_status status = line_move(b, s);
    if (status != AMBIT_OK) return status;
    ambit_expr growth = ambit_divide(b, line_half_square_rate(b, s), s->square);
    density = ambit_add(b, density, ambit_multiply(b, damping, growth));
  }
  return line_wrench(b, port, s, ambit_negate(b, density), out);
}

/* (l - l0)^2 */
static ambit_expr stretch_square(ambit_build *b, const line *s) {
  ambit_expr rest = *b->param(b, LENGTH);
  return rest ? ambit_square(b, ambit_subtract(b, line_length(b, s), rest)) : s->square;
}

/* what whoever moves k and l0 puts in */
static ambit_expr moved_power(ambit_build *b, const line *s, ambit_expr stiffening, ambit_expr lengthening) {
  ambit_expr k = *b->param(b, STIFFNESS), rest = *b->param(b, LENGTH), power = 0;
  if (stiffening) power = ambit_multiply(b, ambit_multiply(b, b->num(b, "0.5"), stiffening), stretch_square(b, s));
  if (lengthening) {
    ambit_expr pull = ambit_multiply(b, k, ambit_subtract(b, line_length(b, s), rest));
    power = ambit_subtract(b, power, ambit_multiply(b, pull, lengthening));
  }
  return power;
}

static ambit_status express_power(ambit_build *b, line *s, ambit_expr *out) {
  ambit_expr stiffening = b->diff_time(b, *b->param(b, STIFFNESS)), damping = *b->param(b, DAMPING);
  ambit_expr lengthening = b->diff_time(b, *b->param(b, LENGTH));
  if (!damping && !stiffening && !lengthening) return AMBIT_UNABLE;
  ambit_status status = line_place(b, s);
  if (status == AMBIT_OK && damping) status = line_move(b, s);
  if (status != AMBIT_OK) return status;
  *out = moved_power(b, s, stiffening, lengthening);
  if (!damping) return AMBIT_OK;
  ambit_expr square = ambit_square(b, line_half_square_rate(b, s));
  *out = ambit_subtract(b, *out, ambit_multiply(b, damping, ambit_divide(b, square, s->square)));
  return AMBIT_OK;
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  line s;
  int wrench = port <= LINE_TO && quantity == AMBIT_WRENCH;
  int whole = port == AMBIT_NO_PORT && (quantity == AMBIT_ENERGY || quantity == AMBIT_POWER);
  if (!wrench && !whole) return AMBIT_UNABLE;
  if (quantity == AMBIT_POWER) return express_power(b, &s, out);
  ambit_status status = line_place(b, &s);
  if (status != AMBIT_OK) return status;
  if (wrench) return express_wrench(b, port, &s, out);
  out[0] = 0;
  out[1] = ambit_multiply(b, ambit_multiply(b, b->num(b, "0.5"), *b->param(b, STIFFNESS)), stretch_square(b, &s));
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 2, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("spring_damper", "1.0",
    "A spring and a damper along the line between two points, one on each frame. Slack at `length`; with a length or a "
    "damping the two points must stay apart.",
    element)
