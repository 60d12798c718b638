/* element_kit_stage.c -- the stage around the element under test (element_kit.h). */
#include "host/params.h"
#include <ambit/registry.h>
#include "kit/element_kit_inside.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static ambit_expr number(element_kit *k, double lo, double hi) {
  return ambit_graph_number(k->graph, ambit_random_in(&k->random, (ambit_interval) { lo, hi }));
}

/* positive; moving: c0 + c1 t + c2 sin t */
static ambit_expr scalar(element_kit *k) {
  ambit_expr x = number(k, 0.3, 1.5), t = ambit_graph_time(k->graph);
  if (!k->moving) return x;
  x = kit_add(k, x, kit_multiply(k, number(k, 0.1, 0.5), t));
  return kit_add(k, x, kit_multiply(k, number(k, 0.1, 0.5), kit_op(k, AMBIT_OP_SIN, t, t)));
}

/* A matrix that a body may have as its inertia: tr(S) 1 - S for S = B B^T. */
static void inertia(element_kit *k, ambit_expr *out) {
  double b[9], s[9] = { 0 };
  for (int i = 0; i < 9; i++)
    b[i] = floor(ambit_random_in(&k->random, (ambit_interval) { -8, 8 })) / 8; /* products are exact */
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 3; j++) s[i] += b[3 * (i / 3) + j] * b[3 * (i % 3) + j];
  for (int i = 0; i < 9; i++) out[i] = ambit_graph_number(k->graph, (i % 4 == 0 ? 1 + s[0] + s[4] + s[8] : 0) - s[i]);
}

static double choice(element_kit *k, const char *shape) {
  double n = 1;
  for (const char *c = shape; *c; c++) n += *c == '|';
  return fmin(floor(ambit_random_in(&k->random, (ambit_interval) { 0, n })), n - 1);
}

/* Direction or vector: of any sign, unless a damping or a stiffness may be meant. */
static void give(element_kit *k, const ambit_param *p, ambit_expr *value) {
  size_t n = ambit_params_doubles((const ambit_param[]) { *p, { 0 } });
  bool any_sign = strcmp(p->shape, "axis") == 0 || strcmp(p->unit, "m") == 0;
  if (strcmp(p->shape, "3x3") == 0)
    inertia(k, value);
  else if (*p->shape == '\0')
    value[0] = scalar(k);
  else if (strcmp(p->shape, "flag") == 0 || strcmp(p->shape, "integer") == 0)
    value[0] = ambit_graph_number(k->graph, 1);
  else if (strchr(p->shape, '|'))
    value[0] = ambit_graph_number(k->graph, choice(k, p->shape));
  else
    for (size_t c = 0; c < n && c < AMBIT_QUANTITY_MAX; c++) value[c] = number(k, any_sign ? -1 : 0, 1);
}

/* Every combination of the optional parameters: bit j of `given` is the j-th of them. */
static void choose_params(element_kit *k, unsigned given, const ambit_expr *param[ELEMENT_KIT_PARAMS]) {
  unsigned optional = 0;
  for (size_t i = 0; k->element->param && k->element->param[i].name; i++) {
    const ambit_param *p = &k->element->param[i];
    param[i] = NULL;
    if (p->fallback && !(given >> optional++ & 1)) continue;
    param[i] = k->value[i];
    give(k, p, k->value[i]);
  }
}

static uint32_t put(
    element_kit *k, const ambit_element *e, const char *name, const ambit_expr *const *param, ambit_frame at) {
  uint32_t part = 0;
  ambit_failure f = { 0 };
  ambit_part_spec spec = { .element = e, .type = "stage", .name = name, .param = param, .connection = &at };
  if (ambit_mechanism_add(k->mechanism, &spec, &part, &f) != AMBIT_OK)
    element_kit_complain(k, "the stage: %s", f.message);
  return part;
}

/* What carries IN port i: a moving frame, or a joint. */
static ambit_frame carrier(element_kit *k, uint32_t i) {
  const ambit_port *p = &k->element->port[i];
  char name[32];
  snprintf(name, sizeof name, "carrier%u", i);
  const ambit_expr *param[ELEMENT_STAGE_PARAMS] = { 0 };
  const ambit_element *e = &element_stage_mover;
  ambit_expr speed[AMBIT_QUANTITY_MAX] = { 0 }, coordinate[AMBIT_QUANTITY_MAX] = { 0 };
  if (p->kind == AMBIT_PORT_JOINT) {
    for (uint32_t c = 0; c < ambit_port_dof(p); c++) speed[c] = ambit_graph_number(k->graph, 1);
    for (uint32_t c = 0; c < ambit_port_coordinates(p); c++) coordinate[c] = ambit_graph_number(k->graph, 1);
    element_stage_make_joint(&k->joint[i], p->dof);
    e = &k->joint[i].element;
    param[0] = speed;
    param[1] = coordinate;
  }
  k->mover[i] = put(k, e, name, param, AMBIT_NOWHERE);
  return (ambit_frame) { k->mover[i], 0 };
}

