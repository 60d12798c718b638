/* set.h -- the states at time t, { centre + low + C xi + z : xi in [-1, 1]^nc, z = G e, e in [-1, 1]^m }.
**
** centre + low is the midpoint in double-double, C the columns of the unknowns (never condensed), and G the generators
** of everything that was added on the way (history.c). The parameters are fixed + F xi, with the same xi. Arrays of
** rows and columns are by rows. Proofs: docs/numerics/lohner.md.
*/
#ifndef LOHNER_SET_H
#define LOHNER_SET_H
#include "field.h"
#include "flow.h"
#include "history.h"
#include "slopes.h"

typedef struct set {
  double t;
  double *centre, *low, *column; /* [nx] [nx] [nx x nc] m, l, C */
  history history;               /* z */
  double *rest, *radius;         /* [nx] bounds of |z|, and of |C xi + z + low| */
  double *lo, *hi;               /* [nx] */
  double *new_centre, *new_low;  /* [nx] where a move leads, ... */
  double *box;                   /* [nx] ... and what it adds to z */
} set;

int set_open(const field *f, set *x); /* 0: out of memory */

/* bound of coordinate j of a state, v = (xi, z + low) */
static inline double set_reach(const field *f, const set *x, uint32_t j) {
  return j < f->nc ? 1 : x->rest[j - f->nc] + fabs(x->low[j - f->nc]);
}

/* from the start of a step to its end */
void set_move(const field *f, set *x, const flow *phi, const slopes *S);
/* new midpoint of state i: the old one, a step and a shift; what is not in it goes to box[i] */
void set_shift(set *x, uint32_t i, double step, ball shift);
/* The new midpoints and the box take their places, generators are moved by M [nx x nx], rows `pitch` apart. */
void set_settle(const field *f, set *x, const double *M, size_t pitch);
void set_hull(const field *f, set *x); /* rest, radius, lo, hi */
#endif
