/* implicit.c -- balances, constraints on speeds and on accelerations, as equations for what is not known. */
#include "mechanics/implicit.h"
#include "graph/collect.h"
#include "mechanics/constrained.h"
#include "mechanics/implicit_order.h"
#include <string.h>

typedef struct source {
  ambit_system_source base; /* first */
  ambit_mechanism *m;
  ambit_arena *arena;       /* of the system */
  const ambit_loops *loops; /* NULL: none */
  uint32_t parts, form;     /* of the mechanism whose equations these are; AMBIT_FORM_* */
} source;

typedef struct writer {
  const source *s;
  ambit_graph *g;
  ambit_variables v;
  ambit_failure *f;
  size_t nfirst;          /* dependent speeds */
  size_t nkept;           /* multipliers */
  ambit_expr *multiplier; /* [nkept] their symbols */
  ambit_expr *unknown, *residual, *rate;
  uint32_t *stage_end, *pivot;
} writer;

static ambit_status no_memory(const writer *w) { return ambit_fail(w->f, AMBIT_NOMEM, "out of memory"); }

static ambit_expr *expressions(const writer *w, size_t n) { return ambit_expressions(w->s->arena, n); }

/* -- multipliers */

/* Which of the kept rows uses it; nkept: none. */
static size_t row_of(const writer *w, const ambit_multiplier *m) {
  for (size_t k = 0; k < w->nkept; k++) {
    const ambit_constraint *row = &w->s->loops->constraints.row[w->s->loops->partition.row[k]];
    if (row->part == m->part && row->index == m->index) return k;
  }
  return w->nkept;
}

/* Those of kept rows are unknowns, all others 0. */
static ambit_status sort_multipliers(writer *w, size_t n, ambit_expr *balance) {
  size_t all = ambit_mechanism_multipliers(w->s->m, 0, NULL), dropped = 0;
  ambit_multiplier *m = ambit_arena_alloc(w->s->arena, (all + 1) * sizeof *m);
  ambit_expr *other = expressions(w, all), *zero = expressions(w, all);
  w->multiplier = expressions(w, w->nkept);
  if (!m || !other || !zero || !w->multiplier) return no_memory(w);
  ambit_mechanism_multipliers(w->s->m, all, m);
  for (size_t k = 0; k < w->nkept; k++) w->multiplier[k] = AMBIT_NO_EXPR;
  for (size_t i = 0; i < all; i++) {
    size_t k = row_of(w, &m[i]);
    if (k < w->nkept)
      w->multiplier[k] = m[i].lambda;
    else
      other[dropped++] = m[i].lambda;
  }
  for (size_t k = 0; k < w->nkept; k++)
    if (w->multiplier[k] == AMBIT_NO_EXPR)
      return ambit_fail(w->f, AMBIT_INVALID, "the constraint `%s` exerts no force",
          w->s->loops->constraints.row[w->s->loops->partition.row[k]].name);
  return ambit_graph_substitute(w->g, n, balance, dropped, other, zero, w->f);
}

/* -- equations */

/* Kept rows of dg/dt, and their time derivatives. */
static ambit_status constrain(const writer *w, ambit_expr *speed, ambit_expr *acceleration) {
  const ambit_constraints *c = &w->s->loops->constraints;
  ambit_expr *leaf = expressions(w, c->nq + c->nu), *rate = expressions(w, c->nq + c->nu);
  if (!leaf || !rate) return no_memory(w);
  for (size_t j = 0; j < c->nq; j++) leaf[j] = c->coordinate[j].q, rate[j] = c->coordinate[j].rate;
  for (size_t i = 0; i < c->nu; i++) leaf[c->nq + i] = c->speed[i].u, rate[c->nq + i] = c->speed[i].du;
  for (size_t k = 0; k < w->nkept; k++) {
    speed[k] = c->rate[w->s->loops->partition.row[k]];
    if (!acceleration) continue;
    acceleration[k] = ambit_graph_time_derivative(w->g, speed[k], c->nq + c->nu, leaf, rate, w->f);
    if (acceleration[k] == AMBIT_NO_EXPR) return w->f && w->f->status != AMBIT_OK ? w->f->status : no_memory(w);
  }
  return AMBIT_OK;
}

static ambit_status room(writer *w, size_t na, size_t nx) {
  w->unknown = expressions(w, na);
  w->residual = expressions(w, na);
  w->rate = expressions(w, nx);
  w->pivot = ambit_arena_alloc(w->s->arena, (na + 1) * sizeof *w->pivot);
  w->stage_end = ambit_arena_alloc(w->s->arena, 2 * sizeof *w->stage_end);
  return w->unknown && w->residual && w->rate && w->pivot && w->stage_end ? AMBIT_OK : no_memory(w);
}

static ambit_implicit_form form_of(const writer *w, size_t na, size_t nstage) {
  return (ambit_implicit_form) { na, nstage, w->unknown, w->rate, w->residual, w->stage_end, w->pivot };
}

/* Parts come after what they are attached to, so the last speeds are those of tips. */
static void order_tips_first(size_t n, uint32_t *order) {
  for (size_t k = 0; k < n; k++) order[k] = (uint32_t)(n - 1 - k);
}

