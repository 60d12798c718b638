/* dynamics.c -- equations of motion M(q) u' = h(q, u, t), shortened entry by entry, and the first-order system.
**
** Balances r (balance.h) are affine in u': M = -dr/du', h = r at u' = 0. M is symmetric, and positive definite for
** physical masses.
*/
#include "mechanics/balance.h"
#include "mechanics/constraints.h"
#include "mechanics/affine_in.h"
#include "mechanics/factor.h"
#include "mechanics/pivot.h"
#include <string.h>

#define SIMPLIFY_SPEEDS 32u /* n^2 entries, each of order n: beyond, shortening them takes longer than it saves */
#define SIMPLIFY_TERMS 64u
#define SIMPLIFY_JOINTS 4u /* above, shortening the elimination takes longer and gains less than 2 % */

typedef struct equations {
  ambit_graph *g;
  ambit_arena *arena;
  ambit_failure *f;
  ambit_variables v;
  size_t n;
  ambit_expr *balance; /* [n] r */
} equations;

/* -- M and h */

static ambit_expr simplify(const equations *s, ambit_expr e) { return ambit_graph_simplify(s->g, e, SIMPLIFY_TERMS); }

/* Which equation is not linear in which u'? */
static ambit_status name_nonlinear(const equations *s) {
  for (size_t i = 0; i < s->n; i++)
    for (size_t j = 0; j < s->n; j++) {
      ambit_expr d = ambit_graph_derivative(s->g, s->balance[i], s->v.du[j], s->f);
      for (size_t k = 0; k < s->n && d != 0; k++) {
        ambit_expr second = d == AMBIT_NO_EXPR ? d : ambit_graph_derivative(s->g, d, s->v.du[k], s->f);
        if (second == AMBIT_NO_EXPR) return AMBIT_INVALID;
        if (second == 0) continue;
        return ambit_fail(s->f, AMBIT_INVALID,
            "the forces on joint `%.*s` are not linear in the acceleration of `%.*s`", AMBIT_JOINT_NAME(&s->v.speed[i]),
            AMBIT_JOINT_NAME(&s->v.speed[k]));
      }
    }
  return ambit_fail(s->f, AMBIT_INVALID, "the forces on the joints are not linear in their accelerations");
}

/* Laws of force that depend on accelerations may be anything; only if they act like inertias is M symmetric. */
static ambit_status check_symmetry(const equations *s, const ambit_expr *slope) {
  size_t n = s->n, count = 0;
  ambit_expr *gap = ambit_expressions(s->arena, n * n);
  if (!gap) return ambit_no_memory(s->f);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++)
      gap[count++] = ambit_graph_op(s->g, AMBIT_OP_SUB, slope[i * n + j], slope[j * n + i]);
  size_t first = ambit_pivot_first_nonzero(s->g, count, gap), i = 1;
  if (first == count) return AMBIT_OK;
  for (; first >= i; i++) first -= i;
  return ambit_fail(s->f, AMBIT_INVALID,
      "the acceleration of joint `%.*s` does not act on `%.*s` as that of `%.*s` on it: a law of force may depend on "
      "accelerations only like an inertia",
      AMBIT_JOINT_NAME(&s->v.speed[first]), AMBIT_JOINT_NAME(&s->v.speed[i]), AMBIT_JOINT_NAME(&s->v.speed[i]));
}

/* slope [n*n] := dr/du' */
static ambit_status read_slopes(ambit_mechanism *m, const equations *s, ambit_expr *slope) {
  ambit_expr *rest = ambit_expressions(s->arena, s->n);
  ambit_affine *affine = ambit_affine_open(s->g, s->n, s->v.du);
  ambit_status status =
      rest && affine ? ambit_affine_in(affine, s->n, s->balance, s->n, s->v.du, slope, rest) : AMBIT_NOMEM;
  bool laws = status == AMBIT_OK && ambit_laws_find(m, affine) < ambit_mechanism_count(m);
  ambit_affine_close(affine);
  if (status == AMBIT_NOMEM) return ambit_no_memory(s->f);
  if (status != AMBIT_OK) return name_nonlinear(s);
  return laws ? check_symmetry(s, slope) : AMBIT_OK;
}

static ambit_status build_mass(ambit_mechanism *m, const equations *s, ambit_expr *mass) {
  size_t n = s->n;
  ambit_status status = read_slopes(m, s, mass);
  if (status != AMBIT_OK) return status;
  for (size_t i = 0; i < n; i++)
    for (size_t j = i; j < n; j++) { /* symmetric */
      ambit_expr d = ambit_graph_op(s->g, AMBIT_OP_NEG, mass[i * n + j], 0);
      mass[i * n + j] = mass[j * n + i] = n <= SIMPLIFY_SPEEDS ? simplify(s, d) : d;
    }
  return AMBIT_OK;
}

/* Every speed of an open chain moves some mass. */
static ambit_status check_loads(const equations *s, const ambit_expr *mass) {
  for (size_t i = 0; i < s->n; i++) {
    size_t j = 0;
    while (j < s->n && mass[i * s->n + j] == 0) j++;
    if (j == s->n) return ambit_pivot_massless(&s->v.speed[i], s->f);
  }
  return AMBIT_OK;
}

