/* point_on_plane.c -- the origin of b stays in the plane through the origin of a; in a planar mechanism that is a pin
** in a straight slot (row: close.h, `along`).
*/
#include "close.h"

enum { NORMAL };

static const ambit_port ports[] = { CLOSE_PORTS(1, "displacement along the normal; force") };
static const ambit_param params[] = {
  { "normal", "1", "axis", "y", "normal of the plane (across the slot), in the axes of `a`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m;
  ambit_status status = close_axis(b, NORMAL, NORMAL, "normal", &m);
  if (status == AMBIT_OK) close_along(b, s, m);
  return status;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("point_on_plane", "1.0",
    "The origin of `b` stays in the plane through the origin of `a` across `normal`: a pin in a straight slot.",
    element)
