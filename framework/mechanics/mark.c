/* mark.c -- which expressions a mechanism keeps: parameters, variables, and what its parts have written. */
#include "mechanics/parts.h"

static void mark_cell(ambit_graph *g, const ambit_part *p, const ambit_cell *cell) {
  if (cell->state == AMBIT_CELL_DONE)
    ambit_graph_mark(g, ambit_quantity_count(p, cell->port, cell->quantity), cell->value);
}

static void mark_part(ambit_graph *g, const ambit_part *p) {
  for (size_t i = 0; i < p->nparam; i++)
    if (p->param[i]) ambit_graph_mark(g, ambit_part_components(p, i), p->param[i]);
  size_t ncell = (size_t)(p->element->nport + 1) * AMBIT_COLUMNS;
  for (size_t k = 0; k < ncell; k++) mark_cell(g, p, &p->cell[k]);
  for (size_t k = 0; p->cut && k < ncell; k++) mark_cell(g, p, &p->cut[k]);
}

void ambit_mechanism_mark(ambit_holder *holder, ambit_graph *g) {
  const ambit_mechanism *m = (const ambit_mechanism *)(const void *)holder;
  for (size_t i = 0; i < m->count; i++) mark_part(g, &m->part[i]);
  for (size_t k = 0; k < AMBIT_COLUMNS; k++) mark_cell(g, NULL, &m->whole[k]);
  for (size_t i = 0; i < m->ncoordinate; i++) {
    ambit_graph_mark(g, 1, &m->coordinate[i].q);
    ambit_graph_mark(g, 1, &m->coordinate[i].rate);
  }
  for (size_t i = 0; i < m->nspeed; i++) {
    ambit_graph_mark(g, 1, &m->speed[i].u);
    ambit_graph_mark(g, 1, &m->speed[i].du);
    ambit_graph_mark(g, 1, &m->speed[i].coordinate);
  }
  for (size_t i = 0; i < m->nmultiplier; i++) ambit_graph_mark(g, 1, &m->multiplier[i].lambda);
}
