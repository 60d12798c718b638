/* point_mass.c -- a mass at the origin of a frame: the inertial force is -m a, a being the proper acceleration (gravity included). */
#include <ambit/spatial.h>

enum { AT };
enum { MASS };

static const ambit_port ports[] = { { "at", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the mass" } };
static const ambit_param params[] = { { "mass", "kg", "", NULL, "mass" }, { NULL, NULL, NULL, NULL, NULL } };

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  ambit_expr m = *b->param(b, MASS);
  if (port == AT && quantity == AMBIT_WRENCH) return ambit_point_wrench(b, AT, m, out);
  if (port == AMBIT_NO_PORT && quantity == AMBIT_ENERGY) return ambit_point_energy(b, AT, m, ambit_vector3_zero(), out);
  return AMBIT_UNABLE;
}
