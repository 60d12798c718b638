/* mechanism.c -- what a mechanism consists of: parts and their connections. */
#include <ambit/mechanism.h>
#include "base/vector.h"
#include "mechanics/parts.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *ambit_part_who(const ambit_part *p, char out[AMBIT_WHO_MAX]) {
  snprintf(out, AMBIT_WHO_MAX, "%s `%s`%s%s%s", p->type, p->name, p->where ? " (" : "", p->where ? p->where : "",
      p->where ? ")" : "");
  return out;
}

/* -- cells */

const char *ambit_quantity_name(uint32_t quantity) {
  switch (quantity) {
  case AMBIT_POSE: return "pose";
  case AMBIT_TWIST: return "twist";
  case AMBIT_ACCEL: return "acceleration";
  case AMBIT_WRENCH: return "wrench";
  case AMBIT_ENERGY: return "energy";
  case AMBIT_POWER: return "power";
  case AMBIT_COORDINATE: return "coordinate";
  case AMBIT_RATE: return "rate";
  case AMBIT_RATE2: return "second rate";
  case AMBIT_EFFORT: return "effort";
  case AMBIT_BALANCE: return "balance";
  case AMBIT_COORDINATE_RATE: return "rate of the coordinates";
  case AMBIT_RESIDUAL: return "residual";
  case AMBIT_FIELD: return "field";
  case AMBIT_MASS: return "mass";
  case AMBIT_MASS_MOMENT: return "first moment of the mass";
  case AMBIT_MOMENTUM: return "momentum";
  default: return "unknown quantity";
  }
}

/* The quantities that a row of cells holds, first to last: of a port of that kind, of the part as a whole (0). */
static const struct {
  uint32_t quantity[AMBIT_COLUMNS];
} columns[] = {
  { { AMBIT_ENERGY, AMBIT_FIELD, AMBIT_POWER, AMBIT_MASS, AMBIT_MASS_MOMENT, AMBIT_MOMENTUM } },
  [AMBIT_PORT_FRAME] = { { AMBIT_POSE, AMBIT_TWIST, AMBIT_ACCEL, AMBIT_WRENCH } },
  [AMBIT_PORT_JOINT] = { { AMBIT_COORDINATE, AMBIT_RATE, AMBIT_RATE2, AMBIT_EFFORT, AMBIT_BALANCE,
      AMBIT_COORDINATE_RATE } },
  [AMBIT_PORT_CONSTRAINT] = { { AMBIT_RESIDUAL } },
  [AMBIT_PORT_STATE] = { { AMBIT_COORDINATE, AMBIT_COORDINATE_RATE } },
};

ambit_cell *ambit_mechanism_cell(ambit_mechanism *m, uint32_t quantity) {
  for (uint32_t k = 0; quantity && k < AMBIT_COLUMNS; k++)
    if (m->whole[k].quantity == quantity) return &m->whole[k];
  return NULL;
}

/* What may depend on accelerations, or on the field of gravity. */
static bool is_cut(uint32_t quantity) {
  return quantity == AMBIT_ACCEL || quantity == AMBIT_WRENCH || quantity == AMBIT_EFFORT || quantity == AMBIT_BALANCE ||
         quantity == AMBIT_ENERGY || quantity == AMBIT_POWER;
}

ambit_cell *ambit_part_cell(const ambit_part *p, uint32_t port, uint32_t quantity) {
  ambit_cell *cell = p->cut && is_cut(quantity) ? p->cut : p->cell;
  uint32_t row = port == AMBIT_NO_PORT ? p->element->nport : port;
  uint32_t kind = port == AMBIT_NO_PORT ? 0 : p->element->port[port].kind;
  for (uint32_t k = 0; quantity && k < AMBIT_COLUMNS; k++)
    if (columns[kind].quantity[k] == quantity) return &cell[row * AMBIT_COLUMNS + k];
  return NULL;
}

size_t ambit_quantity_count(const ambit_part *p, uint32_t port, uint32_t quantity) {
  switch (quantity) {
  case AMBIT_POSE: return 12;
  case AMBIT_TWIST:
  case AMBIT_ACCEL:
  case AMBIT_WRENCH:
  case AMBIT_MOMENTUM: return 6;
  case AMBIT_ENERGY: return 2;
  case AMBIT_POWER:
  case AMBIT_MASS: return 1;
  case AMBIT_FIELD:
  case AMBIT_MASS_MOMENT: return 3;
  case AMBIT_COORDINATE:
  case AMBIT_COORDINATE_RATE: return ambit_port_coordinates(&p->element->port[port]);
  default: return ambit_port_dof(&p->element->port[port]);
  }
}

