/* element_stage.c -- see element_stage.h. */
#include "kit/element_stage.h"
#include <ambit/spatial.h>
#include <stdio.h>

/* -- a frame that moves freely */

static ambit_pose mover_pose(ambit_build *b) {
  static const uint32_t order[3] = { 2, 1, 0 };
  ambit_pose pose;
  pose.rotation = ambit_rotation_identity(b);
  for (uint32_t i = 0; i < 3; i++) {
    ambit_vector3 axis = ambit_vector3_zero();
    axis.c[order[i]] = b->num(b, "1");
    pose.rotation = ambit_rotation_product(b, pose.rotation, ambit_rotation_about(b, axis, b->state(b, i, 0, "rad")));
    pose.position.c[i] = b->state(b, 3 + i, 0, "m");
  }
  return pose;
}

/* w from R^T R', v = R^T r' */
static ambit_screw mover_twist(ambit_build *b, ambit_pose pose) {
  ambit_rotation rate;
  ambit_screw twist;
  for (int i = 0; i < 9; i++) rate.m[i / 3][i % 3] = b->diff_time(b, pose.rotation.m[i / 3][i % 3]);
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    ambit_vector3 column = ambit_vector3_of(rate.m[0][j], rate.m[1][j], rate.m[2][j]);
    twist.angular.c[i] = ambit_rotation_turn_back(b, pose.rotation, column).c[k];
    twist.linear.c[i] = b->diff_time(b, pose.position.c[i]);
  }
  twist.linear = ambit_rotation_turn_back(b, pose.rotation, twist.linear);
  return twist;
}

static ambit_status express_mover(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port == 1 && quantity >= AMBIT_COORDINATE && quantity <= AMBIT_RATE2) {
    for (uint32_t i = 0; i < 6; i++) out[i] = b->state(b, i, quantity - AMBIT_COORDINATE, "1");
    return AMBIT_OK;
  }
  if (port != 0 || quantity > AMBIT_ACCEL) return AMBIT_UNABLE;
  ambit_pose pose = mover_pose(b);
  ambit_screw s = mover_twist(b, pose);
  if (quantity == AMBIT_ACCEL) {
    const ambit_expr *field = b->get(b, AMBIT_NO_PORT, AMBIT_FIELD);
    if (!field) return AMBIT_INVALID;
    for (int i = 0; i < 3; i++) {
      s.angular.c[i] = b->diff_time(b, s.angular.c[i]);
      s.linear.c[i] = ambit_subtract(b, b->diff_time(b, b->diff_time(b, pose.position.c[i])), field[i]);
    }
    s.linear = ambit_rotation_turn_back(b, pose.rotation, s.linear);
  }
  if (quantity == AMBIT_POSE)
    ambit_pose_write(pose, out);
  else
    ambit_screw_write(s, out);
  return AMBIT_OK;
}

static const ambit_port mover_port[] = {
  { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the moving frame" },
  { "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, 6, 0, "three angles, three displacements" },
};
const ambit_element element_stage_mover = { sizeof(ambit_element), 2, mover_port, NULL, express_mover, NULL };

/* -- what is exerted */

static ambit_status give_param(ambit_build *b, uint32_t n, ambit_expr *out) {
  const ambit_expr *value = b->param(b, 0);
  for (uint32_t i = 0; i < n; i++) out[i] = value[i];
  return AMBIT_OK;
}

static ambit_status express_load(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  return port == 0 && quantity == AMBIT_WRENCH ? give_param(b, 6, out) : AMBIT_UNABLE;
}

static const ambit_port load_port[] = { { "at", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the loaded frame" } };
static const ambit_param load_param[] = { { "wrench", "1", "6", NULL, "torque and force" },
  { NULL, NULL, NULL, NULL, NULL } };
const ambit_element element_stage_load = { sizeof(ambit_element), 1, load_port, load_param, express_load, NULL };

static ambit_status express_field(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  return port == AMBIT_NO_PORT && quantity == AMBIT_FIELD ? give_param(b, 3, out) : AMBIT_UNABLE;
}

static const ambit_param field_param[] = { { "field", "m/s^2", "3", NULL, "gravity" },
  { NULL, NULL, NULL, NULL, NULL } };
const ambit_element element_stage_field = { sizeof(ambit_element), 0, NULL, field_param, express_field, NULL };

/* -- joints; the numbers of speeds and of coordinates are known from what the stage gives */

static uint32_t count(ambit_build *b, uint32_t param) {
  uint32_t n = 0;
  const ambit_expr *flags = b->param(b, param);
  while (n < AMBIT_QUANTITY_MAX && flags[n]) n++;
  return n;
}

/* With more coordinates than speeds the first q' are the speeds, the others 0. */
static ambit_status express_joint(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port != 0 || quantity < AMBIT_COORDINATE || quantity > AMBIT_COORDINATE_RATE) return AMBIT_UNABLE;
  uint32_t dof = count(b, 0), coordinates = count(b, 1), order = quantity - AMBIT_COORDINATE;
  if (quantity == AMBIT_COORDINATE || quantity == AMBIT_COORDINATE_RATE) {
    for (uint32_t i = 0; i < coordinates; i++)
      out[i] = quantity == AMBIT_COORDINATE ? b->state(b, i, 0, "1") : i < dof ? b->speed(b, i, 1, "1/s") : 0;
    return AMBIT_OK;
  }
  if (quantity > AMBIT_RATE2) return AMBIT_UNABLE;
  for (uint32_t i = 0; i < dof; i++)
    out[i] = dof == coordinates ? b->state(b, i, order, "1") : b->speed(b, i, order, "1/s");
  return AMBIT_OK;
}

static ambit_status express_effort(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  return port == 0 && quantity == AMBIT_EFFORT ? give_param(b, count(b, 0), out) : AMBIT_UNABLE;
}

static void make(element_stage_joint *j, uint32_t dof, uint32_t role) {
  snprintf(j->shape, sizeof j->shape, "%u", AMBIT_QUANTITY_MAX);
  j->port[0] = (ambit_port) { "joint", AMBIT_PORT_JOINT, role, dof, 0, "the joint" };
  j->param[0] = (ambit_param) { "value", "1", j->shape, NULL, "one for each degree of freedom, then 0" };
  j->param[1] = (ambit_param) { NULL, NULL, NULL, NULL, NULL };
  j->param[2] = j->param[1];
  if (role == AMBIT_ROLE_OUT)
    j->param[1] = (ambit_param) { "coordinates", "1", j->shape, NULL, "one for each coordinate, then 0" };
  j->element = (ambit_element) { sizeof(ambit_element), 1, j->port, j->param,
    role == AMBIT_ROLE_OUT ? express_joint : express_effort, NULL };
}

void element_stage_make_joint(element_stage_joint *j, uint32_t dof) { make(j, dof, AMBIT_ROLE_OUT); }
void element_stage_make_effort(element_stage_joint *j, uint32_t dof) { make(j, dof, AMBIT_ROLE_IN); }
