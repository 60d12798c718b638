/* affine_in.h -- expressions that are affine in some symbols: e = constant + sum of coefficient[k] symbol[k].
**
** All symbols in question are told at opening; which nodes depend on any of them is then known node by node, and a
** search never goes below a node that does not. So a coefficient costs as many steps as there are nodes between e and
** the symbols, however large the rest of the graph is.
**
** The results are identities on the domain of e: sums, products and quotients are taken apart by their rules, and
** nothing else may depend on the symbols. They may be defined where e is not, because a product with 0 is 0 here, even
** if the other factor may be undefined: what such a factor comes from does not act on the result at all.
*/
#ifndef AMBIT_AFFINE_IN_H
#define AMBIT_AFFINE_IN_H
#include <ambit/graph.h>

typedef struct ambit_affine ambit_affine;

ambit_affine *ambit_affine_open(ambit_graph *g, size_t n, const ambit_expr *symbol); /* NULL: out of memory */
void ambit_affine_close(ambit_affine *a);

/* coefficient [ne*n] by rows and constant [ne]. Other symbols that were told at opening may occur in the constants.
** DOMAIN: e[i] is not affine in them, or a coefficient depends on one of the symbols told at opening; NOMEM. */
ambit_status ambit_affine_in(ambit_affine *a, size_t ne, const ambit_expr *e, size_t n, const ambit_expr *symbol,
    ambit_expr *coefficient, ambit_expr *constant);
/* to[i] := e[i] with value[k] for symbol[k]; to may be e */
ambit_status ambit_affine_put(ambit_affine *a, size_t ne, const ambit_expr *e, size_t n, const ambit_expr *symbol,
    const ambit_expr *value, ambit_expr *to);
/* Does any of e[n] depend on one of the symbols told at opening? Out of memory: true. */
bool ambit_affine_varies(ambit_affine *a, size_t n, const ambit_expr *e);
#endif
