/* polynomial.c -- addition by merging, multiplication by sorting all products. */
#include "algebra/polynomial.h"
#include "graph/fold.h"
#include <stdlib.h>
#include <string.h>

static const ambit_polynomial zero = { 0, NULL };
static const uint32_t largest_exponent = INT32_MAX;

static ambit_polynomial fail(ambit_ring *ring) {
  ring->failed = true;
  return zero;
}

/* Room for n terms; counts them as work. */
static ambit_monomial *new_terms(ambit_ring *ring, size_t n) {
  ring->work += n;
  if (ring->work > 256 * ring->limit + 65536) ring->failed = true; /* many nodes of almost `limit` terms each */
  ambit_monomial *term = ring->failed ? NULL : ambit_arena_alloc(ring->arena, n * sizeof *term);
  if (!term) ring->failed = true;
  return term;
}

static int compare(const ambit_monomial *a, const ambit_monomial *b) {
  for (uint32_t i = 0; i < a->n && i < b->n; i++) {
    if (a->power[i].atom != b->power[i].atom) return ambit_store_order(a->g, a->power[i].atom, b->power[i].atom);
    if (a->power[i].n != b->power[i].n) return a->power[i].n < b->power[i].n ? -1 : 1;
  }
  return a->n < b->n ? -1 : a->n > b->n;
}

static int compare_terms(const void *a, const void *b) { return compare(a, b); }

static void lose(ambit_ring *ring, const ambit_monomial *m) {
  for (uint32_t i = 0; i < m->n; i++) {
    ambit_expr atom = m->power[i].atom;
    bool known = ambit_at(ring->g, atom)->total;
    for (size_t k = 0; k < ring->nlost && !known; k++) known = ring->lost[k] == atom;
    if (known) continue;
    if (ring->nlost == AMBIT_LOST_MAX)
      ring->failed = true;
    else
      ring->lost[ring->nlost++] = atom;
  }
}

static bool contains(ambit_polynomial p, ambit_expr atom) {
  for (size_t i = 0; i < p.n; i++)
    for (uint32_t k = 0; k < p.term[i].n; k++)
      if (p.term[i].power[k].atom == atom) return true;
  return false;
}

bool ambit_polynomial_keeps(const ambit_ring *ring, ambit_polynomial p) {
  for (size_t k = 0; k < ring->nlost; k++)
    if (!contains(p, ring->lost[k])) return false;
  return true;
}

/* Takes m into p, whose last term may be its equal; p has room. */
static void append(ambit_ring *ring, ambit_polynomial *p, ambit_monomial m) {
  if (m.c == AMBIT_NO_EXPR) ring->failed = true;
  if (ring->failed) return;
  ambit_monomial *last = p->n ? &p->term[p->n - 1] : NULL;
  if (!last || compare(last, &m) != 0) {
    p->term[p->n++] = m;
    return;
  }
  last->c = ambit_fold_sum(ring->g, last->c, m.c, false);
  if (last->c == AMBIT_NO_EXPR) ring->failed = true;
  if (last->c != AMBIT_ZERO) return;
  lose(ring, last);
  p->n--;
}

ambit_polynomial ambit_polynomial_of(ambit_ring *ring, ambit_expr e) {
  if (e == AMBIT_NO_EXPR) return fail(ring);
  ambit_term t = ambit_fold_split(ring->g, e);
  if (t.c == 0 && ambit_at(ring->g, t.body)->total) return zero;
  if (t.c == 0) t = (ambit_term) { 1, e };
  ambit_monomial *m = new_terms(ring, 1);
  ambit_power *power = ambit_arena_alloc(ring->arena, sizeof *power);
  if (!m || !power) return fail(ring);
  *power = (ambit_power) { t.body, 1 };
  *m = (ambit_monomial) { ring->g, ambit_graph_number(ring->g, t.c), t.body != AMBIT_ONE, power };
  return m->c == AMBIT_NO_EXPR ? fail(ring) : (ambit_polynomial) { 1, m };
}

ambit_polynomial ambit_polynomial_add(ambit_ring *ring, ambit_polynomial p, ambit_polynomial q, bool negative) {
  ambit_polynomial r = { 0, new_terms(ring, p.n + q.n + 1) };
  size_t i = 0, j = 0;
  while ((i < p.n || j < q.n) && !ring->failed) {
    bool left = j == q.n || (i < p.n && compare(&p.term[i], &q.term[j]) <= 0);
    ambit_monomial m = left ? p.term[i++] : q.term[j++];
    if (!left && negative) m.c = ambit_fold_negate(ring->g, m.c);
    append(ring, &r, m);
  }
  return ring->failed || r.n > ring->limit ? fail(ring) : r;
}

