/* series.h -- what a tape does to polynomials of one variable s in [-1, 1], in double-double, with proved remainders.
**
** Every slot holds a function u of s with |u(s) - sum_k u_k s^k| <= tail for all s in [-1, 1], the u_k being exact
** double-doubles: a Taylor model in one variable. Rounding, truncation and uncertainty all go into the tail, which is
** infinite where nothing could be proved. Runs in round-to-nearest. Proofs: docs/numerics/stiff.md.
*/
#ifndef STIFF_SERIES_H
#define STIFF_SERIES_H
#include <ambit/double_double.h>
#include <ambit/num.h>
#include <ambit/solver.h>
#include <ambit/meter.h>
#include <ambit/work.h>

/* coefficients 0 .. n-1; room is with the owner */
typedef struct poly {
  uint32_t n;
  double *hi, *lo, tail;
} poly;

#define POLY_SCRATCH 11

typedef struct series {
  const ambit_tape *tape;
  const ambit_num_service *num;
  uint32_t order; /* highest power that slots keep */
  uint32_t first; /* instructions from here on depend on inputs */
  ambit_work *counted;
  const ambit_meter_service *meter; /* NULL: not profiled */
  poly *slot;
  poly scratch[POLY_SCRATCH]; /* of 2 order + 3 coefficients */
} series;

/* 0: no memory. Constants are read from their texts where that is more precise. */
int series_open(const ambit_host *h, const ambit_num_service *num, const ambit_tape *t, uint32_t order, series *s);
static inline poly *series_input(series *s, uint32_t in) { return &s->slot[s->tape->nconst + in]; }
static inline const poly *series_output(const series *s, uint32_t out) { return &s->slot[s->tape->out[out]]; }
void series_run(series *s); /* all inputs must have been set */

/* -- polynomials (poly.c). r may not be an operand of mul or derive. */
static inline dd poly_get(const poly *a, uint32_t k) { return k < a->n ? (dd) { a->hi[k], a->lo[k] } : (dd) { 0, 0 }; }
static inline void poly_set(poly *r, uint32_t k, dd x) { r->hi[k] = x.hi, r->lo[k] = x.lo; }
void poly_constant(poly *r, dd x, double tail);
void poly_copy(poly *r, const poly *a);
void poly_add(poly *r, const poly *a, const poly *b, double sign);   /* a + sign b, sign = +-1 */
void poly_mul(poly *r, uint32_t room, const poly *a, const poly *b); /* powers from `room` on go to the tail */
void poly_derive(poly *r, const poly *a);                            /* of the polynomial without its tail */
double poly_norm(const poly *a);                                     /* >= |a(s)|, with the tail */
void poly_range(const poly *a, double *lo, double *hi);              /* encloses a(s), with the tail */
dd poly_dot(const poly *a, const poly *b, uint32_t from, uint32_t to, uint32_t k); /* about sum a_j b_(k-j) */

/* functions.c: r := op(a, b) for what is not a sum or a product */
void series_function(series *s, uint32_t op, poly *r, const poly *a, const poly *b);
void series_power(series *s, poly *r, const poly *a, int32_t n); /* a^n */
#endif
