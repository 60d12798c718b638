/* build.c -- what an element sees of the kernel while it writes formulas (ambit_build), and the world. */
#include "base/meter.h"
#include "base/vector.h"
#include "graph/kink.h"
#include "mechanics/parts.h"
#include "num/decimal.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct build {
  ambit_build open; /* first: what the element holds is a pointer to this */
  ambit_mechanism *m;
  ambit_cell *cell;
} build;

static build *of(ambit_build *b) { return (build *)b; }
static const ambit_part *part_of(const build *s) { return &s->m->part[s->cell->part]; }

static ambit_status fail_text(build *s, ambit_status status, const char *text) {
  char who[AMBIT_WHO_MAX];
  if (s->m->deferred) return status; /* being broken off: nothing has failed */
  return ambit_fail(s->m->failure, status, "%s: %s", ambit_part_who(part_of(s), who), text);
}

static ambit_status fail(ambit_build *b, ambit_status status, const char *format, ...) {
  char text[AMBIT_MESSAGE_MAX];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return fail_text(of(b), status == AMBIT_OK ? AMBIT_BROKEN : status, text);
}

static ambit_expr refuse(build *s, ambit_status status, const char *text) {
  fail_text(s, status, text);
  return AMBIT_NO_EXPR;
}

static ambit_expr num(ambit_build *b, const char *decimal) {
  ambit_failure f = { 0 };
  ambit_expr e = ambit_graph_decimal(of(b)->m->graph, decimal, &f);
  return e == AMBIT_NO_EXPR ? refuse(of(b), f.status, f.message) : e;
}

static ambit_expr op(ambit_build *b, uint32_t opcode, ambit_expr x, ambit_expr y) {
  return ambit_graph_op(of(b)->m->graph, opcode, x, y);
}

static const ambit_expr *param(ambit_build *b, uint32_t index) {
  const ambit_part *p = part_of(of(b));
  if (index < p->nparam) return p->param[index];
  fail(b, AMBIT_BROKEN, "it asks for parameter %u of %zu", index, p->nparam);
  return NULL;
}

/* -- variables */

/* A failure of the mechanism's own already names the part; this one does not record anything while broken off. */
static void pass_on(build *s, const ambit_failure *f) {
  if (!s->m->deferred) ambit_fail(s->m->failure, f->status, "%s", f->message);
}

static ambit_expr state(ambit_build *b, uint32_t i, uint32_t order, const char *unit) {
  build *s = of(b);
  const ambit_part *p = part_of(s);
  ambit_failure f = { 0 };
  if (i >= p->ncoordinate || order > 2 || (order > 0 && !ambit_part_has_rates(p))) {
    fail(b, AMBIT_BROKEN, "it asks for coordinate %u, derivative %u; it has %u", i, order, p->ncoordinate);
    return AMBIT_NO_EXPR;
  }
  const ambit_coordinate *c = ambit_part_coordinate(s->m, s->cell->part, i, unit ? unit : p->unit, &f);
  if (c && order == 0) return c->q;
  const ambit_speed *u = c ? &s->m->speed[p->speed[i]] : NULL;
  if (u) return order == 1 ? u->u : u->du;
  pass_on(s, &f);
  return AMBIT_NO_EXPR;
}

static ambit_expr speed(ambit_build *b, uint32_t i, uint32_t order, const char *unit) {
  build *s = of(b);
  const ambit_part *p = part_of(s);
  ambit_failure f = { 0 };
  if (i >= p->dof || order < 1 || order > 2 || ambit_part_has_rates(p)) {
    fail(b, AMBIT_BROKEN, "it asks for speed %u, order %u; it has %u speeds of its own", i, order,
        ambit_part_has_rates(p) ? 0 : p->dof);
    return AMBIT_NO_EXPR;
  }
  const ambit_speed *u = ambit_part_speed(s->m, s->cell->part, i, unit, &f);
  if (u) return order == 1 ? u->u : u->du;
  pass_on(s, &f);
  return AMBIT_NO_EXPR;
}

static ambit_expr multiplier(ambit_build *b, uint32_t i, const char *unit) {
  build *s = of(b);
  ambit_failure f = { 0 };
  if (i >= part_of(s)->rows) {
    fail(b, AMBIT_BROKEN, "it asks for multiplier %u; it has %u", i, part_of(s)->rows);
    return AMBIT_NO_EXPR;
  }
  const ambit_multiplier *one = ambit_part_multiplier(s->m, s->cell->part, i, unit, &f);
  if (one) return one->lambda;
  pass_on(s, &f);
  return AMBIT_NO_EXPR;
}

