/* solver_kit_implicit.c -- see solver_kit_implicit.h. */
#include "kit/solver_kit_implicit.h"
#include <stdio.h>

static ambit_status write_form(ambit_system_source *self, ambit_failure *f) {
  kit_form *o = (kit_form *)(void *)self;
  (void)f;
  self->form = (ambit_implicit_form) { o->na, o->nstage, o->unknown, o->rate, o->residual, o->stage_end, o->pivot };
  return AMBIT_OK;
}

void kit_form_open(kit_model *m, size_t nstage) {
  m->form = (kit_form) { .source.write = write_form, .na = m->nx, .nstage = nstage };
  m->form.stage_end[0] = (uint32_t)(nstage > 1 ? m->nx / 2 : m->nx);
  m->form.stage_end[1] = (uint32_t)m->nx;
  for (size_t i = 0; i < m->nx; i++) {
    char name[16];
    snprintf(name, sizeof name, "%s'", m->name[i]);
    m->form.unknown[i] = ambit_graph_symbol(m->graph, name, "1/s");
  }
}

void kit_form_close(kit_model *m, const ambit_expr *r, const ambit_expr *f) {
  ambit_graph *g = m->graph;
  kit_form *o = &m->form;
  uint32_t first = 0;
  for (size_t s = 0; s < o->nstage; first = o->stage_end[s++])
    for (uint32_t i = o->stage_end[s]; i-- > first;) {
      ambit_expr d = ambit_graph_op(
          g, AMBIT_OP_ADD, ambit_graph_number(g, 2), ambit_graph_op(g, AMBIT_OP_SIN, m->state[i], m->state[i]));
      ambit_expr own = ambit_graph_op(g, AMBIT_OP_MUL, d, r[i]);
      o->residual[i] = own;
      if (i + 1 < o->stage_end[s])
        o->residual[i] = ambit_graph_op(
            g, AMBIT_OP_ADD, own, ambit_graph_op(g, AMBIT_OP_MUL, ambit_graph_number(g, 0.25), o->residual[i + 1]));
      if (s == 1)
        o->residual[i] = ambit_graph_op(g, AMBIT_OP_ADD, o->residual[i], ambit_graph_op(g, AMBIT_OP_SIN, r[0], r[0]));
      o->pivot[first + o->stage_end[s] - 1 - i] = i;
      o->rate[i] = i % 2 ? f[i] : o->unknown[i];
    }
}