/* *power: room for a->n + b->n, used for the product's powers and moved on. */
static ambit_monomial multiply_terms(
    ambit_ring *ring, const ambit_monomial *a, const ambit_monomial *b, ambit_power **power) {
  ambit_monomial m = { ring->g, ambit_fold_product(ring->g, a->c, b->c), 0, *power };
  uint32_t i = 0, j = 0;
  while (i < a->n || j < b->n) {
    bool left = j == b->n || (i < a->n && ambit_store_order(ring->g, a->power[i].atom, b->power[j].atom) <= 0);
    ambit_power next = left ? a->power[i++] : b->power[j++];
    if (m.n == 0 || m.power[m.n - 1].atom != next.atom)
      m.power[m.n++] = next;
    else if (next.n > largest_exponent - m.power[m.n - 1].n)
      ring->failed = true;
    else
      m.power[m.n - 1].n += next.n;
  }
  *power += m.n;
  return m;
}

static size_t count_powers(ambit_polynomial p) {
  size_t n = 0;
  for (size_t i = 0; i < p.n; i++) n += p.term[i].n;
  return n;
}

ambit_polynomial ambit_polynomial_multiply(ambit_ring *ring, ambit_polynomial p, ambit_polynomial q) {
  if (ring->failed) return zero;
  if (p.n == 0 || q.n == 0) {
    for (size_t i = 0; i < p.n; i++) lose(ring, &p.term[i]);
    for (size_t i = 0; i < q.n; i++) lose(ring, &q.term[i]);
    return zero;
  }
  if (p.n > 64 * ring->limit / q.n) return fail(ring);
  ambit_monomial *all = new_terms(ring, p.n * q.n);
  ambit_power *power =
      ambit_arena_alloc(ring->arena, (count_powers(p) * q.n + count_powers(q) * p.n + 1) * sizeof *power);
  if (!all || !power) return fail(ring);
  for (size_t i = 0; i < p.n; i++)
    for (size_t j = 0; j < q.n; j++) all[i * q.n + j] = multiply_terms(ring, &p.term[i], &q.term[j], &power);
  qsort(all, p.n * q.n, sizeof *all, compare_terms);
  ambit_polynomial r = { 0, all }; /* in place: r never overtakes the term that is read */
  for (size_t i = 0; i < p.n * q.n; i++) append(ring, &r, all[i]);
  return ring->failed || r.n > ring->limit ? fail(ring) : r;
}

ambit_polynomial ambit_polynomial_power(ambit_ring *ring, ambit_polynomial p, uint32_t n) {
  ambit_polynomial r = ambit_polynomial_of(ring, AMBIT_ONE);
  for (; n > 0 && !ring->failed; n >>= 1) {
    if (n & 1u) r = ambit_polynomial_multiply(ring, r, p);
    if (n > 1) p = ambit_polynomial_multiply(ring, p, p);
  }
  return r;
}

/* (1 - partner(x)^2)^k */
static ambit_polynomial square_of_partner(ambit_ring *ring, ambit_expr atom, uint32_t op, uint32_t k) {
  uint32_t partner = op == AMBIT_OP_SIN ? AMBIT_OP_COS : AMBIT_OP_SIN;
  ambit_expr angle = ambit_at(ring->g, atom)->a;
  ambit_polynomial one = ambit_polynomial_of(ring, AMBIT_ONE);
  ambit_polynomial square = ambit_polynomial_of(ring, ambit_graph_op(ring->g, partner, angle, angle));
  square = ambit_polynomial_multiply(ring, square, square);
  return ambit_polynomial_power(ring, ambit_polynomial_add(ring, one, square, true), k);
}

static ambit_polynomial reduce_term(ambit_ring *ring, const ambit_monomial *m, uint32_t op) {
  ambit_monomial *rest = new_terms(ring, 1);
  ambit_power *power = ambit_arena_alloc(ring->arena, (m->n + 1u) * sizeof *power);
  if (!rest || !power) return fail(ring);
  *rest = (ambit_monomial) { m->g, m->c, 0, power };
  ambit_polynomial factor = ambit_polynomial_of(ring, AMBIT_ONE);
  for (uint32_t i = 0; i < m->n; i++) {
    ambit_power p = m->power[i];
    bool even = p.n >= 2 && ambit_at(ring->g, p.atom)->op == op;
    if (even) {
      ambit_polynomial square = square_of_partner(ring, p.atom, op, p.n / 2);
      factor = ambit_polynomial_multiply(ring, factor, square);
      p.n %= 2;
    }
    if (p.n > 0) power[rest->n++] = p;
  }
  return ambit_polynomial_multiply(ring, (ambit_polynomial) { 1, rest }, factor);
}

ambit_polynomial ambit_polynomial_reduce(ambit_ring *ring, ambit_polynomial p, uint32_t op) {
  ambit_polynomial r = zero;
  for (size_t i = 0; i < p.n && !ring->failed; i++)
    r = ambit_polynomial_add(ring, r, reduce_term(ring, &p.term[i], op), false);
  return r;
}
