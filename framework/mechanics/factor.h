/* factor.h -- A = U D U^T inside the graph, U unit upper triangular, and solutions of A x = b.
**
** No pivoting: for mass matrices of open chains, ordered from the base to the tip, this fills in least, and the pivots
** are the masses felt at each joint (Featherstone 2008, ch. 6). Every step is an identity where no pivot is 0.
*/
#ifndef AMBIT_FACTOR_H
#define AMBIT_FACTOR_H
#include <ambit/graph.h>

typedef struct ambit_factor {
  ambit_graph *g;
  size_t n;
  ambit_expr *u; /* [n*n] upper triangle: what is left of A, then U; on the diagonal D */
  size_t limit;  /* of ambit_graph_simplify for what the elimination leaves; 0: as it is */
} ambit_factor;

/* Called with each pivot before it divides, the last row first; another status than OK ends the elimination. */
typedef ambit_status (*ambit_pivot_check)(void *user, size_t k, ambit_expr pivot);

ambit_status ambit_factorise(const ambit_factor *a, ambit_pivot_check check, void *user);
/* x := A^-1 x; entries AMBIT_NO_EXPR: out of memory */
void ambit_factor_solve(const ambit_factor *a, ambit_expr *x);
#endif
