/* substitute.c -- leaves, or kinks, replaced all at once; every node is rebuilt at most once, by the folding
** operations.
*/
#include "graph/kink.h"
#include "graph/store.h"
#include "graph/walk.h"
#include <stdlib.h>

static ambit_expr rebuild(ambit_graph *g, ambit_expr e, ambit_expr a, ambit_expr b) {
  const ambit_node x = *ambit_at(g, e);
  bool binary = ambit_op_is_binary(x.op);
  if (ambit_op_is_leaf(x.op) || (a == x.a && (!binary || b == x.b))) return e;
  return ambit_store_rebuild(g, e, a, b);
}

static ambit_expr root_of_square(ambit_graph *g, ambit_expr a) {
  ambit_expr square = ambit_graph_op(g, AMBIT_OP_SQR, a, a);
  return ambit_graph_op(g, AMBIT_OP_SQRT, square, square);
}

/* |a|, or max(a, b) = (a + b + |a - b|) / 2 */
static ambit_expr as_root(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  if (op == AMBIT_OP_ABS) return root_of_square(g, a);
  ambit_expr apart = root_of_square(g, ambit_graph_op(g, AMBIT_OP_SUB, a, b)),
             sum = ambit_graph_op(g, AMBIT_OP_ADD, a, b);
  ambit_expr twice = ambit_graph_op(g, op == AMBIT_OP_MIN ? AMBIT_OP_SUB : AMBIT_OP_ADD, sum, apart);
  return ambit_graph_op(g, AMBIT_OP_MUL, ambit_graph_number(g, 0.5), twice);
}

/* e[i], already positions in the walk, become expressions; roots: kinks are replaced, too. */
static bool replace(ambit_graph *g, const ambit_walk *walk, bool roots, ambit_expr *now) {
  for (size_t i = 0; i < walk->count; i++) {
    if (now[i] != AMBIT_NO_EXPR) continue;
    ambit_expr a = now[walk->a[i]], b = now[walk->b[i]];
    uint32_t op = ambit_at(g, walk->node[i])->op;
    now[i] = roots && ambit_op_has_kink(op) ? as_root(g, op, a, b) : rebuild(g, walk->node[i], a, b);
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
    done = replace(g, &walk, false, now);
  }
  for (size_t i = 0; i < ne && done; i++) e[i] = now[position[i]];
  free(now);
  free(position);
  ambit_walk_close(&walk);
  return done ? AMBIT_OK : no_memory(f);
}

ambit_expr ambit_graph_kinks_as_roots(ambit_graph *g, ambit_expr e) {
  ambit_walk walk;
  if (!ambit_walk_open(g, 1, &e, NULL, &walk)) return AMBIT_NO_EXPR;
  ambit_expr *now = malloc((walk.count + 1) * sizeof *now);
  for (size_t i = 0; now && i < walk.count; i++) now[i] = AMBIT_NO_EXPR;
  uint32_t at = ambit_walk_find(g, e);
  ambit_expr result = now && replace(g, &walk, true, now) ? now[at] : AMBIT_NO_EXPR;
  free(now);
  ambit_walk_close(&walk);
  return result;
}
