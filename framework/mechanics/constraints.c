/* constraints.c -- residual rows, sorted by what they do, and their derivatives. */
#include "mechanics/constraints.h"
#include <stdio.h>
#include <string.h>

#define SIMPLIFY_TERMS 64u

typedef struct rows {
  ambit_constraints *c;
  ambit_mechanism *m;
  ambit_graph *g;
  ambit_arena *arena;
  ambit_failure *f;
  ambit_expr *q, *rate; /* [nq] */
  /* of each row as it was found */
  ambit_constraint *row;
  ambit_expr *derivative; /* dg/dt */
  size_t count;
} rows;

static ambit_expr *expressions(ambit_arena *arena, size_t n) {
  return ambit_arena_alloc(arena, (n + 1) * sizeof(ambit_expr));
}

static bool is_constraint(const ambit_port *p) { return p->kind == AMBIT_PORT_CONSTRAINT && p->role == AMBIT_ROLE_OUT; }

static size_t count_rows(const ambit_mechanism *m) {
  size_t n = 0;
  for (uint32_t part = 0; part < ambit_mechanism_count(m); part++) {
    const ambit_element *e = ambit_mechanism_part_element(m, part);
    for (uint32_t i = 0; i < e->nport; i++)
      if (is_constraint(&e->port[i])) n += ambit_port_dof(&e->port[i]);
  }
  return n;
}

bool ambit_constraints_exist(const ambit_mechanism *m) { return count_rows(m) > 0; }

/* -- what there is */

static ambit_status read_variables(rows *s) {
  ambit_constraints *c = s->c;
  c->nq = ambit_mechanism_coordinates(s->m, 0, NULL);
  c->nu = ambit_mechanism_speeds(s->m, 0, NULL);
  ambit_coordinate *coordinate = ambit_arena_alloc(s->arena, (c->nq + 1) * sizeof *coordinate);
  ambit_speed *speed = ambit_arena_alloc(s->arena, (c->nu + 1) * sizeof *speed);
  s->q = expressions(s->arena, c->nq);
  s->rate = expressions(s->arena, c->nq);
  if (!coordinate || !speed || !s->q || !s->rate) return ambit_no_memory(s->f);
  ambit_mechanism_coordinates(s->m, c->nq, coordinate);
  ambit_mechanism_speeds(s->m, c->nu, speed);
  for (size_t j = 0; j < c->nq; j++) {
    s->q[j] = coordinate[j].q;
    s->rate[j] = coordinate[j].rate;
    if (s->rate[j] == AMBIT_NO_EXPR)
      return ambit_fail(s->f, AMBIT_INVALID, "the coordinate `%s` has no rate", coordinate[j].name);
  }
  c->coordinate = coordinate;
  c->speed = speed;
  return AMBIT_OK;
}

static ambit_status add_row(rows *s, uint32_t part, uint32_t index, uint32_t of, ambit_expr g) {
  char text[160];
  const char *loop = ambit_mechanism_part_name(s->m, part);
  if (of > 1)
    snprintf(text, sizeof text, "%.120s.%u", loop, index + 1);
  else
    snprintf(text, sizeof text, "%.120s", loop);
  for (size_t k = 0; k < s->count; k++) /* a dot in the name of an element makes that of a row */
    if (strcmp(s->row[k].name, text) == 0)
      return ambit_fail(s->f, AMBIT_INVALID,
          "the constraint `%s` of `%s` has the name of one of `%s`: call one of them otherwise", text, loop,
          s->row[k].loop);
  ambit_constraint *row = &s->row[s->count++];
  *row = (ambit_constraint) { ambit_arena_text(s->arena, loop), ambit_arena_text(s->arena, text), part, index, g };
  return row->loop && row->name ? AMBIT_OK : ambit_no_memory(s->f);
}

