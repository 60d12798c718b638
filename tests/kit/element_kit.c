/* element_kit.c -- see element_kit.h. */
#include "kit/element_kit.h"
#include "graph/tape.h"
#include "host/registry.h"
#include "kit/element_stage.h"
#include "model/hull.h"
#include "model/mechanism.h"
#include "model/parts.h"
#include "model/random.h"
#include "model/unit.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PORTS_MAX 8u
#define PARAMS_MAX 16u
#define POINTS 3
#define TOLERANCE 1e-8 /* of residuals of numbers of ordinary size */
#define RESIDUALS_MAX 512u

typedef struct kit {
  element_kit_report *report;
  const ambit_element *element;
  const char *name;
  ambit_random random;
  /* the stage */
  ambit_graph *graph;
  ambit_mechanism *mechanism;
  uint32_t part, mover[PORTS_MAX]; /* mover: of IN ports */
  ambit_expr value[PARAMS_MAX][AMBIT_QUANTITY_MAX], load[PORTS_MAX][AMBIT_QUANTITY_MAX];
  element_stage_joint joint[PORTS_MAX];
  bool moving;
  size_t ncoordinate;
  ambit_expr *leaf, *rate; /* [2 ncoordinate] */
  size_t nresidual;
  ambit_expr residual[RESIDUALS_MAX];
  const char *about[RESIDUALS_MAX];
} kit;

static void complain(kit *k, const char *format, ...) AMBIT_PRINTF(2, 3);
static void complain(kit *k, const char *format, ...) {
  va_list arguments;
  if (k->report->failures++) return;
  va_start(arguments, format);
  int n = snprintf(k->report->first, sizeof k->report->first, "%s: ", k->name);
  vsnprintf(k->report->first + n, sizeof k->report->first - (size_t)n, format, arguments);
  va_end(arguments);
}

/* -- description */

static bool is_sentence(const char *text) { return text && strlen(text) >= 3; }

static bool known_shape(const char *shape) {
  static const char *const word[] = { "", "axis", "flag", "integer" };
  for (size_t i = 0; i < sizeof word / sizeof *word; i++)
    if (strcmp(shape, word[i]) == 0) return true;
  return strchr(shape, '|') || (shape[0] >= '1' && shape[0] <= '9');
}

static void check_description(kit *k) {
  const ambit_element *e = k->element;
  for (uint32_t i = 0; i < e->nport; i++) {
    if (!e->port[i].name || !*e->port[i].name || !is_sentence(e->port[i].doc))
      complain(k, "port %u has no name or no sentence", i);
    for (uint32_t j = 0; j < i; j++)
      if (strcmp(e->port[i].name, e->port[j].name) == 0) complain(k, "two ports are called `%s`", e->port[i].name);
  }
  for (const ambit_param *p = e->param; p && p->name; p++) {
    ambit_unit unit;
    ambit_failure f = { 0 };
    if (!is_sentence(p->doc)) complain(k, "parameter `%s` has no sentence", p->name);
    if (!p->unit || ambit_unit_read(p->unit, &unit, &f) != AMBIT_OK)
      complain(k, "unit of `%s`: %s", p->name, f.message);
    if (!p->shape || !known_shape(p->shape)) complain(k, "parameter `%s` has no known shape", p->name);
    for (const ambit_param *q = e->param; q < p; q++)
      if (strcmp(p->name, q->name) == 0) complain(k, "two parameters are called `%s`", p->name);
    for (uint32_t i = 0; i < e->nport; i++)
      if (strcmp(p->name, e->port[i].name) == 0) complain(k, "a port and a parameter are called `%s`", p->name);
  }
}

/* -- the stage */

static ambit_expr number(kit *k, double lo, double hi) {
  return ambit_graph_number(k->graph, ambit_random_in(&k->random, (ambit_interval) { lo, hi }));
}

