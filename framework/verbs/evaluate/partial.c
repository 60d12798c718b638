/* partial.c -- flags, operation by operation, carried on to the results. */
#include "verbs/evaluate/partial.h"
#include "graph/kink.h"
#include "graph/writer.h"
#include "graph/walk.h"
#include <stdio.h>
#include <string.h>

bool ambit_partial_possible(const ambit_partial *p) {
  bool possible = p->left;
  for (size_t i = 0; i < p->nexpr && !possible; i++) possible = !ambit_graph_node(p->graph, p->bound->expr[i])->total;
  return possible;
}

/* -- on the tape */

#define UNTAINTED UINT32_MAX

/* cause [nslot] := the first operation below that left its domain, or UNTAINTED */
static ambit_status trace(const ambit_partial *p, uint32_t *cause, ambit_failure *f) {
  const ambit_tape *t = p->tape;
  uint32_t *flags = ambit_arena_alloc(p->arena, (t->ninstr + 1) * sizeof *flags);
  if (!flags) return ambit_no_memory(f);
  for (uint32_t i = 0; i < t->nslot; i++) cause[i] = UNTAINTED;
  ambit_block_run_each(p->block, flags);
  for (uint32_t i = 0; i < t->ninstr; i++) {
    uint32_t below = cause[t->a[i]];
    if (below == UNTAINTED && t->op[i] != AMBIT_OP_POWN) below = cause[t->b[i]];
    cause[t->dst[i]] = below == UNTAINTED && flags[i] & AMBIT_F_PARTIAL ? t->op[i] : below;
  }
  return AMBIT_OK;
}

/* -- in the graph */

/* Constants that the tape computes itself raise flags of their own. */
static bool starts_taint(const ambit_partial *p, const ambit_node *x) {
  bool is_leaf = x->op == AMBIT_LEAF_UNKNOWN || x->op == AMBIT_LEAF_CONSTANT;
  return !x->total && (is_leaf || (x->constant && p->folded));
}

/* taint [walk->count]: by constants and data that are partial themselves */
static void spread(const ambit_partial *p, const ambit_walk *walk, bool *taint) {
  for (size_t i = 0; i < walk->count; i++) {
    const ambit_node *x = ambit_graph_node(p->graph, walk->node[i]);
    taint[i] = starts_taint(p, x);
    if (walk->a[i] != i) taint[i] = taint[i] || taint[walk->a[i]] || taint[walk->b[i]];
  }
}

/* The first node of this operation (UNTAINTED: of any) that may leave its domain though its operands do not. */
static ambit_expr find_blamed(const ambit_partial *p, const ambit_walk *walk, uint32_t op) {
  for (size_t i = 0; i < walk->count; i++) {
    const ambit_node *x = ambit_graph_node(p->graph, walk->node[i]);
    if (x->total || walk->a[i] == i || (op != UNTAINTED && x->op != op)) continue;
    const ambit_node *a = ambit_graph_node(p->graph, walk->node[walk->a[i]]);
    if (a->total && ambit_graph_node(p->graph, walk->node[walk->b[i]])->total) return walk->node[i];
  }
  return AMBIT_NO_EXPR;
}

static ambit_status tell(const ambit_partial *p, size_t i, uint32_t op, char blame[AMBIT_BLAME_MAX], ambit_failure *f) {
  ambit_walk walk;
  if (!ambit_walk_open(p->graph, 1, &p->bound->expr[i], NULL, &walk)) return ambit_no_memory(f);
  ambit_expr e = find_blamed(p, &walk, op);
  ambit_walk_close(&walk);
  const char *text =
      e == AMBIT_NO_EXPR ? (op == UNTAINTED ? "" : ambit_op_symbol(op)) : ambit_kink_text(p->graph, e, p->arena);
  snprintf(blame, AMBIT_BLAME_MAX, "%s", text ? text : "");
  return AMBIT_OK;
}

ambit_status ambit_partial_find(
    const ambit_partial *p, uint8_t *partial, char blame[AMBIT_BLAME_MAX], ambit_failure *f) {
  uint32_t *cause = ambit_arena_alloc(p->arena, (p->tape->nslot + 1) * sizeof *cause);
  ambit_walk walk;
  if (!cause) return ambit_no_memory(f);
  blame[0] = '\0';
  ambit_status status = p->left ? trace(p, cause, f) : AMBIT_OK;
  if (status != AMBIT_OK) return status;
  if (!ambit_walk_open(p->graph, p->nexpr, p->bound->expr, NULL, &walk)) return ambit_no_memory(f);
  bool *taint = ambit_arena_alloc(p->arena, walk.count + 1), some = false;
  if (taint) spread(p, &walk, taint);
  for (size_t i = 0; i < p->nexpr && taint; i++) {
    partial[i] = taint[ambit_walk_find(p->graph, p->bound->expr[i])];
    if (p->left && cause[p->tape->out[i]] != UNTAINTED) partial[i] = 1;
    some = some || partial[i];
  }
  ambit_walk_close(&walk);
  if (!taint) return ambit_no_memory(f);
  if (p->left && !some) memset(partial, 1, p->nexpr); /* seen only in the whole: then of any of them */
  for (size_t i = 0; i < p->nexpr; i++)
    if (partial[i]) return tell(p, i, p->left ? cause[p->tape->out[i]] : UNTAINTED, blame, f);
  return AMBIT_OK;
}
