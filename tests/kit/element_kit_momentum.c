/* element_kit_momentum.c -- Newton's third law, and momentum.
**
** Of the wrenches in world axes about the world's origin, with the mass m, its first moment m r_c, the linear momentum
** p and the angular momentum L of the element:
**   sum over IN frames - sum over OUT frames + (L', p') - (m r_c x g, m g) = 0,    (m r_c)' = p,    m' = 0.
** An element without mass passes forces on, equal and opposite on one line. One that touches a single frame and has no
** mass acts from outside the mechanism (a given force, the ground): nothing bears its reaction, nothing is checked. Nor
** is an element that has kinetic energy but tells no momentum. Of an element that closes a loop only the forces are
** compared: its moments cancel where its residuals vanish, and the stage does not close loops.
*/
#include "kit/element_kit_inside.h"

/* Adds `sign` times the wrench at a frame. */
static void add_wrench(element_kit *k, const ambit_expr *pose, const ambit_expr *wrench, int sign, ambit_expr sum[6]) {
  ambit_expr world[6] = { 0 };
  uint32_t code = sign > 0 ? AMBIT_OP_ADD : AMBIT_OP_SUB;
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 3; j++)
      world[i] = kit_add(k, world[i], kit_multiply(k, pose[3 * (i % 3) + j], wrench[3 * (i / 3) + j]));
  for (int i = 0; i < 3; i++) {
    int p = (i + 1) % 3, q = (i + 2) % 3;
    ambit_expr moment =
        kit_subtract(k, kit_multiply(k, pose[9 + p], world[3 + q]), kit_multiply(k, pose[9 + q], world[3 + p]));
    sum[i] = kit_op(k, code, sum[i], kit_add(k, world[i], moment));
    sum[3 + i] = kit_op(k, code, sum[3 + i], world[3 + i]);
  }
}

/* How many frames it touches; 0: of one of them a quantity is refused. */
static unsigned add_wrenches(element_kit *k, ambit_expr sum[6]) {
  unsigned frames = 0;
  for (uint32_t i = 0; i < k->element->nport; i++) {
    const ambit_port *p = &k->element->port[i];
    bool in = p->role == AMBIT_ROLE_IN;
    if (p->kind != AMBIT_PORT_FRAME) continue;
    const ambit_expr *pose = element_kit_ask(k, in ? k->mover[i] : k->part, in ? 0 : i, AMBIT_POSE);
    const ambit_expr *wrench = in ? element_kit_ask(k, k->mover[i], 0, AMBIT_WRENCH) : k->load[i];
    if (!pose || !wrench) return 0;
    add_wrench(k, pose, wrench, in ? 1 : -1, sum);
    frames++;
  }
  return frames;
}

static void add_momentum(element_kit *k, const ambit_expr *momentum, ambit_expr sum[6]) {
  const ambit_expr *mass = element_kit_own(k, AMBIT_MASS), *moment = element_kit_own(k, AMBIT_MASS_MOMENT);
  const ambit_expr *g = ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, AMBIT_FIELD, NULL);
  if (!mass || !moment) {
    element_kit_complain(k, "it has a momentum, but no mass or no first moment of it");
    return;
  }
  element_kit_vanish(k, "a mass that changes", element_kit_derivative(k, mass[0]));
  for (int i = 0; i < 3; i++) {
    int p = (i + 1) % 3, q = (i + 2) % 3;
    element_kit_vanish(
        k, "first moment of the mass", kit_subtract(k, element_kit_derivative(k, moment[i]), momentum[3 + i]));
    ambit_expr weight = kit_subtract(k, kit_multiply(k, moment[p], g[q]), kit_multiply(k, moment[q], g[p]));
    sum[i] = kit_add(k, sum[i], kit_subtract(k, element_kit_derivative(k, momentum[i]), weight));
    sum[3 + i] = kit_add(
        k, sum[3 + i], kit_subtract(k, element_kit_derivative(k, momentum[3 + i]), kit_multiply(k, mass[0], g[i])));
  }
}

static bool has_ports(const element_kit *k, uint32_t kind, uint32_t role) {
  for (uint32_t i = 0; i < k->element->nport; i++)
    if (k->element->port[i].kind == kind && k->element->port[i].role == role) return true;
  return false;
}

void element_kit_check_momentum(element_kit *k) {
  ambit_expr sum[6] = { 0 };
  const ambit_expr *momentum = element_kit_own(k, AMBIT_MOMENTUM), *energy = element_kit_own(k, AMBIT_ENERGY);
  bool untold = !momentum && energy && energy[0] != 0;
  unsigned frames = untold ? 0 : add_wrenches(k, sum);
  bool ground = !has_ports(k, AMBIT_PORT_FRAME, AMBIT_ROLE_IN);
  bool closes = has_ports(k, AMBIT_PORT_CONSTRAINT, AMBIT_ROLE_OUT) && !has_ports(k, AMBIT_PORT_FRAME, AMBIT_ROLE_OUT);
  if (frames == 0 || ground || (frames == 1 && !momentum)) return;
  if (momentum) add_momentum(k, momentum, sum);
  for (int i = 0; i < 3; i++) {
    if (!closes) element_kit_vanish(k, "action and reaction (moment)", sum[i]);
    element_kit_vanish(k, "action and reaction (force)", sum[3 + i]);
  }
  k->report->reactions++;
}
