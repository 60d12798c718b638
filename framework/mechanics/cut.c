/* cut.c -- a second set of cells, and what the mechanism remembers of itself put aside. */
#include "mechanics/cut.h"
#include "mechanics/parts.h"
#include <stdlib.h>
#include <string.h>

struct ambit_cut {
  ambit_mechanism *m;
  ambit_cell *cell, whole[AMBIT_COLUMNS];
  size_t pulled;
};

static size_t cells_of(const ambit_part *p) { return (size_t)(p->element->nport + 1) * AMBIT_COLUMNS; }

static void empty(ambit_cell *cell) {
  cell->state = AMBIT_CELL_EMPTY;
  cell->open = false;
  cell->value = NULL;
  cell->next = NULL;
}

ambit_cut *ambit_cut_open(ambit_mechanism *m) {
  size_t n = 1;
  for (size_t i = 0; i < m->count; i++) n += cells_of(&m->part[i]);
  ambit_cut *cut = malloc(sizeof *cut);
  ambit_cell *cell = malloc(n * sizeof *cell);
  if (!cut || !cell) {
    free(cut);
    free(cell);
    return NULL;
  }
  *cut = (ambit_cut) { .m = m, .cell = cell, .pulled = m->pulled };
  memcpy(cut->whole, m->whole, sizeof cut->whole);
  for (uint32_t k = 0; k < AMBIT_COLUMNS; k++)
    if (m->whole[k].quantity != AMBIT_FIELD) empty(&m->whole[k]);
  for (size_t i = 0; i < m->count; i++) {
    ambit_part *p = &m->part[i];
    memcpy(cell, p->cell, cells_of(p) * sizeof *cell);
    for (size_t k = 0; k < cells_of(p); k++) empty(&cell[k]);
    p->cut = cell;
    cell += cells_of(p);
  }
  return cut;
}

void ambit_cut_close(ambit_cut *cut) {
  if (!cut) return;
  ambit_mechanism *m = cut->m;
  for (size_t i = 0; i < m->count; i++) m->part[i].cut = NULL;
  memcpy(m->whole, cut->whole, sizeof cut->whole);
  m->pulled = cut->pulled;
  free(cut->cell);
  free(cut);
}

ambit_status ambit_cut_give(
    ambit_cut *cut, ambit_frame port, uint32_t quantity, const ambit_expr *value, ambit_failure *f) {
  ambit_mechanism *m = cut->m;
  bool whole = port.part == UINT32_MAX;
  const ambit_part *p = whole ? NULL : &m->part[port.part];
  ambit_cell *cell = whole ? ambit_mechanism_cell(m, quantity) : ambit_part_cell(p, port.port, quantity);
  size_t n = ambit_quantity_count(p, whole ? AMBIT_NO_PORT : port.port, quantity);
  ambit_expr *copy = ambit_arena_alloc(m->arena, n * sizeof *copy);
  if (!copy) return ambit_no_memory(f);
  memcpy(copy, value, n * sizeof *copy);
  cell->value = copy;
  cell->state = AMBIT_CELL_DONE;
  return AMBIT_OK;
}
