/* residual.h -- lumps as what they leave in the equations for unknowns. */
#ifndef ZONOTOPE_RESIDUAL_H
#define ZONOTOPE_RESIDUAL_H
#include "quartic.h"

typedef struct residual {
  int used;
  double *W, *dW; /* [na x nslot] adjoints of the equations: middle, half width */
  double *lean;   /* [na x (na + nvarying) x nx] of the half width, what each eps makes: of unknowns, of what varies */
  double *row;    /* [nx] */
  lump *size;     /* [na] what is left of equation q, by lumps that have no column of their own; no `most` */
  double *miss;   /* [na] by how much an unknown differs besides */
} residual;

int residual_open(zono *z); /* 0: no memory */
/* the adjoint of equation q at slot j: W, dW; eps [nx] what each eps makes of it */
void residual_keep(zono *z, uint32_t q, uint32_t j, double middle, double width, const double *eps);
void residual_start(zono *z); /* of a step */
/* adds lump j to the equations; own: it has columns of its own, only its coefficients' widths are added */
void residual_add(zono *z, uint32_t j, lump size, int own);
/* adds what slopes vary by, after the last lump */
void residual_close(zono *z);
#endif
