/* kink_element.c -- an element with kinks, which conforms: in a joint, a spring that acts beyond a stop only, and
** friction with the square of the rate against it, which beyond a rate grows with that only.
*/
#include <ambit/spatial.h>

enum { JOINT };
enum { STIFFNESS, STOP, DRAG };

static const ambit_port ports[] = { { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0, "the joint that it acts in" } };
static const ambit_param params[] = {
  { "stiffness", "N m/rad|N/m", "", NULL, "of the stop" },
  { "stop", "rad|m", "", "0", "where it begins" },
  { "drag", "1", "", "0.5", "friction for each square of the rate, up to 0.5" },
  { NULL, NULL, NULL, NULL, NULL },
};

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  int effort = port == JOINT && quantity == AMBIT_EFFORT, energy = port == AMBIT_NO_PORT && quantity == AMBIT_ENERGY;
  int power = port == AMBIT_NO_PORT && quantity == AMBIT_POWER;
  if (!effort && !energy && !power) return AMBIT_UNABLE;
  ambit_expr k = *b->param(b, STIFFNESS), stop = *b->param(b, STOP), drag = *b->param(b, DRAG), zero = b->num(b, "0");
  ambit_status status = ambit_check_fixed(b, &k, 1, "stiffness");
  if (status == AMBIT_OK) status = ambit_check_fixed(b, &stop, 1, "stop");
  const ambit_expr *q = status == AMBIT_OK ? b->get(b, JOINT, AMBIT_COORDINATE) : NULL;
  const ambit_expr *u = q ? b->get(b, JOINT, AMBIT_RATE) : NULL;
  if (!u) return AMBIT_INVALID;
  ambit_expr pressed = b->op(b, AMBIT_OP_MAX, ambit_subtract(b, *q, stop), zero);
  ambit_expr rate = b->op(b, AMBIT_OP_MIN, b->op(b, AMBIT_OP_ABS, *u, *u), b->num(b, "0.5"));
  ambit_expr friction = ambit_multiply(b, drag, ambit_multiply(b, *u, rate));
#ifdef KINK_FAULT /* for tests of the kit: a force within 1e-6 of the stop that energy knows nothing of */
  ambit_expr off = ambit_subtract(b, *q, stop);
  off = ambit_subtract(b, b->num(b, "1e-6"), b->op(b, AMBIT_OP_ABS, off, off));
  if (effort) pressed = ambit_add(b, pressed, ambit_multiply(b, b->num(b, "1e5"), b->op(b, AMBIT_OP_MAX, off, zero)));
#endif
  if (effort) *out = ambit_negate(b, ambit_add(b, ambit_multiply(b, k, pressed), friction));
#ifdef KINK_JUMP /* for tests of the kit: energy that is larger by 0.1 J beyond the stop */
  ambit_expr beyond = ambit_subtract(b, *q, stop);
  beyond = b->op(b, AMBIT_OP_DIV, beyond, b->op(b, AMBIT_OP_ABS, beyond, beyond));
#endif
  if (power) *out = ambit_negate(b, ambit_multiply(b, friction, *u));
  if (energy) {
    out[0] = zero;
    out[1] = ambit_multiply(b, ambit_multiply(b, b->num(b, "0.5"), k), ambit_multiply(b, pressed, pressed));
#ifdef KINK_JUMP
    out[1] = ambit_add(b, out[1], ambit_multiply(b, b->num(b, "0.05"), beyond));
#endif
  }
  return AMBIT_OK;
}

static const ambit_element element = { sizeof element, 1, ports, params, express, NULL };

#ifndef KINK_NAME
#define KINK_NAME "kink"
#endif
AMBIT_ELEMENT_ENTRY(KINK_NAME, "1.0", "A stop and quadratic friction in a joint: max, abs and min.", element)
