/* implicit_order.c -- the matrix dR/da in doubles at the reference, and the search for its pivots. */
#include "mechanics/implicit_order.h"
#include "graph/hull.h"
#include "graph/tape.h"
#include "mechanics/balance.h"
#include <math.h>

#define LOST 1e-9 /* a pivot that is this small a part of what it was made of has cancelled */

typedef struct numbers {
  size_t n;
  double *a, *size; /* [n*n] by rows; [n*n] sums of the magnitudes that an entry was made of */
  bool *used;       /* [n] equations */
} numbers;

/* The value of a leaf at the reference; data at their midpoints, speeds and everything else at 0. */
static double value_of(const ambit_loops *loops, const ambit_graph *g, ambit_expr leaf) {
  const ambit_constraints *c = &loops->constraints;
  for (size_t j = 0; j < c->nq; j++)
    if (c->coordinate[j].q == leaf) return loops->reference[j];
  const ambit_node *node = ambit_graph_node(g, leaf);
  return ambit_leaf_is_uncertain(node->op) ? ambit_interval_mid(node->range) : 0;
}

/* Column j of the matrix, as the values with unknown j at 1 less those with all at 0. */
static void read_columns(const ambit_tape *t, size_t n, const uint32_t *place, ambit_interval *in, ambit_interval *slot,
    double *rest, numbers *m) {
  for (size_t j = 0; j <= n; j++) {
    if (j < n && place[j] == UINT32_MAX) continue;
    if (j < n) in[place[j]] = (ambit_interval) { 1, 1 };
    ambit_hull(t, in, slot);
    if (j < n) in[place[j]] = (ambit_interval) { 0, 0 };
    for (size_t i = 0; i < n; i++) {
      double x = ambit_interval_mid(slot[t->out[i]]);
      if (j < n)
        m->a[i * n + j] = x;
      else
        rest[i] = x;
    }
  }
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n && place[j] != UINT32_MAX; i++) {
      double x = m->a[i * n + j], error = 1e-12 * (fabs(x) + fabs(rest[i]));
      m->a[i * n + j] = fabs(x - rest[i]) > error ? x - rest[i] : 0;
      m->size[i * n + j] = fabs(m->a[i * n + j]);
    }
}

static ambit_status evaluate(const ambit_loops *loops, ambit_arena *arena, size_t n, const ambit_expr *e,
    const ambit_expr *unknown, numbers *m, ambit_failure *f) {
  ambit_graph *g = ambit_mechanism_graph(loops->constraints.mechanism);
  size_t nleaf = ambit_graph_leaves(g, n, e, 0, NULL);
  ambit_expr *leaf = ambit_expressions(arena, nleaf);
  ambit_interval *in = ambit_arena_alloc(arena, (nleaf + 1) * sizeof *in);
  uint32_t *place = ambit_arena_alloc(arena, n * sizeof *place);
  double *rest = ambit_arena_alloc(arena, n * sizeof *rest);
  if (!leaf || !in || !place || !rest) return ambit_no_memory(f);
  ambit_graph_leaves(g, n, e, nleaf, leaf);
  for (size_t k = 0; k < n; k++) place[k] = UINT32_MAX;
  for (size_t i = 0; i < nleaf; i++) {
    double x = value_of(loops, g, leaf[i]);
    in[i] = (ambit_interval) { x, x };
    for (size_t k = 0; k < n; k++)
      if (leaf[i] == unknown[k]) place[k] = (uint32_t)i;
  }
  const ambit_tape *tape;
  ambit_status status = ambit_tape_seal(g, arena, n, e, nleaf, leaf, 0, 0, &tape, f);
  if (status != AMBIT_OK) return status;
  ambit_interval *slot = ambit_arena_alloc(arena, (tape->nslot + 1) * sizeof *slot);
  if (!slot) return ambit_no_memory(f);
  read_columns(tape, n, place, in, slot, rest, m);
  return AMBIT_OK;
}

/* -- elimination */

static bool is_pivot(const numbers *m, size_t i, size_t j) {
  double x = fabs(m->a[i * m->n + j]);
  return x > 0 && x < INFINITY && x > LOST * m->size[i * m->n + j];
}

static void eliminate(numbers *m, size_t row, size_t column) {
  size_t n = m->n;
  m->used[row] = true;
  for (size_t i = 0; i < n; i++) {
    if (m->used[i] || m->a[i * n + column] == 0) continue;
    double factor = m->a[i * n + column] / m->a[row * n + column];
    for (size_t j = 0; j < n; j++) {
      m->a[i * n + j] -= factor * m->a[row * n + j];
      m->size[i * n + j] += fabs(factor * m->a[row * n + j]);
    }
    m->a[i * n + column] = 0;
  }
}

/* The next unknown, a place in order[k..n), and its equation: the first that has a pivot in its own; else the largest
** entry of the first. */
static size_t choose(const numbers *m, size_t k, const uint32_t *order, size_t *row) {
  for (size_t i = k; i < m->n; i++)
    if (!m->used[order[i]] && is_pivot(m, order[i], order[i])) {
      *row = order[i];
      return i;
    }
  *row = m->n;
  for (size_t i = 0; i < m->n; i++)
    if (!m->used[i] && (*row == m->n || fabs(m->a[i * m->n + order[k]]) > fabs(m->a[*row * m->n + order[k]]))) *row = i;
  return k;
}

static void search(numbers *m, uint32_t *order, uint32_t *equation) {
  for (size_t k = 0; k < m->n; k++) {
    size_t row, at = choose(m, k, order, &row);
    uint32_t found = order[at];
    for (; at > k; at--) order[at] = order[at - 1]; /* the others keep their order */
    order[k] = found;
    equation[found] = (uint32_t)row;
    if (is_pivot(m, row, found))
      eliminate(m, row, found);
    else
      m->used[row] = true; /* singular at the reference: any order is as good */
  }
}

ambit_status ambit_implicit_order(const ambit_loops *loops, size_t n, const ambit_expr *e, const ambit_expr *unknown,
    uint32_t *order, uint32_t *equation, ambit_failure *f) {
  ambit_arena *arena = ambit_arena_open();
  numbers m = { .n = n };
  if (arena) m.a = ambit_arena_alloc(arena, n * n * sizeof *m.a);
  if (arena) m.size = ambit_arena_alloc(arena, n * n * sizeof *m.size);
  if (arena) m.used = ambit_arena_alloc(arena, n * sizeof *m.used);
  ambit_status status = m.a && m.size && m.used ? evaluate(loops, arena, n, e, unknown, &m, f) : ambit_no_memory(f);
  if (status == AMBIT_OK) search(&m, order, equation);
  ambit_arena_close(arena);
  return status;
}
