/* expand.c -- counts how many summands each node would have, chooses, and writes out what was chosen. */
#include "algebra/expand.h"
#include "algebra/polynomial.h"
#include "algebra/summands.h"
#include "graph/walk.h"
#include <stdlib.h>

#define LIMIT_MAX 100000u

/* The summands of e at the top, where they are in the walk, and which of them are written out. */
typedef struct expander {
  ambit_ring ring;
  ambit_walk walk;
  size_t *count;           /* [walk.count] summands of the node when written out, at most */
  bool *atom, *wanted;     /* [walk.count] */
  ambit_polynomial *value; /* [walk.count] of what is wanted */
  ambit_summands top;
  uint32_t *place; /* [top.n] */
  bool *chosen;    /* [top.n] */
} expander;

static bool is_power(const ambit_node *x) { return x->op == AMBIT_OP_POWN && (int32_t)x->b > 1; }

/* Is the node an atom in any case? A sum of constants is one coefficient. */
static bool stops(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  return x->constant || !(ambit_op_is_sum(x->op) || x->op == AMBIT_OP_NEG || x->op == AMBIT_OP_MUL ||
                            x->op == AMBIT_OP_DIV || x->op == AMBIT_OP_SQR || is_power(x));
}

/* What is more than the limit becomes an atom. All counts are at most LIMIT_MAX: no product overflows. */
static void count_node(expander *x, size_t i) {
  const ambit_node *node = ambit_at(x->ring.g, x->walk.node[i]);
  size_t a = x->count[x->walk.a[i]], b = x->count[x->walk.b[i]], n = 1;
  x->atom[i] = stops(x->ring.g, x->walk.node[i]);
  if (x->atom[i])
    n = 1;
  else if (ambit_op_is_sum(node->op))
    n = a + b;
  else if (node->op == AMBIT_OP_MUL)
    n = a * b;
  else if (node->op == AMBIT_OP_SQR)
    n = a * a;
  else if (is_power(node))
    for (uint32_t k = 0; k < node->b && n <= x->ring.limit && a > 1; k++) n *= a;
  else
    n = a; /* NEG, DIV */
  if (n > x->ring.limit) x->atom[i] = true;
  x->count[i] = x->atom[i] ? 1 : n;
}

/* 1/b as an atom */
static ambit_polynomial reciprocal(ambit_ring *ring, ambit_expr b) {
  bool constant = ambit_at(ring->g, b)->constant;
  ambit_expr e =
      constant ? ambit_fold_quotient(ring->g, AMBIT_ONE, b) : ambit_store_make(ring->g, AMBIT_OP_DIV, AMBIT_ONE, b);
  return ambit_polynomial_of(ring, e);
}

static ambit_polynomial write_node(expander *x, size_t i) {
  ambit_ring *ring = &x->ring;
  ambit_expr e = x->walk.node[i];
  const ambit_node node = *ambit_at(ring->g, e);
  ambit_polynomial a = x->value[x->walk.a[i]], b = x->value[x->walk.b[i]], none = { 0, NULL };
  if (x->atom[i]) return ambit_polynomial_of(ring, e);
  switch (node.op) {
  case AMBIT_OP_MUL: return ambit_polynomial_multiply(ring, a, b);
  case AMBIT_OP_DIV: return ambit_polynomial_multiply(ring, a, reciprocal(ring, node.b));
  case AMBIT_OP_SQR: return ambit_polynomial_power(ring, a, 2);
  case AMBIT_OP_POWN: return ambit_polynomial_power(ring, a, node.b);
  case AMBIT_OP_NEG: return ambit_polynomial_add(ring, none, a, true);
  default: return ambit_polynomial_add(ring, a, b, node.op == AMBIT_OP_SUB);
  }
}

static void write_out(expander *x) {
  for (size_t i = x->walk.count; i-- > 0;) {
    if (!x->wanted[i] || x->atom[i]) continue;
    x->wanted[x->walk.a[i]] = true;
    if (ambit_at(x->ring.g, x->walk.node[i])->op != AMBIT_OP_DIV) x->wanted[x->walk.b[i]] = true;
  }
  for (size_t i = 0; i < x->walk.count && !x->ring.failed; i++)
    if (x->wanted[i]) x->value[i] = write_node(x, i);
}

/* False: no summand is written out. The others are products, or atoms if they would have too many. */
static bool choose(expander *x) {
  bool any = false;
  size_t room = x->ring.limit > x->top.n ? x->ring.limit - x->top.n : 0;
  for (size_t i = 0; i < x->top.n; i++) {
    size_t n = x->count[x->place[i]];
    x->chosen[i] = n - 1 <= room;
    if (!x->chosen[i]) continue;
    room -= n - 1;
    x->wanted[x->place[i]] = true;
    any = any || n > 1;
  }
  return any;
}

static ambit_polynomial collect(expander *x) {
  ambit_ring *ring = &x->ring;
  ambit_polynomial sum = { 0, NULL };
  for (size_t i = 0; i < x->top.n && !ring->failed; i++) {
    ambit_term t = x->top.term[i];
    ambit_polynomial c = ambit_polynomial_of(ring, ambit_graph_number(ring->g, t.c));
    ambit_polynomial p = x->chosen[i] ? x->value[x->place[i]] : ambit_polynomial_of(ring, t.body);
    sum = ambit_polynomial_add(ring, sum, ambit_polynomial_multiply(ring, c, p), false);
  }
  return sum;
}

static bool prepare(expander *x) {
  size_t n = x->top.n;
  ambit_expr *body = malloc((n + 1) * sizeof *body);
  for (size_t i = 0; i < n && body; i++) body[i] = x->top.term[i].body;
  bool done = body && ambit_walk_open(x->ring.g, n, body, stops, &x->walk);
  x->place = calloc(n + 1, sizeof *x->place);
  x->chosen = calloc(n + 1, sizeof *x->chosen);
  x->count = calloc(x->walk.count + 1, sizeof *x->count);
  x->atom = calloc(x->walk.count + 1, sizeof *x->atom);
  x->wanted = calloc(x->walk.count + 1, sizeof *x->wanted);
  x->value = calloc(x->walk.count + 1, sizeof *x->value);
  x->ring.arena = ambit_arena_open();
  done = done && x->place && x->chosen && x->count && x->atom && x->wanted && x->value && x->ring.arena;
  for (size_t i = 0; i < n && done; i++) x->place[i] = ambit_walk_find(x->ring.g, body[i]);
  free(body);
  return done;
}

static void clear(expander *x) {
  ambit_arena_close(x->ring.arena);
  free(x->value);
  free(x->wanted);
  free(x->atom);
  free(x->count);
  free(x->chosen);
  free(x->place);
  ambit_walk_close(&x->walk);
  ambit_summands_close(&x->top);
}

ambit_expr ambit_graph_expand(ambit_graph *g, ambit_expr e, size_t limit) {
  if (limit == 0) return e;
  expander x = { .ring = { .g = g, .limit = limit < LIMIT_MAX ? limit : LIMIT_MAX } };
  ambit_expr expanded = e;
  bool ready = ambit_summands_read(g, e, &x.top, NULL) == AMBIT_OK && prepare(&x);
  for (size_t i = 0; ready && i < x.walk.count; i++) count_node(&x, i);
  if (ready && choose(&x)) {
    write_out(&x);
    ambit_polynomial sum = collect(&x);
    bool keeps = !x.ring.failed && ambit_polynomial_keeps(&x.ring, sum);
    if (keeps) expanded = ambit_polynomial_expanded(&x.ring, sum);
  }
  clear(&x);
  return expanded == AMBIT_NO_EXPR ? e : expanded;
}
