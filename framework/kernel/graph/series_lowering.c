/* series_lowering.c -- TAN, ASIN, ACOS and POWN in opcodes that have simple recurrences for Taylor coefficients;
** functions as their descriptions say.
**
**   tan u  = sin u / cos u                      acos u = pi/2 - asin u
**   asin u = atan(u / sqrt(1 - u^2)), |u| < 1   u^n    = (u^(n/2))^2 or u u^(n-1); n < 0: 1 / u^-n
**   1 / (1 + exp u) = (1 - tanh(u / 2)) / 2: bounded, whatever u is
**
** The domain is the same, but for asin and acos at -1 and 1, where their series do not exist. The nodes are made
** without folding, which would undo the work.
*/
#include "graph/series_lowering.h"
#include "graph/fold.h"
#include "graph/tape.h"
#include "graph/walk.h"
#include "num/function.h"
#include <stdlib.h>

static ambit_expr make(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  return ambit_store_make(g, op, a, b);
}

/* e^v if e = 1 + e^v */
static ambit_expr power_beside_one(const ambit_graph *g, ambit_expr e) {
  const ambit_node x = *ambit_at(g, e);
  if (x.op != AMBIT_OP_ADD || (x.a != AMBIT_ONE && x.b != AMBIT_ONE)) return AMBIT_NO_EXPR;
  ambit_expr power = x.a == AMBIT_ONE ? x.b : x.a;
  return ambit_at(g, power)->op == AMBIT_OP_EXP ? power : AMBIT_NO_EXPR;
}

/* a / (1 + e^v): with tanh(v / 2) it is bounded where e^v is too large for a double */
static ambit_expr lower_quotient(ambit_graph *g, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR || b == AMBIT_NO_EXPR) return AMBIT_NO_EXPR;
  ambit_expr power = power_beside_one(g, b), half = ambit_graph_number(g, 0.5);
  if (power == AMBIT_NO_EXPR) return make(g, AMBIT_OP_DIV, a, b);
  ambit_expr v = ambit_at(g, power)->a, argument = make(g, AMBIT_OP_MUL, half, v);
  ambit_expr y = make(g, AMBIT_OP_TANH, argument, argument);
  ambit_expr share = make(g, AMBIT_OP_MUL, half, make(g, a == power ? AMBIT_OP_ADD : AMBIT_OP_SUB, AMBIT_ONE, y));
  return a == power ? share : make(g, AMBIT_OP_MUL, a, share);
}

static ambit_expr lower_asin(ambit_graph *g, ambit_expr u) {
  ambit_expr rest = make(g, AMBIT_OP_SUB, AMBIT_ONE, make(g, AMBIT_OP_SQR, u, u));
  ambit_expr slope = make(g, AMBIT_OP_DIV, u, make(g, AMBIT_OP_SQRT, rest, rest));
  return make(g, AMBIT_OP_ATAN, slope, slope);
}

static ambit_expr lower_acos(ambit_graph *g, ambit_expr u) {
  ambit_expr half_pi = make(g, AMBIT_OP_MUL, ambit_graph_number(g, 0.5), ambit_graph_pi(g));
  return make(g, AMBIT_OP_SUB, half_pi, lower_asin(g, u));
}

/* u^n, n >= 1: squaring outermost wherever it can be, since SQR is tight on sets */
static ambit_expr positive_power(ambit_graph *g, ambit_expr u, uint32_t n) {
  if (n == 1) return u;
  if (n % 2) return make(g, AMBIT_OP_MUL, u, positive_power(g, u, n - 1));
  ambit_expr root = positive_power(g, u, n / 2);
  return make(g, AMBIT_OP_SQR, root, root);
}

static ambit_expr lower_power(ambit_graph *g, ambit_expr u, int32_t n) {
  if (n == 0) return make(g, AMBIT_OP_ADD, AMBIT_ONE, make(g, AMBIT_OP_MUL, AMBIT_ZERO, u)); /* 1 where u is defined */
  if (n > 0) return positive_power(g, u, (uint32_t)n);
  return make(g, AMBIT_OP_DIV, AMBIT_ONE, positive_power(g, u, (uint32_t)(-(int64_t)n)));
}

/* The operation on operands that are lowered already. */
static ambit_expr lower(ambit_graph *g, uint32_t flags, uint32_t op, ambit_expr a, ambit_expr b) {
  if (a == AMBIT_NO_EXPR) return a;
  uint32_t write = ambit_op_is_binary(op) ? AMBIT_SEAL_WRITE_PAIRS : AMBIT_SEAL_WRITE_FUNCTIONS;
  if (ambit_op_is_function(op) && (flags & (write | AMBIT_TAPE_SERIES))) return ambit_function_of(op)->written(g, a, b);
  if (!(flags & AMBIT_TAPE_SERIES)) return make(g, op, a, b);
  switch (op) {
  case AMBIT_OP_TAN: return make(g, AMBIT_OP_DIV, make(g, AMBIT_OP_SIN, a, a), make(g, AMBIT_OP_COS, a, a));
  case AMBIT_OP_DIV: return lower_quotient(g, a, b);
  case AMBIT_OP_ASIN: return lower_asin(g, a);
  case AMBIT_OP_ACOS: return lower_acos(g, a);
  case AMBIT_OP_POWN: return lower_power(g, a, (int32_t)b);
  default: return make(g, op, a, b);
  }
}