/* h as what it is at rest (weights, springs) plus what the speeds add (Coriolis forces, dampers), each simplified
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

/* Shortening entry by entry costs what the entries share; the list with fewer operations is kept. */
static ambit_status build_force(const equations *s, ambit_expr *force) {
  ambit_expr *at_rest = ambit_expressions(s->arena, s->n), *apart = ambit_expressions(s->arena, s->n);
  if (!at_rest || !apart) return ambit_no_memory(s->f);
  memcpy(force, s->balance, s->n * sizeof *force);
  ambit_status status = ambit_graph_substitute(s->g, s->n, force, s->n, s->v.du, s->v.zero, s->f);
  memcpy(at_rest, force, s->n * sizeof *force);
  if (status == AMBIT_OK) status = ambit_graph_substitute(s->g, s->n, at_rest, s->n, s->v.u, s->v.zero, s->f);
  for (size_t i = 0; status == AMBIT_OK && i < s->n; i++) apart[i] = shorter_force(s, force[i], at_rest[i]);
  if (status == AMBIT_OK && ambit_graph_size(s->g, s->n, apart) <= ambit_graph_size(s->g, s->n, force))
    memcpy(force, apart, s->n * sizeof *force);
  return status;
}

static ambit_status pull_equations(ambit_mechanism *m, equations *s) {
  ambit_status status = ambit_variables_read(m, s->arena, &s->v, s->f);
  if (status != AMBIT_OK) return status;
  s->n = s->v.n;
  s->balance = ambit_expressions(s->arena, s->n);
  return s->balance ? ambit_balances_pull(m, &s->v, s->balance, s->f) : ambit_no_memory(s->f);
}

ambit_status ambit_motion_build(ambit_mechanism *m, ambit_arena *arena, ambit_motion *motion, ambit_failure *f) {
  equations s = { .g = ambit_mechanism_graph(m), .arena = arena, .f = f };
  ambit_status status = pull_equations(m, &s);
  if (status != AMBIT_OK) return status;
  ambit_expr *mass = ambit_expressions(arena, s.n * s.n), *force = ambit_expressions(arena, s.n);
  if (!mass || !force) return ambit_no_memory(f);
  status = build_mass(m, &s, mass);
  if (status == AMBIT_OK && !ambit_constraints_exist(m)) status = check_loads(&s, mass);
  if (status == AMBIT_OK) status = build_force(&s, force);
  *motion = (ambit_motion) { s.n, s.v, mass, force };
  return status;
}

ambit_status ambit_motion_force(
    ambit_mechanism *m, ambit_arena *arena, size_t *n, const ambit_expr **force, ambit_failure *f) {
  equations s = { .g = ambit_mechanism_graph(m), .arena = arena, .f = f };
  ambit_status status = pull_equations(m, &s);
  if (status != AMBIT_OK) return status;
  ambit_expr *h = ambit_expressions(arena, s.n);
  if (!h) return ambit_no_memory(f);
  *n = s.n;
  *force = h;
  return build_force(&s, h);
}

/* -- the solution */

typedef struct pivots {
  ambit_graph *g;
  const ambit_motion *motion;
  ambit_failure *f;
} pivots;

static ambit_status check_pivot(void *user, size_t k, ambit_expr pivot) {
  const pivots *p = user;
  const ambit_expr *scale = &p->motion->mass[k * p->motion->n + k];
  return ambit_pivots_check(p->g, 1, &p->motion->variables.speed[k], &pivot, scale, p->f);
}

ambit_status ambit_motion_accelerations(
    ambit_graph *g, const ambit_motion *motion, const ambit_expr *applied, ambit_expr *du, ambit_failure *f) {
  size_t n = motion->n;
  ambit_arena *arena = ambit_arena_open();
  ambit_factor a = { g, n, arena ? ambit_expressions(arena, n * n) : NULL, n <= SIMPLIFY_JOINTS ? SIMPLIFY_TERMS : 0 };
  ambit_status status = a.u ? AMBIT_OK : ambit_no_memory(f);
  if (status == AMBIT_OK) {
    memcpy(a.u, motion->mass, n * n * sizeof *a.u);
    for (size_t i = 0; i < n; i++)
      du[i] = applied ? ambit_graph_op(g, AMBIT_OP_ADD, motion->force[i], applied[i]) : motion->force[i];
    pivots p = { g, motion, f };
    status = ambit_factorise(&a, check_pivot, &p);
  }
  if (status == AMBIT_OK) ambit_factor_solve(&a, du);
  for (size_t i = 0; status == AMBIT_OK && i < n; i++)
    if (du[i] == AMBIT_NO_EXPR) status = ambit_no_memory(f);
  ambit_arena_close(arena);
  return status;
}

/* -- the system */

ambit_status ambit_dynamics_states(
    ambit_graph *g, const ambit_variables *v, ambit_arena *arena, ambit_system *system, ambit_failure *f) {
  size_t nc = v->ncoordinate, nx = nc + v->n;
  const char **name = ambit_arena_alloc(arena, nx * sizeof *name), **unit = ambit_arena_alloc(arena, nx * sizeof *unit);
  ambit_expr *state = ambit_expressions(arena, nx);
  if (!name || !unit || !state) return ambit_no_memory(f);
  for (size_t i = 0; i < nx; i++) {
    bool speed = i >= nc;
    name[i] = ambit_arena_text(arena, speed ? v->speed[i - nc].name : v->coordinate[i].name);
    unit[i] = ambit_arena_text(arena, speed ? v->speed[i - nc].unit : v->coordinate[i].unit);
    state[i] = speed ? v->speed[i - nc].u : v->coordinate[i].q;
    if (!name[i] || !unit[i]) return ambit_no_memory(f);
  }
  *system = (ambit_system) { .graph = g, .nx = nx, .name = name, .unit = unit, .state = state };
  return AMBIT_OK;
}