/* How many (port, quantity) express() may be asked for. */
static size_t available(const ambit_element *e) {
  size_t n = AMBIT_COLUMNS;
  for (uint32_t i = 0; i < e->nport; i++) {
    const ambit_port *p = &e->port[i];
    bool out = p->role == AMBIT_ROLE_OUT, own_speeds = ambit_port_coordinates(p) != ambit_port_dof(p);
    if (p->kind == AMBIT_PORT_FRAME)
      n += out ? 3 : 1;
    else if (p->kind == AMBIT_PORT_JOINT)
      n += out ? 4 + own_speeds : 1;
    else
      n += p->kind == AMBIT_PORT_STATE ? 2 : 1;
  }
  return n;
}

static uint32_t *unmade(ambit_mechanism *m, uint32_t n) {
  uint32_t *list = ambit_arena_alloc(m->arena, (n + 1) * sizeof *list);
  if (list) memset(list, 0xff, (n + 1) * sizeof *list); /* UINT32_MAX */
  return list;
}

static ambit_status make_variables(ambit_mechanism *m, ambit_part *p, ambit_failure *f) {
  for (uint32_t i = 0; i < p->element->nport; i++) {
    const ambit_port *port = &p->element->port[i];
    if (port->role != AMBIT_ROLE_OUT || port->kind == AMBIT_PORT_FRAME) continue;
    if (port->kind == AMBIT_PORT_CONSTRAINT) {
      p->rows += port->dof;
    } else {
      p->ncoordinate += ambit_port_coordinates(port);
      p->dof += port->kind == AMBIT_PORT_STATE ? 0 : ambit_port_dof(port);
    }
  }
  p->coordinate = unmade(m, p->ncoordinate);
  p->speed = unmade(m, p->dof);
  p->multiplier = unmade(m, p->rows);
  return p->coordinate && p->speed && p->multiplier ? AMBIT_OK : ambit_no_memory(f);
}

static ambit_status make_cells(ambit_mechanism *m, ambit_part *p, uint32_t number, ambit_failure *f) {
  const ambit_element *e = p->element;
  p->cell = ambit_arena_alloc(m->arena, (size_t)(e->nport + 1) * AMBIT_COLUMNS * sizeof *p->cell);
  if (!p->cell) return ambit_no_memory(f);
  for (uint32_t i = 0; i <= e->nport; i++)
    for (uint32_t k = 0; k < AMBIT_COLUMNS; k++) {
      ambit_cell *cell = &p->cell[i * AMBIT_COLUMNS + k];
      cell->part = number;
      cell->port = i == e->nport ? AMBIT_NO_PORT : i;
      cell->quantity = columns[i == e->nport ? 0 : e->port[i].kind].quantity[k];
    }
  return make_variables(m, p, f);
}

/* What was summed over the attached elements no longer holds. Values that elements made without sums stay, with their
** unknowns.
*/
static void forget_sums(ambit_mechanism *m) {
  if (m->nopen == 0) return;
  for (size_t i = 0; i < m->count; i++) {
    const ambit_part *p = &m->part[i];
    for (size_t k = 0; k < (p->element->nport + 1) * AMBIT_COLUMNS; k++)
      if (p->cell[k].open) p->cell[k].state = AMBIT_CELL_EMPTY, p->cell[k].open = false;
  }
  for (uint32_t k = 0; k < AMBIT_COLUMNS; k++) m->whole[k].state = AMBIT_CELL_EMPTY, m->whole[k].open = false;
  m->nopen = 0;
}

/* -- connections */

static const char *kind_name(uint32_t kind) {
  static const char *const name[] = { [AMBIT_PORT_FRAME] = "frame",
    [AMBIT_PORT_JOINT] = "joint",
    [AMBIT_PORT_CONSTRAINT] = "constraint",
    [AMBIT_PORT_STATE] = "state" };
  return name[kind];
}

