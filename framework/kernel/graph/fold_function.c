/* fold_function.c -- functions of one operand, and atan2, min, max: parity, inverses, multiples of pi, known order. */
#include "graph/fold.h"
#include "num/function.h"

static bool is_odd(uint32_t op) {
  return op == AMBIT_OP_SIN || op == AMBIT_OP_TAN || op == AMBIT_OP_ASIN || op == AMBIT_OP_ATAN ||
         op == AMBIT_OP_SINH || op == AMBIT_OP_TANH || (ambit_op_is_function(op) && ambit_function_of(op)->facts.odd);
}

static bool is_even(uint32_t op) { return op == AMBIT_OP_COS || op == AMBIT_OP_COSH || op == AMBIT_OP_ABS; }

/* Is -a the canonical one of the two? */
static bool prefers_negative(const ambit_graph *g, ambit_expr a) {
  const ambit_node *x = ambit_at(g, a);
  if (x->op == AMBIT_OP_SUB) return ambit_fold_precedes(g, x->b, x->a);
  return ambit_fold_is_negative(g, a);
}

/* sin and cos of k pi/2 */
static bool quarter_turns(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr *r) {
  ambit_term t = ambit_fold_split(g, a);
  if (t.body != g->pi || (op != AMBIT_OP_SIN && op != AMBIT_OP_COS)) return false;
  double quarters = 2 * fmod(t.c, 2); /* exact */
  if (quarters != floor(quarters)) return false;
  int k = ((int)quarters + (op == AMBIT_OP_COS ? 1 : 0) + 4) % 4; /* cos x = sin(x + pi/2) */
  *r = k % 2 == 0 ? AMBIT_ZERO : ambit_graph_number(g, k == 1 ? 1 : -1);
  return true;
}

/* op(inner(x)) -> x. `everywhere`: inner is defined wherever x is, so that the domain does not grow. */
static bool undo(const ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr *r) {
  static const struct {
    uint32_t op, inner;
    bool everywhere;
  } inverse[] = {
    { AMBIT_OP_LOG, AMBIT_OP_EXP, true },
    { AMBIT_OP_TAN, AMBIT_OP_ATAN, true },
    { AMBIT_OP_EXP, AMBIT_OP_LOG, false },
    { AMBIT_OP_SIN, AMBIT_OP_ASIN, false },
    { AMBIT_OP_COS, AMBIT_OP_ACOS, false },
  };
  const ambit_node *x = ambit_at(g, a);
  *r = x->a;
  for (size_t i = 0; i < sizeof inverse / sizeof *inverse; i++)
    if (op == inverse[i].op && x->op == inverse[i].inner) return inverse[i].everywhere || x->total;
  return false;
}

/* |a| where the sign of a is known; false: it is not. */
static bool known_sign(ambit_graph *g, ambit_expr a, ambit_expr *r) {
  ambit_interval range = ambit_at(g, a)->range;
  if (range.lo >= 0)
    *r = a;
  else if (range.hi <= 0)
    *r = ambit_fold_negate(g, a);
  else
    return false;
  return true;
}

static ambit_expr absolute(ambit_graph *g, ambit_expr a) {
  ambit_expr r;
  if (known_sign(g, a, &r)) return r;
  ambit_term t = ambit_fold_split(g, a);
  return ambit_fold_scale(g, fabs(t.c), ambit_store_make(g, AMBIT_OP_ABS, t.body, t.body));
}

ambit_expr ambit_fold_function(ambit_graph *g, uint32_t op, ambit_expr a) {
  ambit_expr r;
  const ambit_node *x = ambit_at(g, a);
  if (quarter_turns(g, op, a, &r) || undo(g, op, a, &r)) return r;
  if (op == AMBIT_OP_SQRT && x->op == AMBIT_OP_SQR && known_sign(g, x->a, &r)) return r;
  if ((is_odd(op) || is_even(op)) && prefers_negative(g, a)) {
    r = ambit_fold_negate(g, a);
    if (r == AMBIT_NO_EXPR) return r;
    r = ambit_fold_function(g, op, r);
    return is_odd(op) ? ambit_fold_negate(g, r) : r;
  }
  return op == AMBIT_OP_ABS ? absolute(g, a) : ambit_store_make(g, op, a, a);
}

ambit_expr ambit_fold_pair(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  const ambit_node *x = ambit_at(g, a), *y = ambit_at(g, b);
  if (op == AMBIT_OP_ATAN2)
    return a == AMBIT_ZERO && y->total && y->range.lo > 0 ? AMBIT_ZERO : ambit_store_make(g, op, a, b);
  if (a == b) return a;
  bool a_below = x->range.hi <= y->range.lo, b_below = y->range.hi <= x->range.lo;
  if (x->total && y->total && (a_below || b_below)) return a_below == (op == AMBIT_OP_MIN) ? a : b;
  return ambit_fold_precedes(g, b, a) ? ambit_store_make(g, op, b, a) : ambit_store_make(g, op, a, b);
}
