/* element_kit_points.c -- at random points, with enclosures: what must vanish contains 0 everywhere, and is narrow at
** one point at least (a point may be close to a singular position of the element, and says little then).
*/
#include "graph/tape.h"
#include "kit/element_kit_inside.h"
#include "graph/hull.h"
#include <math.h>
#include <stdlib.h>

#define POINTS 5
#define CLOSE 2        /* of these lie close to rest, */
#define REST 0x1p-12   /* within this, of either sign */
#define TOLERANCE 1e-8 /* of residuals of numbers of ordinary size */
#define NORM_MAX 16
#define NORM_SLACK 0x1p-51 /* a normalised vector of doubles is that close to a unit one, in each component */

/* The variables of a row that holds by itself are a unit vector: around the random point as thin a box as certainly
** contains one.
*/
static void put_on_norm(element_kit *k, ambit_expr row, size_t n, const ambit_expr *leaf, ambit_interval *in) {
  ambit_expr own[NORM_MAX];
  size_t count = ambit_graph_leaves(k->graph, 1, &row, NORM_MAX, own);
  double square = 0;
  for (int pass = 0; count <= NORM_MAX && pass < 2; pass++)
    for (size_t c = 0; c < count; c++)
      for (size_t i = 0; i < n; i++) {
        if (leaf[i] != own[c]) continue;
        double x = in[i].lo / sqrt(square);
        if (pass == 0)
          square += in[i].lo * in[i].lo;
        else
          in[i] = (ambit_interval) { x - NORM_SLACK, x + NORM_SLACK };
      }
}

static void put_on_norms(element_kit *k, size_t n, const ambit_expr *leaf, ambit_interval *in) {
  uint32_t row = 0;
  for (uint32_t i = 0; i < k->element->nport; i++) {
    const ambit_port *p = &k->element->port[i];
    if (p->kind != AMBIT_PORT_CONSTRAINT) continue;
    const ambit_expr *g = element_kit_ask(k, k->part, i, AMBIT_RESIDUAL);
    for (uint32_t c = 0; g && c < p->dof; c++)
      if (element_kit_multiplier(k, row + c) == 0) put_on_norm(k, g[c], n, leaf, in);
    row += p->dof;
  }
}

static void choose_point(element_kit *k, size_t n, const ambit_expr *leaf, ambit_interval *in, double scale) {
  for (size_t i = 0; i < n; i++) {
    const ambit_node *x = ambit_graph_node(k->graph, leaf[i]);
    ambit_interval range = x->op == AMBIT_LEAF_UNKNOWN ? x->value : (ambit_interval) { -1.5, 1.5 };
    double v = ambit_random_in(&k->random, range) * (x->op == AMBIT_LEAF_UNKNOWN ? 1 : scale);
    in[i] = (ambit_interval) { v, v };
  }
  put_on_norms(k, n, leaf, in);
}

static void compare(element_kit *k, const ambit_tape *tape, const ambit_interval *slot, bool *narrow) {
  for (size_t i = 0; i < k->nresidual; i++) {
    ambit_interval x = slot[tape->out[i]];
    k->report->compared++;
    narrow[i] = narrow[i] || x.hi - x.lo < TOLERANCE;
    if (!(x.lo <= 0 && x.hi >= 0))
      element_kit_complain(k, "%s is wrong: the difference is [%.3e, %.3e]%s", k->about[i], x.lo, x.hi,
          k->moving ? " (parameters move)" : "");
  }
}

void element_kit_evaluate(element_kit *k) {
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  size_t n = ambit_graph_leaves(k->graph, k->nresidual, k->residual, 0, NULL);
  ambit_expr *leaf = calloc(n + 1, sizeof *leaf);
  ambit_interval *in = calloc(n + 1, sizeof *in);
  ambit_graph_leaves(k->graph, k->nresidual, k->residual, n, leaf);
  if (ambit_tape_seal(k->graph, arena, k->nresidual, k->residual, n, leaf, 0, 0, &tape, &f) != AMBIT_OK)
    element_kit_complain(k, "%s", f.message);
  ambit_interval *slot = f.status == AMBIT_OK ? calloc(tape->nslot + 1, sizeof *slot) : NULL;
  bool *narrow = calloc(k->nresidual + 1, sizeof *narrow);
  for (int point = 0; slot && point < POINTS; point++) {
    choose_point(k, n, leaf, in, point < POINTS - CLOSE ? 1 : REST);
    ambit_hull(tape, in, slot);
    compare(k, tape, slot, narrow);
  }
  for (size_t i = 0; slot && i < k->nresidual; i++)
    if (!narrow[i]) element_kit_complain(k, "%s cannot be checked: the difference is never narrow", k->about[i]);
  free(narrow);
  free(slot);
  free(in);
  free(leaf);
  ambit_arena_close(arena);
}
