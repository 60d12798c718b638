/* joint_law.h -- elements that act on a joint of one degree of freedom: what they read of it. */
#ifndef AMBIT_JOINT_LAW_H
#define AMBIT_JOINT_LAW_H
#include <ambit/spatial.h>

enum { JOINT };

static const ambit_port joint_law_port[] = { { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_IN, 1, 0,
    "the joint on which it acts" } };

static inline int joint_law_is_effort(uint32_t port, uint32_t quantity) {
  return port == JOINT && quantity == AMBIT_EFFORT;
}

static inline int joint_law_is(uint32_t port, uint32_t quantity, uint32_t whole) {
  return port == AMBIT_NO_PORT && quantity == whole;
}

/* The coordinate or its rate; 1: done. */
static inline int joint_law_read(ambit_build *b, uint32_t quantity, ambit_expr *e) {
  const ambit_expr *value = b->get(b, JOINT, quantity);
  if (value) *e = *value;
  return value != NULL;
}
#endif
