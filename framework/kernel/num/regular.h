/* regular.h -- is every matrix within an interval matrix regular? Is it singular?
**
** Regular: if ||1 - C B||_inf < 1 for some point matrix C and every B of the set, then C B and so B is invertible
** (Neumann series; Rex & Rohn 1998). C is an approximate inverse of the midpoint; nothing is claimed of it.
** Singular: a determinant whose enclosure is [0, 0].
*/
#ifndef AMBIT_REGULAR_H
#define AMBIT_REGULAR_H
#include <ambit/interval.h>
#include <stddef.h>

#define AMBIT_SINGULAR_MAX 8u

/* c := an approximate inverse of the midpoint of b [n*n] by rows, by Gauss-Jordan; c has room for 2*n*n. false: none
** found. */
bool ambit_invert_middle(size_t n, const ambit_interval *b, double *c);
/* Upper bound of ||1 - C B||_inf over the set; infinite or empty entries make it infinite. */
double ambit_distance_from_one(size_t n, const ambit_interval *b, const double *c);

/* b [n*n] by rows, scratch [2*n*n]. false: not proved. */
bool ambit_is_regular(size_t n, const ambit_interval *b, double *scratch);
/* Every matrix of the set, by expansion of the determinant. false: not proved, or n > AMBIT_SINGULAR_MAX. */
bool ambit_is_singular(size_t n, const ambit_interval *b);
#endif
