/* summands.c -- occurrences counted from the root down; collection by sorting. */
#include "algebra/summands.h"
#include "base/vector.h"
#include "graph/walk.h"
#include <stdlib.h>
#include <string.h>

static bool passes(uint32_t op) { return ambit_op_is_sum(op) || op == AMBIT_OP_NEG; }
static bool stops(const ambit_graph *g, ambit_expr e) { return !passes(ambit_at(g, e)->op); }

void ambit_summands_close(ambit_summands *list) {
  free(list->term);
  *list = (ambit_summands) { 0 };
}

/* Appends c * e, not collected. False: out of memory. */
static bool append(const ambit_graph *g, ambit_summands *list, double c, ambit_expr e) {
  ambit_term *term = ambit_vector_reserve(list->term, &list->capacity, list->n + 1, sizeof *term);
  if (!term) return false;
  list->term = term;
  ambit_term t = ambit_fold_split(g, e);
  double product;
  bool exact = ambit_fold_exact(AMBIT_OP_MUL, c, t.c, &product);
  term[list->n++] = exact ? (ambit_term) { product, t.body } : (ambit_term) { c, e };
  return true;
}

typedef struct placed {
  ambit_term term;
  size_t place;
} placed;

static int by_body(const void *p, const void *q) {
  const placed *a = p, *b = q;
  if (a->term.body != b->term.body) return a->term.body < b->term.body ? -1 : 1;
  return a->place < b->place ? -1 : a->place > b->place;
}

static int by_place(const void *p, const void *q) {
  const placed *a = p, *b = q;
  return a->place < b->place ? -1 : a->place > b->place;
}

/* Takes `next` into `last`, if their sum is a summand as they are: exact, of the same domain, no sum itself. */
static bool take(const ambit_graph *g, ambit_term *last, ambit_term next) {
  double c;
  if (last->body != next.body || !ambit_fold_exact(AMBIT_OP_ADD, last->c, next.c, &c)) return false;
  if (ambit_op_is_sum(ambit_at(g, next.body)->op) && fabs(c) == 1) return false;
  last->c = c;
  return true;
}

static bool collect(const ambit_graph *g, ambit_summands *list) {
  if (list->n == 0) return true;
  placed *all = malloc(list->n * sizeof *all);
  if (!all) return false;
  for (size_t i = 0; i < list->n; i++) all[i] = (placed) { list->term[i], i };
  qsort(all, list->n, sizeof *all, by_body);
  size_t n = 0;
  for (size_t i = 0; i < list->n; i++)
    if (n == 0 || !take(g, &all[n - 1].term, all[i].term)) all[n++] = all[i];
  qsort(all, n, sizeof *all, by_place);
  list->n = 0;
  for (size_t i = 0; i < n; i++) {
    ambit_term t = all[i].term;
    if (t.c != 0 || !ambit_at(g, t.body)->total) list->term[list->n++] = t;
  }
  free(all);
  return true;
}

/* How often each node of the walk, whose last one is the sum, is added. False: not exact. */
static bool count(const ambit_graph *g, const ambit_walk *walk, double *times) {
  memset(times, 0, walk->count * sizeof *times);
  times[walk->count - 1] = 1;
  bool exact = true;
  for (size_t i = walk->count; i-- > 0 && exact;) {
    uint32_t op = ambit_at(g, walk->node[i])->op;
    double *a = &times[walk->a[i]], *b = &times[walk->b[i]];
    if (!passes(op)) continue;
    exact = ambit_fold_exact(op == AMBIT_OP_NEG ? AMBIT_OP_SUB : AMBIT_OP_ADD, *a, times[i], a);
    if (exact && ambit_op_is_sum(op)) exact = ambit_fold_exact(op, *b, times[i], b);
  }
  return exact;
}

static bool list_leaves(const ambit_graph *g, const ambit_walk *walk, const double *times, ambit_summands *list) {
  for (size_t i = 0; i < walk->count; i++)
    if (stops(g, walk->node[i]) && !append(g, list, times[i], walk->node[i])) return false;
  return collect(g, list);
}

ambit_status ambit_summands_read(const ambit_graph *g, ambit_expr e, ambit_summands *list, ambit_failure *f) {
  *list = (ambit_summands) { 0 };
  ambit_walk walk;
  ambit_status status = AMBIT_OK;
  if (!ambit_walk_open(g, 1, &e, stops, &walk)) return ambit_no_memory(f);
  double *times = malloc(walk.count * sizeof *times);
  if (times && !count(g, &walk, times))
    status = ambit_fail(f, AMBIT_INVALID, "a term is repeated so often in a sum that its factor is no double");
  else if (!times || !list_leaves(g, &walk, times, list))
    status = ambit_no_memory(f);
  free(times);
  ambit_walk_close(&walk);
  return status;
}

ambit_expr ambit_summand_expression(ambit_graph *g, ambit_term t) { return ambit_fold_scale(g, t.c, t.body); }

/* Does the tree have just the n summands, each once? Then the leaves of the walk are the list, in order. */
static bool is_plain(const ambit_graph *g, const ambit_walk *walk, double *times, size_t n) {
  size_t leaves = 0;
  bool once = count(g, walk, times);
  for (size_t i = 0; i < walk->count && once; i++) {
    if (!stops(g, walk->node[i])) continue;
    leaves++;
    once = fabs(times[i]) == 1;
  }
  return once && leaves == n;
}

static ambit_expr rebuild(ambit_graph *g, const ambit_walk *walk, size_t i, const ambit_expr *now) {
  const ambit_node *x = ambit_at(g, walk->node[i]);
  ambit_expr a = now[walk->a[i]], b = now[walk->b[i]];
  bool same = a == x->a && (x->op == AMBIT_OP_NEG || b == x->b);
  return same ? walk->node[i] : ambit_store_rebuild(g, walk->node[i], a, b);
}

/* Along the tree; times: how often (1, -1) each node is added. */
static ambit_expr replace_leaves(ambit_graph *g, const ambit_walk *walk, const double *times, ambit_expr *now,
    const ambit_expr *old, const ambit_expr *value) {
  size_t next = 0;
  for (size_t i = 0; i < walk->count; i++) {
    ambit_expr e = walk->node[i];
    if (!stops(g, e)) {
      now[i] = rebuild(g, walk, i, now);
    } else {
      ambit_expr to = times[i] < 0 ? ambit_fold_negate(g, value[next]) : value[next];
      now[i] = old[next] == value[next] ? e : to;
      next++;
    }
    if (now[i] == AMBIT_NO_EXPR) return now[i];
  }
  return now[walk->count - 1];
}

ambit_expr ambit_summands_replace(
    ambit_graph *g, ambit_expr e, size_t n, const ambit_expr *old, const ambit_expr *value) {
  ambit_walk walk;
  if (!ambit_walk_open(g, 1, &e, stops, &walk)) return AMBIT_NO_EXPR;
  double *times = malloc(walk.count * sizeof *times);
  ambit_expr *now = malloc(walk.count * sizeof *now), sum = AMBIT_NO_EXPR;
  if (times && now && is_plain(g, &walk, times, n)) {
    sum = replace_leaves(g, &walk, times, now, old, value);
  } else if (times && now) {
    sum = AMBIT_ZERO;
    for (size_t i = 0; i < n; i++) sum = ambit_fold_sum(g, sum, value[i], false);
  }
  free(times);
  free(now);
  ambit_walk_close(&walk);
  return sum;
}
