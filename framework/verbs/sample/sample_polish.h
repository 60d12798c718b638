/* sample_polish.h -- from the extremes that were drawn uphill: a compass search in the box of the data.
**
** Each quantity and side has its own search: from its best point one datum at a time moves by a part of its range, to
** both sides, cut off at the ends; then all the moves that helped together. Without a gain the part is divided by 4.
** The first part is the whole range, so for a quantity that is monotone in each datum two rounds lead to the corner
** that is its extreme. (Hooke & Jeeves 1961; Kolda, Lewis & Torczon 2003.) It finds a local extreme and proves nothing;
** what it evaluates are values like those of any draw.
*/
#ifndef AMBIT_SAMPLE_POLISH_H
#define AMBIT_SAMPLE_POLISH_H
#include <ambit/status.h>
#include "verbs/sample/sample_extremes.h"
#include <ambit/interval.h>

typedef struct ambit_polish {
  const ambit_interval *range; /* [n] */
  ambit_extremes *extremes;    /* where the searches start; what they find is added */
  size_t budget;               /* of evaluations, at most */
  double finest;               /* part of a range at which a search ends */
  size_t first;                /* number of the first evaluation: draws come before */
  /* values [m][count] (NaN: none) at point [n][count] */
  ambit_status (*evaluate)(void *user, size_t count, const double *point, double *value);
  void *user;
} ambit_polish;

/* *evaluated: how many were made. OK, NOMEM, or what evaluate said. */
ambit_status ambit_polish_run(const ambit_polish *q, ambit_arena *arena, size_t *evaluated);
#endif
