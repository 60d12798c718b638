/* collect.c -- mark from the holders, then sweep over the numbers. */
#include "graph/collect.h"
#include "base/vector.h"
#include "graph/store.h"
#include <stdlib.h>

void ambit_graph_hold(ambit_graph *g, ambit_holder *holder) {
  holder->next = g->holders;
  holder->link = &g->holders;
  if (g->holders) g->holders->link = &holder->next;
  g->holders = holder;
}

void ambit_graph_release(ambit_holder *holder) {
  if (!holder->link) return;
  *holder->link = holder->next;
  if (holder->next) holder->next->link = holder->link;
  holder->link = NULL;
}

/* -- marking: the stack holds nodes whose operands may not be marked yet */

static void reach(ambit_graph *g, ambit_expr e) {
  ambit_store_expect(g, e);
  if (g->stored[e].mark == g->collection) return;
  g->stored[e].mark = g->collection;
  if (ambit_op_is_leaf(g->stored[e].node.op)) return;
  ambit_expr *stack = ambit_vector_reserve(g->to_mark, &g->to_mark_capacity, g->to_mark_count + 1, sizeof *stack);
  if (!stack) {
    g->mark_failed = true;
    return;
  }
  g->to_mark = stack;
  stack[g->to_mark_count++] = e;
}

void ambit_graph_mark(ambit_graph *g, size_t n, const ambit_expr *e) {
  for (size_t i = 0; i < n; i++)
    if (e[i] != AMBIT_NO_EXPR) reach(g, e[i]);
  while (g->to_mark_count > 0 && !g->mark_failed) {
    const ambit_node *x = ambit_at(g, g->to_mark[--g->to_mark_count]);
    reach(g, x->a);
    if (ambit_op_is_binary(x->op)) reach(g, x->b);
  }
}

static bool mark_all(ambit_graph *g) {
  static const ambit_expr fixed[] = { AMBIT_ZERO, AMBIT_ONE };
  g->collection++;
  g->to_mark_count = 0;
  g->mark_failed = false;
  ambit_graph_mark(g, 2, fixed);
  ambit_graph_mark(g, 1, &g->pi);
  ambit_graph_mark(g, 1, &g->time);
  for (ambit_holder *h = g->holders; h; h = h->next) h->mark(h, g);
  return !g->mark_failed;
}

/* -- sweeping */

/* Numbers behind the last living node are given up, those between living ones are listed, the smallest first. */
static void sweep(ambit_graph *g) {
  g->living = 0;
  g->unused = AMBIT_NO_EXPR;
  size_t end = g->count; /* behind the last living node */
  while (g->stored[end - 1].mark != g->collection) ambit_store_clear(&g->stored[--end]);
  if (!g->forced) g->count = end;
  for (size_t i = end; i-- > 0;) {
    ambit_stored *x = &g->stored[i];
    if (x->mark == g->collection) {
      g->living++;
      continue;
    }
    ambit_store_clear(x);
    if (g->forced) continue;
    x->node.a = g->unused;
    g->unused = (ambit_expr)i;
  }
}

void ambit_graph_collect(ambit_graph *g) {
  if (mark_all(g)) {
    sweep(g);
    ambit_store_tidy(g);
  }
  g->collected_at = g->made;
  g->due = g->living < AMBIT_COLLECT_LEAST / 2 ? AMBIT_COLLECT_LEAST : 2 * (size_t)g->living;
}

bool ambit_graph_is_due(const ambit_graph *g) {
  return g->living >= g->due || (g->forced && g->made - g->collected_at >= g->forced);
}

void ambit_graph_hasten(ambit_graph *g) { g->due = 0; }

void ambit_graph_postpone(ambit_graph *g) { g->due = g->living + g->living / 4 + AMBIT_COLLECT_LEAST / 4; }
void ambit_graph_collect_always(ambit_graph *g, uint64_t nodes) { g->forced = nodes; }
uint32_t ambit_graph_living(const ambit_graph *g) { return g->living; }
