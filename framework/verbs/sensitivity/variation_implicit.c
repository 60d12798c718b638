/* variation_implicit.c -- variational equations of x' = F(x, a, p, t), R(x, a, p, t) = 0, without solving for a.
**
** With alpha = da/dq they are S' = F_x S + F_a alpha + F_q and R_x S + R_a alpha + R_q = 0, which is R differentiated
** along the direction (S, alpha, dq). R being affine in the unknowns of a stage, these equations are affine in them
** too, and in the alpha of the same stage: the stages of a come first, then for each column those of its alpha.
*/
#include "verbs/sensitivity/variation_build.h"
#include "graph/collect.h"
#include <stdio.h>
#include <string.h>

typedef ambit_variation_build_state build;
typedef ambit_variation_column column;

#define ZERO 0u

static ambit_status no_memory(const build *b) { return ambit_fail(b->f, AMBIT_NOMEM, "out of memory"); }

static void *room(const build *b, size_t n, size_t size) { return ambit_arena_alloc(b->arena, n * size + 1); }

/* -- structure */

/* Does e depend on anything that the column moves? */
static ambit_status is_moved(const build *b, const column *c, ambit_expr e, bool *moved) {
  size_t n = ambit_graph_leaves(b->graph, 1, &e, 0, NULL);
  ambit_expr *leaf = room(b, n, sizeof *leaf);
  if (!leaf) return no_memory(b);
  ambit_graph_leaves(b->graph, 1, &e, n, leaf);
  for (size_t l = 0; l < n && !*moved; l++) {
    *moved = leaf[l] == c->unknown;
    for (size_t k = 0; k < b->s->nx; k++) *moved = *moved || (c->reached[k] && leaf[l] == b->s->state[k]);
    for (size_t k = 0; k < b->form->na; k++)
      *moved = *moved || (c->reached_unknown[k] && leaf[l] == b->form->unknown[k]);
  }
  return AMBIT_OK;
}

/* All unknowns of a stage, if one of its equations moves. */
static ambit_status reach_stage(const build *b, column *c, size_t first, size_t end, bool *grows) {
  bool moved = false;
  ambit_status status = AMBIT_OK;
  if (c->reached_unknown[first]) return status;
  for (size_t k = first; k < end && !moved && status == AMBIT_OK; k++)
    status = is_moved(b, c, b->form->residual[k], &moved);
  for (size_t k = first; k < end && moved; k++) c->reached_unknown[k] = *grows = true;
  return status;
}

static ambit_status reach_column(const build *b, column *c) {
  const ambit_implicit_form *form = b->form;
  ambit_status status = AMBIT_OK;
  for (size_t i = 0; i < b->s->nx; i++) c->reached[i] = c->start[i] != ZERO;
  for (bool grows = true; grows && status == AMBIT_OK;) {
    grows = false;
    for (size_t s = 0; s < form->nstage && status == AMBIT_OK; s++)
      status = reach_stage(b, c, s ? form->stage_end[s - 1] : 0, form->stage_end[s], &grows);
    for (size_t i = 0; i < b->s->nx && status == AMBIT_OK; i++) {
      if (c->reached[i]) continue;
      status = is_moved(b, c, form->rate[i], &c->reached[i]);
      grows = grows || c->reached[i];
    }
  }
  return status;
}

ambit_status ambit_variation_reach(build *b) {
  ambit_status status = AMBIT_OK;
  for (size_t j = 0; j < b->q->nby && status == AMBIT_OK; j++) {
    b->column[j].reached_unknown = room(b, b->form->na, sizeof *b->column[j].reached_unknown);
    status = b->column[j].reached_unknown ? reach_column(b, &b->column[j]) : no_memory(b);
  }
  return status;
}

/* -- equations */

typedef struct writer {
  const build *b;
  ambit_implicit_form to;
  ambit_expr *unknown, *residual, *rate;
  uint32_t *stage_end, *pivot;
  size_t nleaf;             /* the direction: */
  ambit_expr *leaf, *along; /* [nx + na + 2] */
} writer;

static ambit_status count(writer *w) {
  const build *b = w->b;
  size_t na = b->form->na * (1 + b->q->nby), nstage = b->form->nstage * (1 + b->q->nby), n = b->s->nx + b->form->na + 2;
  w->unknown = room(b, na, sizeof *w->unknown), w->residual = room(b, na, sizeof *w->residual);
  w->rate = room(b, b->v->system.nx, sizeof *w->rate);
  w->stage_end = room(b, nstage, sizeof *w->stage_end), w->pivot = room(b, na, sizeof *w->pivot);
  w->leaf = room(b, n, sizeof *w->leaf), w->along = room(b, n, sizeof *w->along);
  bool good = w->unknown && w->residual && w->rate && w->stage_end && w->pivot && w->leaf && w->along;
  return good ? AMBIT_OK : no_memory(b);
}

static void copy_form(writer *w) {
  const ambit_implicit_form *form = w->b->form;
  memcpy(w->unknown, form->unknown, form->na * sizeof *w->unknown);
  memcpy(w->residual, form->residual, form->na * sizeof *w->residual);
  memcpy(w->rate, form->rate, w->b->s->nx * sizeof *w->rate);
  memcpy(w->stage_end, form->stage_end, form->nstage * sizeof *w->stage_end);
  memcpy(w->pivot, form->pivot, form->na * sizeof *w->pivot);
  w->to.na = form->na, w->to.nstage = form->nstage;
}

