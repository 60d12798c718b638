/* rank.h -- a certificate: over a whole set of configurations the constraint Jacobian has full rank.
**
** Over a box of coordinates (uncertain data over their ranges) B(q), an irreducible diagonal block of G_d, is regular
** for every q if ||1 - C B||_inf < 1 for some matrix C: then C B = 1 - (1 - C B) has the Neumann series as its inverse,
** so B has one (Neumaier, Interval Methods for Systems of Equations, 1990, ch. 4). C is an approximate
** inverse at the midpoint. G_d is block triangular, so it is regular where all its blocks are. Boxes are narrowed to
** where the loops can be closed (contract.h: no assembled configuration is lost) and bisected until they are proved or
** the budget is spent. Hence "proved": at every assembled configuration in the box the kept rows of G have full rank,
** and the dependent speeds are unique.
*/
#ifndef AMBIT_RANK_H
#define AMBIT_RANK_H
#include "mechanics/loops.h"

#define AMBIT_RANK_PROVED 0
#define AMBIT_RANK_UNDECIDED 1
#define AMBIT_RANK_SINGULAR 2 /* the box is one point, and a block is proved singular there */
#define AMBIT_RANK_EMPTY 3    /* proved: no assembled configuration in the box */

typedef struct ambit_rank_request {
  ambit_mechanism *mechanism;
  size_t n;
  const char *const *name; /* [n] coordinates that g or G depends on: all of them */
  const double *lo, *hi;   /* [n] */
  double time_lo, time_hi; /* used if anything depends on time */
  size_t budget;           /* boxes to look at */
} ambit_rank_request;

typedef struct ambit_rank {
  int outcome;
  ambit_loops loops;
  ambit_partition partition; /* for which the outcome holds: that of the loops, or one chosen for this box */
  size_t boxes;              /* looked at */
  size_t nrow;               /* UNDECIDED, SINGULAR: rows of the block that was not proved regular */
  const uint32_t *row;
} ambit_rank;

/* INVALID: a coordinate without a range, a range that is empty or not finite, loops that cannot be built. */
ambit_status ambit_rank_certify(const ambit_rank_request *q, ambit_arena *arena, ambit_rank *r, ambit_failure *f);
#endif
