/* point_on_line.c -- the origin of b stays on the line through the origin of a (rows: close.h, `along`). */
#include "close.h"

enum { AXIS };

static const ambit_port ports[] = { CLOSE_PORTS(2, "displacement across the line, in axes carried by `a`; forces") };
static const ambit_param params[] = {
  { "axis", "1", "axis", "x", "direction of the line, in the axes of `a`" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status list_rows(ambit_build *b, closure *s) {
  ambit_vector3 m;
  ambit_status status = close_axis(b, AXIS, AXIS, "axis", &m);
  if (status == AMBIT_OK) close_line(b, s, m);
  return status;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY("point_on_line", "1.0",
    "The origin of `b` stays on the line through the origin of `a` along `axis`, free to slide and turn.", element)
