/* rational.h -- the number that a constant expression is, exactly.
**
** Sums, products, quotients and powers of decimals are rational numbers, so that two of them can be told apart however
** near they are. Nothing else in the graph does that: its constants are known by doubles.
*/
#ifndef AMBIT_RUN_RATIONAL_H
#define AMBIT_RUN_RATIONAL_H
#include <ambit/graph.h>
#include <ambit/rational.h>
#include <ambit/registry.h>

ambit_status ambit_rational_find(ambit_registry *r, const ambit_rational_service **s, ambit_failure *f);
/* x := the number that e is; false: it is none of these (pi, roots, uncertain data), or has more digits than anybody
** writes, and x is anything. */
bool ambit_rational_of(const ambit_rational_service *s, const ambit_graph *g, ambit_expr e, ambit_rational *x);
#endif
