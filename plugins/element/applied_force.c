/* applied_force.c -- a force F at the point c of a frame: the wrench (c x F, F), power F.v_c. */
#include "applied.h"

enum { OFFSET = APPLIED_PARAMS };

static const ambit_param params[] = {
  { "force", "N", "3", NULL, "the force; its components may depend on time, coordinates and rates" },
  APPLIED_AXES_PARAM,
  { "offset", "m", "3", "0,0,0", "the point on which it acts, in the axes of the frame" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_vector3 force;
  if (!applied_know(port, quantity)) return AMBIT_UNABLE;
  ambit_status status = applied_vector(b, &force);
  if (status != AMBIT_OK) return status;
  return applied_write(b, quantity, force_at(b, ambit_vector3_read(b->param(b, OFFSET)), force), out);
}

static const ambit_element element = { sizeof element, 1, applied_port, params, express, NULL };

AMBIT_ELEMENT_ENTRY("applied_force", "1.0",
    "A force on a frame, in world or body axes: numbers, expressions of time and coordinates, or a function(position, "
    "velocity, t) of the point on which it acts, velocity in the same axes as the force.",
    element)
