/* jet_general.h -- inside of the general jets: power series as rows of elements in one block.
**
** Column 0 of a slot is its value series; with a centre, column 1 is the mean series (u(X) + u(c)) / 2; then one
** column per slope direction. Without a centre the mean is the value itself. A slot that some recursion needs in the
** form k u_k has every column a second time, weighted by k. A row is as long as the slot's degree in time allows.
*/
#ifndef AMBIT_JET_GENERAL_H
#define AMBIT_JET_GENERAL_H
#include "graph/jet.h"
#include <ambit/interval.h>
#include <ambit/meter.h>

#define AMBIT_SERIES_NEW UINT32_MAX /* as a target: the next scratch element */

typedef struct ambit_series ambit_series;
struct ambit_series {
  const ambit_tape *tape;
  const ambit_arithmetic *arithmetic;
  void *ctx;
  const ambit_series *centre;
  const ambit_meter_service *meter; /* NULL: not profiled */
  /* numbers of the mean's and the first slope's column; columns per slot */
  uint32_t order, ndir, mean, slope, columns;
  size_t elem, count; /* bytes per element, elements in all */
  char *base;
  uint32_t *first, *length;    /* [nslot] first element, coefficients per row */
  uint8_t *weighted;           /* [nslot] */
  int8_t *branch;              /* [ninstr] of ABS, MIN, MAX: +1 as is or first, -1 negated or second, 0 undecided */
  uint32_t zero, half, number; /* elements: 0, 1/2; number + k: k, k <= order */
  uint32_t factor;             /* two elements: slope factors of an elementary function */
  uint32_t scratch, used, room;
  uint32_t *target, *left, *right; /* [order + 1] operand lists of a run */
  uint32_t flags;                  /* of the advance in progress */
  uint32_t raised;                 /* flags of all orders so far */
  uint32_t refused;                /* a coefficient was put above the degree of its input: nothing can be proved */
};

typedef struct ambit_row {
  uint32_t first, length;
} ambit_row;

ambit_row ambit_series_row(const ambit_series *s, uint32_t slot, uint32_t column);
ambit_row ambit_series_weighted(const ambit_series *s, uint32_t slot, uint32_t column);
/* the element of a_k; that of 0 beyond the row */
uint32_t ambit_series_at(const ambit_series *s, ambit_row a, uint32_t k);
ambit_interval ambit_series_bounds(const ambit_series *s, uint32_t element);
void ambit_series_set(ambit_series *s, uint32_t element, ambit_interval x);

/* dst := op(a, b); returns dst. Flags are collected. */
uint32_t ambit_series_apply(ambit_series *s, uint32_t dst, uint32_t op, uint32_t a, uint32_t b);
/* dst := sum_{j=from}^{to} a_j b_(k-j); returns dst */
uint32_t ambit_series_convolve(
    ambit_series *s, uint32_t dst, ambit_row a, ambit_row b, uint32_t from, uint32_t to, uint32_t k);

/* coefficient k of the value, of slope direction d, of instruction i */
void ambit_series_value(ambit_series *s, uint32_t i, uint32_t k);
void ambit_series_slope(ambit_series *s, uint32_t i, uint32_t k, uint32_t d);
/* before the slopes of order 0: the factors that instruction i's directions share */
void ambit_series_factor(ambit_series *s, uint32_t i);
#endif
