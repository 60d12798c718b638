/* fold_sum.c -- sums and differences: signs outside, equal terms collected, angle sums. */
#include "graph/fold.h"

#define TERMS 12u /* how many of the last terms of each operand are compared */
#define PENDING 32u

static ambit_expr join_ordered(ambit_graph *g, ambit_expr a, ambit_expr b) {
  return ambit_fold_precedes(g, b, a) ? ambit_store_make(g, AMBIT_OP_ADD, b, a)
                                      : ambit_store_make(g, AMBIT_OP_ADD, a, b);
}

ambit_expr ambit_fold_join(ambit_graph *g, ambit_expr a, ambit_expr b, bool negative) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  if (b == AMBIT_ZERO) return a;
  if (a == AMBIT_ZERO) return negative ? ambit_fold_negate(g, b) : b;
  bool minus_a = ambit_fold_is_negative(g, a), minus_b = ambit_fold_is_negative(g, b);
  if (minus_a) a = ambit_fold_negate(g, a);
  if (minus_b) b = ambit_fold_negate(g, b), negative = !negative;
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  if (minus_a != negative) return ambit_store_make(g, AMBIT_OP_SUB, minus_a ? b : a, minus_a ? a : b);
  ambit_expr sum = join_ordered(g, a, b);
  return minus_a ? ambit_fold_negate(g, sum) : sum;
}

typedef struct signed_term {
  ambit_term term;
  uint32_t angles;
} signed_term;

static size_t read_terms(const ambit_graph *g, ambit_expr e, bool negative, ambit_item *item, signed_term *term) {
  size_t n = ambit_fold_items(g, AMBIT_OP_ADD, e, TERMS, item);
  for (size_t i = 0; i < n; i++) {
    ambit_term t = ambit_fold_split(g, item[i].e);
    if (item[i].negative != negative) t.c = -t.c;
    term[i] = (signed_term) { t, g->stored[t.body].angles };
  }
  return n;
}

/* *r := s + t if one rule makes a single term of them. */
static bool merge(ambit_graph *g, signed_term s, signed_term t, ambit_expr *r) {
  bool angles = s.angles >= 2 && t.angles >= 2;
  if (s.term.body != t.term.body) return angles && ambit_fold_angles(g, s.term, t.term, r);
  double c;
  if (!ambit_fold_exact(AMBIT_OP_ADD, s.term.c, t.term.c, &c)) return false;
  if (c == 0 && !ambit_at(g, s.term.body)->total) return false;
  if (angles && s.term.c == t.term.c && ambit_fold_angles(g, s.term, t.term, r)) return true;
  *r = ambit_fold_scale(g, c, s.term.body);
  return true;
}

typedef struct pending {
  ambit_expr e;
  bool negative;
} pending;

/* If a term of *sum and one of *p merge: takes both away, *r := what they make. */
static bool merge_any(ambit_graph *g, ambit_expr *sum, pending *p, ambit_expr *r) {
  ambit_item left[TERMS], right[TERMS];
  signed_term s[TERMS], t[TERMS];
  size_t n = read_terms(g, *sum, false, left, s), m = read_terms(g, p->e, p->negative, right, t);
  for (size_t j = 0; j < m; j++)
    for (size_t i = 0; i < n; i++) {
      if (s[i].term.body != t[j].term.body && (s[i].angles < 2 || t[j].angles < 2)) continue;
      if (!merge(g, s[i], t[j], r)) continue;
      *sum = ambit_fold_without(g, AMBIT_OP_ADD, *sum, &left[i]);
      p->e = ambit_fold_without(g, AMBIT_OP_ADD, p->e, &right[j]);
      return true;
    }
  return false;
}

ambit_expr ambit_fold_sum(ambit_graph *g, ambit_expr a, ambit_expr b, bool negative) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  pending todo[PENDING];
  size_t n = 0;
  todo[n++] = (pending) { b, negative };
  while (n > 0) {
    pending p = todo[--n];
    if (a == AMBIT_NO_EXPR || p.e == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
    ambit_expr merged;
    if (p.e == AMBIT_ZERO || a == AMBIT_ZERO || n + 2 > PENDING || !merge_any(g, &a, &p, &merged)) {
      a = ambit_fold_join(g, a, p.e, p.negative);
      continue;
    }
    todo[n++] = p;
    todo[n++] = (pending) { merged, false };
  }
  return a;
}