static ambit_expr op(kit *k, uint32_t code, ambit_expr a, ambit_expr b) { return ambit_graph_op(k->graph, code, a, b); }
static ambit_expr add(kit *k, ambit_expr a, ambit_expr b) { return op(k, AMBIT_OP_ADD, a, b); }
static ambit_expr subtract(kit *k, ambit_expr a, ambit_expr b) { return op(k, AMBIT_OP_SUB, a, b); }
static ambit_expr multiply(kit *k, ambit_expr a, ambit_expr b) { return op(k, AMBIT_OP_MUL, a, b); }

/* positive; moving: c0 + c1 t + c2 sin t */
static ambit_expr scalar(kit *k) {
  ambit_expr x = number(k, 0.3, 1.5), t = ambit_graph_time(k->graph);
  if (!k->moving) return x;
  x = add(k, x, multiply(k, number(k, 0.1, 0.5), t));
  return add(k, x, multiply(k, number(k, 0.1, 0.5), op(k, AMBIT_OP_SIN, t, t)));
}

/* A matrix that a body may have as its inertia: tr(S) 1 - S for S = B B^T. */
static void inertia(kit *k, ambit_expr *out) {
  double b[9], s[9] = { 0 };
  for (int i = 0; i < 9; i++)
    b[i] = floor(ambit_random_in(&k->random, (ambit_interval) { -8, 8 })) / 8; /* products are exact */
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 3; j++) s[i] += b[3 * (i / 3) + j] * b[3 * (i % 3) + j];
  for (int i = 0; i < 9; i++) out[i] = ambit_graph_number(k->graph, (i % 4 == 0 ? 1 + s[0] + s[4] + s[8] : 0) - s[i]);
}

/* Every combination of the optional parameters: bit j of `given` is the j-th of them. */
static void choose_params(kit *k, unsigned given, const ambit_expr *param[PARAMS_MAX]) {
  unsigned optional = 0;
  for (size_t i = 0; k->element->param && k->element->param[i].name; i++) {
    const ambit_param *p = &k->element->param[i];
    param[i] = NULL;
    if (p->fallback && !(given >> optional++ & 1)) continue;
    param[i] = k->value[i];
    size_t n = ambit_params_doubles((const ambit_param[]) { *p, { 0 } });
    if (strcmp(p->shape, "3x3") == 0)
      inertia(k, k->value[i]);
    else if (*p->shape == '\0')
      k->value[i][0] = scalar(k);
    else if (strcmp(p->shape, "flag") == 0 || strcmp(p->shape, "integer") == 0 || strchr(p->shape, '|'))
      k->value[i][0] = ambit_graph_number(k->graph, 1);
    else
      for (size_t c = 0; c < n && c < AMBIT_QUANTITY_MAX; c++) k->value[i][c] = number(k, -1, 1);
  }
}

static uint32_t put(kit *k, const ambit_element *e, const char *name, const ambit_expr *value, ambit_frame at) {
  const ambit_expr *param[PARAMS_MAX] = { value };
  uint32_t part = 0;
  ambit_failure f = { 0 };
  ambit_part_spec spec = { .element = e, .type = "stage", .name = name, .param = param, .connection = &at };
  if (ambit_mechanism_add(k->mechanism, &spec, &part, &f) != AMBIT_OK) complain(k, "the stage: %s", f.message);
  return part;
}

/* What carries IN port i: a moving frame, or a joint. */
static ambit_frame carrier(kit *k, uint32_t i) {
  const ambit_port *p = &k->element->port[i];
  char name[32];
  snprintf(name, sizeof name, "carrier%u", i);
  if (p->kind == AMBIT_PORT_FRAME) {
    k->mover[i] = put(k, &element_stage_mover, name, NULL, AMBIT_NOWHERE);
  } else {
    ambit_expr flag[AMBIT_QUANTITY_MAX] = { 0 };
    for (uint32_t c = 0; c < p->dof; c++) flag[c] = ambit_graph_number(k->graph, 1);
    element_stage_make_joint(&k->joint[i], p->dof);
    k->mover[i] = put(k, &k->joint[i].element, name, flag, AMBIT_NOWHERE);
  }
  return (ambit_frame) { k->mover[i], 0 };
}

