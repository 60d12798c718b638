/* zonotope.h -- what solutions of one sub-range of the unknowns may be off the polynomials: G e, e in [-1, 1]^columns.
**
** A linear map moves the generators and wraps nothing; a step adds a box of n new ones. When there are too many, the
** older half of the young ones becomes n along principal axes, and these are kept beside; when too many are kept, all
** of them become n again. Change of frame: with D powers of two, E = I - Q^T Q, |E| <= eps < 1 in the row-sum norm,
**   z = sum_c e_c d_c = D Q y,  |y_j| <= v_j + eps / (1 - eps) max v,  v_j = sum_c |Q^T D^-1 d_c|_j
** (docs/numerics/taylor_flow.md).
*/
#ifndef TAYLOR_MODEL_ZONOTOPE_H
#define TAYLOR_MODEL_ZONOTOPE_H
#include "polynomial.h"

typedef struct zonotope_shape {
  uint32_t n, keep;    /* states; boxes held before the older half is condensed */
  size_t room, size;   /* columns; doubles of one zonotope in memory */
  double *work, *unit; /* [n x n x 2 + 2 n] scratch; [n] */
} zonotope_shape;

typedef struct zonotope { /* in memory: used, fixed, then sums [n], then rows of columns [n x room] */
  double *head, *sum, *column;
} zonotope;
enum { USED, FIXED, HEAD };

int zonotope_open(const ambit_host *h, zonotope_shape *w, uint32_t n, uint32_t keep);
static inline zonotope zonotope_at(const zonotope_shape *w, double *base, size_t number) {
  double *at = base + number * w->size;
  return (zonotope) { at, at + HEAD, at + HEAD + w->n };
}
void zonotope_clear(const zonotope_shape *w, zonotope r);
/* G := M G; pad[n] takes what rounding may change. M [n x n] */
void zonotope_multiply(const zonotope_shape *w, zonotope r, const double *M, double *pad);
void zonotope_push(const zonotope_shape *w, zonotope r, const double *box); /* and sums anew */
#endif
