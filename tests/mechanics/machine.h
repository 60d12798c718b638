/* machine.h -- what the tests of mechanisms share: element plugins joined by name, data as text, values at points. */
#ifndef AMBIT_TEST_MACHINE_H
#define AMBIT_TEST_MACHINE_H
#include "graph/tape.h"
#include <ambit/registry.h>
#include "graph/hull.h"
#include <ambit/mechanism.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define MACHINE_PARAMS 8
#define MACHINE_NUMBERS 12

typedef struct machine {
  ambit_graph *graph;
  ambit_registry *registry;
  ambit_mechanism *mechanism;
  ambit_failure failure;
} machine;

static inline machine machine_open(void) {
  machine s = { .graph = ambit_graph_open(), .registry = ambit_registry_open(NULL) };
  s.mechanism = ambit_mechanism_open(s.graph, "machine");
  return s;
}

static inline void machine_close(machine *s) {
  ambit_mechanism_close(s->mechanism);
  ambit_graph_close(s->graph);
  ambit_registry_close(s->registry);
}

static inline ambit_expr machine_number(machine *s, double x) { return ambit_graph_number(s->graph, x); }
static inline ambit_expr machine_symbol(machine *s, const char *name) {
  return ambit_graph_symbol(s->graph, name, "1");
}

/* One parameter: n expressions for `name`; a list of them ends with name NULL. */
typedef struct machine_datum {
  const char *name;
  size_t n;
  ambit_expr e[MACHINE_NUMBERS];
} machine_datum;

/* "offset", "0,-1,0": decimals */
static inline machine_datum machine_text(machine *s, const char *name, const char *list) {
  machine_datum d = { .name = name };
  char text[256];
  snprintf(text, sizeof text, "%s", list);
  for (char *piece = strtok(text, ","); piece; piece = strtok(NULL, ",")) {
    ambit_failure f = { 0 };
    d.e[d.n++] = ambit_graph_decimal(s->graph, piece, &f);
    if (f.status != AMBIT_OK) fail_msg("%s", f.message);
  }
  return d;
}

static inline machine_datum machine_doubles(machine *s, const char *name, size_t n, const double *x) {
  machine_datum d = { .name = name, .n = n };
  for (size_t i = 0; i < n; i++) d.e[i] = machine_number(s, x[i]);
  return d;
}

static inline machine_datum machine_expr(const char *name, ambit_expr e) {
  return (machine_datum) { .name = name, .n = 1, .e = { e } };
}

/* UINT32_MAX: s->failure says why. All IN ports are connected to `at`. */
static inline uint32_t machine_try(
    machine *s, const ambit_element *e, const char *type, const char *name, ambit_frame at, const machine_datum *data) {
  const ambit_expr *param[MACHINE_PARAMS] = { 0 };
  ambit_frame connection[MACHINE_PARAMS];
  uint32_t part = UINT32_MAX;
  for (size_t i = 0; i < MACHINE_PARAMS; i++) connection[i] = at;
  for (const machine_datum *d = data; d && d->name; d++) {
    size_t i = 0;
    while (e->param[i].name && strcmp(e->param[i].name, d->name) != 0) i++;
    if (!e->param[i].name) fail_msg("no parameter `%s`", d->name);
    param[i] = d->e;
  }
  ambit_part_spec spec = { e, type, name, "scene.lua:7", param, connection, NULL };
  ambit_failure_clear(&s->failure);
  return ambit_mechanism_add(s->mechanism, &spec, &part, &s->failure) == AMBIT_OK ? part : UINT32_MAX;
}

static inline const ambit_element *machine_element(machine *s, const char *type) {
  const ambit_element *e = NULL;
  ambit_failure f = { 0 };
  if (ambit_registry_element(s->registry, type, &e, &f) != AMBIT_OK) fail_msg("%s", f.message);
  return e;
}

static inline uint32_t machine_add(
    machine *s, const char *type, const char *name, ambit_frame at, const machine_datum *data) {
  uint32_t part = machine_try(s, machine_element(s, type), type, name, at, data);
  if (part == UINT32_MAX) fail_msg("%s", s->failure.message);
  return part;
}

static const machine_datum machine_end = { 0 };
#define MACHINE_DATA(...) ((const machine_datum[]) { __VA_ARGS__, machine_end })

/* The frame that the part moves: port `to`, number 1 (ground: 0). */
static inline ambit_frame machine_frame(uint32_t part) { return (ambit_frame) { part, 1 }; }

static inline ambit_frame machine_revolute(machine *s, const char *name, ambit_frame from, const char *axis) {
  return machine_frame(machine_add(s, "revolute", name, from, MACHINE_DATA(machine_text(s, "axis", axis))));
}

static inline ambit_frame machine_link(machine *s, ambit_frame from, const char *offset) {
  return machine_frame(machine_add(s, "rigid_link", NULL, from, MACHINE_DATA(machine_text(s, "offset", offset))));
}

static inline void machine_mass(machine *s, ambit_frame at, const char *mass) {
  machine_add(s, "point_mass", NULL, at, MACHINE_DATA(machine_text(s, "mass", mass)));
}

static inline void machine_gravity(machine *s, const char *field) {
  machine_add(s, "gravity", NULL, AMBIT_WORLD, MACHINE_DATA(machine_text(s, "field", field)));
}

static inline const ambit_expr *machine_pull(machine *s, ambit_frame at, uint32_t quantity) {
  ambit_failure_clear(&s->failure);
  const ambit_expr *e = ambit_mechanism_pull(s->mechanism, at, quantity, &s->failure);
  if (!e) fail_msg("%s", s->failure.message);
  return e;
}

/* Enclosures of e[0..n) with leaf[i] = value[i]; other unknowns over their ranges. */
static inline void machine_values(machine *s, size_t n, const ambit_expr *e, size_t nleaf, const ambit_expr *leaf,
    const double *value, ambit_interval *out) {
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  size_t all = ambit_graph_leaves(s->graph, n, e, 0, NULL);
  ambit_expr *in = calloc(all + 1, sizeof *in);
  ambit_interval *range = calloc(all + 1, sizeof *range);
  ambit_graph_leaves(s->graph, n, e, all, in);
  for (size_t i = 0; i < all; i++) {
    range[i] = ambit_graph_node(s->graph, in[i])->range;
    for (size_t k = 0; k < nleaf; k++)
      if (leaf[k] == in[i]) range[i] = (ambit_interval) { value[k], value[k] };
  }
  if (ambit_tape_seal(s->graph, arena, n, e, all, in, 0, 0, &tape, &f) != AMBIT_OK) fail_msg("%s", f.message);
  ambit_interval *slot = calloc(tape->nslot, sizeof *slot);
  ambit_hull(tape, range, slot);
  for (size_t i = 0; i < n; i++) out[i] = slot[tape->out[i]];
  free(slot);
  free(range);
  free(in);
  ambit_arena_close(arena);
}

static inline void machine_text_of(machine *s, ambit_expr e, char out[256]) { ambit_graph_text(s->graph, e, out, 256); }
#endif
