/* implicit.h -- the equations R(x, a, p, t) = 0 for a, stage by stage: M_0 = dR/da at order 0, factored once a step. */
#ifndef ZONOTOPE_IMPLICIT_H
#define ZONOTOPE_IMPLICIT_H
#include "zonotope.h"

#define STAGE_MAX 250 /* unknowns of a stage: a row of the factors is one sum */

typedef struct implicit {
  double *partial;       /* what products keep while the unknowns of an order are sought */
  uint32_t *has_partial; /* [ninstr] number + 1 of the row, 0: none */
  double *change;        /* [nslot] rows: the change of slots by one unknown */
  uint32_t *changed;     /* [nslot] number + 1 of the unknown that it was last changed by */
  double *factor;   /* [sum of squares of stages] rows, in the order of pivots: L below, U on and above the diagonal */
  size_t *stage_at; /* [nstage] where a stage starts in `factor`, in rows */
  double *inverse;  /* [na] rows, 1 / the pivot of each unknown, in the order of pivots */
  double *y;        /* [na] rows */
} implicit;

int zono_open_implicit(zono *z);                      /* 0: no memory */
int zono_factor(zono *z, uint32_t stage);             /* from rows of order 0; 0: see z->why */
void zono_solve(zono *z, uint32_t stage, uint32_t k); /* adds to a_k what the rows of R_k ask for */

static inline double *implicit_partial(const zono *z, uint32_t i) {
  uint32_t n = z->implicit ? z->implicit->has_partial[i] : 0;
  return n ? z->implicit->partial + (size_t)(n - 1) * z->shape.stride : NULL;
}
#endif
