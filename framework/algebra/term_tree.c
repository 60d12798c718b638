/* term_tree.c -- breadth first from each right-hand side; per equation every node is looked at once.
**
** Terms are treated in the order of their levels. The inside of a term is searched down to its maximal sums; a node
** that was searched before, from a term of the same or a smaller level, holds no sum that is new or would get a smaller
** level, so it is skipped.
*/
#include "algebra/term_tree.h"
#include "base/vector.h"
#include "algebra/expand.h"
#include "algebra/node_map.h"
#include "algebra/summands.h"
#include <stdlib.h>
#include <string.h>

typedef struct builder {
  ambit_graph *g;
  ambit_term_tree *tree;
  ambit_node_map seen; /* equation + 1 that has met the node */
  ambit_expr *stack;
  size_t depth, stack_capacity;
} builder;

static ambit_status no_memory(ambit_failure *f) { return ambit_fail(f, AMBIT_NOMEM, "out of memory for terms"); }

/* Is it the first time that this equation meets e? */
static bool meet(builder *b, uint32_t equation, ambit_expr e, bool *first) {
  uint32_t *seen = ambit_node_map_at(&b->seen, e);
  if (!seen) return false;
  *first = *seen != equation + 1;
  *seen = equation + 1;
  return true;
}

static bool add_term(ambit_term_tree *tree, ambit_tree_term term) {
  ambit_tree_term *grown = ambit_vector_reserve(tree->term, &tree->term_capacity, tree->nterm + 1, sizeof *grown);
  if (!grown) return false;
  tree->term = grown;
  grown[tree->nterm++] = term;
  return term.e != AMBIT_NO_EXPR;
}

static bool list_summands(builder *b, const ambit_summands *list, ambit_tree_term as, bool negative) {
  for (size_t i = 0; i < list->n; i++) {
    as.e = ambit_summand_expression(b->g, list->term[i]);
    if (negative && as.e != AMBIT_NO_EXPR) as.e = ambit_fold_negate(b->g, as.e);
    if (!add_term(b->tree, as)) return false;
  }
  return true;
}

/* Lists the sum's terms, each as `as` but for its expression. */
static ambit_status add_sum(builder *b, ambit_expr node, bool negative, ambit_tree_term as, ambit_failure *f) {
  ambit_term_tree *tree = b->tree;
  ambit_summands list;
  ambit_status status = ambit_summands_read(b->g, node, &list, f);
  if (status == AMBIT_OK && list.n > AMBIT_TERM_TREE_MAX - tree->nterm)
    status = ambit_fail(f, AMBIT_INVALID, "more than %u terms up to level %u: ask for fewer levels, or expand less",
        AMBIT_TERM_TREE_MAX, as.level);
  ambit_tree_sum sum = { (uint32_t)tree->nterm, (uint32_t)list.n, node, negative };
  if (status == AMBIT_OK) {
    ambit_tree_sum *grown = ambit_vector_reserve(tree->sum, &tree->sum_capacity, tree->nsum + 1, sizeof *grown);
    if (grown) tree->sum = grown, grown[tree->nsum++] = sum;
    if (!grown || !list_summands(b, &list, as, negative)) status = no_memory(f);
  }
  ambit_summands_close(&list);
  return status;
}

static bool push(builder *b, uint32_t equation, ambit_expr e) {
  bool first;
  if (!meet(b, equation, e, &first)) return false;
  if (!first) return true;
  ambit_expr *stack = ambit_vector_reserve(b->stack, &b->stack_capacity, b->depth + 1, sizeof *stack);
  if (!stack) return false;
  b->stack = stack;
  stack[b->depth++] = e;
  return true;
}

