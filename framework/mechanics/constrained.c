/* constrained.c -- projection on the null space, the reduced system, multipliers. */
#include "mechanics/constrained.h"
#include "mechanics/forward.h"
#include "mechanics/implicit.h"
#include "mechanics/loop_motion.h"
#include <string.h>

typedef struct reduction {
  ambit_mechanism *m;
  ambit_graph *g;
  ambit_arena *arena;
  ambit_failure *f;
  const ambit_loops *loops;
  ambit_loop_motion motion;
  ambit_motion dynamics;
  size_t nu, nfree;
  const uint32_t *independent;
  ambit_expr *force; /* [nu] h without multipliers */
  ambit_expr *du;    /* [nfree] in terms of q, u, t */
} reduction;

static ambit_expr op(const reduction *s, uint32_t code, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(s->g, code, a, b);
}

/* a + b c */
static ambit_expr add_product(const reduction *s, ambit_expr a, ambit_expr b, ambit_expr c) {
  return b == 0 || c == 0 ? a : op(s, AMBIT_OP_ADD, a, op(s, AMBIT_OP_MUL, b, c));
}

static ambit_status check(const reduction *s, size_t n, const ambit_expr *e) {
  for (size_t i = 0; i < n; i++)
    if (e[i] == AMBIT_NO_EXPR) return ambit_no_memory(s->f);
  return AMBIT_OK;
}

/* -- N^T M N and N^T (h - M a) */

/* all multipliers := 0 in e[ne] */
static ambit_status drop_multipliers(
    ambit_mechanism *m, ambit_arena *arena, size_t ne, ambit_expr *e, ambit_failure *f) {
  size_t n = ambit_mechanism_multipliers(m, 0, NULL);
  ambit_multiplier *multiplier = ambit_arena_alloc(arena, (n + 1) * sizeof *multiplier);
  ambit_expr *lambda = ambit_expressions(arena, n), *zero = ambit_expressions(arena, n);
  if (!multiplier || !lambda || !zero) return ambit_no_memory(f);
  ambit_mechanism_multipliers(m, n, multiplier);
  for (size_t k = 0; k < n; k++) lambda[k] = multiplier[k].lambda;
  return ambit_graph_substitute(ambit_mechanism_graph(m), ne, e, n, lambda, zero, f);
}

static ambit_status build_force(reduction *s) {
  s->force = ambit_expressions(s->arena, s->nu);
  if (!s->force) return ambit_no_memory(s->f);
  memcpy(s->force, s->dynamics.force, s->nu * sizeof *s->force);
  return drop_multipliers(s->m, s->arena, s->nu, s->force, s->f);
}

/* y := M x */
static void multiply_mass(const reduction *s, const ambit_expr *x, size_t stride, ambit_expr *y) {
  for (size_t i = 0; i < s->nu; i++) {
    y[i] = 0;
    for (size_t k = 0; k < s->nu; k++) y[i] = add_product(s, y[i], s->dynamics.mass[i * s->nu + k], x[k * stride]);
  }
}

/* component l of N^T y */
static ambit_expr project(const reduction *s, size_t l, const ambit_expr *y) {
  ambit_expr sum = 0;
  for (size_t i = 0; i < s->nu; i++) sum = add_product(s, sum, s->motion.projection[i * s->nfree + l], y[i]);
  return sum;
}

/* The independent speeds as a motion of their own. */
static ambit_status reduced_motion(reduction *s, ambit_motion *reduced) {
  size_t n = s->nfree;
  ambit_variables *v = &reduced->variables;
  ambit_speed *speed = ambit_arena_alloc(s->arena, (n + 1) * sizeof *speed);
  ambit_expr *mass = ambit_expressions(s->arena, n * n), *force = ambit_expressions(s->arena, n),
             *y = ambit_expressions(s->arena, s->nu);
  if (!speed || !mass || !force || !y) return ambit_no_memory(s->f);
  for (size_t l = 0; l < n; l++) {
    speed[l] = s->loops->constraints.speed[s->independent[l]];
    multiply_mass(s, s->motion.projection + l, n, y);
    for (size_t k = 0; k <= l; k++) mass[k * n + l] = mass[l * n + k] = project(s, k, y);
  }
  multiply_mass(s, s->motion.bias, 1, y);
  for (size_t i = 0; i < s->nu; i++) y[i] = op(s, AMBIT_OP_SUB, s->force[i], y[i]);
  for (size_t l = 0; l < n; l++) force[l] = project(s, l, y);
  *v = s->dynamics.variables;
  v->n = n;
  v->speed = speed;
  reduced->n = n;
  reduced->mass = mass;
  reduced->force = force;
  ambit_status status = check(s, n * n, mass);
  return status == AMBIT_OK ? check(s, n, force) : status;
}

