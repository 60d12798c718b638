/* difference_rule.c -- u(x) - w(x - d) for one operation, given that of its operands. In the comments, a and b are the
** operands of u at x, a~ and b~ those of w at x - d, A = a - a~ and B = b - b~. Proofs: docs/numerics/reduction.md.
*/
#include "algebra/difference_pair.h"

static ambit_expr add(ambit_graph *g, ambit_expr a, ambit_expr b) { return ambit_fold_sum(g, a, b, false); }
static ambit_expr subtract(ambit_graph *g, ambit_expr a, ambit_expr b) { return ambit_fold_sum(g, a, b, true); }
static ambit_expr over(ambit_graph *g, ambit_expr a, ambit_expr b) { return ambit_fold_quotient(g, a, b); }
static ambit_expr unary(ambit_graph *g, uint32_t op, ambit_expr a) { return ambit_graph_op(g, op, a, a); }
static ambit_expr half(ambit_graph *g, ambit_expr a) { return ambit_fold_scale(g, 0.5, a); }

/* A structural zero stays one even where the other factor is not proved to be defined. */
static ambit_expr times(ambit_graph *g, ambit_expr a, ambit_expr b) {
  return a == AMBIT_ZERO || b == AMBIT_ZERO ? AMBIT_ZERO : ambit_fold_product(g, a, b);
}

/* 2 f(a - A/2) h(A/2) */
static ambit_expr about_middle(ambit_graph *g, uint32_t f, uint32_t h, ambit_expr a, ambit_expr A) {
  ambit_expr middle = subtract(g, a, half(g, A));
  return ambit_fold_scale(g, 2, times(g, unary(g, f, middle), unary(g, h, half(g, A))));
}

/* a^n - a~^n, n > 0: A for n = 1, then by halves: (p - q)(p + q), and p a - q a~ = (p - q) a + q A. */
static ambit_expr positive_power(ambit_graph *g, ambit_expr a, ambit_expr c, ambit_expr A, uint32_t n) {
  ambit_expr d = A;
  uint32_t have = 1;
  for (uint32_t bit = 31; bit-- > 0;) { /* from the bit below the highest of n: n is its binary digits, read forward */
    if (n >> bit <= 1) continue;
    ambit_expr p = ambit_graph_pown(g, a, (int32_t)have), q = ambit_graph_pown(g, c, (int32_t)have);
    d = times(g, d, add(g, p, q));
    have *= 2;
    if (n >> bit & 1) {
      d = add(g, times(g, d, a), times(g, ambit_graph_pown(g, c, (int32_t)have), A));
      have++;
    }
  }
  return d;
}

/* a^-n - a~^-n = -(a^n - a~^n) a^-n a~^-n */
static ambit_expr power(ambit_graph *g, ambit_expr a, ambit_expr c, ambit_expr A, int32_t n) {
  if (n == 0) return AMBIT_ZERO;
  if (n > 0) return positive_power(g, a, c, A, (uint32_t)n);
  ambit_expr up = positive_power(g, a, c, A, 0u - (uint32_t)n);
  ambit_expr down = times(g, ambit_graph_pown(g, a, n), ambit_graph_pown(g, c, n));
  return ambit_fold_negate(g, times(g, up, down));
}

/* sin A/(cos a cos a~) */
static ambit_expr tangent(ambit_graph *g, ambit_expr a, ambit_expr c, ambit_expr A) {
  ambit_expr below = times(g, unary(g, AMBIT_OP_COS, a), unary(g, AMBIT_OP_COS, c));
  return over(g, unary(g, AMBIT_OP_SIN, A), below);
}

/* tanh A (1 - tanh a tanh a~) */
static ambit_expr hyperbolic_tangent(ambit_graph *g, ambit_expr a, ambit_expr c, ambit_expr A) {
  ambit_expr both = times(g, unary(g, AMBIT_OP_TANH, a), unary(g, AMBIT_OP_TANH, c));
  return times(g, unary(g, AMBIT_OP_TANH, A), subtract(g, AMBIT_ONE, both));
}

