/* expand.h -- products over sums written out: a (b + c) = a b + a c, (b + c)/d = b/d + c/d, (a + b)^2 = a^2 + 2 a b +
** b^2.
**
** Only what is multiplied is written out, not denominators or arguments of functions: the summands of the result are
** the terms of an equation in expanded form. By the distributive law in a commutative ring of atoms (polynomial.h,
** where 1/d is an atom), an identity on the domain of e; equal products are collected, and cancel only if every atom
** that is not total is still there.
*/
#ifndef AMBIT_EXPAND_H
#define AMBIT_EXPAND_H
#include <ambit/graph.h>

/* e written out as far as it has at most `limit` summands then: its summands are taken from left to right, and one that
** would make too many stays as it is; so does a factor that would alone. e itself if there is nothing to write out, or
** not within the limits of a ring. */
ambit_expr ambit_graph_expand(ambit_graph *g, ambit_expr e, size_t limit);
#endif