/* An arbitrary wrench or effort on OUT port i. */
static void burden(kit *k, uint32_t i) {
  const ambit_port *p = &k->element->port[i];
  bool frame = p->kind == AMBIT_PORT_FRAME;
  for (uint32_t c = 0; c < (frame ? 6 : p->dof); c++) k->load[i][c] = number(k, -1, 1);
  if (!frame) element_stage_make_effort(&k->joint[i], p->dof);
  put(k, frame ? &element_stage_load : &k->joint[i].element, NULL, k->load[i], (ambit_frame) { k->part, i });
}

static void take_coordinates(kit *k) {
  k->ncoordinate = ambit_mechanism_coordinates(k->mechanism, 0, NULL);
  ambit_coordinate *c = calloc(k->ncoordinate + 1, sizeof *c);
  k->leaf = calloc(2 * k->ncoordinate + 1, sizeof *k->leaf);
  k->rate = calloc(2 * k->ncoordinate + 1, sizeof *k->rate);
  ambit_speed *u = calloc(k->ncoordinate + 1, sizeof *u);
  ambit_mechanism_coordinates(k->mechanism, k->ncoordinate, c);
  ambit_mechanism_speeds(k->mechanism, k->ncoordinate, u);
  for (size_t i = 0; i < k->ncoordinate; i++) {
    k->leaf[2 * i] = c[i].q, k->rate[2 * i] = c[i].rate;
    k->leaf[2 * i + 1] = u[i].u, k->rate[2 * i + 1] = u[i].du;
  }
  free(u);
  free(c);
}

static bool open_stage(kit *k, unsigned given) {
  ambit_frame connection[PORTS_MAX];
  const ambit_expr *param[PARAMS_MAX] = { 0 };
  ambit_expr field[3];
  ambit_failure f = { 0 };
  k->graph = ambit_graph_open();
  k->mechanism = ambit_mechanism_open(k->graph, "stage");
  for (int c = 0; c < 3; c++) field[c] = number(k, -10, 10);
  put(k, &element_stage_field, "field", field, AMBIT_NOWHERE);
  for (uint32_t i = 0; i < k->element->nport; i++)
    connection[i] = k->element->port[i].role == AMBIT_ROLE_IN ? carrier(k, i) : AMBIT_NOWHERE;
  choose_params(k, given, param);
  ambit_part_spec spec = { k->element, k->name, "subject", "kit.lua:1", param, connection };
  bool added = ambit_mechanism_add(k->mechanism, &spec, &k->part, &f) == AMBIT_OK;
  if (!added) complain(k, "it cannot be added: %s", f.message);
  for (uint32_t i = 0; added && i < k->element->nport; i++)
    if (k->element->port[i].role == AMBIT_ROLE_OUT) burden(k, i);
  take_coordinates(k);
  k->nresidual = 0;
  k->report->stages++;
  return added;
}

static void close_stage(kit *k) {
  free(k->leaf);
  free(k->rate);
  ambit_mechanism_close(k->mechanism);
  ambit_graph_close(k->graph);
}

/* -- quantities */

/* NULL: declined or refused, which is counted; a refusal must name the part. */
static const ambit_expr *ask(kit *k, uint32_t part, uint32_t port, uint32_t quantity) {
  ambit_failure f = { 0 };
  const ambit_expr *e = ambit_mechanism_pull(k->mechanism, (ambit_frame) { part, port }, quantity, &f);
  if (e) {
    k->report->expressed++;
    return e;
  }
  k->report->refused++;
  if (f.status == AMBIT_OK || !strstr(f.message, "subject") || strlen(f.message) < 30)
    complain(
        k, "%s of port %u is refused without a clear message: `%s`", ambit_quantity_name(quantity), port, f.message);
  if (f.status == AMBIT_BROKEN) complain(k, "%s", f.message);
  return NULL;
}

