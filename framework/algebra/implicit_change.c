/* implicit_change.c -- substitution in F and R, and time derivatives along F. */
#include "algebra/implicit_change.h"
#include "graph/collect.h"
#include <string.h>

typedef struct source {
  ambit_system_source base; /* first */
  ambit_implicit_change change;
  ambit_arena *arena;
} source;

/* rate[nx + nfurther] := F, then dg/dt along F */
static ambit_status write_rates(const source *s, const ambit_implicit_form *form, ambit_expr *rate, ambit_failure *f) {
  const ambit_system *of = s->change.of;
  memcpy(rate, form->rate, of->nx * sizeof *rate);
  for (size_t k = 0; k < s->change.nfurther; k++) {
    ambit_expr d = ambit_graph_time_derivative(of->graph, s->change.g[k], of->nx, of->state, form->rate, f);
    if (d == AMBIT_NO_EXPR) return f && f->status != AMBIT_OK ? f->status : ambit_no_memory(f);
    rate[of->nx + k] = d;
  }
  return AMBIT_OK;
}

static ambit_status write(ambit_system_source *self, ambit_failure *f) {
  source *s = (source *)(void *)self;
  const ambit_implicit_change *c = &s->change;
  const ambit_implicit_form *form;
  ambit_failure own = { 0 };
  ambit_status status = ambit_system_implicit(c->of, &form, f);
  if (status != AMBIT_OK || !form) return status;
  size_t nrate = c->of->nx + c->nfurther;
  ambit_expr *all = ambit_arena_alloc(s->arena, (nrate + form->na) * sizeof *all);
  if (!all) return ambit_no_memory(f);
  memcpy(all + nrate, form->residual, form->na * sizeof *all);
  status = write_rates(s, form, all, &own);
  if (status == AMBIT_OK)
    status = ambit_graph_substitute(c->of->graph, nrate + form->na, all, c->n, c->leaf, c->value, &own);
  if (status != AMBIT_OK) return ambit_fail(f, status, "%s", own.message);
  self->form = *form;
  self->form.rate = all;
  self->form.residual = all + nrate;
  return AMBIT_OK;
}

static void mark(const ambit_system_source *self, ambit_graph *g) {
  const ambit_implicit_change *c = &((const source *)(const void *)self)->change;
  ambit_graph_mark(g, c->n, c->leaf);
  ambit_graph_mark(g, c->n, c->value);
  ambit_graph_mark(g, c->nfurther, c->g);
}

static const ambit_expr *copy(ambit_arena *arena, size_t n, const ambit_expr *e) {
  ambit_expr *to = ambit_arena_alloc(arena, (n + 1) * sizeof *to);
  if (to && n) memcpy(to, e, n * sizeof *to);
  return to;
}

ambit_system_source *ambit_implicit_change_open(
    const ambit_implicit_change *change, ambit_arena *arena, ambit_failure *f) {
  if (!change->of->source) return NULL;
  source *s = ambit_arena_alloc(arena, sizeof *s);
  if (s) {
    *s = (source) { { .write = write, .mark = mark }, *change, arena };
    s->change.leaf = copy(arena, change->n, change->leaf);
    s->change.value = copy(arena, change->n, change->value);
    s->change.g = copy(arena, change->nfurther, change->g);
    if (s->change.leaf && s->change.value && s->change.g) return &s->base;
  }
  ambit_no_memory(f);
  return NULL;
}
