/* unknowns.c -- leaves below expressions. */
#include "verbs/run/unknowns.h"
#include <stdio.h>
#include <string.h>

#define NAMED_AT_MOST 4

ambit_status ambit_unknowns_leaves(const ambit_graph *g, ambit_arena *arena, size_t ne, const ambit_expr *e, size_t *n,
    ambit_expr **leaf, ambit_failure *f) {
  *n = ambit_graph_leaves(g, ne, e, 0, NULL);
  *leaf = ambit_arena_alloc(arena, *n * sizeof **leaf);
  if (!*leaf) return ambit_no_memory(f);
  ambit_graph_leaves(g, ne, e, *n, *leaf);
  return AMBIT_OK;
}

ambit_status ambit_unknowns_fold_points(
    ambit_graph *g, ambit_arena *arena, size_t ne, ambit_expr *e, ambit_failure *f) {
  size_t n, points = 0;
  ambit_expr *leaf;
  ambit_status status = ambit_unknowns_leaves(g, arena, ne, e, &n, &leaf, f);
  if (status != AMBIT_OK) return status;
  ambit_expr *number = ambit_arena_alloc(arena, n * sizeof *number);
  if (!number) return ambit_no_memory(f);
  for (size_t i = 0; i < n; i++) {
    const ambit_node *node = ambit_graph_node(g, leaf[i]);
    if (!ambit_leaf_is_uncertain(node->op) || !ambit_interval_is_point(node->value)) continue;
    number[points] = ambit_graph_number(g, node->value.lo);
    if (number[points] == AMBIT_NO_EXPR) return ambit_no_memory(f);
    leaf[points++] = leaf[i];
  }
  return points ? ambit_graph_substitute(g, ne, e, points, leaf, number, f) : AMBIT_OK;
}

static const char *leaf_name(const ambit_node *node) {
  if (node->op == AMBIT_LEAF_TIME) return "t";
  return node->text ? node->text : "?";
}

size_t ambit_unknowns_name_others(const ambit_graph *g, size_t n, const ambit_expr *leaf, size_t nallowed,
    const ambit_expr *allowed, char *out, size_t room) {
  size_t others = 0, used = 0;
  out[0] = '\0';
  for (size_t i = 0; i < n; i++) {
    const ambit_node *node = ambit_graph_node(g, leaf[i]);
    bool fits = ambit_leaf_is_uncertain(node->op);
    for (size_t k = 0; k < nallowed; k++) fits = fits || allowed[k] == leaf[i];
    if (fits) continue;
    if (others < NAMED_AT_MOST && used < room)
      used += (size_t)snprintf(out + used, room - used, "%s`%s`", others ? ", " : "", leaf_name(node));
    others++;
  }
  if (others > NAMED_AT_MOST && used < room) snprintf(out + used, room - used, " and %zu more", others - NAMED_AT_MOST);
  return others;
}