/* The port that an IN port is to be connected to exists, is made by an element and is of the same kind. */
static ambit_status check_connection(
    const ambit_mechanism *m, const ambit_part *p, const ambit_port *own, ambit_frame to, ambit_failure *f) {
  char who[AMBIT_WHO_MAX];
  ambit_part_who(p, who);
  if (to.part == UINT32_MAX)
    return ambit_fail(
        f, AMBIT_INVALID, "%s: port `%s` is not connected; it needs a %s", who, own->name, kind_name(own->kind));
  if (to.part >= m->count)
    return ambit_fail(
        f, AMBIT_INVALID, "%s: port `%s` is connected to part %u, which does not exist", who, own->name, to.part);
  const ambit_part *other = &m->part[to.part];
  if (to.port >= other->element->nport)
    return ambit_fail(f, AMBIT_INVALID, "%s: port `%s` is connected to port %u of `%s`, which has %u", who, own->name,
        to.port, other->name, other->element->nport);
  const ambit_port *theirs = &other->element->port[to.port];
  if (theirs->role != AMBIT_ROLE_OUT)
    return ambit_fail(f, AMBIT_INVALID, "%s: port `%s` is connected to `%s` of `%s`, which is itself to be connected",
        who, own->name, theirs->name, other->name);
  if (theirs->kind != own->kind)
    return ambit_fail(f, AMBIT_INVALID, "%s: port `%s` needs a %s, but `%s` of `%s` is a %s", who, own->name,
        kind_name(own->kind), theirs->name, other->name, kind_name(theirs->kind));
  if (own->dof != theirs->dof)
    return ambit_fail(f, AMBIT_INVALID, "%s: port `%s` needs a joint of %u degrees of freedom, but `%s` of `%s` has %u",
        who, own->name, ambit_port_dof(own), theirs->name, other->name, ambit_port_dof(theirs));
  return AMBIT_OK;
}

static ambit_status connect(ambit_mechanism *m, ambit_part *p, const ambit_frame *to, ambit_failure *f) {
  ambit_status status = AMBIT_OK;
  p->joined = ambit_arena_alloc(m->arena, (p->element->nport + 1) * sizeof *p->joined);
  if (!p->joined) return ambit_no_memory(f);
  for (uint32_t i = 0; status == AMBIT_OK && i < p->element->nport; i++) {
    const ambit_port *own = &p->element->port[i];
    ambit_frame other = to && own->role == AMBIT_ROLE_IN ? to[i] : AMBIT_NOWHERE;
    bool free = own->role == AMBIT_ROLE_OUT || (own->optional && other.part == UINT32_MAX);
    if (!free) status = check_connection(m, p, own, other, f);
    p->joined[i] = (ambit_joined) { other.part, other.port, UINT32_MAX, 0 };
  }
  return status;
}

/* Appends the IN port to what is attached to its other end, so that sums have the order in which parts were added. */
static void attach(ambit_mechanism *m, uint32_t part, uint32_t port) {
  const ambit_joined *own = &m->part[part].joined[port];
  if (m->part[part].element->port[port].role != AMBIT_ROLE_IN || own->part == UINT32_MAX) return;
  ambit_joined *end = &m->part[own->part].joined[own->port];
  if (end->part == UINT32_MAX) {
    end->part = part;
    end->port = port;
  } else {
    ambit_joined *last = &m->part[end->next_part].joined[end->next_port];
    last->next_part = part;
    last->next_port = port;
  }
  end->next_part = part; /* of an OUT port: the last one attached */
  end->next_port = port;
}

/* -- parts */

static ambit_status check_element(const ambit_part_spec *spec, ambit_failure *f) {
  const ambit_element *e = spec->element;
  bool joints = false, states = false;
  for (uint32_t i = 0; i < e->nport; i++) {
    const ambit_port *p = &e->port[i];
    uint32_t c = ambit_port_coordinates(p), d = ambit_port_dof(p);
    bool state = p->kind == AMBIT_PORT_STATE, out = state || p->kind == AMBIT_PORT_CONSTRAINT;
    bool frame = p->kind == AMBIT_PORT_FRAME, kind = out || frame || p->kind == AMBIT_PORT_JOINT;
    bool role = p->role == AMBIT_ROLE_OUT || (p->role == AMBIT_ROLE_IN && !out);
    bool dof = frame ? p->dof == 0 : d > 0 && d <= c && c <= AMBIT_QUANTITY_MAX && (c == d || !out);
    states = states || state;
    joints = joints || (p->kind == AMBIT_PORT_JOINT && p->role == AMBIT_ROLE_OUT);
    if (!p->name || !kind || !role || !dof)
      return ambit_fail(f, AMBIT_INVALID, "element `%s`: its port %u is not declared properly", spec->type, i);
  }
  if (!joints || !states) return AMBIT_OK;
  return ambit_fail(f, AMBIT_INVALID,
      "element `%s` has joints and states of its own: expected one or the other; states can act on a joint that the "
      "element is connected to",
      spec->type);
}