/* The field and the energy of the element itself, out of the sums over all. */
static void ask_whole(kit *k, uint32_t quantity) {
  ambit_failure f = { 0 };
  const ambit_expr *sum = ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, quantity, &f);
  uint8_t state = ambit_part_cell(&k->mechanism->part[k->part], AMBIT_NO_PORT, quantity)->state;
  if (!sum) {
    k->report->refused++;
    if (!strstr(f.message, "subject") || strlen(f.message) < 30)
      complain(k, "its %s is refused without a clear message: `%s`", ambit_quantity_name(quantity), f.message);
  } else if (state == AMBIT_CELL_DONE)
    k->report->expressed++;
  else
    k->report->declined++;
}

/* A quantity of a later version of the ABI is declined; so is one of the wrong kind of port. */
static void check_declines(kit *k) {
  static const uint32_t later[] = { 6, 15, 21, 33, 99, 1000 };
  ambit_failure f = { 0 };
  ambit_expr out[AMBIT_QUANTITY_MAX];
  k->mechanism->failure = &f;
  for (uint32_t port = 0; port <= k->element->nport; port++)
    for (size_t i = 0; i < sizeof later / sizeof *later; i++) {
      ambit_cell cell = {
        .part = k->part, .port = port < k->element->nport ? port : AMBIT_NO_PORT, .quantity = later[i]
      };
      ambit_status status = ambit_build_express(k->mechanism, &cell, out);
      if (status == AMBIT_UNABLE && f.status == AMBIT_OK)
        k->report->declined++;
      else
        complain(k, "the unknown quantity %u at port %u is not declined with AMBIT_UNABLE", later[i], port);
      ambit_failure_clear(&f);
    }
  k->mechanism->failure = NULL;
}

/* -- what must vanish */

static void vanish(kit *k, const char *about, ambit_expr e) {
  if (k->nresidual == RESIDUALS_MAX) {
    complain(k, "too many residuals");
    return;
  }
  k->about[k->nresidual] = about;
  k->residual[k->nresidual++] = e;
}

static ambit_expr derivative(kit *k, ambit_expr e) {
  ambit_failure f = { 0 };
  ambit_expr d = ambit_graph_time_derivative(k->graph, e, 2 * k->ncoordinate, k->leaf, k->rate, &f);
  if (d == AMBIT_NO_EXPR) complain(k, "%s", f.message);
  return d == AMBIT_NO_EXPR ? 0 : d;
}

/* row i of R^T times a vector given as three expressions with a stride */
static ambit_expr turned_back(kit *k, const ambit_expr *pose, int i, const ambit_expr *v, int stride) {
  ambit_expr s = 0;
  for (int j = 0; j < 3; j++) s = add(k, s, multiply(k, pose[3 * j + i], v[j * stride]));
  return s;
}

static void check_pose(kit *k, const ambit_expr *pose) {
  ambit_expr one = ambit_graph_number(k->graph, 1), determinant = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      vanish(k, "orthonormal axes", subtract(k, turned_back(k, pose, i, pose + j, 3), i == j ? one : 0));
    int p = (i + 1) % 3, q = (i + 2) % 3;
    ambit_expr minor = subtract(k, multiply(k, pose[3 + p], pose[6 + q]), multiply(k, pose[3 + q], pose[6 + p]));
    determinant = add(k, determinant, multiply(k, pose[i], minor));
  }
  vanish(k, "right-handed axes", subtract(k, determinant, one));
}

static void check_twist(kit *k, const ambit_expr *pose, const ambit_expr *twist) {
  ambit_expr rate[12];
  for (int i = 0; i < 12; i++) rate[i] = derivative(k, pose[i]);
  for (int i = 0; i < 3; i++) {
    int p = (i + 1) % 3, q = (i + 2) % 3; /* R^T R' = [w x]: row q, column p is w_i */
    vanish(k, "angular velocity", subtract(k, turned_back(k, pose, q, rate + p, 3), twist[i]));
    vanish(k, "velocity", subtract(k, turned_back(k, pose, i, rate + 9, 1), twist[3 + i]));
  }
}

