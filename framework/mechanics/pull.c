/* pull.c -- demand: a quantity is worked out when somebody asks for it, and remembered.
**
** An element asks for what it needs from within express(), so a chain of elements is a chain of nested calls. The C
** stack stays shallow whatever the length of the chain: at DEPTH_MAX nested calls the asked-for cell becomes a
** request of its own, everything is broken off (its elements see NULL from get() and return), the request is served
** first, and the broken-off one is repeated. By then what it needed is remembered: an express() is called once more for
** each deep chain that it hangs on.
**
** A cell that is asked for while it is being worked out closes a loop: BUSY, or WAITING in a request that still
** waits.
*/
#include "base/vector.h"
#include "mechanics/parts.h"
#include <stdio.h>
#include <string.h>

#define DEPTH_MAX 200u
#define LOOP_TEXT 400

static const char *part_name(const ambit_mechanism *m, const ambit_cell *cell) {
  return cell->part < m->count ? m->part[cell->part].name : m->name;
}

/* "a -> b -> a": the parts on the way from the cell back to itself. */
static ambit_status fail_loop(ambit_mechanism *m, const ambit_cell *cell) {
  char text[LOOP_TEXT];
  size_t used = (size_t)snprintf(text, sizeof text, "%.100s", part_name(m, cell));
  const ambit_cell *last = cell;
  for (const ambit_cell *c = cell->next; c; c = c->next) {
    bool closes = c == cell;
    if ((c->part != last->part || closes) && used < sizeof text - 120)
      used += (size_t)snprintf(text + used, sizeof text - used, " -> %.100s", part_name(m, c));
    else if (closes)
      used += (size_t)snprintf(text + used, sizeof text - used, " -> ... -> %.100s", part_name(m, c));
    last = c;
    if (closes) break;
  }
  return ambit_fail(m->failure, AMBIT_INVALID, "a loop of elements: %s (the %s of `%s` waits for itself)", text,
      ambit_quantity_name(cell->quantity), part_name(m, cell));
}

static bool still_waits(const ambit_mechanism *m, uint32_t number) {
  for (size_t i = 0; i + 1 < m->nrequest; i++) /* the last one is being served */
    if (m->request[i].number == number) return true;
  return false;
}

/* -- sums over attached elements */

static bool is_sum(const ambit_mechanism *m, const ambit_cell *cell) {
  if (cell->part == UINT32_MAX) return true;
  if (cell->quantity != AMBIT_WRENCH && cell->quantity != AMBIT_EFFORT) return false;
  return m->part[cell->part].element->port[cell->port].role == AMBIT_ROLE_OUT;
}

/* Adds what one element contributes. */
static ambit_status add_share(ambit_mechanism *m, ambit_cell *sum, ambit_cell *share, size_t n, ambit_expr *out) {
  const ambit_expr *value = ambit_pull_cell(m, share, sum);
  if (!value) return share->state == AMBIT_CELL_DECLINED ? AMBIT_OK : AMBIT_INVALID;
  for (size_t k = 0; k < n; k++) out[k] = ambit_graph_op(m->graph, AMBIT_OP_ADD, out[k], value[k]);
  return AMBIT_OK;
}

static ambit_status work_out_sum(ambit_mechanism *m, ambit_cell *cell, size_t n, ambit_expr *out) {
  ambit_status status = AMBIT_OK;
  cell->open = true;
  m->nopen++;
  memset(out, 0, n * sizeof *out); /* 0 is the constant 0 */
  if (cell->part == UINT32_MAX) {
    for (size_t i = 0; status == AMBIT_OK && i < m->count; i++)
      status = add_share(m, cell, ambit_part_cell(&m->part[i], AMBIT_NO_PORT, cell->quantity), n, out);
    return status;
  }
  ambit_joined at = m->part[cell->part].joined[cell->port];
  while (status == AMBIT_OK && at.part != UINT32_MAX) {
    status = add_share(m, cell, ambit_part_cell(&m->part[at.part], at.port, cell->quantity), n, out);
    const ambit_joined *own = &m->part[at.part].joined[at.port];
    at.part = own->next_part;
    at.port = own->next_port;
  }
  return status;
}

/* -- one cell */

static ambit_status fail_cell(ambit_mechanism *m, const ambit_cell *cell, const char *what) {
  char who[AMBIT_WHO_MAX];
  const ambit_part *p = &m->part[cell->part];
  const char *port = cell->port == AMBIT_NO_PORT ? "the whole" : p->element->port[cell->port].name;
  return ambit_fail(m->failure, AMBIT_BROKEN, "%s: %s of `%s`: %s", ambit_part_who(p, who),
      ambit_quantity_name(cell->quantity), port, what);
}

static ambit_status keep(ambit_mechanism *m, ambit_cell *cell, size_t n, const ambit_expr *out) {
  for (size_t k = 0; k < n; k++)
    if (out[k] >= ambit_graph_count(m->graph)) {
      if (cell->part < m->count) return fail_cell(m, cell, "not every component was written, or memory is exhausted");
      return ambit_fail(m->failure, AMBIT_NOMEM, "out of memory");
    }
  ambit_expr *value = ambit_arena_alloc(m->arena, n * sizeof *value);
  if (!value) return ambit_fail(m->failure, AMBIT_NOMEM, "out of memory");
  memcpy(value, out, n * sizeof *value);
  cell->value = value;
  cell->state = AMBIT_CELL_DONE;
  return AMBIT_OK;
}

