/* solve.h -- linear interval equations.
**
** With C, roughly the inverse of the middle of A: if ||1 - C B||_inf <= d < 1 for every B of A, then x = B^-1 b is
** within d / (1 - d) ||C b||_inf of C b, because x - C b = (1 - C B) x and ||x|| <= ||C b|| / (1 - d) (Neumann series).
** The same equation narrows the enclosure component by component, as long as that pays.
*/
#ifndef AMBIT_SOLVE_H
#define AMBIT_SOLVE_H
#include <ambit/interval.h>
#include <stddef.h>

/* x [n] := an enclosure of all B^-1 c, B in a [n x n] by rows, c in b [n]. scratch [2*n*n]. false: A is not proved
** regular. */
bool ambit_solve_enclose(
    size_t n, const ambit_interval *a, const ambit_interval *b, ambit_interval *x, double *scratch);
#endif
