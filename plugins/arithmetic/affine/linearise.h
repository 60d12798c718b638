/* linearise.h -- an elementary function on an interval as a line plus an error. */
#ifndef AFFINE_LINEARISE_H
#define AFFINE_LINEARISE_H
#include "affine.h"

#define FAR_OUT 0x1p40 /* angles beyond are not counted in turns, and get no line */
#define LINEARISE_CHUNK 64
#define LINEARISE_RECIPROCAL AMBIT_OP_COUNT /* 1/x; the other functions by their opcode */

/* For x in [a[i], b[i]]: op(x) - slope[i] x lies in [glo[i], ghi[i]]. Given are the ranges, which lie in the domain and
** are no points, and enclosures [flo, fhi] of op over them, which are bounded. */
typedef struct linearise_chunk {
  uint32_t op;
  int32_t power; /* of POWN: not 0, 1 or INT32_MIN */
  size_t n;
  double a[LINEARISE_CHUNK], b[LINEARISE_CHUNK], flo[LINEARISE_CHUNK], fhi[LINEARISE_CHUNK];
  double slope[LINEARISE_CHUNK], glo[LINEARISE_CHUNK], ghi[LINEARISE_CHUNK];
} linearise_chunk;

/* upward mode; all results are finite */
void linearise(const affine_context *c, linearise_chunk *k);

/* -- the parts */

typedef struct range {
  double lo, hi;
} range;

/* values.c: f and f' at points and over intervals */
void linearise_values(
    const affine_context *c, uint32_t op, int32_t power, size_t n, const double *x, double *lo, double *hi);
/* enclosures of f' over [a[i], b[i]], with f there */
void linearise_slopes(const affine_context *c, uint32_t op, int32_t power, size_t n, const double *a, const double *b,
    const double *flo, const double *fhi, double *lo, double *hi);
/* about the x with f'(x) = slope, of any branch, no promise */
void linearise_touch(const affine_context *c, uint32_t op, int32_t power, size_t n, const double *slope, double *x);

/* waves.c: the extrema of sin x - slope x (COS: cos) between the ends, added to [glo, ghi] */
void linearise_waves(const affine_context *c, linearise_chunk *k);
#endif