/* Settles the state of the cell. */
static void work_out(ambit_mechanism *m, ambit_cell *cell) {
  ambit_expr out[AMBIT_QUANTITY_MAX];
  bool sum = is_sum(m, cell);
  const ambit_part *p = cell->part < m->count ? &m->part[cell->part] : NULL;
  size_t n = ambit_quantity_count(p, cell->port, cell->quantity);
  memset(out, 0xff, sizeof out); /* AMBIT_NO_EXPR */
  cell->state = AMBIT_CELL_BUSY;
  m->depth++;
  ambit_status status = sum ? work_out_sum(m, cell, n, out) : ambit_build_express(m, cell, out);
  m->depth--;
  if (m->deferred) {
    cell->state = AMBIT_CELL_WAITING;
    cell->request = m->request[m->nrequest - 1].number;
    return;
  }
  cell->state = AMBIT_CELL_EMPTY;
  if (m->failure->status != AMBIT_OK) return;
  if (!sum) m->pulled++;
  if (status == AMBIT_OK)
    keep(m, cell, n, out);
  else if (status == AMBIT_UNABLE && !sum)
    cell->state = AMBIT_CELL_DECLINED;
  else
    fail_cell(m, cell, ambit_status_name(status));
}

const ambit_expr *ambit_pull_cell(ambit_mechanism *m, ambit_cell *cell, ambit_cell *asker) {
  if (m->deferred || m->failure->status != AMBIT_OK) return NULL;
  if (asker) asker->next = cell;
  bool waits = cell->state == AMBIT_CELL_WAITING && still_waits(m, cell->request);
  if (cell->state == AMBIT_CELL_BUSY || waits) {
    fail_loop(m, cell);
    return NULL;
  }
  if (cell->state != AMBIT_CELL_DONE && cell->state != AMBIT_CELL_DECLINED) {
    if (m->depth >= DEPTH_MAX) {
      m->deferred = cell;
      return NULL;
    }
    work_out(m, cell);
  }
  if (asker && cell->open && !asker->open) {
    asker->open = true;
    m->nopen++;
  }
  return cell->state == AMBIT_CELL_DONE ? cell->value : NULL;
}

/* -- requests */

static bool push(ambit_mechanism *m, ambit_cell *cell) {
  ambit_request *grown = ambit_vector_reserve(m->request, &m->request_capacity, m->nrequest + 1, sizeof *grown);
  if (!grown) return false;
  m->request = grown;
  grown[m->nrequest++] = (ambit_request) { cell, ++m->requests };
  return true;
}

static const ambit_expr *serve(ambit_mechanism *m, ambit_cell *cell) {
  const ambit_expr *value = NULL;
  m->nrequest = 0;
  bool room = push(m, cell);
  while (room && m->nrequest > 0) {
    m->depth = 0;
    value = ambit_pull_cell(m, m->request[m->nrequest - 1].cell, NULL);
    if (m->failure->status != AMBIT_OK) break;
    ambit_cell *first = m->deferred;
    m->deferred = NULL;
    if (first)
      room = push(m, first);
    else
      m->nrequest--;
  }
  if (!room) ambit_fail(m->failure, AMBIT_NOMEM, "out of memory");
  m->nrequest = 0;
  m->deferred = NULL;
  return m->failure->status == AMBIT_OK ? value : NULL;
}

static ambit_cell *find(ambit_mechanism *m, ambit_frame frame, uint32_t quantity, ambit_failure *f) {
  ambit_cell *cell = NULL;
  if (frame.part == UINT32_MAX) {
    cell = ambit_mechanism_cell(m, quantity);
    if (!cell)
      ambit_fail(f, AMBIT_INVALID, "mechanism `%s` as a whole has no %s", m->name, ambit_quantity_name(quantity));
    return cell;
  }
  if (frame.part >= m->count || frame.port >= m->part[frame.part].element->nport) {
    ambit_fail(f, AMBIT_INVALID, "mechanism `%s` has no port %u of part %u", m->name, frame.port, frame.part);
    return NULL;
  }
  const ambit_part *p = &m->part[frame.part];
  const ambit_port *port = &p->element->port[frame.port];
  if (port->role == AMBIT_ROLE_OUT) cell = ambit_part_cell(p, frame.port, quantity);
  if (!cell)
    ambit_fail(f, AMBIT_INVALID, "port `%s` of `%s` has no %s that could be asked for", port->name, p->name,
        ambit_quantity_name(quantity));
  return cell;
}

const ambit_expr *ambit_mechanism_pull(ambit_mechanism *m, ambit_frame frame, uint32_t quantity, ambit_failure *f) {
  ambit_failure own = { 0 };
  ambit_cell *cell = find(m, frame, quantity, f);
  if (!cell) return NULL;
  m->failure = &own;
  const ambit_expr *value = serve(m, cell);
  m->failure = NULL;
  if (own.status != AMBIT_OK)
    ambit_fail(f, own.status, "%s", own.message);
  else if (!value) {
    char who[AMBIT_WHO_MAX];
    ambit_fail(
        f, AMBIT_INVALID, "%s has no %s", ambit_part_who(&m->part[cell->part], who), ambit_quantity_name(quantity));
  }
  return value;
}
