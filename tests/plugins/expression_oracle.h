/* expression_oracle.h -- the value of a random expression at a point, enclosed with MPFR: two bounds of 320 bits, each
** operation rounded outward. Nothing of the kernel takes part.
**
** The enclosure is of width zero or tiny, so that monotone pieces suffice: an operand that straddles the edge of a
** domain, a pole or a jump makes the result DOUBTFUL, and nothing is claimed then. The bounds hold because each
** function is monotone between its turning points (sine, cosine: |f(hi) - f(lo)| <= hi - lo).
*/
#ifndef AMBIT_TEST_EXPRESSION_ORACLE_H
#define AMBIT_TEST_EXPRESSION_ORACLE_H
#include "random_expression.h"
#include <stdlib.h>
#include <string.h>

#define ORACLE_BITS 320

typedef enum { DEFINED, UNDEFINED, DOUBTFUL } oracle_state;

typedef struct oracle_value {
  mpfr_t lo, hi;
  oracle_state state;
} oracle_value;

typedef struct expression_oracle {
  oracle_value node[RANDOM_NODES_MAX];
  mpfr_t s, t; /* scratch */
} expression_oracle;

static inline void oracle_open(expression_oracle *o) {
  for (size_t i = 0; i < RANDOM_NODES_MAX; i++) mpfr_inits2(ORACLE_BITS, o->node[i].lo, o->node[i].hi, (mpfr_ptr)NULL);
  mpfr_inits2(ORACLE_BITS, o->s, o->t, (mpfr_ptr)NULL);
}

static inline void oracle_close(expression_oracle *o) {
  for (size_t i = 0; i < RANDOM_NODES_MAX; i++) mpfr_clears(o->node[i].lo, o->node[i].hi, (mpfr_ptr)NULL);
  mpfr_clears(o->s, o->t, (mpfr_ptr)NULL);
}

typedef int (*oracle_unary)(mpfr_t, const mpfr_t, mpfr_rnd_t);
typedef int (*oracle_binary)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t);

static inline void oracle_rising(oracle_value *r, const oracle_value *a, oracle_unary f) {
  f(r->lo, a->lo, MPFR_RNDD);
  f(r->hi, a->hi, MPFR_RNDU);
}

static inline void oracle_falling(oracle_value *r, const oracle_value *a, oracle_unary f) {
  f(r->lo, a->hi, MPFR_RNDD);
  f(r->hi, a->lo, MPFR_RNDU);
}

/* r := the hull of f over the four corners: MUL, DIV (divisor without 0), ATAN2 (off the cut) */
static inline void oracle_corners(
    expression_oracle *o, oracle_value *r, const oracle_value *a, const oracle_value *b, oracle_binary f) {
  const mpfr_t *left[] = { &a->lo, &a->hi }, *right[] = { &b->lo, &b->hi };
  for (int i = 0; i < 4; i++) {
    f(o->s, *left[i / 2], *right[i % 2], MPFR_RNDD);
    f(o->t, *left[i / 2], *right[i % 2], MPFR_RNDU);
    if (i == 0 || mpfr_less_p(o->s, r->lo)) mpfr_set(r->lo, o->s, MPFR_RNDD);
    if (i == 0 || mpfr_greater_p(o->t, r->hi)) mpfr_set(r->hi, o->t, MPFR_RNDU);
  }
}

static inline bool oracle_is_zero(const oracle_value *a) { return mpfr_zero_p(a->lo) && mpfr_zero_p(a->hi); }
static inline bool oracle_has_zero(const oracle_value *a) { return mpfr_sgn(a->lo) <= 0 && mpfr_sgn(a->hi) >= 0; }

static inline int oracle_width(expression_oracle *o, const oracle_value *a) {
  mpfr_sub(o->s, a->hi, a->lo, MPFR_RNDU);
  return mpfr_cmp_d(o->s, 0x1p-30);
}

/* sine, cosine: within the width of the operand */
static inline void oracle_wave(expression_oracle *o, oracle_value *r, const oracle_value *a, oracle_unary f) {
  if (oracle_width(o, a) > 0) {
    r->state = DOUBTFUL;
    return;
  }
  mpfr_set(o->t, o->s, MPFR_RNDU);
  f(r->lo, a->lo, MPFR_RNDD);
  f(r->hi, a->lo, MPFR_RNDU);
  mpfr_sub(r->lo, r->lo, o->t, MPFR_RNDD);
  mpfr_add(r->hi, r->hi, o->t, MPFR_RNDU);
  if (mpfr_cmp_si(r->lo, -1) < 0) mpfr_set_si(r->lo, -1, MPFR_RNDD);
  if (mpfr_cmp_si(r->hi, 1) > 0) mpfr_set_si(r->hi, 1, MPFR_RNDU);
}

