/* joint_torque.c -- a generalised force on a joint, positive along its coordinate. A law is an expression in
** coordinates, rates and time. Power: effort times rate.
*/
#include <ambit/spatial.h>

enum { JOINT };
enum { TORQUE, FORCE };

static const ambit_port ports[] = { { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0, "the joint that is driven" } };
static const ambit_param params[] = {
  { "torque", "N m|", "", "", "torque on a joint that turns" },
  { "force", "|N", "", "", "force on a joint that slides" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status check(ambit_build *b) {
  if (!b->param(b, TORQUE) != !b->param(b, FORCE)) return AMBIT_OK;
  return b->fail(b, AMBIT_INVALID, "expected either `torque` (N m) or `force` (N)");
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  const ambit_expr *torque = b->param(b, TORQUE), *rate = NULL;
  int power = port == AMBIT_NO_PORT && quantity == AMBIT_POWER;
  if (!power && !(port == JOINT && quantity == AMBIT_EFFORT)) return AMBIT_UNABLE;
  if (power) rate = b->get(b, JOINT, AMBIT_RATE);
  if (power && !rate) return AMBIT_INVALID;
  *out = torque ? *torque : *b->param(b, FORCE);
  if (power) *out = ambit_multiply(b, *out, *rate);
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, ports, params, express, check };

AMBIT_ELEMENT_ENTRY("joint_torque", "1.0",
    "A torque on a joint that turns, or a force on one that slides: a number, an expression of coordinates and time, "
    "or a function.",
    element)
