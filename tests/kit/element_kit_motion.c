/* element_kit_motion.c -- poses are rotations and displacements; twists, accelerations and rates are their
** derivatives.
*/
#include "kit/element_kit_inside.h"

/* row i of R^T times a vector given as three expressions with a stride */
static ambit_expr turned_back(element_kit *k, const ambit_expr *pose, int i, const ambit_expr *v, int stride) {
  ambit_expr s = 0;
  for (int j = 0; j < 3; j++) s = kit_add(k, s, kit_multiply(k, pose[3 * j + i], v[j * stride]));
  return s;
}

static void check_pose(element_kit *k, const ambit_expr *pose) {
  ambit_expr one = ambit_graph_number(k->graph, 1), determinant = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      element_kit_vanish(
          k, "orthonormal axes", kit_subtract(k, turned_back(k, pose, i, pose + j, 3), i == j ? one : 0));
    int p = (i + 1) % 3, q = (i + 2) % 3;
    ambit_expr minor =
        kit_subtract(k, kit_multiply(k, pose[3 + p], pose[6 + q]), kit_multiply(k, pose[3 + q], pose[6 + p]));
    determinant = kit_add(k, determinant, kit_multiply(k, pose[i], minor));
  }
  element_kit_vanish(k, "right-handed axes", kit_subtract(k, determinant, one));
}

static void check_twist(element_kit *k, const ambit_expr *pose, const ambit_expr *twist) {
  ambit_expr rate[12];
  for (int i = 0; i < 12; i++) rate[i] = element_kit_derivative(k, pose[i]);
  for (int i = 0; i < 3; i++) {
    int p = (i + 1) % 3, q = (i + 2) % 3; /* R^T R' = [w x]: row q, column p is w_i */
    element_kit_vanish(k, "angular velocity", kit_subtract(k, turned_back(k, pose, q, rate + p, 3), twist[i]));
    element_kit_vanish(k, "velocity", kit_subtract(k, turned_back(k, pose, i, rate + 9, 1), twist[3 + i]));
  }
}

static void check_acceleration(
    element_kit *k, const ambit_expr *pose, const ambit_expr *twist, const ambit_expr *accel) {
  const ambit_expr *field = ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, AMBIT_FIELD, NULL);
  for (int i = 0; i < 3; i++) {
    int p = (i + 1) % 3, q = (i + 2) % 3;
    element_kit_vanish(k, "angular acceleration", kit_subtract(k, element_kit_derivative(k, twist[i]), accel[i]));
    ambit_expr a = element_kit_derivative(k, twist[3 + i]);
    ambit_expr turning =
        kit_subtract(k, kit_multiply(k, twist[p], twist[3 + q]), kit_multiply(k, twist[q], twist[3 + p]));
    a = kit_subtract(k, kit_add(k, a, turning), turned_back(k, pose, i, field, 1));
    element_kit_vanish(k, "proper acceleration", kit_subtract(k, a, accel[3 + i]));
  }
}

static void check_frame(element_kit *k, uint32_t port) {
  const ambit_expr *pose = element_kit_ask(k, k->part, port, AMBIT_POSE);
  const ambit_expr *twist = element_kit_ask(k, k->part, port, AMBIT_TWIST);
  const ambit_expr *accel = element_kit_ask(k, k->part, port, AMBIT_ACCEL);
  if (pose) check_pose(k, pose);
  if (pose && twist) check_twist(k, pose, twist);
  if (pose && twist && accel) check_acceleration(k, pose, twist, accel);
}

/* Where coordinates and speeds are as many the speeds are the rates; else the element says what the rates are, and
** these are what take_variables() differentiates with: the poses have confirmed them.
*/
static void check_joint(element_kit *k, uint32_t port) {
  const ambit_port *p = &k->element->port[port];
  const ambit_expr *q = element_kit_ask(k, k->part, port, AMBIT_COORDINATE);
  const ambit_expr *u = element_kit_ask(k, k->part, port, AMBIT_RATE);
  const ambit_expr *du = element_kit_ask(k, k->part, port, AMBIT_RATE2), *rate = u;
  uint32_t nq = ambit_port_coordinates(p), nu = ambit_port_dof(p);
  if (nq != nu) rate = element_kit_ask(k, k->part, port, AMBIT_COORDINATE_RATE);
  for (uint32_t c = 0; q && rate && c < nq; c++)
    element_kit_vanish(k, "rate", kit_subtract(k, element_kit_derivative(k, q[c]), rate[c]));
  for (uint32_t c = 0; u && du && c < nu; c++)
    element_kit_vanish(k, "second rate", kit_subtract(k, element_kit_derivative(k, u[c]), du[c]));
}

static void check_state(element_kit *k, uint32_t port) {
  const ambit_expr *x = element_kit_ask(k, k->part, port, AMBIT_COORDINATE);
  const ambit_expr *rate = element_kit_ask(k, k->part, port, AMBIT_COORDINATE_RATE);
  for (uint32_t c = 0; x && rate && c < ambit_port_coordinates(&k->element->port[port]); c++)
    element_kit_vanish(k, "rate of a state", kit_subtract(k, element_kit_derivative(k, x[c]), rate[c]));
}

void element_kit_check_motion(element_kit *k) {
  for (uint32_t i = 0; i < k->element->nport; i++) {
    const ambit_port *p = &k->element->port[i];
    if (p->role == AMBIT_ROLE_OUT && p->kind == AMBIT_PORT_FRAME) check_frame(k, i);
    if (p->role == AMBIT_ROLE_OUT && p->kind == AMBIT_PORT_JOINT) check_joint(k, i);
    if (p->role == AMBIT_ROLE_OUT && p->kind == AMBIT_PORT_STATE) check_state(k, i);
  }
}
