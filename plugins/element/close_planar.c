/* close_planar.c -- a plane that slides on a plane closes a loop: b's origin stays in the plane through a's origin
** across an axis of a, and an axis of b is parallel to it (rows: close.h).
*/
#include "close.h"

enum { NORMAL, NORMAL_B };

static const ambit_port ports[] = { CLOSE_PORTS(3, "displacement along the normal, two cosines; force, torques") };
static const ambit_param params[] = {
  { "normal", "1", "axis", "z", "normal of the plane, in the axes of `a`" },
  { "normal_b", "1", "axis", "", "the same direction in the axes of `b`; absent: as `normal`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m, n;
  ambit_status status = close_axis(b, NORMAL, NORMAL, "normal", &m);
  if (status == AMBIT_OK) status = close_axis(b, NORMAL_B, NORMAL, "normal_b", &n);
  if (status != AMBIT_OK) return status;
  close_along(b, s, m);
  close_parallel(b, s, m, n);
  return AMBIT_OK;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("close_planar", "1.0",
    "Closes a loop with a planar joint: `b` slides and turns in the plane of `a` across `normal`.", element)
