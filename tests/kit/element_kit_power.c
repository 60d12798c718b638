/* element_kit_power.c -- the balance of power of one element.
**
**   sum over OUT frames of wrench.twist + sum over OUT joints of (effort - balance).u + P + sum of lambda_k dg_k/dt
**   = sum over IN frames of wrench.twist + sum over IN joints of effort.u + dE/dt
**
** u, u' and lambda are arbitrary. Adding it over all parts, inner ports cancel, and on a motion the balances of states
** and the g vanish: d(sum of E)/dt = sum of P. A joint with a given motion has no balance to vanish: what it would
** take is in its P. So is -lambda dg/dt at fixed coordinates for a constraint that moves in time.
*/
#include "kit/element_kit_inside.h"
#include <stdlib.h>

/* The carrier's frame or joint bears this element alone. */
static bool in_power(element_kit *k, uint32_t i, ambit_expr *power) {
  const ambit_port *p = &k->element->port[i];
  bool frame = p->kind == AMBIT_PORT_FRAME;
  const ambit_expr *force = element_kit_ask(k, k->mover[i], 0, frame ? AMBIT_WRENCH : AMBIT_EFFORT);
  const ambit_expr *rate = force ? element_kit_ask(k, k->mover[i], 0, frame ? AMBIT_TWIST : AMBIT_RATE) : NULL;
  if (rate) *power = kit_subtract(k, *power, kit_dot(k, frame ? 6 : ambit_port_dof(p), force, rate));
  return rate;
}

static bool is_driven(const element_kit *k, const ambit_port *p, const ambit_expr *coordinate) {
  return ambit_port_coordinates(p) == 1 && ambit_graph_node(k->graph, coordinate[0])->op != AMBIT_LEAF_SYMBOL;
}

static bool joint_power(element_kit *k, uint32_t i, ambit_expr *power) {
  const ambit_port *p = &k->element->port[i];
  const ambit_expr *balance = element_kit_ask(k, k->part, i, AMBIT_BALANCE);
  const ambit_expr *rate = balance ? element_kit_ask(k, k->part, i, AMBIT_RATE) : NULL;
  const ambit_expr *coordinate = rate ? element_kit_ask(k, k->part, i, AMBIT_COORDINATE) : NULL;
  if (!coordinate) return false;
  *power = kit_add(k, *power, kit_dot(k, ambit_port_dof(p), k->load[i], rate));
  if (!is_driven(k, p, coordinate)) *power = kit_subtract(k, *power, kit_dot(k, ambit_port_dof(p), balance, rate));
  return true;
}

static bool frame_power(element_kit *k, uint32_t i, ambit_expr *power) {
  const ambit_expr *twist = element_kit_ask(k, k->part, i, AMBIT_TWIST);
  if (twist) *power = kit_add(k, *power, kit_dot(k, 6, k->load[i], twist));
  return twist;
}

ambit_expr element_kit_multiplier(element_kit *k, uint32_t row) {
  size_t n = ambit_mechanism_multipliers(k->mechanism, 0, NULL);
  ambit_multiplier *list = calloc(n + 1, sizeof *list);
  ambit_expr lambda = 0;
  ambit_mechanism_multipliers(k->mechanism, n, list);
  for (size_t i = 0; i < n; i++)
    if (list[i].part == k->part && list[i].index == row) lambda = list[i].lambda;
  free(list);
  return lambda;
}

/* A row that nothing holds must hold by itself. */
static bool constraint_power(element_kit *k, uint32_t i, uint32_t first_row, ambit_expr *power) {
  const ambit_expr *g = element_kit_ask(k, k->part, i, AMBIT_RESIDUAL);
  for (uint32_t row = 0; g && row < k->element->port[i].dof; row++) {
    ambit_expr lambda = element_kit_multiplier(k, first_row + row), rate = element_kit_derivative(k, g[row]);
    if (lambda == 0) element_kit_vanish(k, "rate of a constraint without a multiplier", rate);
    *power = kit_add(k, *power, kit_multiply(k, lambda, rate));
  }
  return g;
}

/* IN ports first: it is their wrenches that bring the multipliers in. */
void element_kit_check_power(element_kit *k) {
  ambit_expr power = 0;
  uint32_t row = 0;
  ambit_failure f = { 0 };
  const ambit_expr *energy = ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, AMBIT_ENERGY, &f);
  const ambit_expr *source = energy ? ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, AMBIT_POWER, &f) : NULL;
  bool complete = source != NULL;
  for (uint32_t i = 0; complete && i < k->element->nport; i++)
    if (k->element->port[i].role == AMBIT_ROLE_IN) complete = in_power(k, i, &power);
  for (uint32_t i = 0; complete && i < k->element->nport; i++) {
    const ambit_port *p = &k->element->port[i];
    if (p->role != AMBIT_ROLE_OUT) continue;
    if (p->kind == AMBIT_PORT_CONSTRAINT) {
      complete = constraint_power(k, i, row, &power);
      row += p->dof;
    } else
      complete = p->kind == AMBIT_PORT_FRAME ? frame_power(k, i, &power) : joint_power(k, i, &power);
  }
  if (!complete) return;
  power = kit_add(k, power, source[0]);
  for (int i = 0; i < 2; i++) power = kit_subtract(k, power, element_kit_derivative(k, energy[i]));
  element_kit_vanish(k, "power", power);
  k->report->powers++;
}
