/* element_kit_points.c -- at random points, with enclosures: what must vanish contains 0 everywhere, and is narrow at
** one point at least (a point may be close to a singular position of the element, and says little then). Then at points
** close to each kink (abs, min, max), on both sides of it. A derivative knows nothing of the kink itself: there, what
** was differentiated may not jump, so its difference between the sides must shrink as they come together.
*/
#include "graph/hull.h"
#include "graph/kink.h"
#include "graph/tape.h"
#include "graph/walk.h"
#include "kit/element_kit_inside.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POINTS 5
#define CLOSE 2        /* of these lie close to rest, */
#define REST 0x1p-12   /* within this, of either sign */
#define TOLERANCE 1e-8 /* of residuals of numbers of ordinary size */
#define SWITCHES 16    /* kinks that are looked for */
#define TRIES 20       /* of random points, for one on each side of a kink */
#define HALVINGS 30    /* of the way between them */
#define SHRUNK 0x1p-8  /* what 30 halvings leave of the largest difference at most, */
#define STEEP 1e-6     /* or of numbers of ordinary size */
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

/* -- kinks */

/* What changes its sign at a kink: the operand of abs, the difference of those of min and max. */
static size_t find_switches(element_kit *k, ambit_expr *e) {
  ambit_walk walk;
  size_t n = 0;
  if (!ambit_walk_open(k->graph, k->nresidual, k->residual, NULL, &walk)) return 0;
  for (size_t i = 0; i < walk.count && n < SWITCHES; i++) {
    const ambit_node x = *ambit_graph_node(k->graph, walk.node[i]);
    if (ambit_op_has_kink(x.op)) e[n++] = x.op == AMBIT_OP_ABS ? x.a : kit_subtract(k, x.a, x.b);
  }
  ambit_walk_close(&walk);
  return n;
}

typedef struct search {
  element_kit *k;
  const ambit_tape *tape;
  size_t n; /* leaves */
  const ambit_expr *leaf;
  ambit_interval *in, *slot, *side[2]; /* side: points below and above a kink */
  size_t first;                        /* output that is the first of what was differentiated */
  double *value[2], *most;             /* that, on the sides, and the largest difference so far */
} search;

/* -1, 1: the sign of output `out` at s->in; 0: not known */
static int sign_at(const search *s, size_t out) {
  ambit_hull(s->tape, s->in, s->slot);
  ambit_interval x = s->slot[s->tape->out[out]];
  return x.hi < 0 ? -1 : x.lo > 0 ? 1 : 0;
}

static bool find_sides(search *s, size_t out) {
  bool has[2] = { false, false };
  for (int i = 0; i < TRIES && !(has[0] && has[1]); i++) {
    choose_point(s->k, s->n, s->leaf, s->in, 1);
    int sign = sign_at(s, out);
    if (sign == 0) continue;
    memcpy(s->side[sign > 0], s->in, s->n * sizeof *s->in);
    has[sign > 0] = true;
  }
  return has[0] && has[1];
}

static void look(search *s, int side) {
  ambit_hull(s->tape, s->side[side], s->slot);
  for (size_t i = 0; i < s->k->nfollowed; i++) {
    ambit_interval x = s->slot[s->tape->out[s->first + i]];
    s->value[side][i] = x.hi - x.lo < TOLERANCE ? 0.5 * x.lo + 0.5 * x.hi : NAN;
  }
}

static double difference(const search *s, size_t i) { return fabs(s->value[1][i] - s->value[0][i]); }

static void note_differences(search *s) {
  for (size_t i = 0; i < s->k->nfollowed; i++) s->most[i] = fmax(s->most[i], difference(s, i));
}

static void check_jumps(const search *s) {
  for (size_t i = 0; i < s->k->nfollowed; i++) {
    s->k->report->compared++;
    if (difference(s, i) > SHRUNK * s->most[i] + STEEP * (1 + fabs(s->value[0][i])))
      element_kit_complain(s->k, "energy, momentum or motion jumps by %.3e at a kink", difference(s, i));
  }
}

