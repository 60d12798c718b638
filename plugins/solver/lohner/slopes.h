/* slopes.h -- S of x(t+h) = phi(m) + S v: how the end of a step depends on coordinates v of its start, over the set and
** piece by piece of it.
*/
#ifndef LOHNER_SLOPES_H
#define LOHNER_SLOPES_H
#include "flow.h"

struct sizes;

typedef struct pieces {
  uint32_t count;
  part part[PIECES_MAX]; /* of the cube of xi; together they are all of it */
} pieces;

/* the Hermite-Obreschkoff formula (hermite.c) */
typedef struct corrector {
  uint32_t r;                      /* order at both ends */
  ambit_jet *end_jet, *tube_jet;   /* derivatives over the end of the step, to order r; over the step, to 2 r + 1 */
  double *weight, *loose;          /* [r + 1] c_i +- loose */
  balls from, to;                  /* [nx x ndir] P; Q_xi, Q */
  double *error;                   /* [nx x ndir] bound of E by directions */
  balls guess;                     /* [nx x ndir] the Taylor slopes at the end */
  double *inverse, *work, *defect; /* [nx x nx] A; scratch; |I - A Q| */
  balls d;                         /* [ndir] scratch */
  double *added;                   /* [nx] what error and defect add to the set */
} corrector;

typedef struct slopes {
  pieces pieces;        /* of this step */
  balls piece, whole;   /* [options.pieces x nx x ndir] S over each piece; [nx x ndir] over the whole set */
  double *matrix;       /* [nx x ndir] M, the point matrix that the set is moved with */
  const double *taylor; /* [nx x ndir] radii of the explicit slopes over the whole set, whether they are used or not */
  int corrected;        /* slopes at the end are those of the corrector */
  int wide;             /* slopes varied over the set in the last step */
  double varies;        /* how much, relative to the set */
  double *curvature;    /* [nc] how much slopes vary */
  uint32_t *cuts;       /* [nc] into how many parts each xi is cut */
  double *added;        /* [nx] what the excess of slopes adds to the set */
  corrector corrector;
} slopes;

ambit_status slopes_open(const field *f, slopes *S);
void slopes_close(const field *f, slopes *S);

/* S for the pieces of the set, and M. Destroys the series over the box; their proof stays. */
void slopes_choose(const field *f, const struct set *x, const struct sizes *z, flow *phi, slopes *S);
/* [-low, high]: what a row of slopes and the point row M make different, (S - M) v, for xi in a part of its cube */
void slopes_beyond(const field *f, const struct set *x, balls row, const double *M, part of, double *low, double *high);
/* (S - M) v of state i, over all pieces */
ball slopes_nonlinear(const field *f, const struct set *x, const slopes *S, uint32_t i);

/* hermite.c; not open if formula is FORMULA_TAYLOR */
ambit_status corrector_open(const field *f, corrector *c);
void corrector_close(const field *f, corrector *c);
/* better slopes at the end of the step, from the box series, its proof and the tube; 0: none */
int corrector_find(const field *f, const struct set *x, const flow *phi, corrector *c, balls S);
#endif