/* An arbitrary wrench or effort on OUT port i. */
static void burden(element_kit *k, uint32_t i) {
  const ambit_port *p = &k->element->port[i];
  bool frame = p->kind == AMBIT_PORT_FRAME;
  const ambit_expr *param[ELEMENT_STAGE_PARAMS] = { k->load[i] };
  for (uint32_t c = 0; c < (frame ? 6 : ambit_port_dof(p)); c++) k->load[i][c] = number(k, -1, 1);
  if (!frame) element_stage_make_effort(&k->joint[i], p->dof);
  put(k, frame ? &element_stage_load : &k->joint[i].element, NULL, param, (ambit_frame) { k->part, i });
}

static void take_variables(element_kit *k) {
  size_t nq = ambit_mechanism_coordinates(k->mechanism, 0, NULL), nu = ambit_mechanism_speeds(k->mechanism, 0, NULL);
  ambit_coordinate *q = calloc(nq + 1, sizeof *q);
  ambit_speed *u = calloc(nu + 1, sizeof *u);
  k->leaf = calloc(nq + nu + 1, sizeof *k->leaf);
  k->rate = calloc(nq + nu + 1, sizeof *k->rate);
  k->nleaf = 0;
  ambit_mechanism_coordinates(k->mechanism, nq, q);
  ambit_mechanism_speeds(k->mechanism, nu, u);
  for (size_t i = 0; i < nq; i++) {
    if (q[i].rate == AMBIT_NO_EXPR) element_kit_complain(k, "coordinate `%s` has no rate", q[i].name);
    k->leaf[k->nleaf] = q[i].q, k->rate[k->nleaf++] = q[i].rate;
  }
  for (size_t i = 0; i < nu; i++) k->leaf[k->nleaf] = u[i].u, k->rate[k->nleaf++] = u[i].du;
  free(q);
  free(u);
}

/* Data may be refused (two that exclude each other, one that must not move), with a message that names the part. */
static bool add_subject(element_kit *k, const ambit_part_spec *spec) {
  ambit_failure f = { 0 };
  if (ambit_mechanism_add(k->mechanism, spec, &k->part, &f) == AMBIT_OK) return true;
  k->report->refused++;
  if (f.status == AMBIT_BROKEN || !strstr(f.message, "subject") || strlen(f.message) < 30)
    element_kit_complain(k, "it cannot be added: %s", f.message);
  return false;
}

bool element_kit_open_stage(element_kit *k, unsigned given) {
  ambit_frame connection[ELEMENT_KIT_PORTS];
  const ambit_expr *param[ELEMENT_KIT_PARAMS] = { 0 };
  ambit_expr field[3];
  const ambit_expr *field_param[ELEMENT_STAGE_PARAMS] = { field };
  k->graph = ambit_graph_open();
  k->mechanism = ambit_mechanism_open(k->graph, "stage");
  k->leaf = k->rate = NULL;
  for (int c = 0; c < 3; c++) field[c] = number(k, -10, 10);
  put(k, &element_stage_field, "field", field_param, AMBIT_NOWHERE);
  for (uint32_t i = 0; i < k->element->nport; i++)
    connection[i] = k->element->port[i].role == AMBIT_ROLE_IN ? carrier(k, i) : AMBIT_NOWHERE;
  choose_params(k, given, param);
  ambit_part_spec spec = { k->element, k->name, "subject", "kit.lua:1", param, connection, NULL };
  k->nresidual = k->nfollowed = 0;
  k->report->stages++;
  if (!add_subject(k, &spec)) return false;
  for (uint32_t i = 0; i < k->element->nport; i++)
    if (k->element->port[i].role == AMBIT_ROLE_OUT && k->element->port[i].kind <= AMBIT_PORT_JOINT) burden(k, i);
  take_variables(k);
  return true;
}

void element_kit_close_stage(element_kit *k) {
  free(k->leaf);
  free(k->rate);
  ambit_mechanism_close(k->mechanism);
  ambit_graph_close(k->graph);
}