ambit_expr ambit_series_helper(ambit_graph *g, ambit_expr e) {
  const ambit_node x = *ambit_at(g, e);
  switch (x.op) {
  case AMBIT_OP_SIN: return make(g, AMBIT_OP_COS, x.a, x.a);
  case AMBIT_OP_COS: return make(g, AMBIT_OP_SIN, x.a, x.a);
  case AMBIT_OP_SINH: return make(g, AMBIT_OP_COSH, x.a, x.a);
  case AMBIT_OP_COSH: return make(g, AMBIT_OP_SINH, x.a, x.a);
  case AMBIT_OP_TANH: return make(g, AMBIT_OP_SUB, AMBIT_ONE, make(g, AMBIT_OP_SQR, e, e));
  case AMBIT_OP_ATAN: return make(g, AMBIT_OP_ADD, AMBIT_ONE, make(g, AMBIT_OP_SQR, x.a, x.a));
  case AMBIT_OP_ATAN2: return make(g, AMBIT_OP_ADD, make(g, AMBIT_OP_SQR, x.a, x.a), make(g, AMBIT_OP_SQR, x.b, x.b));
  default: return AMBIT_NO_EXPR;
  }
}

static bool needs_helper(uint32_t op) {
  return op == AMBIT_OP_SIN || op == AMBIT_OP_COS || op == AMBIT_OP_SINH || op == AMBIT_OP_COSH ||
         op == AMBIT_OP_TANH || op == AMBIT_OP_ATAN || op == AMBIT_OP_ATAN2;
}

static ambit_expr bound(ambit_graph *g, uint32_t flags, uint32_t op, ambit_expr a, ambit_expr b) {
  (void)flags;
  return op == AMBIT_OP_DIV ? lower_quotient(g, a, b) : make(g, op, a, b);
}

/* Rewrites root[0..nout) in place. */
static bool rewrite(ambit_graph *g, uint32_t flags, size_t nout, ambit_expr *root, ambit_walk_stop stop,
    ambit_expr (*by)(ambit_graph *, uint32_t, uint32_t, ambit_expr, ambit_expr)) {
  ambit_walk w;
  if (!ambit_walk_open(g, nout, root, stop, &w)) return false;
  ambit_expr *now = malloc((w.count + 1) * sizeof *now);
  bool done = now;
  for (size_t i = 0; i < nout && done; i++) root[i] = ambit_walk_find(g, root[i]);
  for (size_t i = 0; i < w.count && done; i++) {
    const ambit_node x = *ambit_at(g, w.node[i]);
    bool leaf = ambit_op_is_leaf(x.op) || (stop && stop(g, w.node[i]));
    const char *other = ambit_graph_written_by(g, ambit_graph_writer(g, w.node[i]));
    now[i] = leaf ? w.node[i] : by(g, flags, x.op, now[w.a[i]], x.op == AMBIT_OP_POWN ? x.b : now[w.b[i]]);
    ambit_graph_written_by(g, other);
    done = now[i] != AMBIT_NO_EXPR;
  }
  for (size_t i = 0; i < nout && done; i++) root[i] = now[root[i]];
  free(now);
  ambit_walk_close(&w);
  return done;
}

bool ambit_functions_write(ambit_graph *g, size_t n, ambit_expr *e) {
  return !g->has_functions || rewrite(g, AMBIT_SEAL_WRITE_FUNCTIONS | AMBIT_SEAL_WRITE_PAIRS, n, e, NULL, lower);
}

/* *root: room for the helpers of all nodes below, appended. */
static bool append_helpers(ambit_graph *g, ambit_expr **root, size_t *nroot, ambit_walk_stop stop) {
  ambit_walk w;
  if (!ambit_walk_open(g, *nroot, *root, stop, &w)) return false;
  ambit_expr *grown = realloc(*root, (*nroot + w.count + 1) * sizeof *grown);
  bool done = grown;
  if (grown) *root = grown;
  for (size_t i = 0; i < w.count && done; i++) {
    if (!needs_helper(ambit_at(g, w.node[i])->op) || (stop && stop(g, w.node[i]))) continue;
    ambit_expr helper = ambit_series_helper(g, w.node[i]);
    done = helper != AMBIT_NO_EXPR;
    grown[(*nroot)++] = helper;
  }
  ambit_walk_close(&w);
  return done;
}

bool ambit_series_bound(ambit_graph *g, size_t n, ambit_expr *e) { return rewrite(g, 0, n, e, NULL, bound); }

ambit_status ambit_series_lower(ambit_graph *g, size_t nout, const ambit_expr *out, uint32_t flags, ambit_expr **root,
    size_t *nroot, ambit_failure *f) {
  ambit_walk_stop stop = flags & AMBIT_SEAL_KEEP ? NULL : ambit_tape_folds;
  bool series = flags & AMBIT_TAPE_SERIES, write = flags & (AMBIT_SEAL_WRITE_FUNCTIONS | AMBIT_SEAL_WRITE_PAIRS);
  *nroot = nout;
  *root = calloc(nout + 1, sizeof **root);
  bool done = *root;
  for (size_t i = 0; i < nout && done; i++) (*root)[i] = out[i];
  if (done && (series || (write && g->has_functions))) done = rewrite(g, flags, nout, *root, stop, lower);
  if (done && series) done = append_helpers(g, root, nroot, stop);
  if (done) return AMBIT_OK;
  free(*root);
  *root = NULL;
  return ambit_fail(f, AMBIT_NOMEM, "out of memory while sealing a tape");
}
