/* bound.c -- substitution, then the leaves. */
#include "verbs/evaluate/bound.h"
#include "verbs/run/unknowns.h"
#include <string.h>

static ambit_status substitute(const ambit_evaluate_request *q, ambit_arena *arena, ambit_bound *b, ambit_failure *f) {
  for (size_t i = 0; i < q->nexpr; i++)
    if (q->expr[i] == AMBIT_NO_EXPR) return ambit_fail(f, AMBIT_INVALID, "expression %zu is none", i + 1);
  b->expr = ambit_arena_alloc(arena, q->nexpr * sizeof *b->expr);
  if (!b->expr) return ambit_no_memory(f);
  if (q->nexpr) memcpy(b->expr, q->expr, q->nexpr * sizeof *b->expr);
  ambit_status status = AMBIT_OK;
  if (q->nbinding) status = ambit_graph_substitute(q->graph, q->nexpr, b->expr, q->nbinding, q->leaf, q->value, f);
  return status == AMBIT_OK ? ambit_unknowns_fold_points(q->graph, arena, q->nexpr, b->expr, f) : status;
}

ambit_status ambit_bound_build(const ambit_evaluate_request *q, ambit_arena *arena, ambit_bound *b, ambit_failure *f) {
  *b = (ambit_bound) { 0 };
  ambit_status status = substitute(q, arena, b, f);
  if (status == AMBIT_OK)
    status = ambit_unknowns_leaves(q->graph, arena, q->nexpr, b->expr, &b->nunknown, &b->unknown, f);
  if (status != AMBIT_OK) return status;
  char name[256];
  size_t others = ambit_unknowns_name_others(q->graph, b->nunknown, b->unknown, 0, NULL, name, sizeof name);
  if (others)
    return ambit_fail(
        f, AMBIT_INVALID, "%s %s no value; `at` gives values by name", name, others == 1 ? "has" : "have");
  return AMBIT_OK;
}
