/* robot_models.h -- arms with published data, as mechanisms of element plugins. Shared by tests and benchmarks.
**
** UR5: ur5_robot.urdf of github.com/Gepetto/example-robot-data (BSD-3-Clause), joints shoulder_pan to wrist_3; origins
** have no roll and no yaw. Puma 560: standard DH and inertial data of github.com/petercorke/robotics-toolbox-python,
** models/DH/Puma560.py (MIT): frame i is T = Rz(q) Tz(d) Tx(a) Rx(alpha); armature G^2 Jm. No body
** has the inertia of its first and third link; they are identified parameters.
*/
#ifndef AMBIT_ROBOT_MODELS_H
#define AMBIT_ROBOT_MODELS_H
#include <ambit/registry.h>
#include <ambit/mechanism.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROBOT_JOINTS 6

typedef struct robot {
  ambit_graph *graph;
  ambit_registry *registry;
  ambit_mechanism *mechanism;
} robot;

static inline robot robot_open(const char *name) {
  robot r = { .graph = ambit_graph_open(), .registry = ambit_registry_open(NULL) };
  r.mechanism = ambit_mechanism_open(r.graph, name);
  return r;
}

static inline void robot_close(robot *r) {
  ambit_mechanism_close(r->mechanism);
  ambit_graph_close(r->graph);
  ambit_registry_close(r->registry);
}

static inline void robot_need(int good, const char *what) {
  if (good) return;
  fprintf(stderr, "robot: %s\n", what);
  exit(1);
}

/* "0,-9.81,pi": at most 9 numbers, each a decimal; "pi/2" and "-pi/2" are exact */
static inline size_t robot_numbers(robot *r, const char *list, ambit_expr *e) {
  char text[256], *rest = text;
  size_t n = 0;
  snprintf(text, sizeof text, "%s", list);
  for (char *piece; (piece = strsep(&rest, ",")) != NULL; n++) {
    ambit_failure f = { 0 };
    char *half = strstr(piece, "/2");
    if (half) *half = '\0';
    e[n] = ambit_graph_decimal(r->graph, piece, &f);
    if (half) e[n] = ambit_graph_op(r->graph, AMBIT_OP_MUL, ambit_graph_number(r->graph, 0.5), e[n]);
    robot_need(e[n] != AMBIT_NO_EXPR, f.message);
  }
  return n;
}

/* One part; `data`: name, numbers, ..., NULL. All IN ports are connected to `at`. */
static inline uint32_t robot_add(
    robot *r, const char *type, const char *name, ambit_frame at, const char *const *data) {
  ambit_expr value[8][9];
  const ambit_expr *param[8] = { 0 };
  ambit_frame connection[4] = { at, at, at, at };
  const ambit_element *e = NULL;
  ambit_failure f = { 0 };
  robot_need(ambit_registry_element(r->registry, type, &e, &f) == AMBIT_OK, f.message);
  for (size_t k = 0; data && data[k]; k += 2) {
    uint32_t i = 0;
    while (e->param[i].name && strcmp(e->param[i].name, data[k]) != 0) i++;
    robot_need(e->param[i].name && i < 8, data[k]);
    robot_numbers(r, data[k + 1], value[i]);
    param[i] = value[i];
  }
  ambit_part_spec spec = { e, type, name, "robot_models.h", param, connection, NULL };
  uint32_t part = 0;
  robot_need(ambit_mechanism_add(r->mechanism, &spec, &part, &f) == AMBIT_OK, f.message);
  return part;
}

#define ROBOT_DATA(...) ((const char *const[]) { __VA_ARGS__, NULL })

/* The frame that it moves. */
static inline ambit_frame robot_link(
    robot *r, ambit_frame from, const char *offset, const char *axis, const char *angle) {
  return (ambit_frame) {
    robot_add(r, "rigid_link", NULL, from, ROBOT_DATA("offset", offset, "axis", axis, "angle", angle)), 1
  };
}

static inline ambit_frame robot_joint(
    robot *r, const char *type, const char *name, ambit_frame from, const char *axis) {
  return (ambit_frame) { robot_add(r, type, name, from, ROBOT_DATA("axis", axis)), 1 };
}

static inline void robot_body(
    robot *r, ambit_frame at, const char *mass, const char *centre, double ixx, double iyy, double izz) {
  char inertia[128];
  snprintf(inertia, sizeof inertia, "%.12g,0,0,0,%.12g,0,0,0,%.12g", ixx, iyy, izz);
  robot_add(r, "rigid_body", NULL, at, ROBOT_DATA("mass", mass, "centre", centre, "inertia", inertia, "physical", "0"));
}

