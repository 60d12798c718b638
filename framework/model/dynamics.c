/* dynamics.c -- equations of motion: M(q) q'' = h(q, q', t), M = U D U^T inside the graph, and the first-order
** system.
**
** Principle of virtual power: the balance of joint i, r_i(q, q', q''), is the power of all wrenches and efforts along
** q_i' per unit rate, and vanishes. It is affine in q'': M = -dr/dq'', h = r at q'' = 0. A joint whose given motion
** is a function s(q) of the coordinates (a gear) does no work of its own, so its balance enters as r_i + r_s ds/dq_i.
** M is symmetric, and positive definite for physical masses.
**
** M = U D U^T with unit upper triangular U, from the last coordinate (the tip) to the first, without pivoting: the
** order in which an open chain fills in least and in which the pivots are the masses felt at each joint (Featherstone
** 2008, ch. 6 and 7).
*/
#include "model/dynamics.h"
#include "model/pivot.h"
#include <stdio.h>
#include <string.h>

#define SIMPLIFY_TERMS 64u

typedef struct equations {
  ambit_mechanism *m;
  ambit_graph *g;
  ambit_arena *arena;
  ambit_failure *f;
  size_t n;
  ambit_coordinate *coordinate;    /* [n] */
  ambit_speed *speed;              /* [n] */
  ambit_expr *q, *qd, *qdd, *zero; /* [n] */
  ambit_expr *balance;             /* [n] r */
} equations;

static ambit_status no_memory(ambit_failure *f) { return ambit_fail(f, AMBIT_NOMEM, "out of memory"); }

static ambit_expr *expressions(ambit_arena *arena, size_t n) {
  return ambit_arena_alloc(arena, (n + 1) * sizeof(ambit_expr));
}

/* Calls `visit` for every joint that an element makes. */
static ambit_status each_joint(equations *s, ambit_status (*visit)(equations *s, ambit_frame joint, uint32_t dof)) {
  ambit_status status = AMBIT_OK;
  for (uint32_t part = 0; part < ambit_mechanism_count(s->m); part++) {
    const ambit_element *e = ambit_mechanism_part_element(s->m, part);
    for (uint32_t i = 0; status == AMBIT_OK && i < e->nport; i++)
      if (e->port[i].kind == AMBIT_PORT_JOINT && e->port[i].role == AMBIT_ROLE_OUT)
        status = visit(s, (ambit_frame) { part, i }, e->port[i].dof);
  }
  return status;
}

static ambit_status need_coordinate(equations *s, ambit_frame joint, uint32_t dof) {
  (void)dof;
  return ambit_mechanism_pull(s->m, joint, AMBIT_COORDINATE, s->f) ? AMBIT_OK : AMBIT_INVALID;
}

static ambit_status read_coordinates(equations *s) {
  if (each_joint(s, need_coordinate) != AMBIT_OK) return AMBIT_INVALID;
  s->n = ambit_mechanism_coordinates(s->m, 0, NULL);
  if (s->n == 0)
    return ambit_fail(s->f, AMBIT_INVALID,
        "the mechanism has no coordinates, so nothing moves by itself: leave the angle or displacement of a joint "
        "open");
  s->coordinate = ambit_arena_alloc(s->arena, s->n * sizeof *s->coordinate);
  s->speed = ambit_arena_alloc(s->arena, s->n * sizeof *s->speed);
  s->q = expressions(s->arena, s->n);
  s->qd = expressions(s->arena, s->n);
  s->qdd = expressions(s->arena, s->n);
  s->zero = expressions(s->arena, s->n);
  s->balance = expressions(s->arena, s->n);
  if (!s->coordinate || !s->speed || !s->q || !s->qd || !s->qdd || !s->zero || !s->balance) return no_memory(s->f);
  ambit_mechanism_coordinates(s->m, s->n, s->coordinate);
  ambit_mechanism_speeds(s->m, s->n, s->speed);
  for (size_t i = 0; i < s->n; i++) {
    s->q[i] = s->coordinate[i].q;
    s->qd[i] = s->speed[i].u;
    s->qdd[i] = s->speed[i].du;
  }
  return AMBIT_OK;
}