static ambit_status read_part(rows *s, uint32_t part) {
  const ambit_element *e = ambit_mechanism_part_element(s->m, part);
  uint32_t of = 0, index = 0;
  for (uint32_t i = 0; i < e->nport; i++)
    if (is_constraint(&e->port[i])) of += ambit_port_dof(&e->port[i]);
  for (uint32_t i = 0; i < e->nport; i++) {
    if (!is_constraint(&e->port[i])) continue;
    const ambit_expr *g = ambit_mechanism_pull(s->m, (ambit_frame) { part, i }, AMBIT_RESIDUAL, s->f);
    if (!g) return AMBIT_INVALID;
    for (uint32_t k = 0; k < ambit_port_dof(&e->port[i]); k++) {
      ambit_expr simple = ambit_graph_simplify(s->g, g[k], SIMPLIFY_TERMS);
      ambit_status status = add_row(s, part, index++, of, simple);
      if (status != AMBIT_OK) return status;
    }
  }
  return AMBIT_OK;
}

static ambit_status read_rows(rows *s) {
  size_t room = count_rows(s->m);
  s->row = ambit_arena_alloc(s->arena, (room + 1) * sizeof *s->row);
  s->derivative = expressions(s->arena, room);
  if (!s->row || !s->derivative) return ambit_no_memory(s->f);
  ambit_status status = AMBIT_OK;
  for (uint32_t part = 0; status == AMBIT_OK && part < ambit_mechanism_count(s->m); part++) status = read_part(s, part);
  return status;
}

/* -- derivatives, and what each row is */

/* The variable that a row may not depend on: a speed, or a state of an element's own; NULL: it may. */
static const char *forbidden(const rows *s, ambit_expr leaf, const char **kind) {
  for (size_t k = 0; k < s->c->nu; k++)
    if (leaf == s->c->speed[k].u) return *kind = "speed", s->c->speed[k].name;
  for (size_t j = 0; j < s->c->nq; j++)
    if (leaf == s->q[j] && s->c->coordinate[j].own) return *kind = "state", s->c->coordinate[j].name;
  return NULL;
}

/* Does e have leaves besides uncertain data? And none that is forbidden. */
static ambit_status check_leaves(const rows *s, const ambit_constraint *row, bool *varies) {
  size_t n = ambit_graph_leaves(s->g, 1, &row->g, 0, NULL);
  ambit_expr *leaf = expressions(s->arena, n);
  if (!leaf) return ambit_no_memory(s->f);
  ambit_graph_leaves(s->g, 1, &row->g, n, leaf);
  *varies = false;
  for (size_t i = 0; i < n; i++) {
    *varies = *varies || ambit_graph_node(s->g, leaf[i])->op != AMBIT_LEAF_UNKNOWN;
    const char *kind = NULL, *name = forbidden(s, leaf[i], &kind);
    if (name)
      return ambit_fail(s->f, AMBIT_INVALID,
          "the constraint `%s` depends on the %s `%s`: expected one of positions and time only", row->name, kind, name);
  }
  return AMBIT_OK;
}

static ambit_status check_row(const rows *s, const ambit_constraint *row) {
  bool moves = false;
  ambit_status status = check_leaves(s, row, &moves);
  if (status != AMBIT_OK || moves || row->g == 0) return status;
  ambit_interval x = ambit_graph_node(s->g, row->g)->range;
  if (ambit_interval_contains(x, 0))
    return ambit_fail(s->f, AMBIT_INVALID,
        "the constraint `%s` cannot be kept by moving: uncertain data fix its residual in [%g, %g]; make these data "
        "exact, or choose a closure without this row",
        row->name, x.lo, x.hi);
  return ambit_fail(s->f, AMBIT_INVALID,
      "the loop of `%s` can never be closed: the residual of its row `%s` is %g in every position", row->loop,
      row->name, ambit_interval_mid(x));
}

/* 0: restricts speeds, 1: pure, 2: trivial */
static int kind_of(const ambit_constraint *row, ambit_expr derivative) {
  return row->g == 0 ? 2 : derivative == 0 ? 1 : 0;
}

