/* substitute.c -- leaves replaced all at once; every node is rebuilt at most once, by the folding operations. */
#include "graph/store.h"
#include "graph/walk.h"
#include <stdlib.h>

static ambit_expr rebuild(ambit_graph *g, ambit_expr e, ambit_expr a, ambit_expr b) {
  const ambit_node x = *ambit_at(g, e);
  bool binary = ambit_op_is_binary(x.op);
  if (ambit_op_is_leaf(x.op) || (a == x.a && (!binary || b == x.b))) return e;
  return ambit_store_rebuild(g, e, a, b);
}

/* e[i], already positions in the walk, become expressions. */
static bool replace(ambit_graph *g, const ambit_walk *walk, ambit_expr *now) {
  for (size_t i = 0; i < walk->count; i++) {
    if (now[i] != AMBIT_NO_EXPR) continue;
    now[i] = rebuild(g, walk->node[i], now[walk->a[i]], now[walk->b[i]]);
    if (now[i] == AMBIT_NO_EXPR) return false;
  }
  return true;
}

static ambit_status no_memory(ambit_failure *f) {
  return ambit_fail(f, AMBIT_NOMEM, "out of memory while substituting");
}

static ambit_status check(const ambit_graph *g, size_t n, const ambit_expr *e, ambit_failure *f) {
  for (size_t i = 0; i < n; i++)
    if (e[i] >= g->count)
      return ambit_fail(f, AMBIT_INVALID, "a substitution of or by something that is no expression");
  return AMBIT_OK;
}

ambit_status ambit_graph_substitute(ambit_graph *g, size_t ne, ambit_expr *e, size_t n, const ambit_expr *from,
    const ambit_expr *to, ambit_failure *f) {
  ambit_status status = check(g, ne, e, f);
  if (status == AMBIT_OK) status = check(g, n, from, f);
  if (status == AMBIT_OK) status = check(g, n, to, f);
  if (status != AMBIT_OK) return status;
  ambit_walk walk;
  if (!ambit_walk_open(g, ne, e, NULL, &walk)) return no_memory(f);
  ambit_expr *now = malloc((walk.count + 1) * sizeof *now);
  uint32_t *position = malloc((ne + 1) * sizeof *position);
  bool done = now && position;
  if (done) {
    for (size_t i = 0; i < walk.count; i++) now[i] = AMBIT_NO_EXPR;
    for (size_t k = n; k-- > 0;) { /* of a leaf listed twice, the first counts */
      uint32_t at = ambit_walk_find(g, from[k]);
      if (at != UINT32_MAX) now[at] = to[k];
    }
    for (size_t i = 0; i < ne; i++) position[i] = ambit_walk_find(g, e[i]);
    done = replace(g, &walk, now);
  }
  for (size_t i = 0; i < ne && done; i++) e[i] = now[position[i]];
  free(now);
  free(position);
  ambit_walk_close(&walk);
  return done ? AMBIT_OK : no_memory(f);
}
