/* close_prismatic.c -- a guide closes a loop: b's origin stays on an axis of a, and the axes of b keep the directions
** of those of a (rows: close.h).
*/
#include "close.h"

enum { AXIS };

static const ambit_port ports[] = { CLOSE_PORTS(
    5, "two displacements across the axis, three cosines; forces, torques") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "x", "direction of the guide, in the axes of `a`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m;
  ambit_status status = close_axis(b, AXIS, AXIS, "axis", &m);
  if (status != AMBIT_OK) return status;
  close_line(b, s, m);
  close_axes(b, s);
  return AMBIT_OK;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("close_prismatic", "1.0",
    "Closes a loop with a guide: `b` slides along `axis` of `a` and does not turn against it.", element)