static ambit_status build(reduction *s, ambit_motion *reduced) {
  s->nu = s->loops->constraints.nu;
  s->nfree = s->loops->nfree;
  s->independent = s->loops->partition.independent;
  ambit_status status = ambit_loop_motion_build(s->loops, s->arena, &s->motion, s->f);
  if (status == AMBIT_OK) status = ambit_motion_build(s->m, s->arena, &s->dynamics, s->f);
  if (status == AMBIT_OK) status = build_force(s);
  if (status == AMBIT_OK) status = reduced_motion(s, reduced);
  s->du = ambit_expressions(s->arena, s->nfree);
  if (status == AMBIT_OK && !s->du) status = ambit_no_memory(s->f);
  if (status == AMBIT_OK && s->nfree) status = ambit_motion_accelerations(s->g, reduced, NULL, s->du, s->f);
  return status;
}

/* Dependent speeds in e[0..n) in terms of the independent ones. */
static ambit_status eliminate_speeds(const reduction *s, size_t n, ambit_expr *e) {
  size_t rank = s->loops->partition.rank;
  ambit_expr *from = ambit_expressions(s->arena, rank), *to = ambit_expressions(s->arena, rank);
  if (!from || !to) return ambit_no_memory(s->f);
  for (size_t k = 0; k < rank; k++) {
    uint32_t i = s->loops->partition.column[k];
    from[k] = s->loops->constraints.speed[i].u;
    to[k] = s->motion.speed[i];
  }
  return ambit_graph_substitute(s->g, n, e, rank, from, to, s->f);
}

/* -- the system */

static ambit_status add_invariants(
    const ambit_constraints *c, ambit_arena *arena, ambit_system *system, ambit_failure *f) {
  size_t n = c->n + c->npure;
  ambit_expr *g = ambit_expressions(arena, n);
  const char **name = ambit_arena_alloc(arena, (n + 1) * sizeof *name);
  if (!g || !name) return ambit_no_memory(f);
  for (size_t k = 0; k < n; k++) {
    g[k] = c->row[k].g;
    name[k] = c->row[k].name;
  }
  system->ninvariant = n;
  system->invariant = g;
  system->invariant_name = name;
  return AMBIT_OK;
}

/* The states are those of the open chain, but of the speeds only the independent ones. */
static ambit_status closed_variables(const ambit_loops *loops, ambit_arena *arena, ambit_variables *v) {
  const ambit_constraints *c = &loops->constraints;
  ambit_speed *speed = ambit_arena_alloc(arena, (loops->nfree + 1) * sizeof *speed);
  if (!speed) return AMBIT_NOMEM;
  for (size_t l = 0; l < loops->nfree; l++) speed[l] = c->speed[loops->partition.independent[l]];
  *v = (ambit_variables) { .ncoordinate = c->nq, .n = loops->nfree, .coordinate = c->coordinate, .speed = speed };
  return AMBIT_OK;
}

/* Without rows that restrict a speed (those of unit quaternions, and 0 = 0, do not) there are no loops. */
ambit_status ambit_constrained_outline(
    ambit_mechanism *m, uint32_t form, ambit_arena *arena, ambit_system *system, ambit_failure *f) {
  ambit_failure own = { 0 };
  ambit_constraints c;
  ambit_variables v = { 0 };
  ambit_loops *loops = ambit_arena_alloc(arena, sizeof *loops);
  if (!loops) return ambit_no_memory(f);
  ambit_status status = ambit_constraints_build(m, arena, &c, &own);
  if (status == AMBIT_OK && c.n == 0) {
    loops = NULL;
    status = ambit_variables_read(m, arena, &v, &own);
  } else if (status == AMBIT_OK) {
    status = ambit_loops_build(m, arena, loops, &own);
    if (status == AMBIT_OK) status = closed_variables(loops, arena, &v);
  }
  if (status == AMBIT_OK) status = ambit_dynamics_states(ambit_mechanism_graph(m), &v, arena, system, &own);
  if (status == AMBIT_OK) status = add_invariants(loops ? &loops->constraints : &c, arena, system, &own);
  if (status == AMBIT_OK) status = ambit_implicit_offer(m, loops, form, arena, system, &own);
  return status == AMBIT_OK ? status : ambit_fail(f, status, "%s", own.message);
}

static ambit_status open_rates(
    ambit_mechanism *m, uint32_t form, ambit_arena *arena, const ambit_expr **rate, ambit_failure *f) {
  ambit_forward forward = { 0 };
  ambit_status status = ambit_forward_build(m, form, false, arena, &forward, f);
  const ambit_variables *v = &forward.variables;
  ambit_expr *list = ambit_expressions(arena, v->ncoordinate + v->n);
  if (status == AMBIT_OK && !list) status = ambit_no_memory(f);
  if (status != AMBIT_OK) return status;
  for (size_t j = 0; j < v->ncoordinate; j++) list[j] = v->coordinate[j].rate;
  memcpy(list + v->ncoordinate, forward.du, v->n * sizeof *list);
  *rate = list;
  return drop_multipliers(m, arena, v->n, list + v->ncoordinate, f);
}

static ambit_status closed_rates(reduction *s, const ambit_expr **rate) {
  ambit_motion reduced = { 0 };
  ambit_status status = build(s, &reduced);
  if (status != AMBIT_OK) return status;
  const ambit_constraints *c = &s->loops->constraints;
  ambit_expr *list = ambit_expressions(s->arena, c->nq + s->nfree);
  if (!list) return ambit_no_memory(s->f);
  for (size_t j = 0; j < c->nq; j++) list[j] = c->coordinate[j].rate;
  memcpy(list + c->nq, s->du, s->nfree * sizeof *list);
  *rate = list;
  return eliminate_speeds(s, c->nq + s->nfree, list);
}

