/* range.h -- tight upper bounds of polynomials over boxes of the cube, by branch and bound.
**
** Each box holds the polynomial re-expanded about its middle; the bound is that of its coefficients, the inner estimate
** its value at a vertex. The box with the highest bound is halved until bound and estimate meet. To bound from below,
** negate.
*/
#ifndef TAYLOR_MODEL_RANGE_H
#define TAYLOR_MODEL_RANGE_H
#include "polynomial.h"

typedef struct search {
  const space *space;
  uint32_t room, used;
  double *about, *reach; /* [room x m] */
  double *bound, *rest;  /* [room] of p + rest over the box; rest belongs to the box */
  double *p, *q;         /* [size] the polynomial, and over a box */
  double best;           /* some value of p + rest, or less */
} search;

int search_open(const ambit_host *h, search *w, const space *s, uint32_t room);
/* begins with p (times sign, 1 or -1); then boxes are added; then search_maximum */
void search_begin(search *w, const double *p, double sign);
void search_add(search *w, const double *about, const double *reach, double rest);
/* upper bound of p + rest over all boxes, up to about `tolerance` above the maximum if there is room; sign_only: until
** it is below zero or the maximum is not */
double search_maximum(search *w, double tolerance, int sign_only);
#endif
