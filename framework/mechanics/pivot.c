/* pivot.c -- an analytic function that is not identically zero vanishes on a set of measure zero, so a few random
** points tell. The answer only chooses between an early message and a run that finds out by itself; no proof rests on
** it.
*/
#include "mechanics/pivot.h"
#include "graph/tape.h"
#include "mechanics/balance.h"
#include "graph/hull.h"
#include "num/random.h"
#include <stdlib.h>

#define POINTS 8
#define NARROW 1e-6

typedef struct trial {
  const ambit_graph *g;
  size_t n;
  const ambit_tape *tape; /* outputs: e, then their scales if `scaled` */
  bool scaled;
  ambit_expr *leaf;
  ambit_interval *in, *slot;
  bool *nonzero; /* [n] told from zero at some point */
} trial;

static bool tells(const trial *t, size_t i) {
  ambit_interval e = t->slot[t->tape->out[i]];
  if (!t->scaled) return !ambit_interval_is_empty(e) && (e.lo > 0 || e.hi < 0);
  if (e.lo > 0 || e.hi < 0) return true; /* an empty one too */
  ambit_interval scale = t->slot[t->tape->out[t->n + i]];
  return !ambit_interval_is_bounded(e) || e.hi - e.lo > NARROW * fmax(fabs(scale.lo), fabs(scale.hi));
}

static void try_points(trial *t) {
  ambit_random random = { 1 };
  for (int point = 0; point < POINTS; point++) {
    for (uint32_t i = 0; i < t->tape->nin; i++) {
      ambit_interval range = ambit_graph_node(t->g, t->leaf[i])->range;
      double x = ambit_random_in(&random, ambit_interval_intersect(range, (ambit_interval) { -3, 3 }));
      if (!ambit_interval_contains(range, x)) x = ambit_interval_mid(range);
      t->in[i] = (ambit_interval) { x, x };
    }
    ambit_hull(t->tape, t->in, t->slot);
    for (size_t i = 0; i < t->n; i++) t->nonzero[i] = t->nonzero[i] || tells(t, i);
  }
}

/* nonzero[n]: is e[i] told from zero at some point? False: no memory to find out. */
static bool find_nonzero(ambit_graph *g, size_t n, const ambit_expr *e, const ambit_expr *scale, bool *nonzero) {
  size_t all = scale ? 2 * n : n;
  ambit_arena *arena = ambit_arena_open();
  ambit_expr *out = arena ? ambit_expressions(arena, all) : NULL;
  if (out) memcpy(out, e, n * sizeof *e);
  if (out && scale) memcpy(out + n, scale, n * sizeof *e);
  size_t nleaf = out ? ambit_graph_leaves(g, all, out, 0, NULL) : 0;
  trial t = { .g = g, .n = n, .scaled = scale != NULL, .nonzero = nonzero };
  if (out) t.leaf = ambit_expressions(arena, nleaf);
  if (out) t.in = ambit_arena_alloc(arena, (nleaf + 1) * sizeof *t.in);
  if (t.leaf && t.in) {
    ambit_graph_leaves(g, all, out, nleaf, t.leaf);
    if (ambit_tape_seal(g, arena, all, out, nleaf, t.leaf, 0, 0, &t.tape, NULL) == AMBIT_OK)
      t.slot = ambit_arena_alloc(arena, t.tape->nslot * sizeof *t.slot);
  }
  if (t.slot) try_points(&t);
  ambit_arena_close(arena);
  return t.slot != NULL;
}

/* Number of the first e that is (told from zero == `nonzero`); n: none. */
static size_t find_first(ambit_graph *g, size_t n, const ambit_expr *e, const ambit_expr *scale, bool nonzero) {
  bool *told = calloc(n + 1, sizeof *told);
  size_t first = n;
  if (told && find_nonzero(g, n, e, scale, told))
    for (first = 0; first < n && told[first] != nonzero;) first++;
  free(told);
  return first;
}

size_t ambit_pivot_first_nonzero(ambit_graph *g, size_t n, const ambit_expr *e) {
  return find_first(g, n, e, NULL, true);
}

ambit_status ambit_pivot_massless(const ambit_speed *speed, ambit_failure *f) {
  return ambit_fail(
      f, AMBIT_INVALID, "joint `%.*s` moves no mass: attach a body to what it carries", AMBIT_JOINT_NAME(speed));
}

ambit_status ambit_pivots_check(ambit_graph *g, size_t n, const ambit_speed *speed, const ambit_expr *pivot,
    const ambit_expr *scale, ambit_failure *f) {
  bool certain = true;
  for (size_t i = 0; i < n; i++) {
    if (pivot[i] == AMBIT_NO_EXPR) return ambit_no_memory(f);
    ambit_interval range = ambit_graph_node(g, pivot[i])->range;
    if (range.hi < 0)
      return ambit_fail(f, AMBIT_INVALID, "the mass matrix is not positive: joint `%.*s` moves a negative mass",
          AMBIT_JOINT_NAME(&speed[i]));
    certain = certain && range.lo > 0;
  }
  size_t i = certain ? n : find_first(g, n, pivot, scale, false);
  if (i == n) return AMBIT_OK;
  return ambit_fail(f, AMBIT_INVALID,
      "the mass matrix is singular in every position: joint `%.*s` moves no mass of its own",
      AMBIT_JOINT_NAME(&speed[i]));
}
