/* term_tree_rewrite.c -- an equation with some of its terms replaced, operands first, without recursion.
**
** A listed sum is rebuilt from its terms, everything else from its operands, and only if something below changed. A sum
** node counts as that sum only where it is maximal: below another sum the same node is a partial sum, whose terms
** belong to the greater one. So a node has two values, by where it stands.
*/
#include "base/vector.h"
#include "algebra/node_map.h"
#include "algebra/summands.h"
#include "algebra/term_tree.h"
#include <stdlib.h>

/* A node where it stands: 2 * node, + 1 below a sum. */
typedef uint32_t place;

typedef struct rewriter {
  ambit_graph *g;
  const ambit_term_tree *tree;
  ambit_expr *by; /* [nterm] the replacement, or NO_EXPR */
  /* of the present equation */
  ambit_node_map value; /* by place: 1 + the expression */
  ambit_node_map sum;   /* by node: 1 + the number of the listed sum that it is */
  ambit_expr *scratch;  /* [2 * nterm] */
  place *stack;
  size_t depth, capacity;
} rewriter;

static bool passes(uint32_t op) { return ambit_op_is_sum(op) || op == AMBIT_OP_NEG; }

static place place_of(const ambit_graph *g, ambit_expr e, bool below) {
  return 2 * e + (below && passes(ambit_at(g, e)->op));
}

/* Where the operands of a node stand. */
static bool is_below(const ambit_graph *g, place p) {
  uint32_t op = ambit_at(g, (ambit_expr)(p / 2))->op;
  return ambit_op_is_sum(op) || (op == AMBIT_OP_NEG && p % 2);
}

static const ambit_tree_sum *listed(const rewriter *r, place p) {
  uint32_t sum = p % 2 ? 0 : ambit_node_map_get(&r->sum, p / 2);
  return sum ? &r->tree->sum[sum - 1] : NULL;
}

static bool is_settled(const rewriter *r, place p) { return ambit_node_map_get(&r->value, p) != 0; }

/* Its value is needed. */
static bool ask(rewriter *r, place p) {
  if (is_settled(r, p)) return true;
  place *stack = ambit_vector_reserve(r->stack, &r->capacity, r->depth + 1, sizeof *stack);
  if (!stack) return false;
  r->stack = stack;
  stack[r->depth++] = p;
  return true;
}

static bool ask_below(rewriter *r, place p) {
  const ambit_tree_sum *sum = listed(r, p);
  for (uint32_t k = 0; sum && k < sum->count; k++)
    if (r->by[sum->first + k] == AMBIT_NO_EXPR && !ask(r, place_of(r->g, r->tree->term[sum->first + k].e, false)))
      return false;
  const ambit_node *x = ambit_at(r->g, (ambit_expr)(p / 2));
  if (sum || ambit_op_is_leaf(x->op)) return true;
  bool below = is_below(r->g, p);
  if (ambit_op_is_binary(x->op) && !ask(r, place_of(r->g, x->b, below))) return false;
  return ask(r, place_of(r->g, x->a, below));
}

static ambit_expr value_of(const rewriter *r, ambit_expr e, bool below) {
  return ambit_node_map_get(&r->value, place_of(r->g, e, below)) - 1;
}

static ambit_expr term_value(const rewriter *r, uint32_t k) {
  return r->by[k] != AMBIT_NO_EXPR ? r->by[k] : value_of(r, r->tree->term[k].e, false);
}

static ambit_expr rebuild_sum(rewriter *r, const ambit_tree_sum *sum) {
  ambit_expr *old = r->scratch, *now = old + sum->count;
  bool changed = false;
  for (uint32_t k = 0; k < sum->count; k++) {
    old[k] = r->tree->term[sum->first + k].e;
    now[k] = term_value(r, sum->first + k);
    changed = changed || now[k] != old[k];
    if (!sum->negative) continue;
    old[k] = ambit_fold_negate(r->g, old[k]);
    now[k] = ambit_fold_negate(r->g, now[k]);
  }
  return changed ? ambit_summands_replace(r->g, sum->node, sum->count, old, now) : sum->node;
}

static ambit_expr rebuild(rewriter *r, place p) {
  ambit_expr e = (ambit_expr)(p / 2);
  const ambit_tree_sum *sum = listed(r, p);
  if (sum) return rebuild_sum(r, sum);
  const ambit_node *x = ambit_at(r->g, e);
  if (ambit_op_is_leaf(x->op)) return e;
  bool below = is_below(r->g, p), binary = ambit_op_is_binary(x->op);
  ambit_expr a = value_of(r, x->a, below), b = binary ? value_of(r, x->b, below) : a;
  return a == x->a && (!binary || b == x->b) ? e : ambit_store_rebuild(r->g, e, a, b);
}

