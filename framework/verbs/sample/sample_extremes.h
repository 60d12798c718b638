/* sample_extremes.h -- the least and the greatest value seen of each of several quantities, and where they were. */
#ifndef AMBIT_SAMPLE_EXTREMES_H
#define AMBIT_SAMPLE_EXTREMES_H
#include <ambit/arena.h>
#include <stdbool.h>

enum { AMBIT_LEAST, AMBIT_GREATEST, AMBIT_SIDES };

typedef struct ambit_extreme {
  bool seen;
  double value;
  size_t draw;   /* its number; of equal values the first one counts, whoever saw it first */
  double *point; /* [n] */
} ambit_extreme;

typedef struct ambit_extremes {
  size_t m, n;       /* quantities, data */
  ambit_extreme *at; /* [m * AMBIT_SIDES] */
} ambit_extremes;

bool ambit_extremes_open(ambit_extremes *e, ambit_arena *arena, size_t m, size_t n); /* false: out of memory */
/* A value of quantity j (NaN: none) at point[i * stride]; is it the new extreme of one side? */
bool ambit_extremes_see(ambit_extremes *e, size_t j, double value, size_t draw, const double *point, size_t stride);
void ambit_extremes_merge(ambit_extremes *into, const ambit_extremes *from);
#endif
