/* close_pin.c -- the hinge of a planar mechanism closes a loop: the origins coincide, seen along the normal of the
** plane (rows: close.h, `along`). An offset along the normal does not matter.
*/
#include "close.h"

enum { NORMAL };

static const ambit_port ports[] = { CLOSE_PORTS(2, "displacement in the plane, in axes carried by `a`; forces") };
static const ambit_param params[] = {
  { "normal", "1", "axis", "z", "normal of the mechanism's plane, in the axes of `a`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m;
  ambit_status status = close_axis(b, NORMAL, NORMAL, "normal", &m);
  if (status == AMBIT_OK) close_line(b, s, m);
  return status;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("close_pin", "1.0",
    "Closes a loop of a planar mechanism with a hinge across its plane: two rows, whatever the links' offsets along "
    "`normal`.",
    element)
