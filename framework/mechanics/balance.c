/* balance.c -- which variables there are, and one balance for each speed.
**
** Principle of virtual power: the balance of a joint is the power of all wrenches and efforts along one of its speeds
** u_i per unit of it, and vanishes. A joint whose given motion is a function s(q) of the coordinates (a gear) does no
** work of its own: with ds/dt = sum a_i(q) u_i + b its balance r_s enters as r_i + a_i r_s (Kecskemethy & Hiller 1994).
*/
#include "mechanics/balance.h"
#include "mechanics/parts.h"
#include <stdlib.h>

ambit_status ambit_joints_visit(ambit_mechanism *m, ambit_joint_visit visit, void *user) {
  ambit_status status = AMBIT_OK;
  for (uint32_t part = 0; part < ambit_mechanism_count(m); part++) {
    const ambit_element *e = ambit_mechanism_part_element(m, part);
    uint32_t first = 0;
    for (uint32_t i = 0; status == AMBIT_OK && i < e->nport; i++) {
      if (e->port[i].kind != AMBIT_PORT_JOINT || e->port[i].role != AMBIT_ROLE_OUT) continue;
      status = visit(user, (ambit_frame) { part, i }, first, ambit_port_dof(&e->port[i]));
      first += ambit_port_dof(&e->port[i]);
    }
  }
  return status;
}

/* -- variables */

typedef struct reader {
  ambit_mechanism *m;
  ambit_failure *f;
} reader;

/* The lists of coordinates and speeds leave out what fails; this says why. */
static ambit_status need_variables(void *user, ambit_frame joint, uint32_t first, uint32_t dof) {
  reader *r = user;
  (void)first;
  if (!ambit_mechanism_pull(r->m, joint, AMBIT_COORDINATE, r->f)) return AMBIT_INVALID;
  const ambit_port *port = &ambit_mechanism_part_element(r->m, joint.part)->port[joint.port];
  if (ambit_port_coordinates(port) == dof) return AMBIT_OK;
  return ambit_mechanism_pull(r->m, joint, AMBIT_COORDINATE_RATE, r->f) ? AMBIT_OK : AMBIT_INVALID;
}

/* A speed on whose time derivative e[ne] depends; NULL: none. */
static const ambit_speed *accelerated(const ambit_mechanism *m, size_t ne, const ambit_expr *e) {
  const ambit_speed *found = NULL;
  size_t n = ambit_graph_leaves(m->graph, ne, e, 0, NULL);
  ambit_expr *leaf = malloc((n + 1) * sizeof *leaf);
  if (leaf) ambit_graph_leaves(m->graph, ne, e, n, leaf);
  for (size_t k = 0; leaf && k < n; k++)
    for (size_t i = 0; i < m->nspeed; i++)
      if (m->speed[i].du == leaf[k]) found = &m->speed[i];
  free(leaf);
  return found;
}

/* The variables and rates of elements' own states. An acceleration would have to be known before it is solved for. */
static ambit_status need_states(reader *r, uint32_t part, uint32_t port) {
  const ambit_part *p = &r->m->part[part];
  ambit_frame at = { part, port };
  char who[AMBIT_WHO_MAX];
  if (!ambit_mechanism_pull(r->m, at, AMBIT_COORDINATE, r->f)) return AMBIT_INVALID;
  const ambit_expr *rate = ambit_mechanism_pull(r->m, at, AMBIT_COORDINATE_RATE, r->f);
  if (!rate) return AMBIT_INVALID;
  const ambit_speed *speed = accelerated(r->m, ambit_port_dof(&p->element->port[port]), rate);
  if (!speed) return AMBIT_OK;
  return ambit_fail(r->f, AMBIT_INVALID,
      "%s: its rate depends on the acceleration of `%.*s`: expected coordinates, speeds, states and time",
      ambit_part_who(p, who), AMBIT_JOINT_NAME(speed));
}

static ambit_status visit_states(reader *r) {
  for (uint32_t part = 0; part < ambit_mechanism_count(r->m); part++) {
    const ambit_element *e = ambit_mechanism_part_element(r->m, part);
    for (uint32_t i = 0; i < e->nport; i++)
      if (e->port[i].kind == AMBIT_PORT_STATE && need_states(r, part, i) != AMBIT_OK) return AMBIT_INVALID;
  }
  return AMBIT_OK;
}

ambit_status ambit_variables_read(ambit_mechanism *m, ambit_arena *arena, ambit_variables *v, ambit_failure *f) {
  reader r = { m, f };
  if (ambit_joints_visit(m, need_variables, &r) != AMBIT_OK || visit_states(&r) != AMBIT_OK) return AMBIT_INVALID;
  size_t nc = ambit_mechanism_coordinates(m, 0, NULL), n = ambit_mechanism_speeds(m, 0, NULL);
  if (nc == 0)
    return ambit_fail(f, AMBIT_INVALID,
        "the mechanism has no coordinates, so nothing moves by itself: leave the angle or displacement of a joint "
        "open");
  ambit_coordinate *coordinate = ambit_arena_alloc(arena, (nc + 1) * sizeof *coordinate);
  ambit_speed *speed = ambit_arena_alloc(arena, n * sizeof *speed);
  ambit_expr *u = ambit_expressions(arena, n), *du = ambit_expressions(arena, n), *zero = ambit_expressions(arena, n);
  if (!coordinate || !speed || !u || !du || !zero) return ambit_no_memory(f);
  ambit_mechanism_coordinates(m, nc, coordinate);
  ambit_mechanism_speeds(m, n, speed);
  for (size_t i = 0; i < n; i++) u[i] = speed[i].u, du[i] = speed[i].du;
  *v = (ambit_variables) { nc, n, coordinate, speed, u, du, zero };
  return AMBIT_OK;
}

