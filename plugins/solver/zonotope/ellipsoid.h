/* ellipsoid.h -- old errors, and what they become with the data: part of the set, beside the generators. */
#ifndef ZONOTOPE_ELLIPSOID_H
#define ZONOTOPE_ELLIPSOID_H
#include "proof.h"

typedef struct ellipsoid {
  double *Q;      /* [nx x nx] l'e <= sqrt(l'Q l) for all l */
  double *size;   /* [nx] sqrt(Q_ii), rounded up */
  double *sum;    /* [nx x nx] sum X_i / s_i of this step, the lower half */
  double total;   /* sum s_i */
  uint32_t terms; /* their number */
  double *mean;   /* [nx x nx] its map, without the data */
  double *weight; /* [nx x nx] for traces */
  double *map, *half, *work, *work_new;
  double *column, *row, *turned;
  uint32_t age;
  double *unit;            /* [nx] of the states, for traces */
  double *segment, *reach; /* [nx] */
  double *mixed;           /* [nx x (ngen_max + nx)] what one datum makes of the generators */
  int is_used;
} ellipsoid;

int ellipsoid_open(zono *z); /* 0: no memory */
void ellipsoid_start(zono *z);
void ellipsoid_begin(zono *z, const double *y); /* a step's end: nothing is added yet */
void ellipsoid_move(zono *z, const double *y);  /* adds what it becomes by the map y / E, from y + at on */
void ellipsoid_add(zono *z, const double *v, enum origin from); /* adds v r, |r| <= 1: to the box, if it is not used */
void ellipsoid_finish(zono *z);                                 /* Q from what was added */
double ellipsoid_size(const zono *z, uint32_t i);               /* |e_i|, at most */
double ellipsoid_through(const zono *z, const double *y);       /* |sum_k y_k e_k / E_k|, at most */
#endif