/* The angle between (1, a~) and (1, a) is below pi: atan2(A, 1 + a a~), with a a~ = (a - A/2)^2 - (A/2)^2, which is
** off the cut of atan2 whatever the enclosure of a as soon as |A| < 2. */
static ambit_expr arc_tangent(ambit_graph *g, ambit_expr a, ambit_expr A) {
  ambit_expr h = half(g, A), middle = unary(g, AMBIT_OP_SQR, subtract(g, a, h));
  ambit_expr one = subtract(g, AMBIT_ONE, unary(g, AMBIT_OP_SQR, h));
  return ambit_graph_op(g, AMBIT_OP_ATAN2, A, add(g, middle, one));
}

static ambit_expr of_function(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr c, ambit_expr A) {
  switch (op) {
  case AMBIT_OP_NEG: return ambit_fold_negate(g, A);
  case AMBIT_OP_SQR: return times(g, A, subtract(g, ambit_fold_scale(g, 2, a), A));
  case AMBIT_OP_SIN: return about_middle(g, AMBIT_OP_COS, AMBIT_OP_SIN, a, A);
  case AMBIT_OP_COS: return ambit_fold_negate(g, about_middle(g, AMBIT_OP_SIN, AMBIT_OP_SIN, a, A));
  case AMBIT_OP_EXP: return about_middle(g, AMBIT_OP_EXP, AMBIT_OP_SINH, a, A);
  case AMBIT_OP_SINH: return about_middle(g, AMBIT_OP_COSH, AMBIT_OP_SINH, a, A);
  case AMBIT_OP_COSH: return about_middle(g, AMBIT_OP_SINH, AMBIT_OP_SINH, a, A);
  case AMBIT_OP_TAN: return tangent(g, a, c, A);
  case AMBIT_OP_TANH: return hyperbolic_tangent(g, a, c, A);
  case AMBIT_OP_ATAN: return arc_tangent(g, a, A);
  case AMBIT_OP_LOG: return ambit_fold_negate(g, unary(g, AMBIT_OP_LOG, subtract(g, AMBIT_ONE, over(g, A, a))));
  default: /* SQRT */ return over(g, A, add(g, unary(g, AMBIT_OP_SQRT, a), unary(g, AMBIT_OP_SQRT, c)));
  }
}

/* e, which lies between lo and hi */
static ambit_expr clamp(ambit_graph *g, ambit_expr lo, ambit_expr hi, ambit_expr e) {
  return ambit_graph_op(g, AMBIT_OP_MAX, lo, ambit_graph_op(g, AMBIT_OP_MIN, hi, e));
}

/* | |a| - |a~| | <= |A|, and the greater (lesser) of two moves by something between A and B. */
static ambit_expr kink(ambit_graph *g, uint32_t op, ambit_expr A, ambit_expr B, ambit_expr plain) {
  if (op == AMBIT_OP_ABS) {
    ambit_expr far = unary(g, AMBIT_OP_ABS, A);
    return clamp(g, ambit_fold_negate(g, far), far, plain);
  }
  return clamp(g, ambit_graph_op(g, AMBIT_OP_MIN, A, B), ambit_graph_op(g, AMBIT_OP_MAX, A, B), plain);
}