static ambit_expr settle(rewriter *r, ambit_expr root) {
  place top = place_of(r->g, root, false);
  r->depth = 0;
  if (!ask(r, top)) return AMBIT_NO_EXPR;
  while (r->depth > 0) {
    place p = r->stack[r->depth - 1];
    size_t depth = r->depth;
    if (!is_settled(r, p) && !ask_below(r, p)) return AMBIT_NO_EXPR;
    if (r->depth > depth) continue;
    r->depth--;
    if (is_settled(r, p)) continue;
    ambit_expr e = rebuild(r, p);
    uint32_t *value = e == AMBIT_NO_EXPR ? NULL : ambit_node_map_at(&r->value, p);
    if (!value) return AMBIT_NO_EXPR;
    *value = e + 1;
  }
  return ambit_node_map_get(&r->value, top) - 1;
}

/* A right-hand side that is no sum has one term at most, which is all of it. */
static ambit_expr settle_root(rewriter *r, const ambit_tree_sum *root) {
  bool is_sum = ambit_op_is_sum(ambit_at(r->g, root->node)->op);
  if (!is_sum && root->count == 0) return AMBIT_ZERO;
  if (!is_sum)
    return r->by[root->first] != AMBIT_NO_EXPR ? r->by[root->first] : settle(r, r->tree->term[root->first].e);
  ambit_expr e = settle(r, root->node);
  return root->negative ? ambit_fold_negate(r->g, e) : e;
}

/* The equation's right-hand side; some of its terms are replaced. */
static ambit_expr rewrite_equation(rewriter *r, uint32_t i, uint32_t whole) {
  const ambit_term_tree *tree = r->tree;
  if (r->by[whole] != AMBIT_NO_EXPR) return r->by[whole];
  ambit_node_map_close(&r->value);
  ambit_node_map_close(&r->sum);
  for (uint32_t k = tree->first_sum[i]; k < tree->first_sum[i + 1]; k++) {
    if (!ambit_op_is_sum(ambit_at(r->g, tree->sum[k].node)->op)) continue;
    uint32_t *sum = ambit_node_map_at(&r->sum, tree->sum[k].node);
    if (!sum) return AMBIT_NO_EXPR;
    *sum = k + 1;
  }
  ambit_expr e = settle_root(r, &tree->sum[tree->first_sum[i]]);
  return e == tree->expanded[i] ? tree->rate[i] : e;
}

static ambit_status read_replacements(
    rewriter *r, size_t n, const uint32_t *index, const ambit_expr *replacement, ambit_failure *f) {
  for (size_t k = 0; k < r->tree->nterm; k++) r->by[k] = AMBIT_NO_EXPR;
  for (size_t k = 0; k < n; k++) {
    if (index[k] >= r->tree->nterm)
      return ambit_fail(f, AMBIT_INVALID, "there is no term %zu: there are %zu", (size_t)index[k] + 1, r->tree->nterm);
    if (replacement[k] >= ambit_graph_count(r->g))
      return ambit_fail(f, AMBIT_INVALID, "the replacement of term %u is no expression", index[k] + 1);
    if (r->by[index[k]] != AMBIT_NO_EXPR)
      return ambit_fail(f, AMBIT_INVALID, "term %u is replaced twice", index[k] + 1);
    r->by[index[k]] = replacement[k];
  }
  return AMBIT_OK;
}

static ambit_status rewrite_equations(rewriter *r, ambit_expr *rate, ambit_failure *f) {
  const ambit_term_tree *tree = r->tree;
  for (size_t k = 0, end; k < tree->nterm; k = end) {
    uint32_t i = tree->term[k].equation;
    bool any = false;
    for (end = k; end < tree->nterm && tree->term[end].equation == i; end++) any = any || r->by[end] != AMBIT_NO_EXPR;
    rate[i] = any ? rewrite_equation(r, i, (uint32_t)k) : tree->rate[i];
    if (rate[i] == AMBIT_NO_EXPR) return ambit_fail(f, AMBIT_NOMEM, "out of memory while replacing terms");
  }
  return AMBIT_OK;
}

ambit_status ambit_term_tree_rewrite(ambit_graph *g, const ambit_term_tree *tree, size_t n, const uint32_t *index,
    const ambit_expr *replacement, ambit_expr *rate, ambit_failure *f) {
  rewriter r = { .g = g, .tree = tree };
  r.by = malloc((tree->nterm + 1) * sizeof *r.by);
  r.scratch = malloc((2 * tree->nterm + 1) * sizeof *r.scratch);
  ambit_status status = AMBIT_OK;
  if (!r.by || !r.scratch) status = ambit_fail(f, AMBIT_NOMEM, "out of memory while replacing terms");
  if (status == AMBIT_OK) status = read_replacements(&r, n, index, replacement, f);
  if (status == AMBIT_OK) status = rewrite_equations(&r, rate, f);
  free(r.by);
  free(r.scratch);
  ambit_node_map_close(&r.value);
  ambit_node_map_close(&r.sum);
  free(r.stack);
  return status;
}