/* The sums inside term `at` become its children, from left to right. */
static ambit_status search(builder *b, uint32_t at, ambit_failure *f) {
  ambit_tree_term outer = b->tree->term[at];
  ambit_tree_term as = { outer.equation, outer.level + 1, at, AMBIT_NO_EXPR };
  b->depth = 0;
  if (!push(b, as.equation, outer.e)) return no_memory(f);
  while (b->depth > 0) {
    ambit_expr e = b->stack[--b->depth];
    const ambit_node *x = ambit_at(b->g, e);
    if (ambit_op_is_leaf(x->op)) continue;
    if (ambit_op_is_sum(x->op)) {
      ambit_status status = add_sum(b, e, false, as, f);
      if (status != AMBIT_OK) return status;
      continue;
    }
    ambit_expr left = x->a;
    if (ambit_op_is_binary(x->op) && !push(b, as.equation, x->b)) return no_memory(f);
    if (!push(b, as.equation, left)) return no_memory(f);
  }
  return AMBIT_OK;
}

static ambit_status add_equation(builder *b, uint32_t i, ambit_failure *f) {
  ambit_term_tree *tree = b->tree;
  uint32_t whole = (uint32_t)tree->nterm;
  if (!add_term(tree, (ambit_tree_term) { i, 0, AMBIT_NO_TERM, tree->rate[i] })) return no_memory(f);
  if (tree->max_level == 0) return AMBIT_OK;
  ambit_expr root = tree->expanded[i];
  bool negative = ambit_at(b->g, root)->op == AMBIT_OP_NEG, first;
  if (negative) root = ambit_at(b->g, root)->a;
  if (ambit_op_is_sum(ambit_at(b->g, root)->op) && !meet(b, i, root, &first)) return no_memory(f);
  ambit_status status = add_sum(b, root, negative, (ambit_tree_term) { i, 1, whole, AMBIT_NO_EXPR }, f);
  for (size_t k = whole + 1; k < tree->nterm && status == AMBIT_OK && tree->term[k].level < tree->max_level; k++)
    status = search(b, (uint32_t)k, f);
  return status;
}

static ambit_status add_equations(builder *b, size_t expand_limit, ambit_failure *f) {
  ambit_term_tree *tree = b->tree;
  ambit_status status = AMBIT_OK;
  for (size_t i = 0; i < tree->nequation && status == AMBIT_OK; i++) {
    ambit_failure inner = { 0 };
    tree->first_sum[i] = (uint32_t)tree->nsum;
    tree->expanded[i] = ambit_graph_expand(b->g, tree->rate[i], expand_limit);
    status = add_equation(b, (uint32_t)i, &inner);
    if (status != AMBIT_OK) ambit_fail(f, status, "equation %zu: %s", i + 1, inner.message);
  }
  tree->first_sum[tree->nequation] = (uint32_t)tree->nsum;
  return status;
}

ambit_status ambit_term_tree_open(ambit_graph *g, size_t n, const ambit_expr *rate, uint32_t max_level,
    size_t expand_limit, ambit_term_tree *tree, ambit_failure *f) {
  *tree = (ambit_term_tree) { .max_level = max_level, .nequation = n };
  for (size_t i = 0; i < n; i++)
    if (rate[i] >= ambit_graph_count(g)) return ambit_fail(f, AMBIT_INVALID, "equation %zu is no expression", i + 1);
  tree->rate = calloc(2 * n + 1, sizeof *tree->rate);
  tree->first_sum = calloc(n + 1, sizeof *tree->first_sum);
  if (!tree->rate || !tree->first_sum) return no_memory(f);
  tree->expanded = tree->rate + n;
  if (n) memcpy(tree->rate, rate, n * sizeof *rate);
  builder b = { .g = g, .tree = tree };
  ambit_status status = add_equations(&b, expand_limit, f);
  ambit_node_map_close(&b.seen);
  free(b.stack);
  return status;
}

void ambit_term_tree_close(ambit_term_tree *tree) {
  free(tree->rate);
  free(tree->first_sum);
  free(tree->term);
  free(tree->sum);
  *tree = (ambit_term_tree) { 0 };
}
