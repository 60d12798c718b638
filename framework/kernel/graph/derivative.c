/* derivative.c -- the chain rule, node by node, operands first.
**
** The derivative of a node uses the node itself where it can (exp, sqrt, quotients, tan, tanh), so that values and
** derivatives share work on a tape. ABS, MIN and MAX have no derivative where they switch, so they are refused unless
** their operands are fixed. ATAN2 jumps on its cut, b < 0 at a = 0, yet its formula is defined there: a derivative
** holds only where the original is defined and differentiable (graph.h).
*/
#include "graph/fold.h"
#include "graph/kink.h"
#include "graph/name.h"
#include "num/function.h"
#include "graph/walk.h"
#include <stdlib.h>

static ambit_expr op2(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) { return ambit_graph_op(g, op, a, b); }
static ambit_expr add(ambit_graph *g, ambit_expr a, ambit_expr b) { return ambit_fold_sum(g, a, b, false); }
static ambit_expr subtract(ambit_graph *g, ambit_expr a, ambit_expr b) { return ambit_fold_sum(g, a, b, true); }
static ambit_expr times(ambit_graph *g, ambit_expr a, ambit_expr b) { return op2(g, AMBIT_OP_MUL, a, b); }
/* a da, where da may be a structural zero: it stays one even where a is not proved to be defined */
static ambit_expr share(ambit_graph *g, ambit_expr a, ambit_expr da) {
  return da == AMBIT_ZERO ? AMBIT_ZERO : times(g, a, da);
}
static ambit_expr over(ambit_graph *g, ambit_expr a, ambit_expr b) { return op2(g, AMBIT_OP_DIV, a, b); }
static ambit_expr unary(ambit_graph *g, uint32_t op, ambit_expr a) { return op2(g, op, a, a); }

/* n a^(n-1): n itself is a double; a^(INT32_MIN - 1) is written in two steps */
static ambit_expr power_slope(ambit_graph *g, ambit_expr e, ambit_expr a, int32_t n) {
  ambit_expr lower = n > INT32_MIN ? ambit_graph_pown(g, a, n - 1) : over(g, e, a);
  return times(g, ambit_graph_number(g, n), lower);
}

/* f'(a) for e = f(a) */
static ambit_expr slope(ambit_graph *g, ambit_expr e, uint32_t op, ambit_expr a, ambit_expr b) {
  switch (op) {
  case AMBIT_OP_SQR: return times(g, ambit_graph_number(g, 2), a);
  case AMBIT_OP_POWN: return power_slope(g, e, a, (int32_t)b);
  case AMBIT_OP_SQRT: return over(g, ambit_graph_number(g, 0.5), e);
  case AMBIT_OP_EXP: return e;
  case AMBIT_OP_LOG: return over(g, AMBIT_ONE, a);
  case AMBIT_OP_SIN: return unary(g, AMBIT_OP_COS, a);
  case AMBIT_OP_COS: return ambit_fold_negate(g, unary(g, AMBIT_OP_SIN, a));
  case AMBIT_OP_TAN: return add(g, AMBIT_ONE, unary(g, AMBIT_OP_SQR, e));
  case AMBIT_OP_ASIN:
  case AMBIT_OP_ACOS: {
    ambit_expr root = unary(g, AMBIT_OP_SQRT, subtract(g, AMBIT_ONE, unary(g, AMBIT_OP_SQR, a)));
    ambit_expr s = over(g, AMBIT_ONE, root);
    return op == AMBIT_OP_ASIN ? s : ambit_fold_negate(g, s);
  }
  case AMBIT_OP_ATAN: return over(g, AMBIT_ONE, add(g, AMBIT_ONE, unary(g, AMBIT_OP_SQR, a)));
  case AMBIT_OP_SINH: return unary(g, AMBIT_OP_COSH, a);
  case AMBIT_OP_COSH: return unary(g, AMBIT_OP_SINH, a);
  case AMBIT_OP_TANH: return subtract(g, AMBIT_ONE, unary(g, AMBIT_OP_SQR, e));
  default: return ambit_op_is_function(op) ? ambit_function_of(op)->slope(g, e, a) : AMBIT_NO_EXPR;
  }
}

/* of a function of two operands */
static ambit_expr total(ambit_graph *g, ambit_expr e, ambit_node x, ambit_expr da, ambit_expr db) {
  const ambit_described *f = ambit_function_of(x.op);
  ambit_expr first = da == AMBIT_ZERO ? da : times(g, f->partial(g, e, x.a, x.b, false), da);
  ambit_expr second = db == AMBIT_ZERO ? db : times(g, f->partial(g, e, x.a, x.b, true), db);
  return add(g, first, second);
}

/* d f(a, b) given da, db: e = f(a, b) is node x */
static ambit_expr differential(ambit_graph *g, ambit_expr e, ambit_node x, ambit_expr da, ambit_expr db) {
  switch (x.op) {
  case AMBIT_OP_ADD: return add(g, da, db);
  case AMBIT_OP_SUB: return subtract(g, da, db);
  case AMBIT_OP_NEG: return ambit_fold_negate(g, da);
  case AMBIT_OP_MUL: return add(g, share(g, x.b, da), share(g, x.a, db));
  case AMBIT_OP_DIV: return over(g, subtract(g, da, share(g, e, db)), x.b);
  case AMBIT_OP_ATAN2: {
    ambit_expr turn = subtract(g, share(g, x.b, da), share(g, x.a, db));
    return over(g, turn, add(g, unary(g, AMBIT_OP_SQR, x.a), unary(g, AMBIT_OP_SQR, x.b)));
  }
  default:
    if (ambit_op_is_function(x.op) && ambit_op_is_binary(x.op)) return total(g, e, x, da, db);
    return times(g, slope(g, e, x.op, x.a, x.b), da);
  }
}