static ambit_status differentiate(rows *s) {
  for (size_t k = 0; k < s->count; k++) {
    ambit_status status = check_row(s, &s->row[k]);
    if (status != AMBIT_OK) return status;
    ambit_expr d = ambit_graph_time_derivative(s->g, s->row[k].g, s->c->nq, s->q, s->rate, s->f);
    if (d == AMBIT_NO_EXPR) return s->f && s->f->status != AMBIT_OK ? s->f->status : ambit_no_memory(s->f);
    s->derivative[k] = ambit_graph_simplify(s->g, d, SIMPLIFY_TERMS);
  }
  return AMBIT_OK;
}

static ambit_status sort_rows(rows *s) {
  ambit_constraints *c = s->c;
  ambit_constraint *row = ambit_arena_alloc(s->arena, (s->count + 1) * sizeof *row);
  ambit_expr *rate = expressions(s->arena, s->count);
  if (!row || !rate) return ambit_no_memory(s->f);
  size_t total = 0, of[3] = { 0 };
  for (int kind = 0; kind < 3; kind++)
    for (size_t k = 0; k < s->count; k++)
      if (kind_of(&s->row[k], s->derivative[k]) == kind) {
        rate[total] = s->derivative[k];
        row[total++] = s->row[k];
        of[kind]++;
      }
  c->n = of[0], c->npure = of[1], c->ntrivial = of[2];
  c->row = row;
  c->rate = rate;
  return AMBIT_OK;
}

static ambit_expr slope_of(const rows *s, ambit_expr e, ambit_expr leaf) {
  ambit_expr d = ambit_graph_derivative(s->g, e, leaf, s->f);
  return d == AMBIT_NO_EXPR ? d : ambit_graph_simplify(s->g, d, SIMPLIFY_TERMS);
}

static ambit_status build_matrices(rows *s) {
  ambit_constraints *c = s->c;
  size_t positions = c->n + c->npure;
  ambit_expr *slope = expressions(s->arena, positions * c->nq), *velocity = expressions(s->arena, c->n * c->nu),
             *drive = expressions(s->arena, c->n);
  if (!slope || !velocity || !drive) return ambit_no_memory(s->f);
  for (size_t k = 0; k < positions; k++)
    for (size_t j = 0; j < c->nq; j++) {
      slope[k * c->nq + j] = slope_of(s, c->row[k].g, s->q[j]);
      if (slope[k * c->nq + j] == AMBIT_NO_EXPR) return ambit_no_memory(s->f);
    }
  for (size_t k = 0; k < c->n; k++) {
    for (size_t i = 0; i < c->nu; i++) {
      velocity[k * c->nu + i] = slope_of(s, c->rate[k], c->speed[i].u);
      if (velocity[k * c->nu + i] == AMBIT_NO_EXPR) return ambit_no_memory(s->f);
    }
    drive[k] = slope_of(s, c->row[k].g, ambit_graph_time(s->g));
    if (drive[k] == AMBIT_NO_EXPR) return ambit_no_memory(s->f);
  }
  c->slope = slope;
  c->velocity = velocity;
  c->drive = drive;
  return AMBIT_OK;
}

ambit_status ambit_constraints_build(ambit_mechanism *m, ambit_arena *arena, ambit_constraints *c, ambit_failure *f) {
  ambit_failure own = { 0 };
  *c = (ambit_constraints) { .mechanism = m };
  rows s = { .c = c, .m = m, .g = ambit_mechanism_graph(m), .arena = arena, .f = &own };
  ambit_status status = read_variables(&s);
  if (status == AMBIT_OK) status = read_rows(&s);
  if (status == AMBIT_OK) status = differentiate(&s);
  if (status == AMBIT_OK) status = sort_rows(&s);
  if (status == AMBIT_OK) status = build_matrices(&s);
  return status == AMBIT_OK ? status : ambit_fail(f, own.status, "%s", own.message);
}
