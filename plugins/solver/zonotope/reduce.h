/* reduce.h -- fewer generators. */
#ifndef ZONOTOPE_REDUCE_H
#define ZONOTOPE_REDUCE_H
#include "proof.h"

typedef struct joint {
  double share, sign; /* of the first column in the sum; of the second one */
  double left;        /* what they leave, in units of the states' sets */
} joint;

joint joint_of(const zono *z, const double *a, const double *b); /* the best for two columns */
void join(zono *z, double *a, const double *b, joint j,
    enum origin from); /* a := a + sign b; what they leave goes into the box */
/* what a column in the box is larger by than itself, in units of the states' sets [Girard 2005] */
double boxed_size(const zono *z, const double *g);
void reduce(zono *z, uint32_t n); /* G := the columns [n] that count most; the others join them, or leave */
#endif