/* Halves the way between the sides, then compares on both. */
static void try_kink(search *s, size_t out, bool *narrow) {
  if (!find_sides(s, out)) return;
  memset(s->most, 0, s->k->nfollowed * sizeof *s->most);
  for (int i = 0; i < 2; i++) look(s, i);
  note_differences(s);
  for (int i = 0; i < HALVINGS; i++) {
    for (size_t j = 0; j < s->n; j++) {
      double v = 0.5 * s->side[0][j].lo + 0.5 * s->side[1][j].lo;
      s->in[j] = (ambit_interval) { v, v };
    }
    put_on_norms(s->k, s->n, s->leaf, s->in);
    int sign = sign_at(s, out);
    if (sign == 0) break;
    memcpy(s->side[sign > 0], s->in, s->n * sizeof *s->in);
    look(s, sign > 0);
    note_differences(s);
  }
  check_jumps(s);
  for (int i = 0; i < 2; i++) {
    ambit_hull(s->tape, s->side[i], s->slot);
    compare(s->k, s->tape, s->slot, narrow);
  }
}

static void try_kinks(search *s, size_t count, bool *narrow) {
  size_t room = s->k->nfollowed + 1;
  for (int i = 0; i < 2; i++) {
    s->side[i] = calloc(s->n + 1, sizeof *s->side[i]);
    s->value[i] = calloc(room, sizeof *s->value[i]);
  }
  s->most = calloc(room, sizeof *s->most);
  for (size_t i = 0; i < count; i++) try_kink(s, s->k->nresidual + i, narrow);
  for (int i = 0; i < 2; i++) free(s->side[i]), free(s->value[i]);
  free(s->most);
}

void element_kit_evaluate(element_kit *k) {
  ambit_failure f = { 0 };
  ambit_arena *arena = ambit_arena_open();
  const ambit_tape *tape;
  ambit_expr all[2 * ELEMENT_KIT_RESIDUALS + SWITCHES];
  size_t nswitch = find_switches(k, all + k->nresidual), nall = k->nresidual + nswitch;
  memcpy(all, k->residual, k->nresidual * sizeof *all);
  size_t first = nall, more = nswitch ? k->nfollowed : 0; /* where nothing has kinks, nothing is to be followed */
  memcpy(all + first, k->followed, more * sizeof *all);
  nall += more;
  size_t n = ambit_graph_leaves(k->graph, nall, all, 0, NULL);
  ambit_expr *leaf = calloc(n + 1, sizeof *leaf);
  ambit_interval *in = calloc(n + 1, sizeof *in);
  ambit_graph_leaves(k->graph, nall, all, n, leaf);
  if (ambit_tape_seal(k->graph, arena, nall, all, n, leaf, 0, 0, &tape, &f) != AMBIT_OK)
    element_kit_complain(k, "%s", f.message);
  ambit_interval *slot = f.status == AMBIT_OK ? calloc(tape->nslot + 1, sizeof *slot) : NULL;
  bool *narrow = calloc(k->nresidual + 1, sizeof *narrow);
  for (int point = 0; slot && point < POINTS; point++) {
    choose_point(k, n, leaf, in, point < POINTS - CLOSE ? 1 : REST);
    ambit_hull(tape, in, slot);
    compare(k, tape, slot, narrow);
  }
  search s = { .k = k, .tape = tape, .n = n, .leaf = leaf, .in = in, .slot = slot, .first = first };
  if (slot && nswitch) try_kinks(&s, nswitch, narrow);
  for (size_t i = 0; slot && i < k->nresidual; i++)
    if (!narrow[i]) element_kit_complain(k, "%s cannot be checked: the difference is never narrow", k->about[i]);
  free(narrow);
  free(slot);
  free(in);
  free(leaf);
  ambit_arena_close(arena);
}
