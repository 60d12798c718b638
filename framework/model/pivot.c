/* pivot.c -- an analytic function that is not identically zero vanishes on a set of measure zero, so a few random
** points tell. The answer only chooses between an early message and a run that finds out by itself; no proof rests on
** it.
*/
#include "model/pivot.h"
#include "graph/tape.h"
#include "model/hull.h"
#include "model/random.h"
#include <stdlib.h>

#define POINTS 8

static bool contains_zero_everywhere(
    const ambit_graph *g, const ambit_tape *t, const ambit_expr *leaf, ambit_interval *in, ambit_interval *slot) {
  ambit_random random = { 1 };
  for (int point = 0; point < POINTS; point++) {
    for (uint32_t i = 0; i < t->nin; i++) {
      ambit_interval range = ambit_graph_node(g, leaf[i])->range;
      double x = ambit_random_in(&random, ambit_interval_intersect(range, (ambit_interval) { -3, 3 }));
      if (!ambit_interval_contains(range, x)) x = ambit_interval_mid(range);
      in[i] = (ambit_interval) { x, x };
    }
    ambit_hull(t, in, slot);
    ambit_interval e = slot[t->out[0]];
    if (e.lo > 0 || e.hi < 0) return false; /* an empty one too */
  }
  return true;
}

bool ambit_pivot_vanishes(ambit_graph *g, ambit_expr e) {
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape = NULL;
  size_t n = ambit_graph_leaves(g, 1, &e, 0, NULL);
  ambit_expr *leaf = calloc(n + 1, sizeof *leaf);
  ambit_interval *in = calloc(n + 1, sizeof *in), *slot = NULL;
  bool ready = arena && leaf && in;
  if (ready) ambit_graph_leaves(g, 1, &e, n, leaf);
  ready = ready && ambit_tape_seal(g, arena, 1, &e, n, leaf, 0, 0, &tape, NULL) == AMBIT_OK;
  if (ready) slot = calloc(tape->nslot + 1, sizeof *slot);
  bool vanishes = slot && contains_zero_everywhere(g, tape, leaf, in, slot);
  free(slot);
  free(in);
  free(leaf);
  ambit_arena_close(arena);
  return vanishes;
}
