/* strip.h -- states that are known to stay within bounds (ambit_problem.x_least). */
#ifndef ZONOTOPE_STRIP_H
#define ZONOTOPE_STRIP_H
#include "zonotope.h"

int strip_bounds(const zono *z, uint32_t i); /* are bounds of state i known? */
uint32_t strip_columns(const zono *z);       /* that a step may add; */
int strip_open(zono *z);                     /* 0: no memory */
/* the rows and n columns of the end of a step, cut to these bounds; returns the number of columns */
uint32_t strip_all(zono *z, uint32_t n);
void strip_within(const zono *z, double *lo, double *hi); /* the same of ranges of all states */
#endif
