/* gravity.c -- a uniform field of gravity; several add up. Masses feel it as the proper acceleration of the world. */
#include <ambit/spatial.h>

enum { FIELD };

static const ambit_param params[] = {
  { "field", "m/s^2", "3", NULL, "acceleration of free fall, world axes" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port != AMBIT_NO_PORT || quantity != AMBIT_FIELD) return AMBIT_UNABLE;
  const ambit_expr *field = b->param(b, FIELD);
  for (int i = 0; i < 3; i++) out[i] = field[i];
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 0, NULL, params, express, NULL };

AMBIT_ELEMENT_ENTRY(
    "gravity", "1.0", "A uniform field of gravity, { 0, 0, \"-9.81\" } for instance; several add up.", element)
