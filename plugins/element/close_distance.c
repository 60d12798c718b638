/* close_distance.c -- a rod without mass, hinged at both ends, keeps the origins of a and b at its length l (row:
** close.h, `rod`).
**
** g = (d.d / l - l) / 2 instead of |d| - l: the same zeros and, on them, the same derivative, so that g is the excess
** of length to first order and the multiplier the force in the rod (> 0 pushes the ends apart); but no root, hence
** polynomial in d and smooth everywhere. A length that is given as a function of time is a drive: where g vanishes
** d.(v_b - v_a) = l l', so it puts lambda l' into the mechanism; elsewhere -lambda dg/dl l'.
*/
#include "close.h"

enum { LENGTH };

static const ambit_port ports[] = { CLOSE_PORTS(1, "excess of length, to first order; force in the rod") };
static const ambit_param params[] = {
  { "length", "m", "", NULL, "distance of the origins; a function of time drives it" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check(ambit_build *b) {
  ambit_expr l = *b->param(b, LENGTH);
  double lo, hi;
  b->range(b, l, &lo, &hi);
  if (!(hi > 0)) return b->fail(b, AMBIT_INVALID, "the length must be positive, it is at most %g m", hi);
  if (b->diff_time(b, l) == b->partial_time(b, l)) return AMBIT_OK;
  return b->fail(b, AMBIT_INVALID, "the length depends on a coordinate: expected a number, or a function of time");
}

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_expr l = *b->param(b, LENGTH);
  ambit_expr excess = ambit_subtract(b, ambit_divide(b, ambit_vector3_dot(b, s->gap, s->gap), l), l);
  close_row *row = close_push(s, ambit_multiply(b, b->num(b, "0.5"), excess), "N");
  row->force = ambit_vector3_scale(b, ambit_divide(b, b->num(b, "1"), l), s->gap);
  return AMBIT_OK;
}

/* -lambda dg/dl l': frames that are moved by others are their affair */
static ambit_status express_power(ambit_build *b, closure *s, ambit_expr *out) {
  ambit_expr l = *b->param(b, LENGTH), rate = b->partial_time(b, l);
  if (rate == 0) return AMBIT_UNABLE;
  if (close_read(b, s) != AMBIT_OK) return AMBIT_INVALID;
  ambit_expr stretch = ambit_divide(b, ambit_vector3_dot(b, s->gap, s->gap), ambit_square(b, l));
  ambit_expr slope = ambit_multiply(b, b->num(b, "0.5"), ambit_add(b, stretch, b->num(b, "1")));
  *out = ambit_multiply(b, ambit_multiply(b, b->multiplier(b, 0, "N"), slope), rate);
  return AMBIT_OK;
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  closure s;
  if (port == AMBIT_NO_PORT && quantity == AMBIT_POWER) return express_power(b, &s, out);
  return close_express(b, list_rows, &s, port, quantity, out);
}

static const ambit_element element = { sizeof element, 3, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("close_distance", "1.0",
    "Closes a loop with a massless rod with spherical ends: the origins of `a` and `b` keep the distance `length`.",
    element)
