/* close_weld.c -- two frames of different chains are one: origins and axes coincide (rows: close.h). */
#include "close.h"

static const ambit_port ports[] = { CLOSE_PORTS(
    6, "displacement in the world's axes, three cosines; forces, torques") };
static const ambit_param params[] = { { NULL, NULL, NULL, NULL, NULL } };

static ambit_status list_rows(ambit_build *b, closure *s) {
  close_origins(b, s);
  close_axes(b, s);
  return AMBIT_OK;
}

CLOSE_ELEMENT(list_rows)
AMBIT_ELEMENT_ENTRY(
    "close_weld", "1.0", "Closes a loop rigidly: `a` and `b` have the same origin and the same axes.", element)
