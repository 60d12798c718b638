/* fold_product.c -- products, quotients and integer powers: coefficient to the left, equal bases collected. */
#include "graph/fold.h"

#define FACTORS 8u

typedef struct power {
  ambit_expr base;
  int64_t n;
} power;

/* e = base^n, with the domain of e */
static power read_power(const ambit_graph *g, ambit_expr e) {
  const ambit_node *x = ambit_at(g, e);
  if (x->op == AMBIT_OP_SQR) return (power) { x->a, 2 };
  if (x->op == AMBIT_OP_POWN && x->b != 0) return (power) { x->a, (int32_t)x->b };
  if (x->op == AMBIT_OP_DIV && x->a == AMBIT_ONE) return (power) { x->b, -1 };
  return (power) { e, 1 };
}

static bool fits(int64_t n) { return n >= INT32_MIN && n <= INT32_MAX; }

/* May base^m * base^n be written base^(m+n)? The domain excludes 0 if an exponent is negative, and must go on doing
** so. */
static bool may_merge(const ambit_graph *g, ambit_expr base, int64_t m, int64_t n) {
  if (!fits(m + n)) return false;
  if ((m > 0 && n > 0) || m + n < 0) return true;
  return ambit_is_nonzero(g, base);
}

ambit_expr ambit_fold_multiply(ambit_graph *g, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  if (a == AMBIT_ONE) return b;
  if (b == AMBIT_ONE) return a;
  return ambit_fold_precedes(g, b, a) ? ambit_store_make(g, AMBIT_OP_MUL, b, a)
                                      : ambit_store_make(g, AMBIT_OP_MUL, a, b);
}

/* Takes one base that is a factor of both out of a and b: *merged is their product. False: there is none. */
static bool collect_base(ambit_graph *g, ambit_expr *a, ambit_expr *b, ambit_expr *merged) {
  if (*a == AMBIT_NO_EXPR || *b == AMBIT_NO_EXPR) return false;
  ambit_item left[FACTORS], right[FACTORS];
  size_t n = ambit_fold_items(g, AMBIT_OP_MUL, *a, FACTORS, left);
  size_t m = ambit_fold_items(g, AMBIT_OP_MUL, *b, FACTORS, right);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) {
      power p = read_power(g, left[i].e), q = read_power(g, right[j].e);
      if (p.base != q.base || p.base == AMBIT_ONE || !may_merge(g, p.base, p.n, q.n)) continue;
      *merged = ambit_fold_power(g, p.base, (int32_t)(p.n + q.n));
      *a = ambit_fold_without(g, AMBIT_OP_MUL, *a, &left[i]);
      *b = ambit_fold_without(g, AMBIT_OP_MUL, *b, &right[j]);
      return true;
    }
  return false;
}

/* The constant that is a factor at the top, split off; AMBIT_ONE: there is none. */
static ambit_expr take_constant(const ambit_graph *g, ambit_expr *e) {
  const ambit_node *x = ambit_at(g, *e);
  if (x->op != AMBIT_OP_MUL || x->constant || !ambit_at(g, x->a)->constant) return AMBIT_ONE;
  *e = x->b;
  return x->a;
}

/* Two inexact constant factors become one, which the tape folds. */
static bool collect_constants(ambit_graph *g, ambit_expr a, ambit_expr b, ambit_expr *r) {
  if (ambit_at(g, a)->constant == ambit_at(g, b)->constant) {
    ambit_expr p = take_constant(g, &a), q = take_constant(g, &b);
    if (p == AMBIT_ONE || q == AMBIT_ONE) return false;
    *r = ambit_fold_product(g, ambit_fold_product(g, p, q), ambit_fold_product(g, a, b));
    return true;
  }
  ambit_expr factor = ambit_at(g, a)->constant ? a : b, other = ambit_at(g, a)->constant ? b : a;
  ambit_expr inner = take_constant(g, &other);
  if (inner == AMBIT_ONE) return false;
  *r = ambit_fold_product(g, ambit_fold_product(g, factor, inner), other);
  return true;
}

/* Of bodies without coefficients. A loop, not recursion: two long products may have all their factors in common. */
static ambit_expr multiply_bodies(ambit_graph *g, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_ONE) return b;
  if (b == AMBIT_ONE) return a;
  ambit_expr r, merged, powers = AMBIT_ONE;
  if (collect_constants(g, a, b, &r)) return r;
  bool any = false;
  while (collect_base(g, &a, &b, &merged)) {
    powers = ambit_fold_product(g, powers, merged);
    any = true;
  }
  if (any) return ambit_fold_product(g, ambit_fold_multiply(g, a, b), powers);
  const ambit_node *x = ambit_at(g, a), *y = ambit_at(g, b);
  if (x->op == AMBIT_OP_DIV && x->b == b && ambit_is_nonzero(g, b)) return x->a;
  if (y->op == AMBIT_OP_DIV && y->b == a && ambit_is_nonzero(g, a)) return y->a;
  return ambit_fold_multiply(g, a, b);
}

ambit_expr ambit_fold_product(ambit_graph *g, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  if (a == AMBIT_ONE) return b;
  if (b == AMBIT_ONE) return a;
  ambit_term s = ambit_fold_split(g, a), t = ambit_fold_split(g, b);
  if (s.c == 1 && t.c == 1) return multiply_bodies(g, a, b);
  double c;
  bool exact = ambit_fold_exact(AMBIT_OP_MUL, s.c, t.c, &c);
  if (!exact && s.body == AMBIT_ONE && t.body == AMBIT_ONE) return ambit_fold_multiply(g, a, b);
  ambit_expr body = multiply_bodies(g, s.body, t.body);
  return exact ? ambit_fold_scale(g, c, body) : ambit_fold_scale(g, s.c, ambit_fold_scale(g, t.c, body));
}