static const char *not_smooth(uint32_t op) {
  return op == AMBIT_OP_ABS ? "abs" : op == AMBIT_OP_MIN ? "min" : op == AMBIT_OP_MAX ? "max" : NULL;
}

static ambit_expr no_memory(ambit_failure *f) {
  ambit_fail(f, AMBIT_NOMEM, "out of memory while differentiating");
  return AMBIT_NO_EXPR;
}

/* d [walk->count]: at the leaves given, elsewhere computed here. */
static ambit_expr chain(ambit_graph *g, const ambit_walk *walk, ambit_expr *d, ambit_failure *f) {
  ambit_expr last = AMBIT_ZERO;
  for (size_t i = 0; i < walk->count; i++) {
    ambit_expr e = walk->node[i];
    ambit_node x = *ambit_at(g, e);
    ambit_expr da = d[walk->a[i]], db = d[walk->b[i]];
    if (!ambit_op_is_leaf(x.op)) {
      const char *kink = not_smooth(x.op);
      bool fixed = da == AMBIT_ZERO && db == AMBIT_ZERO;
      if (kink && !fixed) {
        const char *writer = ambit_graph_writer(g, e);
        ambit_fail(f, AMBIT_INVALID, "%s%s%s has no derivative where it switches: it cannot be differentiated", kink,
            writer ? " of " : "", writer ? writer : "");
        return AMBIT_NO_EXPR;
      }
      d[i] = fixed ? AMBIT_ZERO : differential(g, e, x, da, db);
      if (d[i] == AMBIT_NO_EXPR) return no_memory(f);
    }
    last = d[i];
  }
  return last;
}

/* Where the time derivative would need that of a function of which only bounds are known. */
static ambit_expr no_rate(const ambit_graph *g, ambit_expr varying, ambit_failure *f) {
  char name[AMBIT_DATUM_NAME_MAX];
  ambit_graph_leaf_name(g, varying, name);
  ambit_fail(f, AMBIT_INVALID,
      "`%s` varies in time in any way within its bounds: what is differentiated by time, such as a position, a length "
      "or a given motion, may not depend on it; use ambit.between for one unknown constant",
      name);
  return AMBIT_NO_EXPR;
}

static ambit_expr find_varying(const ambit_graph *g, const ambit_walk *walk) {
  for (size_t i = 0; i < walk->count; i++)
    if (ambit_at(g, walk->node[i])->op == AMBIT_LEAF_VARYING) return walk->node[i];
  return AMBIT_NO_EXPR;
}

static ambit_expr differentiate(ambit_graph *g, ambit_expr e, size_t n, const ambit_expr *leaf, const ambit_expr *rate,
    ambit_expr time_rate, ambit_failure *f) {
  if (e >= g->count) {
    ambit_fail(f, AMBIT_INVALID, "there is no expression to differentiate");
    return AMBIT_NO_EXPR;
  }
  ambit_walk walk;
  if (!ambit_walk_open(g, 1, &e, NULL, &walk)) return no_memory(f);
  ambit_expr *d = calloc(walk.count, sizeof *d); /* AMBIT_ZERO everywhere */
  if (d) {
    uint32_t at = g->time == AMBIT_NO_EXPR ? UINT32_MAX : ambit_walk_find(g, g->time);
    if (at != UINT32_MAX) d[at] = time_rate;
    for (size_t k = 0; k < n; k++)
      if ((at = ambit_walk_find(g, leaf[k])) != UINT32_MAX) d[at] = rate[k];
  }
  ambit_expr varying = time_rate == AMBIT_ZERO ? AMBIT_NO_EXPR : find_varying(g, &walk);
  ambit_expr r = !d ? no_memory(f) : varying != AMBIT_NO_EXPR ? no_rate(g, varying, f) : chain(g, &walk, d, f);
  free(d);
  ambit_walk_close(&walk);
  return r;
}

ambit_expr ambit_graph_derivative(ambit_graph *g, ambit_expr e, ambit_expr x, ambit_failure *f) {
  ambit_expr one = AMBIT_ONE;
  return differentiate(g, e, 1, &x, &one, AMBIT_ZERO, f);
}

ambit_expr ambit_graph_time_derivative(
    ambit_graph *g, ambit_expr e, size_t n, const ambit_expr *leaf, const ambit_expr *rate, ambit_failure *f) {
  return differentiate(g, e, n, leaf, rate, AMBIT_ONE, f);
}

ambit_expr ambit_graph_rate_off_kinks(
    ambit_graph *g, ambit_expr e, size_t n, const ambit_expr *leaf, const ambit_expr *rate, ambit_failure *f) {
  e = e < g->count ? ambit_graph_kinks_as_roots(g, e) : e;
  return e == AMBIT_NO_EXPR ? no_memory(f) : differentiate(g, e, n, leaf, rate, AMBIT_ONE, f);
}
