/* substitute.h -- one variable of a polynomial in a plain array replaced by mid + rad y. Upward mode. */
#ifndef SUBSTITUTE_H
#define SUBSTITUTE_H
#include "monomials.h"

/* coef [count]; rad 0: the variable disappears */
void substitute_variable(const monomials *m, double *coef, uint32_t v, double mid, double rad);
/* How much the polynomial over [-1, 1]^nvar differs from the exact one at most, if |mid| + rad <= 1 (to a few units in
** the last place) and `size` bounds the sum of |coef| before. */
double substitute_error(const monomials *m, double size);
#endif
