/* walk.c -- depth-first search with its own stack; marks are stamped with the number of the walk, so that nothing
** needs clearing and a walk costs only what it reaches.
*/
#include "graph/walk.h"
#include "base/vector.h"
#include <stdlib.h>
#include <string.h>

struct ambit_marks {
  uint32_t *stamp, *position; /* position: valid where stamp == walk; OPEN: on the stack */
  size_t capacity;
  uint32_t walk;
  ambit_expr *stack, *order;
  size_t stack_capacity, order_capacity;
};

#define OPEN UINT32_MAX

ambit_marks *ambit_marks_open(void) { return calloc(1, sizeof(ambit_marks)); }

void ambit_marks_close(ambit_marks *marks) {
  if (!marks) return;
  free(marks->stamp);
  free(marks->position);
  free(marks->stack);
  free(marks->order);
  free(marks);
}

/* A new walk over a graph of `count` nodes. */
static bool begin(ambit_marks *m, size_t count) {
  if (count > m->capacity) {
    size_t room = 2 * count;
    uint32_t *stamp = calloc(room, sizeof *stamp), *position = malloc(room * sizeof *position);
    if (!stamp || !position) {
      free(stamp);
      free(position);
      return false;
    }
    free(m->stamp);
    free(m->position);
    m->stamp = stamp, m->position = position, m->capacity = room, m->walk = 0;
  }
  if (m->walk == UINT32_MAX) {
    memset(m->stamp, 0, m->capacity * sizeof *m->stamp);
    m->walk = 0;
  }
  m->walk++;
  return true;
}

static bool push(ambit_marks *m, size_t *depth, ambit_expr e) {
  if (m->stamp[e] == m->walk) return true;
  ambit_expr *stack = ambit_vector_reserve(m->stack, &m->stack_capacity, *depth + 1, sizeof *stack);
  if (!stack) return false;
  m->stack = stack;
  stack[(*depth)++] = e;
  return true;
}

/* The node leaves the stack: all its operands are numbered. */
static bool settle(ambit_marks *m, size_t *count, ambit_expr e) {
  ambit_expr *order = ambit_vector_reserve(m->order, &m->order_capacity, *count + 1, sizeof *order);
  if (!order) return false;
  m->order = order;
  m->position[e] = (uint32_t)*count;
  order[(*count)++] = e;
  return true;
}

static bool search(const ambit_graph *g, ambit_expr root, ambit_walk_stop stop, size_t *count) {
  ambit_marks *m = g->marks;
  size_t depth = 0;
  if (!push(m, &depth, root)) return false;
  while (depth > 0) {
    ambit_expr e = m->stack[depth - 1];
    if (m->stamp[e] == m->walk) { /* second visit, or reached by another way meanwhile */
      depth--;
      if (m->position[e] == OPEN && !settle(m, count, e)) return false;
      continue;
    }
    ambit_store_expect(g, e);
    m->stamp[e] = m->walk;
    m->position[e] = OPEN;
    const ambit_node *x = ambit_at(g, e);
    if (ambit_op_is_leaf(x->op) || (stop && stop(g, e))) continue;
    if (ambit_op_is_binary(x->op) && !push(m, &depth, x->b)) return false;
    if (!push(m, &depth, x->a)) return false;
  }
  return true;
}

bool ambit_walk_open(const ambit_graph *g, size_t ne, const ambit_expr *e, ambit_walk_stop stop, ambit_walk *walk) {
  ambit_marks *m = g->marks;
  *walk = (ambit_walk) { 0 };
  if (!begin(m, g->count)) return false;
  size_t count = 0;
  for (size_t i = 0; i < ne; i++)
    if (!search(g, e[i], stop, &count)) return false;
  uint32_t *memory = malloc((3 * count + 1) * sizeof *memory);
  if (!memory) return false;
  *walk = (ambit_walk) { count, memory, memory + count, memory + 2 * count };
  for (size_t i = 0; i < count; i++) {
    ambit_expr k = walk->node[i] = m->order[i];
    const ambit_node *x = ambit_at(g, k);
    bool leaf = ambit_op_is_leaf(x->op) || (stop && stop(g, k));
    walk->a[i] = leaf ? (uint32_t)i : m->position[x->a];
    walk->b[i] = leaf || !ambit_op_is_binary(x->op) ? walk->a[i] : m->position[x->b];
  }
  return true;
}

void ambit_walk_close(ambit_walk *walk) {
  free(walk->node);
  *walk = (ambit_walk) { 0 };
}

uint32_t ambit_walk_find(const ambit_graph *g, ambit_expr e) {
  const ambit_marks *m = g->marks;
  return e < m->capacity && m->stamp[e] == m->walk ? m->position[e] : UINT32_MAX;
}