static void check_acceleration(kit *k, const ambit_expr *pose, const ambit_expr *twist, const ambit_expr *accel) {
  const ambit_expr *field = ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, AMBIT_FIELD, NULL);
  for (int i = 0; i < 3; i++) {
    int p = (i + 1) % 3, q = (i + 2) % 3;
    vanish(k, "angular acceleration", subtract(k, derivative(k, twist[i]), accel[i]));
    ambit_expr a = derivative(k, twist[3 + i]);
    a = add(k, a, subtract(k, multiply(k, twist[p], twist[3 + q]), multiply(k, twist[q], twist[3 + p])));
    a = subtract(k, a, turned_back(k, pose, i, field, 1));
    vanish(k, "proper acceleration", subtract(k, a, accel[3 + i]));
  }
}

static void check_frame(kit *k, uint32_t port) {
  const ambit_expr *pose = ask(k, k->part, port, AMBIT_POSE);
  const ambit_expr *twist = ask(k, k->part, port, AMBIT_TWIST);
  const ambit_expr *accel = ask(k, k->part, port, AMBIT_ACCEL);
  if (pose) check_pose(k, pose);
  if (pose && twist) check_twist(k, pose, twist);
  if (pose && twist && accel) check_acceleration(k, pose, twist, accel);
}

static void check_joint(kit *k, uint32_t port) {
  const ambit_expr *q = ask(k, k->part, port, AMBIT_COORDINATE), *qd = ask(k, k->part, port, AMBIT_RATE);
  const ambit_expr *qdd = ask(k, k->part, port, AMBIT_RATE2);
  for (uint32_t c = 0; q && qd && qdd && c < k->element->port[port].dof; c++) {
    vanish(k, "rate", subtract(k, derivative(k, q[c]), qd[c]));
    vanish(k, "second rate", subtract(k, derivative(k, qd[c]), qdd[c]));
  }
}

static ambit_expr dot(kit *k, uint32_t n, const ambit_expr *a, const ambit_expr *b) {
  ambit_expr s = 0;
  for (uint32_t i = 0; i < n; i++) s = add(k, s, multiply(k, a[i], b[i]));
  return s;
}

/* What port i brings in, minus what it passes on; false: the element has no such quantity. */
static bool port_power(kit *k, uint32_t i, ambit_expr *power) {
  const ambit_port *p = &k->element->port[i];
  if (p->role == AMBIT_ROLE_IN) { /* the carrier's frame bears this element alone */
    const ambit_expr *wrench = ask(k, k->mover[i], 0, AMBIT_WRENCH),
                     *twist = wrench ? ask(k, k->mover[i], 0, AMBIT_TWIST) : NULL;
    if (twist) *power = subtract(k, *power, dot(k, 6, wrench, twist));
    return twist;
  }
  if (p->kind == AMBIT_PORT_FRAME) {
    const ambit_expr *twist = ask(k, k->part, i, AMBIT_TWIST);
    if (twist) *power = add(k, *power, dot(k, 6, k->load[i], twist));
    return twist;
  }
  const ambit_expr *balance = ask(k, k->part, i, AMBIT_BALANCE),
                   *rate = balance ? ask(k, k->part, i, AMBIT_RATE) : NULL;
  if (rate) *power = add(k, *power, subtract(k, dot(k, p->dof, k->load[i], rate), dot(k, p->dof, balance, rate)));
  return rate;
}

/* A joint with a given motion is driven: its balance is the effort that is missing, and the identity is the same. */
static void check_power(kit *k) {
  ambit_expr power = 0;
  ambit_failure f = { 0 };
  const ambit_expr *energy = ambit_mechanism_pull(k->mechanism, AMBIT_NOWHERE, AMBIT_ENERGY, &f);
  bool complete = energy != NULL;
  for (uint32_t i = 0; complete && i < k->element->nport; i++) complete = port_power(k, i, &power);
  if (!complete) return;
  for (int i = 0; i < 2; i++) power = subtract(k, power, derivative(k, energy[i]));
  vanish(k, "power", power);
  k->report->powers++;
}