static ambit_expr rule(ambit_pairs *p, const ambit_pair *pair) {
  ambit_graph *g = p->g;
  ambit_node x = *ambit_at(g, pair->u), y = *ambit_at(g, pair->w);
  bool binary = ambit_op_is_binary(x.op);
  const ambit_pair_link *link = &p->link[pair->first];
  ambit_expr A = p->pair[link[0].pair].result, B = binary ? p->pair[link[1].pair].result : AMBIT_ZERO;
  if (A == AMBIT_ZERO && B == AMBIT_ZERO) return AMBIT_ZERO;
  switch (x.op) {
  case AMBIT_OP_ADD: return add(g, A, B);
  case AMBIT_OP_SUB: return subtract(g, A, B);
  case AMBIT_OP_MUL: return add(g, times(g, A, x.b), times(g, ambit_shifted(p, y.a), B));
  case AMBIT_OP_DIV: return over(g, subtract(g, A, times(g, ambit_shifted(p, pair->w), B)), x.b);
  case AMBIT_OP_POWN: return power(g, x.a, ambit_shifted(p, y.a), A, (int32_t)x.b);
  case AMBIT_OP_ABS:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return kink(g, x.op, A, B, subtract(g, pair->u, ambit_shifted(p, pair->w)));
  default: return of_function(g, x.op, x.a, ambit_shifted(p, y.a), A);
  }
}

/* -- several items */

static ambit_expr scaled(ambit_graph *g, double c, ambit_expr e) { return ambit_fold_scale(g, c, e); }

/* cu u - cw u~ = (cu - cw) u + cw (u - u~) */
static ambit_expr term(ambit_pairs *p, const ambit_pair_link *l) {
  ambit_graph *g = p->g;
  if (l->pair == AMBIT_NO_PAIR)
    return l->u != AMBIT_NO_EXPR ? scaled(g, l->cu, l->u) : scaled(g, -l->cw, ambit_shifted(p, l->w));
  ambit_expr d = scaled(g, l->cw, p->pair[l->pair].result);
  if (l->cu == l->cw) return d;
  ambit_expr c = subtract(g, ambit_graph_number(g, l->cu), ambit_graph_number(g, l->cw));
  return add(g, times(g, c, l->u), d);
}

static ambit_expr sum(ambit_pairs *p, const ambit_pair *pair) {
  ambit_expr s = AMBIT_ZERO;
  for (size_t i = 0; i < pair->count; i++) s = add(p->g, s, term(p, &p->link[pair->first + i]));
  return s;
}

/* Equal factors stand in front; the others by turns: a b - a~ b~ = A b + a~ B. Factors without a partner are one of
** them: their products, on either side. */
static ambit_expr product(ambit_pairs *p, const ambit_pair *pair) {
  ambit_graph *g = p->g;
  ambit_expr front = AMBIT_ONE, lone_u = AMBIT_ONE, lone_w = AMBIT_ONE, w = AMBIT_ONE, d = AMBIT_ZERO;
  for (size_t i = 0; i < pair->count; i++) {
    const ambit_pair_link *l = &p->link[pair->first + i];
    if (l->pair == AMBIT_NO_PAIR) {
      if (l->u != AMBIT_NO_EXPR) lone_u = ambit_fold_product(g, lone_u, l->u);
      if (l->w != AMBIT_NO_EXPR) lone_w = ambit_fold_product(g, lone_w, ambit_shifted(p, l->w));
    } else if (p->pair[l->pair].result == AMBIT_ZERO) {
      front = ambit_fold_product(g, front, l->u);
    } else {
      d = add(g, times(g, d, l->u), times(g, w, p->pair[l->pair].result));
      w = ambit_fold_product(g, w, ambit_shifted(p, l->w));
    }
  }
  if (lone_u != lone_w)
    d = add(g, times(g, d, lone_u), times(g, w, subtract(g, lone_u, lone_w)));
  else
    d = times(g, d, lone_u);
  return times(g, front, d);
}

ambit_expr ambit_pair_solve(ambit_pairs *p, const ambit_pair *pair) {
  switch (pair->state) {
  case PAIR_RULE: return rule(p, pair);
  case PAIR_SUM: return sum(p, pair);
  case PAIR_PRODUCT: return product(p, pair);
  default: /* plain */
    if (pair->u == pair->w && !ambit_moves(p, pair->u)) return AMBIT_ZERO;
    return subtract(p->g, pair->u, ambit_shifted(p, pair->w));
  }
}