/* narrower than pi, and the cosine has one sign at both ends: no pole between */
static inline void oracle_tan(expression_oracle *o, oracle_value *r, const oracle_value *a) {
  r->state = DOUBTFUL;
  if (oracle_width(o, a) > 0) return;
  mpfr_cos(o->s, a->lo, MPFR_RNDN);
  mpfr_cos(o->t, a->hi, MPFR_RNDN);
  if (mpfr_sgn(o->s) * mpfr_sgn(o->t) <= 0) return;
  r->state = DEFINED;
  oracle_rising(r, a, mpfr_tan);
}

static inline void oracle_square(oracle_value *r, const oracle_value *a, int32_t n) {
  bool even = n % 2 == 0, zero = oracle_has_zero(a);
  bool falls = n < 0 ? (even ? mpfr_sgn(a->lo) > 0 : true) : (even && mpfr_sgn(a->lo) < 0);
  if (n == 0) {
    mpfr_set_si(r->lo, 1, MPFR_RNDD), mpfr_set_si(r->hi, 1, MPFR_RNDU);
    return;
  }
  if (n < 0 && zero) {
    r->state = oracle_is_zero(a) ? UNDEFINED : DOUBTFUL;
    return;
  }
  if (even && zero && !oracle_is_zero(a)) { /* n > 0: from 0 to the larger end */
    mpfr_set_zero(r->lo, 1);
    mpfr_pow_si(r->hi, mpfr_cmpabs(a->lo, a->hi) > 0 ? a->lo : a->hi, n, MPFR_RNDU);
    return;
  }
  mpfr_pow_si(r->lo, falls ? a->hi : a->lo, n, MPFR_RNDD);
  mpfr_pow_si(r->hi, falls ? a->lo : a->hi, n, MPFR_RNDU);
}

static inline void oracle_from(oracle_value *r, const oracle_value *a, double edge, bool open, oracle_unary f) {
  int lo = mpfr_cmp_d(a->lo, edge), hi = mpfr_cmp_d(a->hi, edge);
  if (hi < 0 || (open && hi == 0))
    r->state = UNDEFINED;
  else if (lo < 0 || (open && lo == 0))
    r->state = DOUBTFUL;
  else
    oracle_rising(r, a, f);
}

static inline void oracle_arc(oracle_value *r, const oracle_value *a, bool sine) {
  if (mpfr_cmp_si(a->hi, -1) < 0 || mpfr_cmp_si(a->lo, 1) > 0)
    r->state = UNDEFINED;
  else if (mpfr_cmp_si(a->lo, -1) < 0 || mpfr_cmp_si(a->hi, 1) > 0)
    r->state = DOUBTFUL;
  else if (sine)
    oracle_rising(r, a, mpfr_asin);
  else
    oracle_falling(r, a, mpfr_acos);
}

static inline void oracle_atan2(expression_oracle *o, oracle_value *r, oracle_value *y, oracle_value *x) {
  if (oracle_is_zero(y)) { /* the sign of a zero is no part of a real number */
    mpfr_set_zero(y->lo, 1), mpfr_set_zero(y->hi, 1);
    if (oracle_is_zero(x))
      r->state = UNDEFINED;
    else if (oracle_has_zero(x))
      r->state = DOUBTFUL;
  } else if (oracle_has_zero(y) && mpfr_sgn(x->lo) <= 0)
    r->state = DOUBTFUL;
  if (oracle_is_zero(x)) mpfr_set_zero(x->lo, 1), mpfr_set_zero(x->hi, 1);
  if (r->state == DEFINED) oracle_corners(o, r, y, x, mpfr_atan2);
}

static inline void oracle_abs(oracle_value *r, const oracle_value *a) {
  bool zero = oracle_has_zero(a), low = mpfr_cmpabs(a->lo, a->hi) <= 0;
  mpfr_abs(r->hi, low ? a->hi : a->lo, MPFR_RNDU);
  if (zero)
    mpfr_set_zero(r->lo, 1);
  else
    mpfr_abs(r->lo, low ? a->lo : a->hi, MPFR_RNDD);
}