static inline robot robot_ur5(void) {
  static const struct {
    const char *name, *offset, *pitch, *axis, *mass, *centre;
    double ixx, izz;
  } link[ROBOT_JOINTS] = {
    { "shoulder_pan", "0,0,0.089159", "0", "0,0,1", "3.7", "0,0,0", 0.010267495893, 0.00666 },
    { "shoulder_lift", "0,0.13585,0", "1.57079632679", "0,1,0", "8.393", "0,0,0.28", 0.22689067591, 0.0151074 },
    { "elbow", "0,-0.1197,0.425", "0", "0,1,0", "2.275", "0,0,0.25", 0.049443313556, 0.004095 },
    { "wrist_1", "0,0,0.39225", "1.57079632679", "0,1,0", "1.219", "0,0,0", 0.111172755531, 0.21942 },
    { "wrist_2", "0,0.093,0", "0", "0,0,1", "1.219", "0,0,0", 0.111172755531, 0.21942 },
    { "wrist_3", "0,0,0.09465", "0", "0,1,0", "0.1879", "0,0,0", 0.0171364731454, 0.033822 },
  };
  robot r = robot_open("UR5");
  robot_add(&r, "gravity", NULL, AMBIT_WORLD, ROBOT_DATA("field", "0,0,-9.81"));
  ambit_frame at = AMBIT_WORLD;
  for (int i = 0; i < ROBOT_JOINTS; i++) {
    at = robot_link(&r, at, link[i].offset, "0,1,0", link[i].pitch);
    at = robot_joint(&r, "revolute", link[i].name, at, link[i].axis);
    robot_body(&r, at, link[i].mass, link[i].centre, link[i].ixx, link[i].ixx, link[i].izz);
  }
  return r;
}

static inline robot robot_puma560(void) {
  static const struct {
    const char *offset, *alpha, *mass, *centre;
    double ixx, iyy, izz;
    const char *armature;
  } link[ROBOT_JOINTS] = {
    { "0,0,0.67183", "pi/2", "0", "0,0,0", 0, 0.35, 0, "0.784029968642" },
    { "0.4318,0,0", "0", "17.4", "-0.3638,0.006,0.2275", 0.13, 0.524, 0.539, "2.324814845" },
    { "0.0203,0,0.15005", "-pi/2", "4.8", "-0.0203,-0.0141,0.070", 0.066, 0.086, 0.0125, "0.576873331938" },
    { "0,0,0.4318", "pi/2", "0.82", "0,0.019,0", 1.8e-3, 1.3e-3, 1.8e-3, "0.19079062612368" },
    { "0,0,0", "-pi/2", "0.34", "0,0,0", 0.3e-3, 0.4e-3, 0.3e-3, "0.170706291657" },
    { "0,0,0", "0", "0.09", "0,0,0.032", 0.15e-3, 0.15e-3, 0.04e-3, "0.194064505668" },
  };
  robot r = robot_open("Puma 560");
  robot_add(&r, "gravity", NULL, AMBIT_WORLD, ROBOT_DATA("field", "0,0,-9.81"));
  ambit_frame at = AMBIT_WORLD;
  for (int i = 0; i < ROBOT_JOINTS; i++) {
    char name[8];
    snprintf(name, sizeof name, "q%d", i + 1);
    ambit_frame turned = robot_joint(&r, "revolute", name, at, "0,0,1");
    robot_add(&r, "armature", NULL, (ambit_frame) { turned.part, 2 }, ROBOT_DATA("inertia", link[i].armature));
    at = robot_link(&r, turned, link[i].offset, "1,0,0", link[i].alpha);
    robot_body(&r, at, link[i].mass, link[i].centre, link[i].ixx, link[i].iyy, link[i].izz);
  }
  return r;
}

/* -- chains of n equal links: in a plane, or each joint turned against the one before about a skew axis */

static inline robot robot_chain(int n, int spatial) {
  robot r = robot_open("chain");
  robot_add(&r, "gravity", NULL, AMBIT_WORLD, ROBOT_DATA("field", "0,-9.81,0"));
  ambit_frame at = AMBIT_WORLD;
  for (int i = 0; i < n; i++) {
    char name[16];
    snprintf(name, sizeof name, "q%d", i + 1);
    at = robot_joint(&r, "revolute", name, at, "0,0,1");
    if (spatial)
      robot_add(&r, "rigid_body", NULL, at,
          ROBOT_DATA(
              "mass", "1.3", "centre", "0.1,0.2,0.3", "inertia", "0.3,0.01,0.02,0.01,0.4,-0.03,0.02,-0.03,0.35"));
    at = spatial ? robot_link(&r, at, "0.3,0.1,0.2", i % 2 ? "0.3,0.2,0.7" : "1,0.5,0", i % 2 ? "1.1" : "-0.7")
                 : robot_link(&r, at, "0,-1,0", "0,0,1", "0");
    if (!spatial) robot_add(&r, "point_mass", NULL, at, ROBOT_DATA("mass", "1"));
  }
  return r;
}
#endif
