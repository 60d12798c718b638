/* kink.c -- the writers of non-smooth formulas; few of them, so that a sorted list is enough. */
#include "graph/kink.h"
#include "base/vector.h"
#include "graph/store.h"
#include <stdio.h>

#define FORMULA_MAX 60

const char *ambit_graph_written_by(ambit_graph *g, const char *maker) {
  const char *before = g->kinks.maker;
  g->kinks.maker = maker;
  return before;
}

const char *ambit_graph_writer(const ambit_graph *g, ambit_expr e) {
  size_t lo = 0, hi = g->kinks.count;
  while (lo < hi) {
    size_t mid = lo + (hi - lo) / 2;
    if (g->kinks.known[mid].e < e)
      lo = mid + 1;
    else
      hi = mid;
  }
  return lo < g->kinks.count && g->kinks.known[lo].e == e ? g->kinks.known[lo].maker : NULL;
}

bool ambit_kinks_note(ambit_graph *g, ambit_expr e) {
  ambit_kinks *k = &g->kinks;
  if (!k->maker) return true;
  const char *maker = ambit_arena_text(g->arena, k->maker);
  struct ambit_kink *known = ambit_vector_reserve(k->known, &k->capacity, k->count + 1, sizeof *known);
  if (!maker || !known) return false;
  k->known = known;
  known[k->count++] = (struct ambit_kink) { e, maker };
  return true;
}

const char *ambit_kink_text(const ambit_graph *g, ambit_expr e, ambit_arena *arena) {
  const char *writer = ambit_graph_writer(g, e);
  char formula[FORMULA_MAX + 1], text[256];
  size_t length = ambit_graph_text(g, e, formula, sizeof formula);
  snprintf(text, sizeof text, "%s%s%s%s", formula, length < sizeof formula ? "" : " ...", writer ? " of " : "",
      writer ? writer : "");
  return ambit_arena_text(arena, text);
}