static ambit_status write_open(writer *w, ambit_implicit_form *form) {
  const ambit_variables *v = &w->v;
  ambit_status status = room(w, v->n, v->ncoordinate + v->n);
  if (status == AMBIT_OK) status = ambit_balances_pull(w->s->m, v, w->residual, w->f);
  if (status == AMBIT_OK) status = sort_multipliers(w, v->n, w->residual);
  if (status != AMBIT_OK) return status;
  memcpy(w->unknown, v->du, v->n * sizeof *w->unknown);
  for (size_t j = 0; j < v->ncoordinate; j++) w->rate[j] = v->coordinate[j].rate;
  memcpy(w->rate + v->ncoordinate, v->du, v->n * sizeof *w->rate);
  order_tips_first(v->n, w->pivot);
  w->stage_end[0] = (uint32_t)v->n;
  *form = form_of(w, v->n, 1);
  return AMBIT_OK;
}

/* Unknowns and equations of stage 2, behind those of stage 1. */
static ambit_status write_accelerations(writer *w) {
  size_t nu = w->v.n, first = w->nfirst, n = nu + w->nkept;
  ambit_expr *balance = expressions(w, n);
  uint32_t *order = w->pivot + first, *equation = ambit_arena_alloc(w->s->arena, n * sizeof *equation);
  if (!balance || !equation) return no_memory(w);
  ambit_status status = ambit_balances_pull(w->s->m, &w->v, balance, w->f);
  if (status == AMBIT_OK) status = sort_multipliers(w, nu, balance);
  if (status == AMBIT_OK) status = constrain(w, w->residual, balance + nu);
  if (status != AMBIT_OK) return status;
  memcpy(w->unknown + first, w->v.du, nu * sizeof *w->unknown);
  memcpy(w->unknown + first + nu, w->multiplier, w->nkept * sizeof *w->unknown);
  order_tips_first(nu, order);
  for (size_t k = nu; k < n; k++) order[k] = (uint32_t)k;
  status = ambit_implicit_order(w->s->loops, n, balance, w->unknown + first, order, equation, w->f);
  for (size_t k = 0; k < n; k++) {
    w->residual[first + k] = balance[equation[k]];
    order[k] += (uint32_t)first;
  }
  return status;
}

static ambit_status write_closed(writer *w, ambit_implicit_form *form) {
  const ambit_loops *l = w->s->loops;
  const ambit_constraints *c = &l->constraints;
  w->nfirst = w->nkept = l->partition.rank;
  size_t na = w->nfirst + (l->nfree ? c->nu + w->nkept : 0);
  ambit_status status = room(w, na, c->nq + l->nfree);
  if (status != AMBIT_OK) return status;
  for (size_t k = 0; k < w->nfirst; k++) {
    w->unknown[k] = c->speed[l->partition.column[k]].u;
    w->pivot[k] = (uint32_t)k;
  }
  w->stage_end[0] = (uint32_t)w->nfirst;
  w->stage_end[1] = (uint32_t)na;
  for (size_t j = 0; j < c->nq; j++) w->rate[j] = c->coordinate[j].rate;
  for (size_t i = 0; i < l->nfree; i++) w->rate[c->nq + i] = c->speed[l->partition.independent[i]].du;
  status = l->nfree ? write_accelerations(w) : constrain(w, w->residual, NULL);
  *form = form_of(w, na, l->nfree ? 2 : 1);
  return status;
}

/* A mechanism that has got further parts has other equations: then there is no form. */
static ambit_status write(ambit_system_source *self, ambit_failure *f) {
  const source *s = (const source *)(const void *)self;
  ambit_failure own = { 0 };
  ambit_implicit_form form = { 0 };
  writer w = { .s = s, .g = ambit_mechanism_graph(s->m), .f = &own };
  if (ambit_mechanism_count(s->m) != s->parts) return AMBIT_OK;
  ambit_status status = ambit_variables_read(s->m, s->arena, &w.v, &own);
  if (status == AMBIT_OK) status = s->loops ? write_closed(&w, &form) : write_open(&w, &form);
  if (status != AMBIT_OK) return ambit_fail(f, status, "%s", own.message);
  self->form = form;
  return AMBIT_OK;
}

static ambit_status write_rates(ambit_system_source *self, ambit_failure *f) {
  const source *s = (const source *)(const void *)self;
  if (ambit_mechanism_count(s->m) != s->parts)
    return ambit_fail(f, AMBIT_INVALID,
        "the mechanism has got further parts since these equations of motion were asked for: ask for new ones, "
        "m:dynamics()");
  return ambit_constrained_rates(s->m, s->loops, s->form, s->arena, &self->rate, f);
}

static void mark(const ambit_system_source *self, ambit_graph *g) {
  const source *s = (const source *)(const void *)self;
  if (!s->loops) return;
  const ambit_constraints *c = &s->loops->constraints;
  ambit_graph_mark(g, c->n, c->rate);
  ambit_graph_mark(g, c->n, c->drive);
  ambit_graph_mark(g, c->n * c->nu, c->velocity);
  ambit_graph_mark(g, (c->n + c->npure) * c->nq, c->slope);
  for (size_t k = 0; k < c->n + c->npure + c->ntrivial; k++) ambit_graph_mark(g, 1, &c->row[k].g);
}

ambit_status ambit_implicit_offer(ambit_mechanism *m, const ambit_loops *loops, uint32_t form, ambit_arena *arena,
    ambit_system *system, ambit_failure *f) {
  source *s = ambit_arena_alloc(arena, sizeof *s);
  if (!s) return ambit_no_memory(f);
  *s = (source) { { .write = write, .write_rates = write_rates, .mark = mark }, m, arena, loops,
    ambit_mechanism_count(m), form };
  system->source = &s->base;
  return AMBIT_OK;
}
