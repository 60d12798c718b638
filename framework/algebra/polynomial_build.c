/* polynomial_build.c -- from polynomials back to expressions: expanded, or factored greedily (the multivariate Horner
** scheme: take the atom that most terms have in common out of these, then go on inside and with the rest; Ceberio &
** Kreinovich 2004).
*/
#include "algebra/polynomial.h"
#include "graph/fold.h"
#include <stdlib.h>
#include <string.h>

static bool is_reciprocal(const ambit_graph *g, ambit_expr atom) {
  const ambit_node *x = ambit_at(g, atom);
  return x->op == AMBIT_OP_DIV && x->a == AMBIT_ONE;
}

/* Reciprocals make one quotient. */
static ambit_expr build_term(ambit_graph *g, const ambit_monomial *m) {
  ambit_expr above = AMBIT_ONE, below = AMBIT_ONE;
  for (uint32_t i = 0; i < m->n; i++) {
    ambit_power p = m->power[i];
    if (is_reciprocal(g, p.atom))
      below = ambit_fold_product(g, below, ambit_fold_power(g, ambit_at(g, p.atom)->b, (int32_t)p.n));
    else
      above = ambit_fold_product(g, above, ambit_fold_power(g, p.atom, (int32_t)p.n));
  }
  return ambit_fold_product(g, m->c, ambit_fold_quotient(g, above, below));
}

ambit_expr ambit_polynomial_expanded(ambit_ring *ring, ambit_polynomial p) {
  ambit_expr sum = AMBIT_ZERO;
  for (size_t i = 0; i < p.n; i++) sum = ambit_fold_sum(ring->g, sum, build_term(ring->g, &p.term[i]), false);
  return sum;
}

static int by_atom(const void *p, const void *q) {
  const ambit_power *a = p, *b = q;
  if (a->atom != b->atom) return a->atom < b->atom ? -1 : 1;
  return a->n < b->n ? -1 : a->n > b->n;
}

/* The atom that occurs in most terms (of several the first), with the smallest of its powers there; n = 0: none occurs
** twice. */
static ambit_power commonest(ambit_ring *ring, ambit_polynomial p) {
  ambit_power best = { 0, 0 };
  size_t n = 0, most = 1;
  for (size_t i = 0; i < p.n; i++) n += p.term[i].n;
  ambit_power *all = malloc((n + 1) * sizeof *all);
  if (!all) {
    ring->failed = true;
    return best;
  }
  n = 0;
  for (size_t i = 0; i < p.n; i++)
    for (uint32_t k = 0; k < p.term[i].n; k++) all[n++] = p.term[i].power[k];
  qsort(all, n, sizeof *all, by_atom);
  for (size_t first = 0, end; first < n; first = end) {
    for (end = first; end < n && all[end].atom == all[first].atom; end++) {}
    bool more = end - first > most;
    bool as_many = end - first == most && best.n > 0;
    if (!more && !(as_many && ambit_store_order(ring->g, all[first].atom, best.atom) < 0)) continue;
    most = end - first;
    best = all[first];
  }
  free(all);
  return best;
}

/* m / f in *quotient; false: f is no factor of m. */
static bool divide_term(ambit_ring *ring, const ambit_monomial *m, ambit_power f, ambit_monomial *quotient) {
  uint32_t at = 0;
  while (at < m->n && m->power[at].atom != f.atom) at++;
  if (at == m->n) return false;
  ambit_power *power = ambit_arena_alloc(ring->arena, m->n * sizeof *power);
  if (!power) {
    ring->failed = true;
    return false;
  }
  *quotient = (ambit_monomial) { m->g, m->c, 0, power };
  for (uint32_t i = 0; i < m->n; i++) {
    ambit_power p = m->power[i];
    if (i == at) p.n -= f.n;
    if (p.n > 0) power[quotient->n++] = p;
  }
  return true;
}

static ambit_expr multiply_by_power(ambit_graph *g, ambit_expr e, ambit_power f) {
  if (is_reciprocal(g, f.atom))
    return ambit_fold_quotient(g, e, ambit_fold_power(g, ambit_at(g, f.atom)->b, (int32_t)f.n));
  return ambit_fold_product(g, ambit_fold_power(g, f.atom, (int32_t)f.n), e);
}

/* The coefficient that all terms have but for sign, divided out of them in place; AMBIT_ONE: none. */
static ambit_expr common_coefficient(ambit_graph *g, ambit_polynomial p) {
  if (p.n < 2 || !ambit_is_exact(g, p.term[0].c)) return AMBIT_ONE;
  double c = fabs(ambit_at(g, p.term[0].c)->value.lo);
  for (size_t i = 0; i < p.n; i++)
    if (c == 1 || !ambit_is_exact(g, p.term[i].c) || fabs(ambit_at(g, p.term[i].c)->value.lo) != c) return AMBIT_ONE;
  for (size_t i = 0; i < p.n; i++) p.term[i].c = ambit_graph_number(g, ambit_at(g, p.term[i].c)->value.lo > 0 ? 1 : -1);
  return ambit_graph_number(g, c);
}

#define DEEPEST 200 /* of nested factors; what is deeper is left expanded */

/* p is used up. Each level takes an atom out of at least two terms; the rest is done by the loop. */
static ambit_expr factor(ambit_ring *ring, ambit_polynomial p, int depth) {
  ambit_expr sum = AMBIT_ZERO;
  for (;;) {
    ambit_power f = depth < DEEPEST ? commonest(ring, p) : (ambit_power) { 0, 0 };
    if (ring->failed) return AMBIT_NO_EXPR;
    if (f.n == 0) return ambit_fold_sum(ring->g, ambit_polynomial_expanded(ring, p), sum, false);
    ambit_polynomial inner = { 0, ambit_arena_alloc(ring->arena, p.n * sizeof *inner.term) };
    if (!inner.term) ring->failed = true;
    size_t rest = 0;
    for (size_t i = 0; i < p.n && !ring->failed; i++) {
      if (divide_term(ring, &p.term[i], f, &inner.term[inner.n]))
        inner.n++;
      else
        p.term[rest++] = p.term[i];
    }
    if (ring->failed) return AMBIT_NO_EXPR;
    p.n = rest;
    ambit_expr c = common_coefficient(ring->g, inner);
    ambit_expr part = multiply_by_power(ring->g, factor(ring, inner, depth + 1), f);
    sum = ambit_fold_sum(ring->g, sum, ambit_fold_product(ring->g, c, part), false);
  }
}

ambit_expr ambit_polynomial_factored(ambit_ring *ring, ambit_polynomial p) {
  ambit_polynomial copy = { p.n, ambit_arena_alloc(ring->arena, (p.n + 1) * sizeof *copy.term) };
  if (!copy.term) {
    ring->failed = true;
    return AMBIT_NO_EXPR;
  }
  if (p.n > 0) memcpy(copy.term, p.term, p.n * sizeof *copy.term);
  ambit_expr c = common_coefficient(ring->g, copy);
  return ambit_fold_product(ring->g, c, factor(ring, copy, 0));
}
