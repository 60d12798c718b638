/* given.h -- a start that is given as polynomials of many terms: the set that another run ended with. */
#ifndef ZONOTOPE_GIVEN_H
#define ZONOTOPE_GIVEN_H
#include "zonotope.h"

/* Are there so many instructions, all of them sums, products, and quotients by constants, that a row for each would
** take much memory? */
int given_is_large(const ambit_tape *t);
/* rows and radii of all outputs, with data j = unknown[j] at about_j + scale_j xi_j; off [nin]: how far inputs are from
** that. 0: no memory, or too large to compute with */
int given_evaluate(zono *z, const double *off);
#endif
