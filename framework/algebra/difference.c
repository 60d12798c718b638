/* difference.c -- the pairs below u and w, each solved once, operands first, on a stack of its own. */
#include "algebra/difference.h"
#include "base/vector.h"
#include "algebra/difference_pair.h"
#include "graph/series_lowering.h"
#include "graph/walk.h"
#include <stdlib.h>

/* -- pairs by their expressions */

static size_t place_of(const ambit_pairs *p, ambit_expr u, ambit_expr w) {
  uint64_t h = ((uint64_t)u << 32 | w) * 0x9e3779b97f4a7c15u;
  size_t mask = p->table_size - 1, at = (size_t)(h >> 32) & mask;
  while (p->table[at] != AMBIT_NO_PAIR && (p->pair[p->table[at]].u != u || p->pair[p->table[at]].w != w))
    at = (at + 1) & mask;
  return at;
}

static bool grow_table(ambit_pairs *p) {
  size_t size = p->table_size ? 2 * p->table_size : 64;
  uint32_t *table = malloc(size * sizeof *table);
  if (!table) return false;
  for (size_t i = 0; i < size; i++) table[i] = AMBIT_NO_PAIR;
  free(p->table);
  p->table = table;
  p->table_size = size;
  for (size_t i = 0; i < p->npair; i++) p->table[place_of(p, p->pair[i].u, p->pair[i].w)] = (uint32_t)i;
  return true;
}

uint32_t ambit_pairs_find(ambit_pairs *p, ambit_expr u, ambit_expr w) {
  if (2 * (p->npair + 1) > p->table_size && !grow_table(p)) return AMBIT_NO_PAIR;
  size_t at = place_of(p, u, w);
  if (p->table[at] != AMBIT_NO_PAIR) return p->table[at];
  ambit_pair *pair = ambit_vector_reserve(p->pair, &p->pair_capacity, p->npair + 1, sizeof *pair);
  if (!pair) return AMBIT_NO_PAIR;
  p->pair = pair;
  pair[p->npair] = (ambit_pair) { .u = u, .w = w, .result = AMBIT_NO_EXPR, .state = PAIR_NEW };
  return p->table[at] = (uint32_t)p->npair++;
}

bool ambit_pairs_link(ambit_pairs *p, ambit_pair_link link) {
  ambit_pair_link *grown = ambit_vector_reserve(p->link, &p->link_capacity, p->nlink + 1, sizeof *grown);
  if (!grown) return false;
  p->link = grown;
  grown[p->nlink++] = link;
  return true;
}

/* -- one after the other */

typedef struct pair_stack {
  uint32_t *at;
  size_t depth, capacity;
} pair_stack;

static bool push(pair_stack *s, uint32_t at) {
  uint32_t *grown = ambit_vector_reserve(s->at, &s->capacity, s->depth + 1, sizeof *grown);
  if (!grown) return false;
  s->at = grown;
  grown[s->depth++] = at;
  return true;
}

static bool push_links(const ambit_pairs *p, pair_stack *s, uint32_t at) {
  const ambit_pair *pair = &p->pair[at];
  for (size_t i = 0; i < pair->count; i++) {
    uint32_t below = p->link[pair->first + i].pair;
    if (below != AMBIT_NO_PAIR && p->pair[below].state != PAIR_SOLVED && !push(s, below)) return false;
  }
  return true;
}

static bool solve(ambit_pairs *p, pair_stack *s, uint32_t root) {
  if (!push(s, root)) return false;
  while (s->depth) {
    uint32_t at = s->at[s->depth - 1];
    if (p->pair[at].state == PAIR_SOLVED) {
      s->depth--;
    } else if (p->pair[at].state == PAIR_NEW) {
      if (!ambit_pair_plan(p, at) || !push_links(p, s, at)) return false;
    } else {
      ambit_expr result = ambit_pair_solve(p, &p->pair[at]);
      if (result == AMBIT_NO_EXPR) return false;
      p->pair[at].result = result;
      p->pair[at].state = PAIR_SOLVED;
    }
  }
  return true;
}

/* -- everything at x - d */