/* -- balances */

static size_t find(const ambit_expr *list, size_t n, ambit_expr e) {
  size_t i = 0;
  while (i < n && list[i] != e) i++;
  return i;
}

/* r_i += balance * ds/dq_i for a joint that follows coordinates; nothing for one that does not. */
static ambit_status add_follower(equations *s, ambit_frame joint, uint32_t k, ambit_expr coordinate) {
  for (size_t i = 0; i < s->n; i++) {
    ambit_expr slope = ambit_graph_derivative(s->g, coordinate, s->q[i], s->f);
    if (slope == AMBIT_NO_EXPR) return AMBIT_INVALID;
    if (slope == 0) continue;
    const ambit_expr *r = ambit_mechanism_pull(s->m, joint, AMBIT_BALANCE, s->f);
    if (!r) return AMBIT_INVALID;
    ambit_expr share = ambit_graph_op(s->g, AMBIT_OP_MUL, r[k], slope);
    s->balance[i] = ambit_graph_op(s->g, AMBIT_OP_ADD, s->balance[i], share);
  }
  return AMBIT_OK;
}

static ambit_status add_joint(equations *s, ambit_frame joint, uint32_t dof) {
  const ambit_expr *coordinate = ambit_mechanism_pull(s->m, joint, AMBIT_COORDINATE, s->f);
  if (!coordinate) return AMBIT_INVALID;
  for (uint32_t k = 0; k < dof; k++) {
    size_t i = find(s->q, s->n, coordinate[k]);
    ambit_status status = AMBIT_OK;
    if (i < s->n && s->coordinate[i].part == joint.part) {
      const ambit_expr *r = ambit_mechanism_pull(s->m, joint, AMBIT_BALANCE, s->f);
      if (!r) return AMBIT_INVALID;
      s->balance[i] = ambit_graph_op(s->g, AMBIT_OP_ADD, s->balance[i], r[k]);
    } else if (!ambit_graph_node(s->g, coordinate[k])->constant)
      status = add_follower(s, joint, k, coordinate[k]);
    if (status != AMBIT_OK) return status;
  }
  return AMBIT_OK;
}

/* -- M and h */

static ambit_expr simplify(const equations *s, ambit_expr e) { return ambit_graph_simplify(s->g, e, SIMPLIFY_TERMS); }

/* Is the equation linear in q''? Then M is free of it. */
static ambit_status check_affine(const equations *s, ambit_expr entry, size_t i) {
  for (size_t k = 0; k < s->n; k++) {
    ambit_expr second = ambit_graph_derivative(s->g, entry, s->qdd[k], s->f);
    if (second == AMBIT_NO_EXPR) return AMBIT_INVALID;
    if (second != 0)
      return ambit_fail(s->f, AMBIT_INVALID, "the forces on joint `%s` are not linear in the acceleration of `%s`",
          s->coordinate[i].name, s->coordinate[k].name);
  }
  return AMBIT_OK;
}

static ambit_status build_mass(const equations *s, ambit_expr *mass) {
  size_t n = s->n;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i; j < n; j++) { /* symmetric */
      ambit_expr d = ambit_graph_derivative(s->g, s->balance[i], s->qdd[j], s->f);
      if (d == AMBIT_NO_EXPR) return AMBIT_INVALID;
      d = simplify(s, ambit_graph_op(s->g, AMBIT_OP_NEG, d, d));
      ambit_status status = check_affine(s, d, i);
      if (status != AMBIT_OK) return status;
      mass[i * n + j] = mass[j * n + i] = d;
    }
  for (size_t i = 0; i < n; i++) {
    size_t j = 0;
    while (j < n && mass[i * n + j] == 0) j++;
    if (j == n)
      return ambit_fail(s->f, AMBIT_INVALID,
          "joint `%s` moves no mass: attach a rigid_body or point_mass to what it carries", s->coordinate[i].name);
  }
  return AMBIT_OK;
}

