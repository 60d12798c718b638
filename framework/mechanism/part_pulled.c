/* part_pulled.c -- how much of one part was asked for. */
#include "mechanism/parts.h"

size_t ambit_mechanism_part_pulled(const ambit_mechanism *m, uint32_t part) {
  const ambit_part *p = &m->part[part];
  size_t cells = ((size_t)p->element->nport + 1) * AMBIT_COLUMNS, n = 0;
  for (size_t i = 0; i < cells; i++) n += p->cell[i].state == AMBIT_CELL_DONE;
  return n;
}