static bool shift(ambit_pairs *p, const ambit_walk *walk, size_t n, const ambit_expr *leaf, const ambit_expr *delta) {
  for (size_t k = n; k-- > 0;) { /* of a leaf listed twice, the first counts */
    p->shifted[leaf[k]] = ambit_fold_sum(p->g, leaf[k], delta[k], true);
    if (p->shifted[leaf[k]] == AMBIT_NO_EXPR) return false;
  }
  for (size_t i = 0; i < walk->count; i++) {
    ambit_expr e = walk->node[i];
    ambit_node x = *ambit_at(p->g, e);
    if (ambit_op_is_leaf(x.op)) {
      if (p->shifted[e] == AMBIT_NO_EXPR) p->shifted[e] = e;
      continue;
    }
    bool binary = ambit_op_is_binary(x.op);
    ambit_expr a = p->shifted[x.a], b = binary ? p->shifted[x.b] : x.b;
    if (a == AMBIT_NO_EXPR || (binary && b == AMBIT_NO_EXPR)) return false;
    p->shifted[e] = a == x.a && b == x.b ? e : ambit_store_rebuild(p->g, e, a, b);
  }
  return true;
}

static bool open_pairs(
    ambit_pairs *p, size_t n, const ambit_expr *root, size_t nleaf, const ambit_expr *leaf, const ambit_expr *delta) {
  ambit_walk walk;
  if (!ambit_walk_open(p->g, n, root, NULL, &walk)) return false;
  p->nodes = p->g->count;
  p->shifted = malloc(p->nodes * sizeof *p->shifted);
  bool done = p->shifted != NULL;
  for (size_t i = 0; i < p->nodes && done; i++) p->shifted[i] = i <= AMBIT_ONE ? (ambit_expr)i : AMBIT_NO_EXPR;
  done = done && shift(p, &walk, nleaf, leaf, delta);
  ambit_walk_close(&walk);
  return done;
}

/* A leaf's own difference is its delta. */
static bool seed(ambit_pairs *p, size_t n, const ambit_expr *leaf, const ambit_expr *delta) {
  for (size_t k = 0; k < n; k++) {
    uint32_t at = ambit_pairs_find(p, leaf[k], leaf[k]);
    if (at == AMBIT_NO_PAIR) return false;
    if (p->pair[at].state != PAIR_SOLVED) p->pair[at].result = delta[k];
    p->pair[at].state = PAIR_SOLVED;
  }
  return true;
}

static bool solve_all(ambit_pairs *p, size_t n, const ambit_expr *u, const ambit_expr *w, ambit_expr *out) {
  pair_stack stack = { 0 };
  bool done = true;
  for (size_t i = 0; i < n && done; i++) {
    uint32_t at = ambit_pairs_find(p, u[i], w[i]);
    done = at != AMBIT_NO_PAIR && solve(p, &stack, at);
    if (done) out[i] = p->pair[at].result;
  }
  free(stack.at);
  return done;
}

static ambit_status check(const ambit_graph *g, size_t n, const ambit_expr *e, bool leaves, ambit_failure *f) {
  for (size_t i = 0; i < n; i++) {
    if (e[i] >= g->count) return ambit_fail(f, AMBIT_INVALID, "a difference of or by something that is no expression");
    uint32_t op = ambit_at(g, e[i])->op;
    if (leaves && op != AMBIT_LEAF_SYMBOL && !ambit_leaf_is_uncertain(op) && op != AMBIT_LEAF_TIME)
      return ambit_fail(
          f, AMBIT_INVALID, "a difference by something that is neither a variable nor an uncertain datum");
  }
  return AMBIT_OK;
}

ambit_status ambit_graph_difference(ambit_graph *g, size_t n, const ambit_expr *u, const ambit_expr *w, size_t nleaf,
    const ambit_expr *leaf, const ambit_expr *delta, bool clamps, ambit_expr *out, ambit_failure *f) {
  ambit_status status = check(g, n, u, false, f);
  if (status == AMBIT_OK) status = check(g, n, w, false, f);
  if (status == AMBIT_OK) status = check(g, nleaf, leaf, true, f);
  if (status == AMBIT_OK) status = check(g, nleaf, delta, false, f);
  if (status != AMBIT_OK || n == 0) return status;
  ambit_pairs p = { .g = g, .clamps = clamps };
  ambit_expr *root = malloc(2 * n * sizeof *root);
  for (size_t i = 0; i < n && root; i++) root[i] = u[i], root[n + i] = w[i];
  bool done = root && ambit_functions_write(g, 2 * n, root) && open_pairs(&p, 2 * n, root, nleaf, leaf, delta) &&
              seed(&p, nleaf, leaf, delta) && solve_all(&p, n, root, root + n, out);
  free(root), free(p.shifted), free(p.pair), free(p.link), free(p.table);
  return done ? AMBIT_OK : ambit_fail(f, AMBIT_NOMEM, "out of memory while subtracting models");
}