/* h as what it is at rest (weights, springs) plus what the rates add (Coriolis forces, dampers), each simplified
** apart: their common factors differ. A second pass collects what the first has made equal. Whichever is shorter,
** that or h as a whole; h as a whole where it is not defined at rest.
*/
static ambit_expr shorter_force(const equations *s, ambit_expr h, ambit_expr at_rest) {
  ambit_expr whole = simplify(s, h);
  if (!ambit_graph_node(s->g, at_rest)->total) return whole;
  ambit_expr rates = simplify(s, simplify(s, ambit_graph_op(s->g, AMBIT_OP_SUB, h, at_rest)));
  ambit_expr parts = ambit_graph_op(s->g, AMBIT_OP_ADD, rates, simplify(s, simplify(s, at_rest)));
  if (parts == AMBIT_NO_EXPR) return whole;
  return ambit_graph_size(s->g, 1, &parts) < ambit_graph_size(s->g, 1, &whole) ? parts : whole;
}

static ambit_status build_force(const equations *s, ambit_expr *force) {
  ambit_expr *at_rest = expressions(s->arena, s->n);
  if (!at_rest) return no_memory(s->f);
  memcpy(force, s->balance, s->n * sizeof *force);
  ambit_status status = ambit_graph_substitute(s->g, s->n, force, s->n, s->qdd, s->zero, s->f);
  memcpy(at_rest, force, s->n * sizeof *force);
  if (status == AMBIT_OK) status = ambit_graph_substitute(s->g, s->n, at_rest, s->n, s->qd, s->zero, s->f);
  for (size_t i = 0; status == AMBIT_OK && i < s->n; i++) force[i] = shorter_force(s, force[i], at_rest[i]);
  return status;
}

ambit_status ambit_motion_build(ambit_mechanism *m, ambit_arena *arena, ambit_motion *motion, ambit_failure *f) {
  equations s = { .m = m, .g = ambit_mechanism_graph(m), .arena = arena, .f = f };
  ambit_status status = read_coordinates(&s);
  if (status == AMBIT_OK) status = each_joint(&s, add_joint);
  if (status != AMBIT_OK) return status;
  for (size_t i = 0; i < s.n; i++)
    if (s.balance[i] == AMBIT_NO_EXPR) return no_memory(f);
  ambit_expr *mass = expressions(arena, s.n * s.n), *force = expressions(arena, s.n);
  if (!mass || !force) return no_memory(f);
  status = build_mass(&s, mass);
  if (status == AMBIT_OK) status = build_force(&s, force);
  *motion = (ambit_motion) { s.n, s.coordinate, mass, force };
  return status;
}

/* -- M = U D U^T, and the solution */

typedef struct factors {
  ambit_graph *g;
  size_t n;
  ambit_expr *u; /* [n*n] upper triangle: what is left of M, then U; on the diagonal D */
} factors;

static ambit_expr op(const factors *s, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(s->g, code, a, b);
}

/* a - b c, where b or c may be a structural zero */
static ambit_expr reduce(const factors *s, ambit_expr a, ambit_expr b, ambit_expr c) {
  if (b == 0 || c == 0) return a;
  return op(s, AMBIT_OP_SUB, a, op(s, AMBIT_OP_MUL, b, c));
}

static ambit_status check_pivot(const factors *s, const ambit_motion *motion, size_t k, ambit_failure *f) {
  ambit_expr pivot = s->u[k * s->n + k];
  const char *name = motion->coordinate[k].name;
  if (pivot == AMBIT_NO_EXPR) return no_memory(f);
  ambit_interval range = ambit_graph_node(s->g, pivot)->range;
  if (range.hi < 0)
    return ambit_fail(f, AMBIT_INVALID, "the mass matrix is not positive: joint `%s` moves a negative mass", name);
  if (range.lo > 0 || !ambit_pivot_vanishes(s->g, pivot)) return AMBIT_OK;
  return ambit_fail(
      f, AMBIT_INVALID, "the mass matrix is singular in every position: joint `%s` moves no mass of its own", name);
}

