/* polynomial.h -- sparse polynomials whose variables ("atoms") are expressions, for ambit_graph_simplify.
**
** A coefficient is a constant expression: an exact double, or what the graph made of doubles whose sum or product is
** none. Nothing is rounded. Monomials are sorted, none twice. When a term cancels, its atoms that are not total are
** remembered: a polynomial from which one of them has vanished may be defined where its expression is not, and must
** not replace it (ambit_polynomial_keeps). The ring fails above its limit of terms and when memory is exhausted.
*/
#ifndef AMBIT_POLYNOMIAL_H
#define AMBIT_POLYNOMIAL_H
#include <ambit/graph.h>

#define AMBIT_LOST_MAX 64u

typedef struct ambit_ring {
  ambit_graph *g;
  ambit_arena *arena; /* of all polynomials */
  size_t limit, work; /* terms of one polynomial; terms ever made */
  bool failed;
  ambit_expr lost[AMBIT_LOST_MAX]; /* atoms that are not total and were in a term that cancelled */
  size_t nlost;
} ambit_ring;

typedef struct ambit_power {
  ambit_expr atom;
  uint32_t n; /* >= 1 */
} ambit_power;

typedef struct ambit_monomial {
  const ambit_graph *g; /* whose order the atoms have */
  ambit_expr c;         /* not 0 */
  uint32_t n;
  ambit_power *power; /* [n] by ascending atom (ambit_store_order) */
} ambit_monomial;

typedef struct ambit_polynomial {
  size_t n;
  ambit_monomial *term; /* [n] ascending; n = 0: the polynomial 0 */
} ambit_polynomial;

ambit_polynomial ambit_polynomial_of(ambit_ring *ring, ambit_expr e); /* a constant, or constant * atom */
ambit_polynomial ambit_polynomial_add(ambit_ring *ring, ambit_polynomial p, ambit_polynomial q, bool negative);
ambit_polynomial ambit_polynomial_multiply(ambit_ring *ring, ambit_polynomial p, ambit_polynomial q);
ambit_polynomial ambit_polynomial_power(ambit_ring *ring, ambit_polynomial p, uint32_t n); /* n >= 1 */
/* Even powers of the function `op` (SIN, COS) by 1 - the square of its partner. */
ambit_polynomial ambit_polynomial_reduce(ambit_ring *ring, ambit_polynomial p, uint32_t op);
bool ambit_polynomial_keeps(const ambit_ring *ring, ambit_polynomial p); /* are all lost atoms still in p? */

ambit_expr ambit_polynomial_expanded(ambit_ring *ring, ambit_polynomial p); /* a sum of products */
ambit_expr ambit_polynomial_factored(
    ambit_ring *ring, ambit_polynomial p); /* the commonest atoms taken out, again and again */
#endif