/* Cancels one common base of the quotient a / b; false: none may be cancelled. */
static bool cancel_base(ambit_graph *g, ambit_expr *a, ambit_expr *b) {
  if (*a == AMBIT_NO_EXPR || *b == AMBIT_NO_EXPR) return false;
  ambit_item above[FACTORS], below[FACTORS];
  size_t n = ambit_fold_items(g, AMBIT_OP_MUL, *a, FACTORS, above);
  size_t m = ambit_fold_items(g, AMBIT_OP_MUL, *b, FACTORS, below);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) {
      power p = read_power(g, above[i].e), q = read_power(g, below[j].e);
      if (p.base != q.base || p.base == AMBIT_ONE || p.n < 0 || q.n < 0 || !may_merge(g, p.base, p.n, -q.n)) continue;
      int32_t left = (int32_t)(p.n - q.n);
      *a = ambit_fold_without(g, AMBIT_OP_MUL, *a, &above[i]);
      *b = ambit_fold_without(g, AMBIT_OP_MUL, *b, &below[j]);
      if (left > 0) *a = ambit_fold_product(g, *a, ambit_fold_power(g, p.base, left));
      if (left < 0) *b = ambit_fold_product(g, *b, ambit_fold_power(g, p.base, -left));
      return true;
    }
  return false;
}

/* base^m to the power n as base^(m n): the domain must not gain 0. */
static bool may_nest(const ambit_graph *g, power p, int32_t n) {
  if (p.n == 1 || !fits(p.n * n)) return false;
  return p.n > 0 || n > 0 || ambit_is_nonzero(g, p.base);
}

/* a / b as it stands, but for the signs */
static ambit_expr divide(ambit_graph *g, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  bool minus_a = ambit_fold_is_negative(g, a), minus_b = ambit_fold_is_negative(g, b);
  if (minus_a) a = ambit_fold_negate(g, a);
  if (minus_b) b = ambit_fold_negate(g, b);
  if (b == AMBIT_ONE) return minus_a != minus_b ? ambit_fold_negate(g, a) : a;
  ambit_expr r = ambit_store_make(g, AMBIT_OP_DIV, a, b);
  return minus_a != minus_b ? ambit_fold_negate(g, r) : r;
}

/* Of bodies without coefficients. */
static ambit_expr divide_bodies(ambit_graph *g, ambit_expr a, ambit_expr b) {
  while (cancel_base(g, &a, &b)) {}
  if (a == AMBIT_ONE && b != AMBIT_NO_EXPR && may_nest(g, read_power(g, b), -1)) return ambit_fold_power(g, b, -1);
  return divide(g, a, b);
}

ambit_expr ambit_fold_quotient(ambit_graph *g, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  if (b == AMBIT_ONE) return a;
  if (a == AMBIT_ZERO && ambit_is_nonzero(g, b)) return AMBIT_ZERO;
  ambit_term s = ambit_fold_split(g, a), t = ambit_fold_split(g, b);
  double c;
  if (t.c == 0 || s.c == 0 || (s.body == AMBIT_ONE && t.body == AMBIT_ONE)) return divide(g, a, b);
  if (t.body == AMBIT_ONE && ambit_fold_exact(AMBIT_OP_DIV, 1, t.c, &c))
    return ambit_fold_product(g, ambit_graph_number(g, c), a);
  if (!ambit_fold_exact(AMBIT_OP_DIV, s.c, t.c, &c)) return divide(g, a, b);
  return ambit_fold_scale(g, c, divide_bodies(g, s.body, t.body));
}

static ambit_expr make_power(ambit_graph *g, ambit_expr a, int32_t n) {
  if (n == 1) return a;
  if (n == 2) return ambit_store_make(g, AMBIT_OP_SQR, a, a);
  if (n == -1) return ambit_store_make(g, AMBIT_OP_DIV, AMBIT_ONE, a);
  return ambit_store_make(g, AMBIT_OP_POWN, a, (uint32_t)n);
}

ambit_expr ambit_fold_power(ambit_graph *g, ambit_expr a, int32_t n) {
  if (a == AMBIT_NO_EXPR || a == AMBIT_ONE || n == 1) return a;
  const ambit_node *x = ambit_at(g, a);
  if (n == 0) return x->total ? AMBIT_ONE : ambit_store_make(g, AMBIT_OP_POWN, a, 0);
  ambit_term t = ambit_fold_split(g, a);
  double c;
  if (t.c != 1 && ambit_fold_exact_power(t.c, n, &c)) return ambit_fold_scale(g, c, ambit_fold_power(g, t.body, n));
  power p = read_power(g, a);
  if (may_nest(g, p, n)) return ambit_fold_power(g, p.base, (int32_t)(p.n * n));
  bool even = n % 2 == 0;
  if (even && x->op == AMBIT_OP_ABS) return ambit_fold_power(g, x->a, n);
  if (even && x->op == AMBIT_OP_SQRT && x->total) return ambit_fold_power(g, x->a, n / 2);
  if (even && x->op == AMBIT_OP_SUB && ambit_fold_precedes(g, x->b, x->a)) a = ambit_fold_negate(g, a);
  return a == AMBIT_NO_EXPR ? a : make_power(g, a, n);
}