static ambit_status factorise(const factors *s, const ambit_motion *motion, ambit_failure *f) {
  size_t n = s->n;
  for (size_t k = n; k-- > 0;) {
    ambit_status status = check_pivot(s, motion, k, f);
    if (status != AMBIT_OK) return status;
    for (size_t i = 0; i < k; i++) {
      ambit_expr left = s->u[i * n + k];
      if (left == 0) continue;
      ambit_expr unit = op(s, AMBIT_OP_DIV, left, s->u[k * n + k]);
      for (size_t j = 0; j <= i; j++) {
        ambit_expr reduced = reduce(s, s->u[j * n + i], unit, s->u[j * n + k]);
        if (reduced != s->u[j * n + i]) s->u[j * n + i] = ambit_graph_simplify(s->g, reduced, SIMPLIFY_TERMS);
      }
    }
    for (size_t i = 0; i < k; i++)
      if (s->u[i * n + k]) s->u[i * n + k] = op(s, AMBIT_OP_DIV, s->u[i * n + k], s->u[k * n + k]);
  }
  return AMBIT_OK;
}

/* x := h; U y = x from the tip; x = D^-1 y; U^T x = x from the base. */
static void solve(const factors *s, ambit_expr *x) {
  size_t n = s->n;
  for (size_t k = n; k-- > 0;) {
    ambit_expr given = x[k];
    for (size_t i = k + 1; i < n; i++) x[k] = reduce(s, x[k], s->u[k * n + i], x[i]);
    if (x[k] != given) x[k] = ambit_graph_simplify(s->g, x[k], SIMPLIFY_TERMS);
  }
  for (size_t k = 0; k < n; k++) {
    x[k] = op(s, AMBIT_OP_DIV, x[k], s->u[k * n + k]);
    for (size_t i = 0; i < k; i++) x[k] = reduce(s, x[k], s->u[i * n + k], x[i]);
  }
}

ambit_status ambit_motion_accelerations(ambit_graph *g, const ambit_motion *motion, ambit_expr *qdd, ambit_failure *f) {
  size_t n = motion->n;
  ambit_arena *arena = ambit_arena_open();
  factors s = { g, n, arena ? expressions(arena, n * n) : NULL };
  ambit_status status = s.u ? AMBIT_OK : no_memory(f);
  if (status == AMBIT_OK) {
    memcpy(s.u, motion->mass, n * n * sizeof *s.u);
    memcpy(qdd, motion->force, n * sizeof *qdd);
    status = factorise(&s, motion, f);
  }
  if (status == AMBIT_OK) solve(&s, qdd);
  for (size_t i = 0; status == AMBIT_OK && i < n; i++)
    if (qdd[i] == AMBIT_NO_EXPR) status = no_memory(f);
  ambit_arena_close(arena);
  return status;
}

/* -- the system */

static const char *joined(ambit_arena *arena, const char *a, const char *b) {
  char text[256];
  snprintf(text, sizeof text, "%s%s", a, b);
  return ambit_arena_text(arena, text);
}

ambit_status ambit_dynamics_system(ambit_mechanism *m, ambit_arena *arena, ambit_system *system, ambit_failure *f) {
  ambit_motion motion = { 0 };
  ambit_status status = ambit_motion_build(m, arena, &motion, f);
  if (status != AMBIT_OK) return status;
  size_t n = motion.n;
  const char **name = ambit_arena_alloc(arena, 2 * n * sizeof *name),
             **unit = ambit_arena_alloc(arena, 2 * n * sizeof *unit);
  ambit_expr *state = expressions(arena, 2 * n), *rate = expressions(arena, 2 * n);
  if (!name || !unit || !state || !rate) return no_memory(f);
  status = ambit_motion_accelerations(ambit_mechanism_graph(m), &motion, rate + n, f);
  for (size_t i = 0; i < n; i++) {
    const ambit_coordinate *c = &motion.coordinate[i];
    state[i] = c->q;
    state[n + i] = rate[i] = c->rate;
    name[i] = joined(arena, c->name, "");
    name[n + i] = joined(arena, c->name, "'");
    unit[i] = joined(arena, c->unit, "");
    unit[n + i] = joined(arena, c->unit, "/s");
    if (!name[i] || !name[n + i] || !unit[i] || !unit[n + i]) return no_memory(f);
  }
  *system = (ambit_system) {
    .graph = ambit_mechanism_graph(m), .nx = 2 * n, .name = name, .unit = unit, .state = state, .rate = rate
  };
  return status;
}
