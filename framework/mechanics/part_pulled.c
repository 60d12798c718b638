/* part_pulled.c -- which quantities one part has, and which of them were asked for. */
#include "mechanics/parts.h"

typedef struct listing {
  const ambit_part *part;
  size_t n, room;
  ambit_part_quantity *out;
} listing;

static void list(listing *l, uint32_t port, uint32_t quantity) {
  const ambit_cell *cell = ambit_part_cell(l->part, port, quantity);
  bool there = cell->state == AMBIT_CELL_DONE || cell->state == AMBIT_CELL_DECLINED;
  if (l->n < l->room) l->out[l->n] = (ambit_part_quantity) { ambit_quantity_name(quantity), port, there };
  l->n++;
}

/* What express() may be asked for at a port: sums over what is attached are not the element's. */
static void list_port(listing *l, uint32_t i) {
  const ambit_port *port = &l->part->element->port[i];
  bool is_out = port->role == AMBIT_ROLE_OUT;
  if (port->kind == AMBIT_PORT_CONSTRAINT) {
    list(l, i, AMBIT_RESIDUAL);
  } else if (port->kind == AMBIT_PORT_STATE) {
    list(l, i, AMBIT_COORDINATE);
    list(l, i, AMBIT_COORDINATE_RATE);
  } else if (!is_out) {
    list(l, i, port->kind == AMBIT_PORT_FRAME ? AMBIT_WRENCH : AMBIT_EFFORT);
  } else if (port->kind == AMBIT_PORT_FRAME) {
    for (uint32_t q = AMBIT_POSE; q <= AMBIT_ACCEL; q++) list(l, i, q);
  } else {
    for (uint32_t q = AMBIT_COORDINATE; q <= AMBIT_RATE2; q++) list(l, i, q);
    list(l, i, AMBIT_BALANCE);
    if (ambit_port_coordinates(port) != ambit_port_dof(port)) list(l, i, AMBIT_COORDINATE_RATE);
  }
}

size_t ambit_mechanism_part_quantities(const ambit_mechanism *m, uint32_t part, size_t room, ambit_part_quantity *out) {
  static const uint32_t whole[] = { AMBIT_ENERGY, AMBIT_POWER, AMBIT_FIELD, AMBIT_MASS, AMBIT_MASS_MOMENT,
    AMBIT_MOMENTUM };
  listing l = { &m->part[part], 0, room, out };
  for (uint32_t i = 0; i < l.part->element->nport; i++) list_port(&l, i);
  for (size_t i = 0; i < sizeof whole / sizeof *whole; i++) list(&l, AMBIT_NO_PORT, whole[i]);
  return l.n;
}
