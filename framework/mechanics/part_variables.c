/* part_variables.c -- the variables of a mechanism: coordinates q, speeds u and multipliers, each a symbol of the graph
** that exists once an element has asked for it.
**
** Symbols are found by name, so every name must be nobody else's. A coordinate is "beta" (several: "beta.1", ...), its
** speed "beta'" ("beta.1'"), the time derivative of that "beta''". Where an element has fewer speeds than coordinates,
** a speed is no derivative of one coordinate: "beta'.1" and "beta''.1".
*/
#include "base/vector.h"
#include "mechanics/parts.h"
#include <stdio.h>
#include <string.h>

#define NAME_BYTES 128
#define UNIT_BYTES 80
#define MULTIPLIER "lambda_"

static const char *name_of(char out[NAME_BYTES], const char *before, const char *part, uint32_t number) {
  if (number)
    snprintf(out, NAME_BYTES, "%s%.100s.%u", before, part, number);
  else
    snprintf(out, NAME_BYTES, "%s%.100s", before, part);
  return out;
}

static ambit_expr symbol(ambit_mechanism *m, const char *unit, const char *per, const char *name, const char *primes) {
  char full[NAME_BYTES + 8], text[UNIT_BYTES];
  snprintf(full, sizeof full, "%s%s", name, primes);
  snprintf(text, sizeof text, "%.60s%s", unit, per);
  return ambit_graph_symbol(m->graph, full, text);
}

/* Parts have different names, but a dot may make the name of a coordinate that of another one, and a part may be called
** like a multiplier.
*/
static ambit_status check_free(
    const ambit_mechanism *m, const ambit_part *p, const char *what, const char *name, ambit_failure *f) {
  char who[AMBIT_WHO_MAX];
  bool taken = false;
  for (size_t i = 0; i < m->nmultiplier; i++) taken = taken || strcmp(m->multiplier[i].name, name) == 0;
  bool derived = strchr(name, '.') || strncmp(name, MULTIPLIER, strlen(MULTIPLIER)) == 0;
  for (size_t i = 0; derived && i < m->ncoordinate; i++) taken = taken || strcmp(m->coordinate[i].name, name) == 0;
  if (!taken) return AMBIT_OK;
  return ambit_fail(
      f, AMBIT_INVALID, "%s: its %s `%s` has the name of another variable", ambit_part_who(p, who), what, name);
}

static ambit_status add_speed(ambit_mechanism *m, const ambit_speed *s, ambit_failure *f) {
  ambit_speed *grown = ambit_vector_reserve(m->speed, &m->speed_capacity, m->nspeed + 1, sizeof *grown);
  if (!grown || !s->name || !s->unit || s->u == AMBIT_NO_EXPR || s->du == AMBIT_NO_EXPR) return ambit_no_memory(f);
  m->speed = grown;
  grown[m->nspeed] = *s;
  m->part[s->part].speed[s->index] = (uint32_t)m->nspeed++;
  return AMBIT_OK;
}

/* The speed that is the time derivative of a coordinate. */
static ambit_status add_rate(ambit_mechanism *m, ambit_coordinate *c, ambit_failure *f) {
  char name[NAME_BYTES + 1], unit[UNIT_BYTES];
  snprintf(name, sizeof name, "%s'", c->name);
  snprintf(unit, sizeof unit, "%.60s/s", c->unit);
  ambit_speed s = { .name = ambit_arena_text(m->arena, name),
    .unit = ambit_arena_text(m->arena, unit),
    .u = symbol(m, c->unit, "/s", c->name, "'"),
    .du = symbol(m, c->unit, "/s^2", c->name, "''"),
    .part = c->part,
    .index = c->index,
    .coordinate = c->q };
  c->rate = s.u;
  return add_speed(m, &s, f);
}

const ambit_coordinate *ambit_part_coordinate(
    ambit_mechanism *m, uint32_t part, uint32_t i, const char *unit, ambit_failure *f) {
  const ambit_part *p = &m->part[part];
  if (p->coordinate[i] != UINT32_MAX) return &m->coordinate[p->coordinate[i]];
  char name[NAME_BYTES];
  name_of(name, "", p->name, p->ncoordinate > 1 ? i + 1 : 0);
  if (check_free(m, p, "coordinate", name, f) != AMBIT_OK) return NULL;
  ambit_coordinate *grown =
      ambit_vector_reserve(m->coordinate, &m->coordinate_capacity, m->ncoordinate + 1, sizeof *grown);
  if (grown) m->coordinate = grown;
  ambit_coordinate c = { .name = ambit_arena_text(m->arena, name),
    .unit = ambit_arena_text(m->arena, unit),
    .q = symbol(m, unit, "", name, ""),
    .rate = AMBIT_NO_EXPR,
    .part = part,
    .index = i,
    .own = p->dof == 0 };
  bool good = grown && c.name && c.unit && c.q != AMBIT_NO_EXPR;
  if (!good) ambit_no_memory(f);
  if (!good || (ambit_part_has_rates(p) && add_rate(m, &c, f) != AMBIT_OK)) return NULL;
  p->coordinate[i] = (uint32_t)m->ncoordinate;
  grown[m->ncoordinate] = c;
  return &grown[m->ncoordinate++];
}

