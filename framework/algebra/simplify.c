/* simplify.c -- the polynomial normal form of an expression over its non-polynomial parts, written back if that is
** shorter.
**
** Each node below e gets a polynomial: sums, products and powers are expanded, a / b is a times the atom 1/b,
** everything else is an atom whose operands have been simplified first. Candidates are the polynomial as it is and
** with sin^2 = 1 - cos^2 (or the reverse), each expanded and factored; the one with the fewest operations wins,
** provided it has fewer than e. All steps are identities on the domain of e, and none enlarges it (polynomial.h).
** Work is bounded by `limit`; beyond it e is returned.
*/
#include "graph/fold.h"
#include "algebra/polynomial.h"
#include "graph/walk.h"
#include <stdlib.h>

typedef struct simplifier {
  ambit_ring ring;
  ambit_walk walk;
  ambit_polynomial *value; /* [walk.count] */
  ambit_expr *settled;     /* [walk.count] the shortest form found; AMBIT_NO_EXPR: not asked for yet */
  size_t effort;           /* nodes looked at while measuring candidates */
} simplifier;

#define EFFORT_MAX 2000000u /* so that deeply nested functions do not take quadratic time */

typedef struct choice {
  ambit_expr best;
  size_t size;
} choice;

static void consider(ambit_graph *g, choice *c, ambit_expr e) {
  if (e == AMBIT_NO_EXPR) return;
  size_t size = ambit_graph_size(g, 1, &e);
  if (size < c->size) *c = (choice) { e, size };
}

/* Both ways of writing p. A failure here only loses the candidate. */
static void consider_polynomial(ambit_ring *ring, choice *c, ambit_polynomial p) {
  bool keeps = !ring->failed && ambit_polynomial_keeps(ring, p);
  if (keeps) consider(ring->g, c, ambit_polynomial_expanded(ring, p));
  if (keeps) consider(ring->g, c, ambit_polynomial_factored(ring, p));
  ring->failed = false;
}

static bool has_square(const ambit_graph *g, ambit_polynomial p, uint32_t op) {
  for (size_t i = 0; i < p.n; i++)
    for (uint32_t k = 0; k < p.term[i].n; k++)
      if (p.term[i].power[k].n >= 2 && ambit_at(g, p.term[i].power[k].atom)->op == op) return true;
  return false;
}

static ambit_expr settle(simplifier *s, uint32_t i) {
  if (s->settled[i] != AMBIT_NO_EXPR) return s->settled[i];
  ambit_graph *g = s->ring.g;
  ambit_expr e = s->walk.node[i];
  if (s->effort > EFFORT_MAX) return s->settled[i] = e;
  choice c = { e, ambit_graph_size(g, 1, &e) };
  s->effort += 1 + c.size;
  if (c.size > 0) {
    consider_polynomial(&s->ring, &c, s->value[i]);
    static const uint32_t function[] = { AMBIT_OP_SIN, AMBIT_OP_COS };
    for (size_t k = 0; k < 2; k++)
      if (has_square(g, s->value[i], function[k]))
        consider_polynomial(&s->ring, &c, ambit_polynomial_reduce(&s->ring, s->value[i], function[k]));
  }
  return s->settled[i] = c.best;
}

static ambit_polynomial reciprocal(simplifier *s, uint32_t i) {
  ambit_expr b = settle(s, i);
  return ambit_polynomial_of(&s->ring, ambit_fold_quotient(s->ring.g, AMBIT_ONE, b));
}

static ambit_polynomial read_power(simplifier *s, uint32_t i, int32_t n) {
  uint32_t a = s->walk.a[i];
  if (n > 0) return ambit_polynomial_power(&s->ring, s->value[a], (uint32_t)n);
  if (n < 0) return ambit_polynomial_power(&s->ring, reciprocal(s, a), (uint32_t)(-(int64_t)n));
  return ambit_polynomial_of(&s->ring, ambit_fold_power(s->ring.g, settle(s, a), 0));
}

static ambit_polynomial read_node(simplifier *s, uint32_t i) {
  const ambit_node x = *ambit_at(s->ring.g, s->walk.node[i]);
  uint32_t a = s->walk.a[i], b = s->walk.b[i];
  ambit_polynomial p = s->value[a], q = s->value[b];
  switch (x.op) {
  case AMBIT_OP_ADD: return ambit_polynomial_add(&s->ring, p, q, false);
  case AMBIT_OP_SUB: return ambit_polynomial_add(&s->ring, p, q, true);
  case AMBIT_OP_NEG: return ambit_polynomial_add(&s->ring, (ambit_polynomial) { 0 }, p, true);
  case AMBIT_OP_MUL: return ambit_polynomial_multiply(&s->ring, p, q);
  case AMBIT_OP_SQR: return ambit_polynomial_multiply(&s->ring, p, p);
  case AMBIT_OP_DIV: return ambit_polynomial_multiply(&s->ring, p, reciprocal(s, b));
  case AMBIT_OP_POWN: return read_power(s, i, (int32_t)x.b);
  default: break;
  }
  if (ambit_op_is_leaf(x.op)) return ambit_polynomial_of(&s->ring, s->walk.node[i]);
  return ambit_polynomial_of(&s->ring, ambit_store_rebuild(s->ring.g, s->walk.node[i], settle(s, a), settle(s, b)));
}

static ambit_expr simplify(simplifier *s, ambit_expr e) {
  for (size_t i = 0; i < s->walk.count; i++) s->settled[i] = AMBIT_NO_EXPR;
  for (uint32_t i = 0; i < s->walk.count; i++) {
    s->value[i] = read_node(s, i);
    if (s->ring.failed) return e;
  }
  return settle(s, (uint32_t)s->walk.count - 1);
}

ambit_expr ambit_graph_simplify(ambit_graph *g, ambit_expr e, size_t limit) {
  if (e >= g->count || limit == 0) return e;
  simplifier s = { .ring = { .g = g, .arena = ambit_arena_open(), .limit = limit } };
  if (!s.ring.arena) return e;
  ambit_expr r = e;
  if (ambit_walk_open(g, 1, &e, NULL, &s.walk)) {
    s.value = calloc(s.walk.count, sizeof *s.value);
    s.settled = malloc(s.walk.count * sizeof *s.settled);
    if (s.value && s.settled) r = simplify(&s, e);
    free(s.value);
    free(s.settled);
    ambit_walk_close(&s.walk);
  }
  ambit_arena_close(s.ring.arena);
  return r;
}
