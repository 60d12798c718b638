/* history.h -- the part z of a set that no unknown accounts for: generators w_c d_c, and frames for what is condensed.
 */
#ifndef LOHNER_HISTORY_H
#define LOHNER_HISTORY_H
#include "ball.h"
#include <ambit/base.h>

/* Generators w_c d_c, oldest first, in groups of n columns; a group has a level (history.c). */
typedef struct history {
  uint32_t n;    /* states */
  uint32_t keep; /* groups of one level before the older half is condensed; 0: one frame, condensed at every step */
  uint32_t group, room;                      /* groups held, and how many fit */
  uint32_t *level;                           /* [room] */
  size_t pitch;                              /* columns per row */
  double *direction;                         /* [n x pitch] */
  double *weight;                            /* [pitch] */
  double *block;                             /* [n x BLOCK] scratch of the product */
  double *frame, *shape, *size, *sum, *unit; /* scratch of condensing: [n x n] [n x n] [n] [n] [n] */
  uint32_t *order;                           /* [n] */
} history;

int history_open(const ambit_host *h, history *g, uint32_t n, uint32_t keep);
void history_clear(history *g);
/* G := M G, rounded; adds what rounding may have changed to pad[n]. M [n x n], rows `pitch` apart; rest[n] is the
** sum before */
void history_multiply(history *g, const double *M, size_t pitch, const double *rest, double *pad);
void history_push(history *g, const double *box); /* n new generators: the box, one for each state */
void history_sum(const history *g, double *rest); /* rest[i] >= sum over columns of |G_ic| */
/* about J G [k x g->pitch], J [k x n] with rows `pitch` apart, about G (J G)^T, transposed [k x n], and about the sums
** of squares of the rows of G [n] */
void history_spread(const history *g, uint32_t k, const double *J, size_t pitch, double *spread);
void history_correlate(const history *g, uint32_t k, const double *spread, double *cross, double *square);

/* frame.c: orthogonal frames; results are approximate, bounds are not */
/* Gram-Schmidt of n columns of A [n x pitch], longest of length times weight first; order, size: scratch [n] */
void frame_orthogonal(
    uint32_t n, const double *A, size_t pitch, const double *weight, double *frame, uint32_t *order, double *size);
double frame_defect(
    uint32_t n, const double *frame); /* >= the row-sum norm of I - Q^T Q; infinite if anything is not finite */
#endif