/* -- pulling */

/* The cell of a quantity at a port of the element itself; NULL: the failure says why, or an optional port is not
** connected.
*/
static ambit_cell *reach(build *s, uint32_t port, uint32_t quantity) {
  ambit_mechanism *m = s->m;
  const ambit_part *p = part_of(s);
  if (port == AMBIT_NO_PORT) {
    ambit_cell *sum = ambit_mechanism_cell(m, quantity);
    if (sum) return sum;
  } else if (port < p->element->nport) {
    bool own = p->element->port[port].role == AMBIT_ROLE_OUT || quantity == AMBIT_WRENCH || quantity == AMBIT_EFFORT;
    ambit_joined to = p->joined[port];
    if (!own && to.part == UINT32_MAX) return NULL;
    ambit_cell *cell = own ? ambit_part_cell(p, port, quantity) : ambit_part_cell(&m->part[to.part], to.port, quantity);
    if (cell) return cell;
  }
  fail(&s->open, AMBIT_BROKEN, "it asks for the %s of port %u, which has none", ambit_quantity_name(quantity), port);
  return NULL;
}

static const ambit_expr *get(ambit_build *b, uint32_t port, uint32_t quantity) {
  build *s = of(b);
  ambit_cell *cell = reach(s, port, quantity);
  if (!cell) return NULL;
  const ambit_expr *value = ambit_pull_cell(s->m, cell, s->cell);
  if (!value && !s->m->deferred && cell->state == AMBIT_CELL_DECLINED)
    fail(b, AMBIT_INVALID, "it needs the %s of `%s`, which has none", ambit_quantity_name(quantity),
        s->m->part[cell->part].name);
  return value;
}

/* -- unknowns, time, ranges */

static ambit_expr unknown(ambit_build *b, const char *lo, const char *hi) {
  build *s = of(b);
  ambit_failure f = { 0 };
  ambit_interval l = AMBIT_EMPTY, h = AMBIT_EMPTY;
  if (ambit_decimal_read(lo, &l, NULL, &f) != AMBIT_OK || ambit_decimal_read(hi, &h, NULL, &f) != AMBIT_OK)
    return refuse(s, f.status, f.message);
  ambit_interval range = { l.lo, h.hi };
  if (!(l.lo <= h.hi) || !ambit_interval_is_bounded(range))
    return refuse(s, AMBIT_BROKEN, "it asks for an unknown in an empty or unbounded interval");
  char name[AMBIT_DATUM_NAME_MAX];
  ambit_part_unknown_name(&s->m->part[s->cell->part], name);
  return ambit_graph_datum(s->m->graph, name, NULL, range, ambit_interval_of(l.hi, h.lo));
}

/* q' of a coordinate of an element that has speeds of its own. */
static ambit_expr own_rate(build *s, const ambit_coordinate *c) {
  const ambit_part *p = &s->m->part[c->part];
  for (uint32_t port = 0, i = c->index; port < p->element->nport; port++) {
    const ambit_port *joint = &p->element->port[port];
    if (!ambit_port_has_coordinates(joint)) continue;
    if (i >= ambit_port_coordinates(joint)) {
      i -= ambit_port_coordinates(joint);
      continue;
    }
    const ambit_expr *rate = ambit_pull_cell(s->m, ambit_part_cell(p, port, AMBIT_COORDINATE_RATE), s->cell);
    return rate ? rate[i] : AMBIT_NO_EXPR;
  }
  return AMBIT_NO_EXPR;
}

/* What the leaf x becomes by d/dt: q -> q', u -> u'; AMBIT_NO_EXPR: a failure, or being broken off. */
static ambit_expr leaf_rate(build *s, ambit_expr x, ambit_failure *f) {
  for (size_t i = 0; i < s->m->ncoordinate; i++) {
    const ambit_coordinate *c = &s->m->coordinate[i];
    if (x == c->q) return c->rate != AMBIT_NO_EXPR ? c->rate : own_rate(s, c);
  }
  for (size_t i = 0; i < s->m->nspeed; i++) {
    const ambit_speed *u = &s->m->speed[i];
    if (x == u->u) return u->du;
    if (x != u->du) continue;
    ambit_fail(f, AMBIT_INVALID,
        "a given motion depends on the time derivative of `%s`: its own would need a further one", u->name);
    return AMBIT_NO_EXPR;
  }
  return 0; /* fixed; the graph itself knows the rate of TIME */
}

