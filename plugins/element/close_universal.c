/* close_universal.c -- a Cardan joint closes a loop: the origins coincide, and an axis of b stays perpendicular to one
** of a (rows: close.h).
*/
#include "close.h"

enum { FIRST, SECOND };

static const ambit_port ports[] = { CLOSE_PORTS(4, "displacement in the world's axes, one cosine; forces, torque") };
static const ambit_param params[] = {
  { "first", "1", "axis", "x", "axis fixed in `a`, in its axes" },
  { "second", "1", "axis", "y", "axis fixed in `b`, in its axes" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m, n;
  ambit_status status = close_axis(b, FIRST, FIRST, "first", &m);
  if (status == AMBIT_OK) status = close_axis(b, SECOND, SECOND, "second", &n);
  if (status != AMBIT_OK) return status;
  close_origins(b, s);
  close_square(b, s, m, n);
  return AMBIT_OK;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("close_universal", "1.0",
    "Closes a loop with a Cardan joint: the origins coincide, and the two axes stay perpendicular.", element)