static ambit_status fill_part(ambit_mechanism *m, ambit_part *p, const ambit_part_spec *spec, ambit_failure *f) {
  p->element = spec->element;
  p->type = ambit_arena_text(m->arena, spec->type);
  if (!p->type) return ambit_no_memory(f);
  p->where = spec->where && *spec->where ? ambit_arena_text(m->arena, spec->where) : NULL;
  p->unit = ambit_arena_text(m->arena, spec->unit ? spec->unit : "1");
  p->name = spec->name ? ambit_arena_text(m->arena, spec->name) : ambit_part_make_name(m, p->type);
  if (!p->name || !p->unit) return ambit_no_memory(f);
  ambit_status status = ambit_part_check_name(m, p, f);
  if (status == AMBIT_OK) status = ambit_part_take_params(m, p, spec->param, f);
  if (status == AMBIT_OK && !ambit_part_name_data(m, p)) return ambit_no_memory(f);
  if (status == AMBIT_OK) status = connect(m, p, spec->connection, f);
  return status == AMBIT_OK ? make_cells(m, p, (uint32_t)m->count, f) : status;
}

ambit_status ambit_mechanism_add(ambit_mechanism *m, const ambit_part_spec *spec, uint32_t *number, ambit_failure *f) {
  ambit_status status = check_element(spec, f);
  if (status != AMBIT_OK) return status;
  ambit_part *grown = ambit_vector_reserve(m->part, &m->capacity, m->count + 1, sizeof *grown);
  if (!grown || m->count >= UINT32_MAX - 1) return ambit_no_memory(f);
  m->part = grown;
  ambit_part part = { 0 };
  status = fill_part(m, &part, spec, f);
  m->part[m->count] = part;
  if (status == AMBIT_OK) status = ambit_build_check(m, (uint32_t)m->count, f);
  if (status != AMBIT_OK) return status;
  if (!ambit_part_enter_name(m, &part)) return ambit_no_memory(f);
  uint32_t own = (uint32_t)m->count++;
  for (uint32_t i = 0; i < part.element->nport; i++) attach(m, own, i);
  m->available += available(part.element);
  forget_sums(m);
  if (number) *number = own;
  return AMBIT_OK;
}

ambit_mechanism *ambit_mechanism_open(ambit_graph *g, const char *name) {
  ambit_mechanism *m = calloc(1, sizeof *m);
  if (!m) return NULL;
  m->graph = g;
  m->holder.mark = ambit_mechanism_mark;
  ambit_graph_hold(g, &m->holder);
  m->arena = ambit_arena_open();
  m->name = m->arena ? ambit_arena_text(m->arena, name ? name : "mechanism") : NULL;
  for (uint32_t k = 0; k < AMBIT_COLUMNS; k++)
    m->whole[k] = (ambit_cell) { .part = UINT32_MAX, .port = AMBIT_NO_PORT, .quantity = columns[0].quantity[k] };
  ambit_part_spec world = { .element = &ambit_world_element, .type = "world", .name = "world" };
  if (m->name && ambit_mechanism_add(m, &world, NULL, NULL) == AMBIT_OK) return m;
  ambit_mechanism_close(m);
  return NULL;
}

void ambit_mechanism_close(ambit_mechanism *m) {
  if (!m) return;
  ambit_graph_release(&m->holder);
  ambit_arena_close(m->arena);
  free(m->names.table);
  free(m->names.type);
  free(m->request);
  free(m->coordinate);
  free(m->speed);
  free(m->multiplier);
  free(m->part);
  free(m);
}

ambit_graph *ambit_mechanism_graph(ambit_mechanism *m) { return m->graph; }
uint32_t ambit_mechanism_count(const ambit_mechanism *m) { return (uint32_t)m->count; }
const char *ambit_mechanism_part_name(const ambit_mechanism *m, uint32_t part) { return m->part[part].name; }
const ambit_element *ambit_mechanism_part_element(const ambit_mechanism *m, uint32_t part) {
  return m->part[part].element;
}

void ambit_mechanism_pulled(const ambit_mechanism *m, size_t *pulled, size_t *all) {
  *pulled = m->pulled;
  *all = m->available;
}
