/* close_cylindrical.c -- a pin that turns and slides closes a loop: b's origin stays on an axis of a, and an axis of b
** is parallel to it (rows: close.h).
*/
#include "close.h"

enum { AXIS, AXIS_B };

static const ambit_port ports[] = { CLOSE_PORTS(4, "two displacements across the axis, two cosines; forces, torques") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis through the origin of `a`, in its axes" },
  { "axis_b", "1", "axis", "", "the same axis in the axes of `b`; absent: as `axis`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m, n;
  ambit_status status = close_axis(b, AXIS, AXIS, "axis", &m);
  if (status == AMBIT_OK) status = close_axis(b, AXIS_B, AXIS, "axis_b", &n);
  if (status != AMBIT_OK) return status;
  close_line(b, s, m);
  close_parallel(b, s, m, n);
  return AMBIT_OK;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("close_cylindrical", "1.0", "Closes a loop with a pin that turns and slides along `axis`.", element)
