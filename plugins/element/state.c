/* state.c -- a quantity with a first-order equation of its own: x' = rate, a function of coordinates, speeds, other
** states, data and time. Laws of force may depend on it.
*/
#include <ambit/spatial.h>

enum { VALUE };
enum { RATE };

static const ambit_port ports[] = { { "value", AMBIT_PORT_STATE, AMBIT_ROLE_OUT, 1, 0, "the state" } };
static const ambit_param params[] = {
  { "rate", "1", "", NULL, "its time derivative, in its unit by s" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port != VALUE || (quantity != AMBIT_COORDINATE && quantity != AMBIT_COORDINATE_RATE)) return AMBIT_UNABLE;
  *out = quantity == AMBIT_COORDINATE ? b->state(b, 0, 0, NULL) : *b->param(b, RATE);
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, ports, params, express, NULL };

AMBIT_ELEMENT_ENTRY("state", "1.0",
    "A quantity with an equation of its own, x' = rate: a current, a pressure, the integral of a controller. In scenes "
    "m:state { \"x\", unit = \"A\", rate = function(q, x, t) ... end }.",
    element)
