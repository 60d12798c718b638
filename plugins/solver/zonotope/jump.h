/* jump.h -- sampled systems: states become functions of themselves at known instants. */
#ifndef ZONOTOPE_JUMP_H
#define ZONOTOPE_JUMP_H
#include "zonotope.h"

int jump_open(zono *z);             /* after the initial values; 0: no memory */
size_t jump_columns(const zono *z); /* that one jump may add */
int jump_open_proofs(zono *z);      /* after that of the flow; 0: no memory */
/* the set at an instant := what all jumps of this instant make of it; 0: see z->why */
int jump_all(zono *z);
/* the instant of the next jump; infinite: there is none */
static inline double jump_next(const zono *z) {
  return z->jumped < z->problem.njump_time ? z->problem.jump_time[z->jumped] : INFINITY;
}
#endif
