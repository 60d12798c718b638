/* jets.h -- Taylor series of a tape: layout and program.
**
** A coefficient is midpoint +- radius. Each slot has its coefficients contiguous by order, and, if it is ever the
** right factor of a product, a second copy in reversed order: then coefficient k of a product, sum_j a_j b_(k-j), is
** one dot product of contiguous arrays. The two terms with order k itself are added by themselves: so the long sum
** waits for no number that was just written. All arrays hold finite numbers at all times. A coefficient that is not
** bounded is stored as DBL_MAX and remembered as `failed`. Slopes: for each block of `width` directions, an array by
** order of `width` midpoints, and one of radii.
*/
#ifndef JETS_H
#define JETS_H
#include "interval.h"

typedef struct row { /* a power series with interval coefficients */
  double *mid, *rad;
} row;

typedef struct slot {
  row u;        /* order k at [k] */
  row reversed; /* order k at [order - k] */
  row moving;   /* k u_k at [k]: the series of t du/dt */
  row mean;     /* of u over the box and u at the centre; u itself if there is no centre */
  row mean_moving;
  row slope, slope_moving; /* [block][order + 1][width] */
  uint32_t degree;         /* coefficients above are zero */
  uint32_t varies;         /* some input reaches this slot; if not, slopes are zero */
} slot;

#define STEP_COPY AMBIT_OP_COUNT /* r := a */

/* A product of series that the rule of a step needs: coefficient k is sum_j a_j b_(k-j). */
typedef struct factors {
  row a, b;        /* b reversed */
  uint32_t da, db; /* degrees */
} factors;

/* One instruction; SIN and COS of the same operand are one step, and SINH and COSH (r: sine, other: cosine). */
typedef struct step {
  uint32_t op, degree;
  slot *r, *other;
  const slot *a, *b, *aux;
  uint32_t r_index, other_index, a_index, b_index; /* to find the same slot at the centre */
  uint32_t nproduct;
  factors product[3];
} step;

typedef struct jets jets;
struct jets {
  const ambit_num_service *num;
  const ambit_meter_service *meter;
  uint32_t order, ndir, width, blocks;
  uint32_t nslot, nsource, nin; /* sources are the constants and inputs, nin of them inputs */
  uint32_t nstep, nmoving;      /* steps whose degree is at least 1 come first in `moving` */
  slot *slot;
  step *step;
  const step **moving;
  const jets *centre;
  uint32_t failed, flags; /* first order that could not be bounded, and why; order + 1 if none */
};

/* jets_open.c; width: directions in a vector of the variant */
ambit_status jets_open(const ambit_host *h, void *ctx, const ambit_tape *t, uint32_t order, uint32_t ndir,
    const void *centre, uint32_t width, void **self);
void jets_close(void *self);
/* jets_access.c */
void jets_put(void *self, uint32_t in, uint32_t k, double mid, double rad, const double *dmid, const double *drad);
void jets_get(const void *self, uint32_t slot, uint32_t k, double *mid, double *rad, double *dmid, double *drad);
void jets_magnitude(const void *self, uint32_t slot, uint32_t n, double *mag, double *dmag);

/* jets_start.c, upward mode. Flags are AMBIT_F_*. */
typedef struct bounds {
  double lo, hi;
} bounds;
bounds jets_bounds(row u); /* of coefficient 0 */
bounds jets_intersect(bounds a, bounds b);
/* order 0 of the functions of a step; any but ADD, SUB, NEG */
uint32_t jets_start(const jets *j, const step *s, bounds *r, bounds *other);
/* Intervals that contain the slope of r by its operand and of other by its operand; ATAN2: of r by its first and by
** its second operand. For LOG, ATAN, ATAN2, EXP, SIN, SINH, TANH. */
uint32_t jets_start_slope(const jets *j, const step *s, bounds *first, bounds *second);
/* ABS, MIN, MAX: 1 if the result is a, -1 if it is b (ABS: -a), 0 if order 0 over the box and
** at the centre leaves it open */
int jets_choice(const jets *j, const step *s);
#endif
