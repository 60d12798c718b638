/* series.h -- Taylor series in time whose coefficients are polynomials: the `ambit_jets` of this plugin.
**
** Opened through "ambit.jet/1", so that the kernel's `tail` works on them. What differs from other jets: a coefficient
** of an input is an exact polynomial, and `integrate` puts the rounded quotient there and keeps what it leaves out as a
** `defect`, because the solver follows polynomials that are no solutions, and bounds by how much they fail.
*/
#ifndef TAYLOR_MODEL_SERIES_H
#define TAYLOR_MODEL_SERIES_H
#include "range.h"
#include <ambit/jet.h>
#include <ambit/meter.h>
#include <ambit/num.h>

#define SCRATCH_CELLS 12

typedef struct series {
  const space *space;
  const ambit_num_service *num;
  const ambit_meter_service *meter; /* NULL: not profiled */
  const ambit_tape *tape;
  uint32_t order;
  double *cells;         /* [nslot x (order + 1)] */
  double *inverses;      /* [ninstr] 1 / the divisor of the recursion at order 0, where there is one */
  uint32_t *has_inverse; /* [ninstr] number of its cell + 1 */
  int8_t *branch;        /* [ninstr] ABS, MIN, MAX: 1 as is or the first, -1 negated or the second, 0 undecided */
  double *scratch;       /* [SCRATCH_CELLS] */
  double *defect;        /* [nin x order] of input i at order k: |f_k - (k + 1) x_(k+1)| on the cube */
  sum sum;
  search search;
  uint32_t kink; /* number + 1 of the instruction that met its kink, 0: none */
} series;

/* what the jets' open gets as `ctx`; it leaves the object here */
typedef struct series_source {
  const space *space;
  const ambit_num_service *num;
  series *made;
} series_source;

extern const ambit_jets series_jets;

static inline cell series_cell(const series *s, uint32_t slot, uint32_t k) {
  return cell_at(s->space, s->cells, (size_t)slot * (s->order + 1u) + k);
}
static inline cell series_scratch(const series *s, uint32_t n) { return cell_at(s->space, s->scratch, n); }
/* coefficient 0 of input `in` := the polynomial with these coefficients +- rad */
void series_put(series *s, uint32_t in, const double *c, double rad);

/* rules.c: order k of instruction i; AMBIT_F_* */
uint32_t series_rule(series *s, uint32_t i, uint32_t k);
/* functions.c: of polynomials; AMBIT_F_*. floor: a lower bound of |divisor| known otherwise, or 0 */
uint32_t series_inverse(series *s, cell to, cell a, double floor);
uint32_t series_function(series *s, uint32_t op, cell to, cell pair, cell a, cell b);
/* functions.c: bounds of p +- rad over the cube, which is cut if that is needed to see the sign */
void series_range(const series *s, cell x, double *low, double *high);
#endif
