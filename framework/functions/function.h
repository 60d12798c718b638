/* function.h -- what the files of this folder share: one function each, described for everybody (num/function.h).
**
** A new function is a row of AMBIT_FUNCTIONS (ambit/tape.h) and a file here that defines ambit_function_NAME.
*/
#ifndef AMBIT_FUNCTIONS_FUNCTION_H
#define AMBIT_FUNCTIONS_FUNCTION_H
#include "functions/value.h"
#include "graph/store.h"
#include "num/function.h"

#define FACTS(shape_, least_, most_, open_, odd_, touch_)                                                              \
  {                                                                                                                    \
    .size = sizeof(ambit_function_facts), .shape = shape_, .least = least_, .most = most_, .open = open_, .odd = odd_, \
    .touch = touch_                                                                                                    \
  }

/* -- intervals */

static inline ambit_interval function_op(uint32_t op, ambit_interval a) {
  ambit_interval r;
  ambit_interval_op(op, &r, a, a);
  return r;
}
static inline ambit_interval function_power(ambit_interval a, int32_t n) {
  ambit_interval r;
  ambit_interval_pown(&r, a, n);
  return r;
}
static inline ambit_interval function_over(ambit_interval a, double n) {
  return ambit_interval_div(a, (ambit_interval) { n, n });
}

/* (-1)^(k-1) / (k x^k): coefficient k of ln x */
static inline ambit_interval function_log_coefficient(ambit_interval x, uint32_t k) {
  ambit_interval r = function_over(function_power(x, -(int32_t)k), k);
  return k % 2 ? r : value_negate(r);
}

/* -- expressions: with folding, for derivatives; node by node, for `written` */

static inline ambit_expr function_number(ambit_graph *g, double x) { return ambit_graph_number(g, x); }
static inline ambit_expr function_make(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  return ambit_store_make(g, op, a, b);
}
static inline ambit_expr function_make_one(ambit_graph *g, uint32_t op, ambit_expr a) {
  return ambit_store_make(g, op, a, a);
}
static inline ambit_expr function_fold(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b) {
  return ambit_graph_op(g, op, a, b);
}
static inline ambit_expr function_fold_one(ambit_graph *g, uint32_t op, ambit_expr a) {
  return ambit_graph_op(g, op, a, a);
}
#endif
