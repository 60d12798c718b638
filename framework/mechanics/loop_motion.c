/* loop_motion.c -- N, b and a: dependent speeds and accelerations as functions of the independent ones. */
#include "mechanics/loop_motion.h"
#include "mechanics/balance.h"
#include <string.h>

typedef struct motion {
  const ambit_loops *loops;
  ambit_graph *g;
  ambit_arena *arena;
  ambit_failure *f;
  const ambit_loop_solver *solver;
  ambit_expr *b; /* [n] right-hand side */
  ambit_expr *x; /* [nu] */
} motion;

/* x := -G_d^-1 b in the dependent places, 0 in the others */
static ambit_status solve_negative(motion *s) {
  const ambit_constraints *c = &s->loops->constraints;
  for (size_t i = 0; i < c->nu; i++) s->x[i] = 0;
  for (size_t k = 0; k < c->n; k++) s->b[k] = ambit_graph_op(s->g, AMBIT_OP_NEG, s->b[k], 0);
  return ambit_loop_solve(s->solver, s->b, s->x, s->f);
}

static ambit_status build_projection(motion *s, ambit_expr *projection) {
  const ambit_constraints *c = &s->loops->constraints;
  size_t nfree = s->loops->nfree;
  for (size_t l = 0; l < nfree; l++) {
    uint32_t column = s->loops->partition.independent[l];
    for (size_t k = 0; k < c->n; k++) s->b[k] = c->velocity[k * c->nu + column];
    ambit_status status = solve_negative(s);
    if (status != AMBIT_OK) return status;
    for (size_t i = 0; i < c->nu; i++) projection[i * nfree + l] = s->x[i];
    projection[column * nfree + l] = ambit_graph_number(s->g, 1);
  }
  return AMBIT_OK;
}

static ambit_status build_speed(motion *s, const ambit_expr *projection, ambit_expr *speed) {
  const ambit_constraints *c = &s->loops->constraints;
  size_t nfree = s->loops->nfree;
  memcpy(s->b, c->drive, c->n * sizeof *s->b);
  ambit_status status = solve_negative(s);
  for (size_t i = 0; status == AMBIT_OK && i < c->nu; i++) {
    speed[i] = s->x[i];
    for (size_t l = 0; l < nfree; l++) {
      ambit_expr u = c->speed[s->loops->partition.independent[l]].u;
      ambit_expr share = ambit_graph_op(s->g, AMBIT_OP_MUL, projection[i * nfree + l], u);
      speed[i] = ambit_graph_op(s->g, AMBIT_OP_ADD, speed[i], share);
    }
  }
  return status;
}

static ambit_status build_bias(motion *s, ambit_expr *bias) {
  const ambit_constraints *c = &s->loops->constraints;
  ambit_expr *q = ambit_expressions(s->arena, c->nq), *rate = ambit_expressions(s->arena, c->nq);
  if (!q || !rate) return ambit_no_memory(s->f);
  for (size_t j = 0; j < c->nq; j++) {
    q[j] = c->coordinate[j].q;
    rate[j] = c->coordinate[j].rate;
  }
  for (size_t k = 0; k < c->n; k++) {
    ambit_expr gamma = ambit_graph_time_derivative(s->g, c->rate[k], c->nq, q, rate, s->f);
    if (gamma == AMBIT_NO_EXPR) return s->f->status != AMBIT_OK ? s->f->status : ambit_no_memory(s->f);
    s->b[k] = ambit_graph_simplify(s->g, gamma, 64);
  }
  ambit_status status = solve_negative(s);
  memcpy(bias, s->x, c->nu * sizeof *bias);
  return status;
}

ambit_status ambit_loop_motion_build(
    const ambit_loops *loops, ambit_arena *arena, ambit_loop_motion *out, ambit_failure *f) {
  const ambit_constraints *c = &loops->constraints;
  ambit_failure own = { 0 };
  motion s = { .loops = loops,
    .g = ambit_mechanism_graph(c->mechanism),
    .arena = arena,
    .f = &own,
    .solver = &out->solver,
    .b = ambit_expressions(arena, c->n),
    .x = ambit_expressions(arena, c->nu) };
  ambit_expr *projection = ambit_expressions(arena, c->nu * loops->nfree), *speed = ambit_expressions(arena, c->nu),
             *bias = ambit_expressions(arena, c->nu);
  if (!s.b || !s.x || !projection || !speed || !bias) return ambit_no_memory(f);
  *out = (ambit_loop_motion) { .projection = projection, .speed = speed, .bias = bias };
  ambit_status status = ambit_loop_solver_open(s.g, arena, &loops->partition, c->velocity, &out->solver, &own);
  if (status == AMBIT_OK) status = build_projection(&s, projection);
  if (status == AMBIT_OK) status = build_speed(&s, projection, speed);
  if (status == AMBIT_OK) status = build_bias(&s, bias);
  return status == AMBIT_OK ? status : ambit_fail(f, status, "%s", own.message);
}
