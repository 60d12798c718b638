/* close_revolute.c -- a hinge that closes a loop in space: the origins coincide, and an axis of b is parallel to one of
** a (rows: close.h).
*/
#include "close.h"

enum { AXIS, AXIS_B };

static const ambit_port ports[] = { CLOSE_PORTS(5, "displacement in the world's axes, two cosines; forces, torques") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "z", "axis of the hinge, in the axes of `a`" },
  { "axis_b", "1", "axis", "", "the same axis in the axes of `b`; absent: as `axis`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m, n;
  ambit_status status = close_axis(b, AXIS, AXIS, "axis", &m);
  if (status == AMBIT_OK) status = close_axis(b, AXIS_B, AXIS, "axis_b", &n);
  if (status != AMBIT_OK) return status;
  close_origins(b, s);
  close_parallel(b, s, m, n);
  return AMBIT_OK;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("close_revolute", "1.0",
    "Closes a loop in space with a hinge: the origins of `a` and `b` coincide, and so does the `axis`.", element)