static ambit_expr diff_time(ambit_build *b, ambit_expr x) {
  build *s = of(b);
  ambit_graph *g = s->m->graph;
  if (x >= ambit_graph_count(g)) return AMBIT_NO_EXPR;
  ambit_failure f = { 0 };
  size_t all = ambit_graph_leaves(g, 1, &x, 0, NULL), n = 0;
  ambit_expr *leaf = malloc((2 * all + 1) * sizeof *leaf), *rate = leaf + all, e = AMBIT_NO_EXPR;
  if (!leaf) return refuse(s, AMBIT_NOMEM, "out of memory");
  ambit_graph_leaves(g, 1, &x, all, leaf);
  bool known = true;
  for (size_t i = 0; i < all && known; i++) {
    ambit_expr r = leaf_rate(s, leaf[i], &f);
    known = r != AMBIT_NO_EXPR;
    if (r == 0) continue;
    leaf[n] = leaf[i];
    rate[n++] = r;
  }
  if (known) e = ambit_graph_time_derivative(g, x, n, leaf, rate, &f);
  free(leaf);
  return f.status == AMBIT_OK ? e : refuse(s, f.status, f.message);
}

static ambit_expr partial_time(ambit_build *b, ambit_expr x) {
  build *s = of(b);
  ambit_failure f = { 0 };
  ambit_expr e = ambit_graph_time_derivative(s->m->graph, x, 0, NULL, NULL, &f);
  return f.status == AMBIT_OK ? e : refuse(s, f.status, f.message);
}

static void range(ambit_build *b, ambit_expr x, double *lo, double *hi) {
  const ambit_graph *g = of(b)->m->graph;
  ambit_interval r = x < ambit_graph_count(g) ? ambit_graph_node(g, x)->range : AMBIT_ENTIRE;
  *lo = r.lo;
  *hi = r.hi;
}

ambit_status ambit_build_express(ambit_mechanism *m, ambit_cell *cell, ambit_expr *out) {
  build s = { .open = { sizeof s.open, num, op, param, state, get, unknown, fail, diff_time, range, speed, multiplier,
                  partial_time },
    .m = m,
    .cell = cell };
  char who[AMBIT_WHO_MAX];
  const char *asker = ambit_graph_written_by(m->graph, ambit_part_who(part_of(&s), who));
  ambit_meter_enter(AMBIT_FRAME_ELEMENT, part_of(&s)->type);
  ambit_status status = part_of(&s)->element->express(&s.open, cell->port, cell->quantity, out);
  ambit_meter_leave();
  ambit_graph_written_by(m->graph, asker);
  return status;
}

ambit_status ambit_build_check(ambit_mechanism *m, uint32_t part, ambit_failure *f) {
  ambit_cell cell = { .part = part, .port = AMBIT_NO_PORT };
  ambit_failure own = { 0 };
  build s = { .open = { .size = sizeof s.open,
                  .num = num,
                  .op = op,
                  .param = param,
                  .fail = fail,
                  .diff_time = diff_time,
                  .range = range,
                  .partial_time = partial_time },
    .m = m,
    .cell = &cell };
  if (!part_of(&s)->element->check) return AMBIT_OK;
  m->failure = &own;
  ambit_status status = part_of(&s)->element->check(&s.open);
  m->failure = NULL;
  if (own.status != AMBIT_OK) return ambit_fail(f, own.status, "%s", own.message);
  if (status == AMBIT_OK) return AMBIT_OK;
  char who[AMBIT_WHO_MAX];
  return ambit_fail(f, status, "%s: its data are refused", ambit_part_who(part_of(&s), who));
}

/* -- the world */

/* At rest, where the world's axes are; gravity is a proper acceleration upwards. */
static ambit_status express_world(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (port != 0 || quantity > AMBIT_ACCEL) return AMBIT_UNABLE;
  const ambit_expr *field = quantity == AMBIT_ACCEL ? b->get(b, AMBIT_NO_PORT, AMBIT_FIELD) : NULL;
  if (quantity == AMBIT_ACCEL && !field) return AMBIT_INVALID;
  memset(out, 0, (quantity == AMBIT_POSE ? 12 : 6) * sizeof *out);
  for (int i = 0; i < 3 && quantity == AMBIT_POSE; i++) out[4 * i] = b->num(b, "1");
  for (int i = 0; i < 3 && field; i++) out[3 + i] = b->op(b, AMBIT_OP_NEG, field[i], 0);
  return AMBIT_OK;
}

static const ambit_port world_port[] = { { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the world's own frame" } };
const ambit_element ambit_world_element = {
  .size = sizeof ambit_world_element, .nport = 1, .port = world_port, .express = express_world
};
