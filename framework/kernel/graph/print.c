/* print.c -- expressions as text, in room that is given.
**
** Writing stops when the room is used up; the full length is found by a pass over the nodes, since a graph with much
** sharing can stand for a text of astronomical length.
*/
#include "graph/writer.h"
#include "graph/walk.h"
#include <stdlib.h>
#include <string.h>

static size_t plus(size_t a, size_t b) { return a < SIZE_MAX - b ? a + b : SIZE_MAX; }

static size_t operand_length(const ambit_writer *w, ambit_expr e, size_t length, int place) {
  return ambit_writer_brackets(w, e, place) ? plus(length, 2) : length;
}

static size_t full_length(const ambit_writer *w, ambit_expr e) {
  ambit_walk walk;
  if (!ambit_walk_open(w->g, 1, &e, NULL, &walk)) return 0;
  size_t *length = malloc(walk.count * sizeof *length), total = 0;
  char buffer[AMBIT_LEAF_MAX];
  for (size_t i = 0; i < walk.count && length; i++) {
    const ambit_node *x = ambit_at(w->g, walk.node[i]);
    if (ambit_op_is_leaf(x->op)) {
      total = length[i] = strlen(ambit_leaf_text(w->g, walk.node[i], buffer));
      continue;
    }
    ambit_layout l = ambit_layout_infix(w, walk.node[i]);
    total = plus(strlen(l.head) + strlen(l.tail), operand_length(w, x->a, length[walk.a[i]], l.place_a));
    if (l.two) total = plus(plus(total, strlen(l.middle)), operand_length(w, x->b, length[walk.b[i]], l.place_b));
    length[i] = total;
  }
  free(length);
  ambit_walk_close(&walk);
  return total;
}

size_t ambit_graph_text(const ambit_graph *g, ambit_expr e, char *out, size_t room) {
  ambit_writer w = { .g = g, .style = &ambit_style_text, .out = out, .room = room };
  if (room > 0) ambit_writer_run(&w, e); /* out of memory: what was written so far */
  return full_length(&w, e);
}
