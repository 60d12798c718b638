/* kink.c -- the writers of formulas with kinks or edges: texts of their nodes. */
#include "graph/kink.h"
#include "graph/store.h"
#include <stdio.h>

#define FORMULA_MAX 60

const char *ambit_graph_written_by(ambit_graph *g, const char *maker) {
  const char *before = g->maker;
  g->maker = maker;
  return before;
}

const char *ambit_graph_writer(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  return ambit_op_is_leaf(x->op) ? NULL : x->text;
}

const char *ambit_kink_text(const ambit_graph *g, ambit_expr e, ambit_arena *arena) {
  const char *writer = ambit_graph_writer(g, e);
  char formula[FORMULA_MAX + 1], text[256];
  size_t length = ambit_graph_text(g, e, formula, sizeof formula);
  snprintf(text, sizeof text, "%s%s%s%s", formula, length < sizeof formula ? "" : " ...", writer ? " of " : "",
      writer ? writer : "");
  return ambit_arena_text(arena, text);
}
