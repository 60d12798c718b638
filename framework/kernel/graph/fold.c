/* fold.c -- the entry of all operations; coefficients, signs and the canonical order of operands.
**
** Every rule is an identity of real functions on the domain of what it replaces, and does not enlarge that domain,
** except by points where a part known to be total was removed. Proofs: docs/numerics/folding.md.
*/
#include "graph/fold.h"
#include "graph/kink.h"
#include "num/interval.h"

bool ambit_fold_exact(uint32_t op, double a, double b, double *r) {
  ambit_interval x, p = { a, a }, q = { b, b };
  uint32_t flags = ambit_interval_op(op, &x, p, q);
  *r = x.lo;
  return flags == 0 && ambit_interval_is_point(x);
}

bool ambit_fold_exact_power(double a, int32_t n, double *r) {
  ambit_interval x;
  uint32_t flags = ambit_interval_pown(&x, (ambit_interval) { a, a }, n);
  *r = x.lo;
  return flags == 0 && ambit_interval_is_point(x);
}

/* Exact constants, then other constants, then the rest. */
static uint32_t rank(const ambit_graph *g, ambit_expr e) {
  if (ambit_is_exact(g, e)) return 0;
  return ambit_at(g, e)->constant ? 1 : 2;
}

bool ambit_fold_precedes(const ambit_graph *g, ambit_expr a, ambit_expr b) {
  uint32_t p = rank(g, a), q = rank(g, b);
  return p != q ? p < q : ambit_store_order(g, a, b) < 0;
}

ambit_term ambit_fold_split(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  if (ambit_is_exact(g, e)) return (ambit_term) { x->value.lo, AMBIT_ONE };
  if (x->op == AMBIT_OP_NEG) return (ambit_term) { -1, x->a };
  if (x->op == AMBIT_OP_MUL && ambit_is_exact(g, x->a)) return (ambit_term) { ambit_at(g, x->a)->value.lo, x->b };
  return (ambit_term) { 1, e };
}

ambit_expr ambit_fold_scale(ambit_graph *g, double c, ambit_expr body) {
  if (body == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  if (c == 1) return body;
  if (c == -1) return ambit_fold_negate(g, body);
  if (body == AMBIT_ONE) return ambit_graph_number(g, c);
  if (c == 0 && ambit_at(g, body)->total) return AMBIT_ZERO;
  ambit_term inner = ambit_fold_split(g, body);
  double product;
  if (inner.c != 1 && ambit_fold_exact(AMBIT_OP_MUL, c, inner.c, &product))
    return ambit_fold_scale(g, product, inner.body);
  const ambit_node *x = ambit_at(g, body);
  if (x->op == AMBIT_OP_DIV && ambit_is_exact(g, x->b) &&
      ambit_fold_exact(AMBIT_OP_DIV, c, ambit_at(g, x->b)->value.lo, &product))
    return ambit_fold_scale(g, product, x->a); /* c (a / b) = (c / b) a */
  return ambit_store_make(g, AMBIT_OP_MUL, ambit_graph_number(g, c), body);
}

ambit_expr ambit_fold_negate(ambit_graph *g, ambit_expr a) {
  if (a == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  const ambit_node *x = ambit_at(g, a);
  if (ambit_is_exact(g, a)) return ambit_graph_number(g, -x->value.lo);
  if (x->op == AMBIT_OP_NEG) return x->a;
  if (x->op == AMBIT_OP_SUB) return ambit_store_make(g, AMBIT_OP_SUB, x->b, x->a);
  ambit_term t = ambit_fold_split(g, a);
  if (t.c == -1) return t.body;
  if (t.c != 1) return ambit_store_make(g, AMBIT_OP_MUL, ambit_graph_number(g, -t.c), t.body);
  return ambit_store_make(g, AMBIT_OP_NEG, a, a);
}

bool ambit_fold_is_negative(const ambit_graph *g, ambit_expr e) { return ambit_fold_split(g, e).c < 0; }

static bool fold_constants(const ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b, double *r) {
  if (!ambit_is_exact(g, a) || !ambit_is_exact(g, b)) return false;
  return ambit_fold_exact(op, ambit_at(g, a)->value.lo, ambit_at(g, b)->value.lo, r);
}

/* e answers an operation on a and b, before which there were so many nodes. */
static ambit_expr counted(ambit_graph *g, size_t before, ambit_expr a, ambit_expr b, ambit_expr e) {
  if (e == AMBIT_NO_EXPR) return e;
  g->tally.asked++;
  if (e == a || e == b || ambit_at(g, e)->op == AMBIT_LEAF_CONSTANT)
    g->tally.folded++;
  else if (e < before)
    g->tally.shared++;
  return e;
}

ambit_graph_tally ambit_graph_answers(const ambit_graph *g) { return g->tally; }

static ambit_expr fold(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  double c;
  if (fold_constants(g, op, a, b, &c)) return ambit_graph_number(g, c);
  switch (op) {
  case AMBIT_OP_ADD: return ambit_fold_sum(g, a, b, false);
  case AMBIT_OP_SUB: return ambit_fold_sum(g, a, b, true);
  case AMBIT_OP_NEG: return ambit_fold_negate(g, a);
  case AMBIT_OP_MUL: return ambit_fold_product(g, a, b);
  case AMBIT_OP_DIV: return ambit_fold_quotient(g, a, b);
  case AMBIT_OP_SQR: return ambit_fold_power(g, a, 2);
  case AMBIT_OP_ATAN2:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return ambit_fold_pair(g, op, a, b);
  default: return ambit_op_is_binary(op) ? ambit_store_make(g, op, a, b) : ambit_fold_function(g, op, a);
  }
}

ambit_expr ambit_graph_op(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  if (op == AMBIT_OP_POWN) return ambit_graph_pown(g, a, (int32_t)b);
  if (op >= AMBIT_OP_COUNT && !ambit_op_is_function(op)) return AMBIT_NO_EXPR;
  if (!ambit_op_is_binary(op)) b = a;
  if (a >= g->count || b >= g->count) return AMBIT_NO_EXPR;
  size_t before = g->count;
  return counted(g, before, a, b, fold(g, op, a, b));
}

ambit_expr ambit_graph_pown(ambit_graph *g, ambit_expr a, int32_t n) {
  if (a >= g->count) return AMBIT_NO_EXPR;
  size_t before = g->count;
  return counted(g, before, a, a, ambit_fold_power(g, a, n));
}

ambit_expr ambit_store_rebuild(ambit_graph *g, ambit_expr e, ambit_expr a, ambit_expr b) {
  uint32_t op = ambit_at(g, e)->op;
  if (op == AMBIT_OP_POWN) return ambit_graph_pown(g, a, (int32_t)ambit_at(g, e)->b);
  if (!ambit_op_has_kink(op) && ambit_at(g, e)->total) return ambit_graph_op(g, op, a, b);
  const char *other = ambit_graph_written_by(g, ambit_graph_writer(g, e));
  ambit_expr rebuilt = ambit_graph_op(g, op, a, b);
  ambit_graph_written_by(g, other);
  return rebuilt;
}