static bool drives(const ambit_element *e) {
  for (uint32_t i = 0; i < e->nport; i++)
    if (e->port[i].role == AMBIT_ROLE_IN && e->port[i].kind == AMBIT_PORT_JOINT) return true;
  return false;
}

/* -- numbers */

static void evaluate(kit *k) {
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  size_t n = ambit_graph_leaves(k->graph, k->nresidual, k->residual, 0, NULL);
  ambit_expr *leaf = calloc(n + 1, sizeof *leaf);
  ambit_interval *in = calloc(n + 1, sizeof *in);
  ambit_graph_leaves(k->graph, k->nresidual, k->residual, n, leaf);
  if (ambit_tape_seal(k->graph, arena, k->nresidual, k->residual, n, leaf, 0, 0, &tape, &f) != AMBIT_OK)
    complain(k, "%s", f.message);
  ambit_interval *slot = f.status == AMBIT_OK ? calloc(tape->nslot + 1, sizeof *slot) : NULL;
  for (int point = 0; slot && point < POINTS; point++) {
    for (size_t i = 0; i < n; i++) {
      const ambit_node *x = ambit_graph_node(k->graph, leaf[i]);
      ambit_interval range = x->op == AMBIT_LEAF_UNKNOWN ? x->value : (ambit_interval) { -1.5, 1.5 };
      double v = ambit_random_in(&k->random, range);
      in[i] = (ambit_interval) { v, v };
    }
    ambit_hull(tape, in, slot);
    for (size_t i = 0; i < k->nresidual; i++) {
      ambit_interval x = slot[tape->out[i]];
      k->report->compared++;
      if (!(x.lo <= 0 && x.hi >= 0 && x.hi - x.lo < TOLERANCE))
        complain(k, "%s is wrong: the difference is [%.3e, %.3e]%s", k->about[i], x.lo, x.hi,
            k->moving ? " (parameters move)" : "");
    }
  }
  free(slot);
  free(in);
  free(leaf);
  ambit_arena_close(arena);
}

static void run_stage(kit *k, unsigned given) {
  if (open_stage(k, given)) {
    check_declines(k);
    ask_whole(k, AMBIT_FIELD);
    ask_whole(k, AMBIT_ENERGY);
    for (uint32_t i = 0; i < k->element->nport; i++) {
      const ambit_port *p = &k->element->port[i];
      if (p->role == AMBIT_ROLE_OUT && p->kind == AMBIT_PORT_FRAME) check_frame(k, i);
      if (p->role == AMBIT_ROLE_OUT && p->kind == AMBIT_PORT_JOINT) check_joint(k, i);
      if (p->role == AMBIT_ROLE_IN && p->kind == AMBIT_PORT_JOINT) ask(k, k->mover[i], 0, AMBIT_EFFORT);
    }
    if (!drives(k->element)) check_power(k);
    evaluate(k);
  }
  close_stage(k);
}

element_kit_report element_kit_run(const ambit_element *element, const char *name, uint64_t seed) {
  element_kit_report report = { 0 };
  kit k = { .report = &report, .element = element, .name = name, .random = { seed } };
  unsigned optional = 0;
  size_t params = 0;
  for (const ambit_param *p = element->param; p && p->name; p++, params++) optional += p->fallback != NULL;
  if (element->nport > PORTS_MAX || params > PARAMS_MAX || optional > 8)
    complain(&k, "more ports or parameters than the kit can stage");
  else
    check_description(&k);
  for (unsigned given = 0; report.failures == 0 && given < 1u << optional; given++)
    for (int moving = 0; moving < 2; moving++) {
      k.moving = moving;
      run_stage(&k, given);
    }
  if (report.failures == 0 && report.expressed == 0) complain(&k, "it expresses nothing at all");
  return report;
}
