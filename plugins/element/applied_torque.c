/* applied_torque.c -- a torque T on a frame: the wrench (T, 0), power T.w. */
#include "applied.h"

static const ambit_param params[] = {
  { "torque", "N m", "3", NULL, "the torque; its components may depend on time, coordinates and rates" },
  APPLIED_AXES_PARAM,
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_screw wrench = { ambit_vector3_zero(), ambit_vector3_zero() };
  if (!applied_know(port, quantity)) return AMBIT_UNABLE;
  ambit_status status = applied_vector(b, &wrench.angular);
  return status == AMBIT_OK ? applied_write(b, quantity, wrench, out) : status;
}

static const ambit_element element = { sizeof element, 1, applied_port, params, express, NULL };

AMBIT_ELEMENT_ENTRY("applied_torque", "1.0",
    "A torque on a frame, in world or body axes: numbers, expressions of time and coordinates, or a "
    "function(angular_velocity, t), in the same axes as the torque.",
    element)