static inline void oracle_cosh(oracle_value *r, const oracle_value *a) {
  bool zero = oracle_has_zero(a), low = mpfr_cmpabs(a->lo, a->hi) <= 0;
  mpfr_cosh(r->hi, low ? a->hi : a->lo, MPFR_RNDU);
  if (zero)
    mpfr_set_si(r->lo, 1, MPFR_RNDD);
  else
    mpfr_cosh(r->lo, low ? a->lo : a->hi, MPFR_RNDD);
}

static inline void oracle_divide(expression_oracle *o, oracle_value *r, const oracle_value *a, const oracle_value *b) {
  if (oracle_is_zero(b))
    r->state = UNDEFINED;
  else if (oracle_has_zero(b))
    r->state = DOUBTFUL;
  else
    oracle_corners(o, r, a, b, mpfr_div);
}

static inline void oracle_atanh(oracle_value *r, const oracle_value *a) {
  if (mpfr_cmp_si(a->hi, -1) <= 0 || mpfr_cmp_si(a->lo, 1) >= 0)
    r->state = UNDEFINED;
  else if (mpfr_cmp_si(a->lo, -1) <= 0 || mpfr_cmp_si(a->hi, 1) >= 0)
    r->state = DOUBTFUL;
  else
    oracle_rising(r, a, mpfr_atanh);
}

/* over the ends of |a| and |b|, in which it rises */
static inline void oracle_hypot(oracle_value *r, const oracle_value *a, const oracle_value *b) {
  oracle_value x, y;
  mpfr_inits2(ORACLE_BITS, x.lo, x.hi, y.lo, y.hi, (mpfr_ptr)NULL);
  oracle_abs(&x, a), oracle_abs(&y, b);
  mpfr_hypot(r->lo, x.lo, y.lo, MPFR_RNDD), mpfr_hypot(r->hi, x.hi, y.hi, MPFR_RNDU);
  mpfr_clears(x.lo, x.hi, y.lo, y.hi, (mpfr_ptr)NULL);
}

/* a > 0: monotone in each operand; at a = 0 there may be a limit, of which nothing is claimed */
static inline void oracle_pow(expression_oracle *o, oracle_value *r, const oracle_value *a, const oracle_value *b) {
  if (mpfr_sgn(a->hi) < 0)
    r->state = UNDEFINED;
  else if (mpfr_sgn(a->lo) <= 0)
    r->state = DOUBTFUL;
  else
    oracle_corners(o, r, a, b, mpfr_pow);
}

/* r := op(a, b), defined operands; the signs of zeros in them may change */
static inline void oracle_operation(
    expression_oracle *o, uint32_t op, oracle_value *r, oracle_value *a, oracle_value *b, int32_t n) {
  r->state = DEFINED;
  switch (op) {
  case AMBIT_OP_ADD: mpfr_add(r->lo, a->lo, b->lo, MPFR_RNDD), mpfr_add(r->hi, a->hi, b->hi, MPFR_RNDU); break;
  case AMBIT_OP_SUB:
    if (a == b)
      mpfr_set_zero(r->lo, 1), mpfr_set_zero(r->hi, 1); /* one number, not two */
    else
      mpfr_sub(r->lo, a->lo, b->hi, MPFR_RNDD), mpfr_sub(r->hi, a->hi, b->lo, MPFR_RNDU);
    break;
  case AMBIT_OP_NEG: oracle_falling(r, a, mpfr_neg); break;
  case AMBIT_OP_MUL: oracle_corners(o, r, a, b, mpfr_mul); break;
  case AMBIT_OP_SQR: oracle_square(r, a, 2); break;
  case AMBIT_OP_POWN: oracle_square(r, a, n); break;
  case AMBIT_OP_DIV: oracle_divide(o, r, a, b); break;
  case AMBIT_OP_SQRT: oracle_from(r, a, 0, false, mpfr_sqrt); break;
  case AMBIT_OP_EXP: oracle_rising(r, a, mpfr_exp); break;
  case AMBIT_OP_LOG: oracle_from(r, a, 0, true, mpfr_log); break;
  case AMBIT_OP_SIN: oracle_wave(o, r, a, mpfr_sin); break;
  case AMBIT_OP_COS: oracle_wave(o, r, a, mpfr_cos); break;
  case AMBIT_OP_TAN: oracle_tan(o, r, a); break;
  case AMBIT_OP_ASIN: oracle_arc(r, a, true); break;
  case AMBIT_OP_ACOS: oracle_arc(r, a, false); break;
  case AMBIT_OP_ATAN: oracle_rising(r, a, mpfr_atan); break;
  case AMBIT_OP_ATAN2: oracle_atan2(o, r, a, b); break;
  case AMBIT_OP_SINH: oracle_rising(r, a, mpfr_sinh); break;
  case AMBIT_OP_COSH: oracle_cosh(r, a); break;
  case AMBIT_OP_TANH: oracle_rising(r, a, mpfr_tanh); break;
  case AMBIT_OP_ABS: oracle_abs(r, a); break;
  case AMBIT_OP_MIN: mpfr_min(r->lo, a->lo, b->lo, MPFR_RNDD), mpfr_min(r->hi, a->hi, b->hi, MPFR_RNDU); break;
  case AMBIT_OP_MAX: mpfr_max(r->lo, a->lo, b->lo, MPFR_RNDD), mpfr_max(r->hi, a->hi, b->hi, MPFR_RNDU); break;
  case AMBIT_OP_LOG1P: oracle_from(r, a, -1, true, mpfr_log1p); break;
  case AMBIT_OP_EXPM1: oracle_rising(r, a, mpfr_expm1); break;
  case AMBIT_OP_ASINH: oracle_rising(r, a, mpfr_asinh); break;
  case AMBIT_OP_ACOSH: oracle_from(r, a, 1, false, mpfr_acosh); break;
  case AMBIT_OP_ATANH: oracle_atanh(r, a); break;
  case AMBIT_OP_LOG2: oracle_from(r, a, 0, true, mpfr_log2); break;
  case AMBIT_OP_LOG10: oracle_from(r, a, 0, true, mpfr_log10); break;
  case AMBIT_OP_EXP2: oracle_rising(r, a, mpfr_exp2); break;
  case AMBIT_OP_CBRT: oracle_rising(r, a, mpfr_cbrt); break;
  case AMBIT_OP_HYPOT: oracle_hypot(r, a, b); break;
  case AMBIT_OP_POW: oracle_pow(o, r, a, b); break;
  default: abort();
  }
}

