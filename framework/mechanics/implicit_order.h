/* implicit_order.h -- in which order accelerations and multipliers of a closed mechanism are eliminated, and by which
** equations.
**
** From the tips to the base the pivots are articulated inertias, and those of multipliers -G M^-1 G^T: all are regular
** where M is positive definite. A joint of a loop need not move any mass of its own. So the order is tried in numbers
** at the reference configuration: who has no pivot yet waits until others have given it one, or takes the equation with
** the largest entry. That is a choice in floating point; whoever uses it meets a pivot that vanishes and says so.
*/
#ifndef AMBIT_IMPLICIT_ORDER_H
#define AMBIT_IMPLICIT_ORDER_H
#include "mechanics/loops.h"

/* e [n] affine in unknown [n]. order [n]: unknowns in the order of elimination; equation [n]: number of the one that
** belongs to unknown k. `order` holds the one that is preferred. */
ambit_status ambit_implicit_order(const ambit_loops *loops, size_t n, const ambit_expr *e, const ambit_expr *unknown,
    uint32_t *order, uint32_t *equation, ambit_failure *f);
#endif
