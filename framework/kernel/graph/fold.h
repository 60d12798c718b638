/* fold.h -- the rules that rewrite an operation as it is made. Each rule is proved in docs/numerics/folding.md.
**
** A term is c * body with an exact double c that is not part of the body. All functions return AMBIT_NO_EXPR when
** memory is exhausted, and pass AMBIT_NO_EXPR on.
*/
#ifndef AMBIT_FOLD_H
#define AMBIT_FOLD_H
#include "graph/store.h"

typedef struct ambit_term {
  double c;
  ambit_expr body; /* AMBIT_ONE: the term is the constant c */
} ambit_term;

ambit_term ambit_fold_split(const ambit_graph *g, ambit_expr e);        /* e = c * body */
ambit_expr ambit_fold_scale(ambit_graph *g, double c, ambit_expr body); /* c * body */
/* The result of the operation on exact constants, if it is a double. */
bool ambit_fold_exact(uint32_t op, double a, double b, double *r);
bool ambit_fold_exact_power(double a, int32_t n, double *r);
bool ambit_fold_precedes(const ambit_graph *g, ambit_expr a, ambit_expr b); /* the canonical order of operands */
bool ambit_fold_is_negative(
    const ambit_graph *g, ambit_expr e); /* e has a minus sign that ambit_fold_negate takes away */

ambit_expr ambit_fold_negate(ambit_graph *g, ambit_expr a);
ambit_expr ambit_fold_sum(ambit_graph *g, ambit_expr a, ambit_expr b, bool negative); /* a + b, a - b */
ambit_expr ambit_fold_product(ambit_graph *g, ambit_expr a, ambit_expr b);
ambit_expr ambit_fold_quotient(ambit_graph *g, ambit_expr a, ambit_expr b);
ambit_expr ambit_fold_power(ambit_graph *g, ambit_expr a, int32_t n);
/* s + t by one of the angle sums; false: none fits. *r may be AMBIT_NO_EXPR. */
bool ambit_fold_angles(ambit_graph *g, ambit_term s, ambit_term t, ambit_expr *r);
ambit_expr ambit_fold_function(ambit_graph *g, uint32_t op, ambit_expr a);           /* unary */
ambit_expr ambit_fold_pair(ambit_graph *g, uint32_t op, ambit_expr a, ambit_expr b); /* ATAN2, MIN, MAX */

/* One operand of a tree of sums (or products): where it is is told by a path from the root, bit i: the b side at
** depth i. */
typedef struct ambit_item {
  ambit_expr e;
  bool negative;
  uint32_t path, depth;
} ambit_item;

#define AMBIT_ITEM_DEPTH 12u /* how far below the root a rule looks: bounds the work per operation */

/* The last operands of the tree below e, at most `room`; MUL: factors, ADD: signed terms. */
size_t ambit_fold_items(const ambit_graph *g, uint32_t op, ambit_expr e, size_t room, ambit_item *item);
/* The tree without that operand; a tree of nothing is 0, or 1. */
ambit_expr ambit_fold_without(ambit_graph *g, uint32_t op, ambit_expr e, const ambit_item *item);
/* a + b or a - b, a * b in canonical order and sign, without looking deeper. */
ambit_expr ambit_fold_join(ambit_graph *g, ambit_expr a, ambit_expr b, bool negative);
ambit_expr ambit_fold_multiply(ambit_graph *g, ambit_expr a, ambit_expr b);
#endif