size_t ambit_variables_find(const ambit_variables *v, uint32_t part, uint32_t index) {
  size_t lo = 0, hi = v->n; /* in the order of the parts */
  while (lo < hi) {
    size_t mid = lo + (hi - lo) / 2;
    const ambit_speed *s = &v->speed[mid];
    if (s->part < part || (s->part == part && s->index < index))
      lo = mid + 1;
    else
      hi = mid;
  }
  bool found = lo < v->n && v->speed[lo].part == part && v->speed[lo].index == index;
  return found ? lo : v->n;
}

/* -- balances */

typedef struct collector {
  ambit_mechanism *m;
  ambit_graph *g;
  const ambit_variables *v;
  ambit_failure *f;
  ambit_expr *balance; /* [n] */
} collector;

static ambit_status add(collector *c, size_t i, ambit_expr share) {
  c->balance[i] = ambit_graph_op(c->g, AMBIT_OP_ADD, c->balance[i], share);
  return c->balance[i] == AMBIT_NO_EXPR ? ambit_no_memory(c->f) : AMBIT_OK;
}

/* INVALID: this given motion of a joint moves with a state. What the state's equation takes from the mechanism would be
** done without a force.
*/
static ambit_status refuse_states(const collector *c, ambit_frame joint, ambit_expr motion) {
  size_t n = ambit_graph_leaves(c->g, 1, &motion, 0, NULL);
  ambit_expr *leaf = malloc((n + 1) * sizeof *leaf);
  ambit_status status = leaf ? AMBIT_OK : ambit_no_memory(c->f);
  if (leaf) ambit_graph_leaves(c->g, 1, &motion, n, leaf);
  for (size_t k = 0; status == AMBIT_OK && k < n; k++)
    for (size_t i = 0; status == AMBIT_OK && i < c->m->ncoordinate; i++) {
      const ambit_coordinate *x = &c->m->coordinate[i];
      char who[AMBIT_WHO_MAX];
      if (x->own && x->q == leaf[k])
        status = ambit_fail(c->f, AMBIT_INVALID,
            "%s: its given motion depends on the state `%s`, whose rate depends on the motion of the mechanism: leave "
            "the joint open and let a spring pull it to where the state wants it",
            ambit_part_who(&c->m->part[joint.part], who), x->name);
    }
  free(leaf);
  return status;
}

/* r_i += r_s d(ds/dt)/du_i for row k of a joint that follows others; nothing for one whose motion is known in time. */
static ambit_status add_follower(collector *c, ambit_frame joint, uint32_t k, ambit_expr coordinate) {
  const ambit_expr *rates = ambit_mechanism_pull(c->m, joint, AMBIT_RATE, c->f);
  if (!rates) return AMBIT_INVALID;
  size_t all = ambit_graph_leaves(c->g, 1, &rates[k], 0, NULL);
  ambit_expr *leaf = malloc((all + 1) * sizeof *leaf);
  ambit_status status = leaf ? AMBIT_OK : ambit_no_memory(c->f);
  if (leaf) ambit_graph_leaves(c->g, 1, &rates[k], all, leaf);
  for (size_t j = 0; status == AMBIT_OK && j < all; j++) {
    size_t i = 0;
    while (i < c->v->n && c->v->u[i] != leaf[j]) i++;
    if (i == c->v->n) continue;
    status = refuse_states(c, joint, coordinate);
    if (status != AMBIT_OK) break;
    ambit_expr slope = ambit_graph_derivative(c->g, rates[k], leaf[j], c->f);
    const ambit_expr *r = slope == AMBIT_NO_EXPR ? NULL : ambit_mechanism_pull(c->m, joint, AMBIT_BALANCE, c->f);
    status = r ? add(c, i, ambit_graph_op(c->g, AMBIT_OP_MUL, r[k], slope)) : AMBIT_INVALID;
  }
  free(leaf);
  return status;
}

static ambit_status add_joint(void *user, ambit_frame joint, uint32_t first, uint32_t dof) {
  collector *c = user;
  const ambit_port *port = &ambit_mechanism_part_element(c->m, joint.part)->port[joint.port];
  const ambit_expr *coordinate = ambit_mechanism_pull(c->m, joint, AMBIT_COORDINATE, c->f);
  ambit_status status = coordinate ? AMBIT_OK : AMBIT_INVALID;
  for (uint32_t k = 0; status == AMBIT_OK && k < dof; k++) {
    size_t i = ambit_variables_find(c->v, joint.part, first + k);
    if (i < c->v->n) {
      const ambit_expr *r = ambit_mechanism_pull(c->m, joint, AMBIT_BALANCE, c->f);
      status = r ? add(c, i, r[k]) : AMBIT_INVALID;
    } else if (ambit_port_coordinates(port) == dof && !ambit_graph_node(c->g, coordinate[k])->constant)
      status = add_follower(c, joint, k, coordinate[k]);
  }
  return status;
}

ambit_status ambit_balances_pull(ambit_mechanism *m, const ambit_variables *v, ambit_expr *balance, ambit_failure *f) {
  collector c = { m, ambit_mechanism_graph(m), v, f, balance };
  for (size_t i = 0; i < v->n; i++) balance[i] = 0; /* the constant 0 */
  return ambit_joints_visit(m, add_joint, &c);
}

uint32_t ambit_laws_find(const ambit_mechanism *m, ambit_affine *affine) {
  for (uint32_t part = 0; part < m->count; part++) {
    const ambit_part *p = &m->part[part];
    for (size_t i = 0; i < p->nparam; i++)
      if (p->param[i] && ambit_affine_varies(affine, ambit_part_components(p, i), p->param[i])) return part;
  }
  return (uint32_t)m->count;
}
