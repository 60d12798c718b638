/* splitting.h -- which directions of a piece are fast, and the ends of its frame; approximate. */
#ifndef STIFF_SPLITTING_H
#define STIFF_SPLITTING_H
#include "spectrum.h"

/* Errors of the state are B z with |z|, by blocks of columns in the 2-norm, at most w. The first n - fast columns are
** slow. */
typedef struct carried {
  int valid;                           /* 0: nothing was carried yet, B is the unit matrix times the scale */
  uint32_t fast, blocks, block[N_MAX]; /* block of each column, ascending */
  square B;
  double w[N_MAX]; /* [blocks] */
} carried;

/* What a piece, in its own time s in [-1, 1], is split by: both ends' spectra and rates (eta/2) J */
typedef struct ends {
  uint32_t n, states;  /* parameters follow the states */
  const double *scale; /* [n] size of each state */
  const spectrum *from, *to;
  const double *rate_from, *rate_to; /* (eta/2) J [n x n] */
} ends;

typedef struct split {
  uint32_t slow, fast, blocks, block[N_MAX];
  square slow0, slow1, fast0, fast1; /* [n x slow], [n x fast] at s = -1 and 1 */
  double decay[N_MAX];               /* [fast] of the columns of fast0, about */
  square G0;                         /* [slow x slow]: the carried slow columns are slow0 G0 */
} split;

/* 0: no splitting is good enough */
int split_choose(const ends *e, const carried *b, split *r);
#endif