static void point(writer *w, ambit_expr leaf, ambit_expr along) {
  w->leaf[w->nleaf] = leaf;
  w->along[w->nleaf++] = along;
}

/* The direction of column j, with new unknowns for what it reaches, stage by stage. */
static ambit_status open_direction(writer *w, size_t j) {
  const build *b = w->b;
  const column *c = &b->column[j];
  w->nleaf = 0;
  point(w, ambit_graph_time(b->graph), ZERO);
  if (c->unknown != AMBIT_NO_EXPR) point(w, c->unknown, c->scale);
  for (size_t i = 0; i < b->s->nx; i++) {
    uint32_t at = b->v->place[i * b->q->nby + j];
    if (at != AMBIT_VARIATION_ZERO) point(w, b->s->state[i], b->v->system.state[at]);
  }
  for (size_t k = 0; k < b->form->na; k++) {
    if (!c->reached_unknown[k]) continue;
    char name[192]; /* the numbers tell apart what is the same up to there */
    snprintf(name, sizeof name, "d %.50s/d %.50s (%zu, %zu)", ambit_graph_node(b->graph, b->form->unknown[k])->text,
        b->q->by[j].name, k, j);
    ambit_expr alpha = ambit_graph_symbol(b->graph, name, "");
    if (alpha == AMBIT_NO_EXPR) return no_memory(b);
    point(w, b->form->unknown[k], alpha);
  }
  return AMBIT_OK;
}

static ambit_status derive(const writer *w, ambit_expr e, ambit_expr *d) {
  *d = ambit_graph_time_derivative(w->b->graph, e, w->nleaf, w->leaf, w->along, w->b->f);
  if (*d != AMBIT_NO_EXPR) return AMBIT_OK;
  return w->b->f && w->b->f->status != AMBIT_OK ? w->b->f->status : no_memory(w->b);
}

/* The stages of a column's unknowns: their equations and pivots are those of the system, moved. */
static ambit_status write_stages(writer *w, const column *c) {
  const ambit_implicit_form *form = w->b->form;
  size_t from = w->nleaf, before = w->to.na;
  for (size_t k = 0; k < form->na; k++) from -= c->reached_unknown[k];
  ambit_status status = AMBIT_OK;
  for (size_t s = 0, k = 0; s < form->nstage; s++) {
    size_t first = k, at = w->to.na;
    if (!c->reached_unknown[first]) {
      k = form->stage_end[s];
      continue;
    }
    for (; k < form->stage_end[s] && status == AMBIT_OK; k++) {
      w->unknown[w->to.na] = w->along[from + (w->to.na - before)];
      w->pivot[w->to.na] = (uint32_t)(form->pivot[k] - first + at);
      status = derive(w, form->residual[k], &w->residual[w->to.na++]);
    }
    if (status != AMBIT_OK) return status;
    w->stage_end[w->to.nstage++] = (uint32_t)w->to.na;
  }
  return AMBIT_OK;
}

static ambit_status write_column(writer *w, size_t j) {
  const build *b = w->b;
  ambit_status status = open_direction(w, j);
  if (status == AMBIT_OK) status = write_stages(w, &b->column[j]);
  for (size_t i = 0; i < b->s->nx && status == AMBIT_OK; i++) {
    uint32_t at = b->v->place[i * b->q->nby + j];
    if (at != AMBIT_VARIATION_ZERO) status = derive(w, b->form->rate[i], &w->rate[at]);
  }
  return status;
}

static ambit_status written(ambit_system_source *self, ambit_failure *f) {
  (void)self, (void)f;
  return AMBIT_OK;
}

static void mark(const ambit_system_source *self, ambit_graph *g) {
  const build *b = ((const ambit_variation_source *)(const void *)self)->build;
  for (size_t j = 0; j < b->q->nby; j++)
    if (b->column[j].unknown != AMBIT_NO_EXPR) {
      ambit_graph_mark(g, 1, &b->column[j].unknown);
      ambit_graph_mark(g, 1, &b->column[j].scale);
    }
}

ambit_status ambit_variation_implicit(build *b, ambit_status (*later)(ambit_system_source *self, ambit_failure *f)) {
  ambit_variation_source *source = ambit_arena_alloc(b->arena, sizeof *source);
  writer w = { .b = b };
  ambit_status status = source ? count(&w) : no_memory(b);
  if (status != AMBIT_OK) return status;
  copy_form(&w);
  for (size_t j = 0; j < b->q->nby && status == AMBIT_OK; j++) status = write_column(&w, j);
  if (status != AMBIT_OK) return status;
  w.to.unknown = w.unknown, w.to.rate = w.rate, w.to.residual = w.residual;
  w.to.stage_end = w.stage_end, w.to.pivot = w.pivot;
  *source = (ambit_variation_source) {
    { .written = true, .form = w.to, .write = written, .write_rates = later, .mark = mark }, b
  };
  b->v->system.source = &source->base;
  return AMBIT_OK;
}
