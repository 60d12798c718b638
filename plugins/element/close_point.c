/* close_point.c -- two points coincide: a spherical joint that closes a loop (rows: close.h, `world`). In a planar
** mechanism the row across its plane vanishes by itself, and what is left is a hinge.
*/
#include "close.h"

static const ambit_port ports[] = { CLOSE_PORTS(3, "displacement from a to b in the world's axes; forces") };
static const ambit_param params[] = { { NULL, NULL, NULL, NULL, NULL } };

static ambit_status list_rows(ambit_build *b, closure *s) {
  close_origins(b, s);
  return AMBIT_OK;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("close_point", "1.0",
    "Closes a loop with a spherical joint, in a planar mechanism a hinge: the origins of `a` and `b` coincide.",
    element)
