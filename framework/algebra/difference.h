/* difference.h -- u(x) - w(x - d), written so that it vanishes with d and with what u and w do not have in common.
**
** For a model and a reduced one, run together: x' = f(x) and, for e = x - y with y' = g(y), e' = f(x) - g(x - e). Taken
** as it stands, the right-hand side is a difference of two large numbers, and an enclosure of it never becomes small.
** Here it is rewritten by identities of real functions: sin u - sin v = 2 cos(u - D/2) sin(D/2) with D = u - v, the
** product rule u v - u~ v~ = D[u] v + u~ D[v], and so on; equal terms and factors of u and w meet each other. Functions
** that the kernel describes (AMBIT_FUNCTIONS) are written in other operations first.
**
** Every rule is an identity wherever u(x) and w(x - d) are both defined (docs/numerics/reduction.md), with one
** exception: the square root, D/(sqrt u + sqrt v), is not defined at u = v = 0, where the root has no derivative.
** Functions without such an identity on their whole domain (abs, min, max, asin, acos, atan2) are left as the plain
** difference; with `clamps`, abs, min and max are kept within what the differences of their operands allow, which
** narrows bounds of values, but widens those of slopes. What does not depend on d may disappear from the result
** although it is not defined everywhere: the result says nothing about where u is defined.
*/
#ifndef AMBIT_DIFFERENCE_H
#define AMBIT_DIFFERENCE_H
#include <ambit/graph.h>

/* out[i] := u[i](leaf) - w[i](leaf - delta), i < n; all from one memory, so that what they share is shared. INVALID: an
** argument that is no expression, or a `leaf` that is none. */
ambit_status ambit_graph_difference(ambit_graph *g, size_t n, const ambit_expr *u, const ambit_expr *w, size_t nleaf,
    const ambit_expr *leaf, const ambit_expr *delta, bool clamps, ambit_expr *out, ambit_failure *f);
#endif