const ambit_speed *ambit_part_speed(ambit_mechanism *m, uint32_t part, uint32_t i, const char *unit, ambit_failure *f) {
  const ambit_part *p = &m->part[part];
  if (p->speed[i] != UINT32_MAX) return &m->speed[p->speed[i]];
  char name[NAME_BYTES], base[NAME_BYTES], second[NAME_BYTES];
  snprintf(base, sizeof base, "%.100s'", p->name);
  snprintf(second, sizeof second, "%.100s''", p->name);
  name_of(name, "", base, i + 1);
  ambit_speed s = { .name = ambit_arena_text(m->arena, name),
    .unit = ambit_arena_text(m->arena, unit),
    .u = symbol(m, unit, "", name, ""),
    .part = part,
    .index = i,
    .coordinate = AMBIT_NO_EXPR };
  s.du = symbol(m, unit, "/s", name_of(name, "", second, i + 1), "");
  return add_speed(m, &s, f) == AMBIT_OK ? &m->speed[m->nspeed - 1] : NULL;
}

const ambit_multiplier *ambit_part_multiplier(
    ambit_mechanism *m, uint32_t part, uint32_t i, const char *unit, ambit_failure *f) {
  const ambit_part *p = &m->part[part];
  if (p->multiplier[i] != UINT32_MAX) return &m->multiplier[p->multiplier[i]];
  char name[NAME_BYTES];
  name_of(name, MULTIPLIER, p->name, p->rows > 1 ? i + 1 : 0);
  if (check_free(m, p, "multiplier", name, f) != AMBIT_OK) return NULL;
  ambit_multiplier *grown =
      ambit_vector_reserve(m->multiplier, &m->multiplier_capacity, m->nmultiplier + 1, sizeof *grown);
  if (grown) m->multiplier = grown;
  ambit_multiplier one = {
    .name = ambit_arena_text(m->arena, name), .lambda = symbol(m, unit, "", name, ""), .part = part, .index = i
  };
  if (!grown || !one.name || one.lambda == AMBIT_NO_EXPR) {
    ambit_no_memory(f);
    return NULL;
  }
  p->multiplier[i] = (uint32_t)m->nmultiplier;
  grown[m->nmultiplier] = one;
  return &grown[m->nmultiplier++];
}

/* -- lists, in the order of the parts */

/* Asks every joint for its coordinates, so that their symbols exist. */
static void ask_joints(ambit_mechanism *m, uint32_t part) {
  const ambit_element *e = m->part[part].element;
  for (uint32_t port = 0; port < e->nport; port++) {
    if (!ambit_port_has_coordinates(&e->port[port])) continue;
    bool speeds = e->port[port].kind == AMBIT_PORT_JOINT && !ambit_part_has_rates(&m->part[part]);
    ambit_mechanism_pull(m, (ambit_frame) { part, port }, AMBIT_COORDINATE, NULL);
    if (speeds) ambit_mechanism_pull(m, (ambit_frame) { part, port }, AMBIT_RATE, NULL);
  }
}

/* q' of a coordinate of an element that has speeds of its own. */
static ambit_expr pull_rate(ambit_mechanism *m, uint32_t part, uint32_t i) {
  const ambit_element *e = m->part[part].element;
  for (uint32_t port = 0; port < e->nport; port++) {
    if (!ambit_port_has_coordinates(&e->port[port])) continue;
    uint32_t count = ambit_port_coordinates(&e->port[port]);
    if (i >= count) {
      i -= count;
      continue;
    }
    const ambit_expr *rate = ambit_mechanism_pull(m, (ambit_frame) { part, port }, AMBIT_COORDINATE_RATE, NULL);
    return rate ? rate[i] : AMBIT_NO_EXPR;
  }
  return AMBIT_NO_EXPR;
}

size_t ambit_mechanism_coordinates(ambit_mechanism *m, size_t room, ambit_coordinate *out) {
  size_t n = 0;
  for (uint32_t i = 0; i < m->count; i++) {
    ask_joints(m, i);
    for (uint32_t k = 0; k < m->part[i].ncoordinate; k++) {
      uint32_t at = m->part[i].coordinate[k];
      if (at == UINT32_MAX) continue;
      if (n < room) {
        out[n] = m->coordinate[at];
        if (out[n].rate == AMBIT_NO_EXPR) out[n].rate = pull_rate(m, i, k);
      }
      n++;
    }
  }
  return n;
}

const char *ambit_mechanism_coordinate_unit(const ambit_mechanism *m, ambit_expr q) {
  for (size_t i = 0; i < m->ncoordinate; i++)
    if (m->coordinate[i].q == q) return m->coordinate[i].unit;
  return NULL;
}

size_t ambit_mechanism_speeds(ambit_mechanism *m, size_t room, ambit_speed *out) {
  size_t n = 0;
  for (uint32_t i = 0; i < m->count; i++) {
    ask_joints(m, i);
    for (uint32_t k = 0; k < m->part[i].dof; k++) {
      if (m->part[i].speed[k] == UINT32_MAX) continue;
      if (n < room) out[n] = m->speed[m->part[i].speed[k]];
      n++;
    }
  }
  return n;
}

size_t ambit_mechanism_multipliers(ambit_mechanism *m, size_t room, ambit_multiplier *out) {
  size_t n = 0;
  for (uint32_t i = 0; i < m->count; i++)
    for (uint32_t k = 0; k < m->part[i].rows; k++) {
      if (m->part[i].multiplier[k] == UINT32_MAX) continue;
      if (n < room) out[n] = m->multiplier[m->part[i].multiplier[k]];
      n++;
    }
  return n;
}