static inline void oracle_literal(expression_oracle *o, oracle_value *r, const char *text) {
  const char *slash = strchr(text, '/');
  if (strcmp(text, "pi") == 0) {
    mpfr_const_pi(r->lo, MPFR_RNDD), mpfr_const_pi(r->hi, MPFR_RNDU);
    return;
  }
  mpfr_strtofr(r->lo, text, NULL, 10, MPFR_RNDD), mpfr_strtofr(r->hi, text, NULL, 10, MPFR_RNDU);
  if (!slash) return;
  mpfr_set_si(o->s, atol(slash + 1), MPFR_RNDN); /* exact */
  mpfr_div(r->lo, r->lo, o->s, MPFR_RNDD), mpfr_div(r->hi, r->hi, o->s, MPFR_RNDU);
}

/* Bounds that MPFR could not hold, or too far apart to judge anything: nothing is claimed. */
static inline void oracle_settle(expression_oracle *o, oracle_value *r) {
  if (r->state != DEFINED) return;
  bool held = mpfr_number_p(r->lo) && mpfr_number_p(r->hi);
  if (held) {
    mpfr_sub(o->s, r->hi, r->lo, MPFR_RNDU);
    held = mpfr_cmp_d(o->s, 0x1p-60) <= 0 || mpfr_get_exp(o->s) < mpfr_get_exp(r->hi) - 100;
  }
  if (!held) r->state = DOUBTFUL;
}

/* All nodes at the point. */
static inline void oracle_evaluate(expression_oracle *o, const random_expression *x, const double *point) {
  for (uint32_t i = 0; i < x->count; i++) {
    const random_node *q = &x->node[i];
    oracle_value *r = &o->node[i];
    r->state = DEFINED;
    if (q->op == LEAF_LITERAL)
      oracle_literal(o, r, q->text);
    else if (q->op >= AMBIT_OP_END) {
      double value = q->op == LEAF_DATUM ? point[q->a] : q->number;
      mpfr_set_d(r->lo, value, MPFR_RNDD), mpfr_set_d(r->hi, value, MPFR_RNDU);
    } else {
      oracle_value *a = &o->node[q->a], *b = &o->node[q->b];
      if (a->state == UNDEFINED || b->state == UNDEFINED)
        r->state = UNDEFINED;
      else if (a->state == DOUBTFUL || b->state == DOUBTFUL)
        r->state = DOUBTFUL;
      else
        oracle_operation(o, q->op, r, a, b, q->n);
    }
    oracle_settle(o, r);
  }
}

/* Could the value lie in x? */
static inline bool oracle_inside(const oracle_value *v, ambit_interval x) {
  return mpfr_cmp_d(v->lo, x.hi) <= 0 && mpfr_cmp_d(v->hi, x.lo) >= 0;
}
#endif