ambit_status ambit_constrained_rates(ambit_mechanism *m, const ambit_loops *loops, uint32_t form, ambit_arena *arena,
    const ambit_expr **rate, ambit_failure *f) {
  ambit_failure own = { 0 };
  const ambit_expr *list = NULL;
  reduction s = { .m = m, .g = ambit_mechanism_graph(m), .arena = arena, .f = &own, .loops = loops };
  ambit_status status = loops ? closed_rates(&s, &list) : open_rates(m, form, arena, &list, &own);
  *rate = status == AMBIT_OK ? list : NULL;
  return status == AMBIT_OK ? status : ambit_fail(f, status, "%s", own.message);
}

ambit_status ambit_constrained_system(
    ambit_mechanism *m, uint32_t form, ambit_arena *arena, ambit_system *system, ambit_failure *f) {
  ambit_status status = ambit_constrained_outline(m, form, arena, system, f);
  return status == AMBIT_OK ? ambit_system_rates(system, &system->rate, f) : status;
}

/* -- what the states determine */

static ambit_status build_accelerations(const reduction *s, ambit_expr *du) {
  for (size_t i = 0; i < s->nu; i++) {
    du[i] = s->motion.bias[i];
    for (size_t l = 0; l < s->nfree; l++)
      du[i] = add_product(s, du[i], s->motion.projection[i * s->nfree + l], s->du[l]);
  }
  return check(s, s->nu, du);
}

/* lambda from G_d^T lambda = (M u' - h)_d */
static ambit_status build_multipliers(reduction *s, const ambit_expr *du, ambit_expr *lambda) {
  ambit_expr *b = ambit_expressions(s->arena, s->nu);
  if (!b) return ambit_no_memory(s->f);
  multiply_mass(s, du, 1, b);
  for (size_t i = 0; i < s->nu; i++) b[i] = op(s, AMBIT_OP_SUB, b[i], s->force[i]);
  return ambit_loop_solve_transposed(&s->motion.solver, b, lambda, s->f);
}

ambit_status ambit_constrained_build(ambit_mechanism *m, ambit_arena *arena, ambit_constrained *c, ambit_failure *f) {
  ambit_failure own = { 0 };
  ambit_motion reduced = { 0 };
  reduction s = { .m = m, .g = ambit_mechanism_graph(m), .arena = arena, .f = &own, .loops = &c->loops };
  ambit_status status = ambit_loops_build(m, arena, &c->loops, &own);
  if (status == AMBIT_OK) status = build(&s, &reduced);
  if (status != AMBIT_OK) return ambit_fail(f, status, "%s", own.message);
  size_t n = c->loops.constraints.n;
  ambit_expr *all = ambit_expressions(arena, 2 * s.nu + n), *du = all + s.nu, *lambda = du + s.nu;
  if (!all) return ambit_no_memory(f);
  memcpy(all, s.motion.speed, s.nu * sizeof *all);
  status = build_accelerations(&s, du);
  if (status == AMBIT_OK) status = build_multipliers(&s, du, lambda);
  if (status == AMBIT_OK) status = eliminate_speeds(&s, 2 * s.nu + n, all);
  c->speed = all;
  c->du = du;
  c->multiplier = lambda;
  return status == AMBIT_OK ? status : ambit_fail(f, status, "%s", own.message);
}

static bool of_row(const ambit_constraint *row, const ambit_multiplier *m) {
  return row->part == m->part && row->index == m->index;
}

ambit_status ambit_constrained_express(
    const ambit_constrained *c, ambit_arena *arena, size_t ne, ambit_expr *e, ambit_failure *f) {
  const ambit_constraints *k = &c->loops.constraints;
  size_t nm = ambit_mechanism_multipliers(k->mechanism, 0, NULL), n = 0;
  ambit_multiplier *multiplier = ambit_arena_alloc(arena, (nm + 1) * sizeof *multiplier);
  ambit_expr *from = ambit_expressions(arena, 2 * k->nu + nm), *to = ambit_expressions(arena, 2 * k->nu + nm);
  if (!multiplier || !from || !to) return ambit_no_memory(f);
  for (size_t i = 0; i < k->nu; i++) {
    from[n] = k->speed[i].du, to[n++] = c->du[i];
    from[n] = k->speed[i].u, to[n++] = c->speed[i];
  }
  ambit_mechanism_multipliers(k->mechanism, nm, multiplier);
  for (size_t i = 0; i < nm; i++) {
    from[n] = multiplier[i].lambda, to[n] = 0; /* of a row that is 0 = 0 or redundant */
    for (size_t r = 0; r < k->n; r++)
      if (of_row(&k->row[r], &multiplier[i])) to[n] = c->multiplier[r];
    n++;
  }
  return ambit_graph_substitute(ambit_mechanism_graph(k->mechanism), ne, e, n, from, to, f);
}
