/* change.h -- what the slopes' dependence on the data makes of the distance within a step: change.c. */
#ifndef ZONOTOPE_CHANGE_H
#define ZONOTOPE_CHANGE_H
#include "quartic.h"

#define CROSSES 2 /* of what a datum changes */

/* J - J_0 = sum_r xi_k(r) u_r w_r' + what dJ bounds then */
typedef struct change {
  double *slope;       /* [ntarget x nx x m] what each datum makes of coefficients of states */
  int known;           /* it is of the step at hand */
  uint32_t count;      /* of crosses; 0: dJ is all */
  double *u, *w;       /* [CROSSES m x nx] */
  double *mean, *tilt; /* [CROSSES m x nx] w' mean, w' tilt */
  double *size, *flat; /* [CROSSES m] for the mean, moment and end of |w' z(s)|: s / h times the one, and the other */
  lump *lump;          /* [CROSSES m] of it */
  double *rest, *work; /* [nx x nx] dJ without crosses; [nx x nx] */
} change;

int change_open(zono *z);   /* 0: no memory */
void change_begin(zono *z); /* crosses, if generators depend on the data */
/* c theta is part of z', |theta| <= rest */
void change_note(zono *z, const double *c, double rest);
/* sizes, from all that was noted, |c| rest of which is summed up in centre, and what else z' has; dJ := rest */
void change_end(zono *z, const double *centre, const double *width);
#endif
