/* model.h -- what the files of the Taylor-model plugin share: the element and the context.
**
** An element stands for a function v of the uncertain data x in [-1, 1]^nvar (normalised) and claims two things:
**   |v(x) - p(x)| <= rad for every x, with a polynomial p of degree <= order   (rad = inf: p = 0 and nothing is
**   claimed) lo <= v(x) <= hi                                                            (the hull; empty: v is
**   nowhere defined)
** A remainder that is not centred moves its middle into p, which loses nothing. The polynomial is kept in blocks of
** eight coefficients, of which only those marked in `mask` are defined; the others are zero and not even read, so that
** few terms cost little. Block 0 is always there. Zero bytes are the constant 0.
*/
#ifndef MODEL_H
#define MODEL_H
#include "kernels.h"
#include "monomials.h"
#include <ambit/arithmetic.h>
#include <ambit/num.h>
#include <ambit/rounding.h>
#include <ambit/taylor.h>
#include <math.h>
#include <string.h>

typedef struct interval {
  double lo, hi;
} interval;

typedef struct model { /* the head of an element; norms, mask and coefficients follow at the context's offsets */
  interval hull;
  double rad;
  double down, up; /* p - coefficient 0 lies in [-down, up] */
  double size;     /* sum of norms without degree 0 */
  double unused[2];
} model;

enum { MODEL_SCRATCH = 5, RANGE_BOXES_MAX = 256 };

typedef struct context {
  const ambit_num_service *num;
  const kernels *kernels;
  monomials m;
  uint32_t boxes; /* into so many boxes bounds() may split the domain */
  size_t elem, norm_at, mask_at, coef_at;
  ambit_rounding outside; /* environment to restore on leave */
  double *packed[2];      /* operands in rows */
  interval *at[2];        /* [count] monomials and powers of variables at a box; nvar order <= count */
  uint32_t *index[2];     /* lists of monomials */
  double *value[2];       /* and their coefficients */
  double *lanes[3];       /* operands and product with the lanes side by side; NULL: too big */
  char *scratch;          /* MODEL_SCRATCH elements, then order + 1 for compositions */
  uint8_t *alive;         /* [count] for compositions: has a monomial, or one it divides, a coefficient? */
  double *box;            /* polynomials of boxes; NULL: boxes < 2 */
} context;

static inline double *model_norm(const context *c, const model *x) {
  return (double *)(void *)((char *)(uintptr_t)x + c->norm_at); /* [order + 1] sum |coefficient| of each degree */
}
static inline uint64_t *model_mask(const context *c, const model *x) {
  return (uint64_t *)(void *)((char *)(uintptr_t)x + c->mask_at);
}
static inline double *model_coef(const context *c, const model *x) {
  return (double *)(void *)((char *)(uintptr_t)x + c->coef_at);
}
static inline model *model_scratch(const context *c, unsigned i) { return (model *)(void *)(c->scratch + i * c->elem); }
static inline double model_coefficient(const context *c, const model *x, uint32_t i) {
  uint32_t block = i / MONOMIALS_BLOCK;
  if (block && !(model_mask(c, x)[block / 64] >> (block % 64) & 1)) return 0;
  return model_coef(c, x)[i];
}
static inline int model_is_polynomial(const model *x) { return x->rad < INFINITY; }
/* of bounded intervals; upward mode */
static inline interval interval_times(interval a, interval b) {
  double down = fmax(fmax(-a.lo * b.lo, -a.lo * b.hi), fmax(-a.hi * b.lo, -a.hi * b.hi));
  double up = fmax(fmax(a.lo * b.lo, a.lo * b.hi), fmax(a.hi * b.lo, a.hi * b.hi));
  return (interval) { -down, up };
}
static inline int interval_is_empty(interval x) { return !(x.lo <= x.hi); }

/* -- model.c. Upward mode, as all that follows unless it says otherwise. */

/* x := every number of `hull`, with no dependence on the data */
void model_set_interval(const context *c, model *x, interval hull);
/* x := an independent variable in `hull` */
void model_set_variable(const context *c, model *x, interval hull, uint32_t var);
void model_copy(const context *c, model *dst, const model *src);
/* Norms and the naive range of p, from its coefficients. */
void model_survey(const context *c, model *x);
/* The end of every operation: p and rad are written, `hull` encloses the values too. Surveys, intersects the hull with
** the range of p +- rad, and falls back to the hull where p says no more. Returns EMPTY and UNBOUNDED flags. */
uint32_t model_finish(const context *c, model *x, interval hull);
/* only the hull is known */
uint32_t model_finish_interval(const context *c, model *x, interval hull);
/* adds [lo, hi] to the values: middle to coefficient 0, rest to rad; before model_finish */
void model_add_interval(const context *c, model *x, interval y);
/* coefficient i, with its block marked and cleared if it was absent */
double *model_place(const context *c, model *x, uint32_t i);
/* an element that holds only a polynomial, the constant v */
void model_clear(const context *c, model *x, double v);
/* op on the hulls by the kernel; returns flags */
uint32_t model_hull(const context *c, uint32_t op, interval *r, interval a, interval b, int32_t exponent);
interval model_range_naive(const context *c, const model *x); /* of p */

/* -- product.c */
/* p of dst := p of a times p of b, cut after degree `limit`; returns a bound of what rounding and cutting lost.
** rad and hull of dst are not written, and it is not surveyed. */
double model_product(const context *c, model *dst, const model *a, const model *b, uint32_t limit);
uint32_t model_multiply(const context *c, model *dst, const model *a, const model *b);
/* n products dst[i] := a[i] b[i] whose polynomials the lanes of the vector unit compute together where that pays */
uint32_t model_multiply_many(
    const context *c, size_t n, model *const *dst, const model *const *a, const model *const *b);

/* -- linear.c */
/* p of dst := p of a + sign p of b; returns the rounding error; not surveyed */
double model_sum(const context *c, model *dst, const model *a, const model *b, double sign);
uint32_t model_add(const context *c, model *dst, const model *a, const model *b, double sign);
uint32_t model_negate(const context *c, model *dst, const model *a);

/* -- range.c */
/* p lies in [c_0 - *down, c_0 + *up]; x is surveyed. Exact in each variable's quadratic part. */
void model_range_quadratic(const context *c, const model *x, double *down, double *up);
/* the range of p by splitting the domain into at most `boxes` boxes */
interval model_range(const context *c, const model *x, uint32_t boxes);
interval model_bounds(const context *c, const model *x);

/* -- function.c */
uint32_t model_function(const context *c, uint32_t op, model *dst, const model *a, int32_t exponent);
uint32_t model_divide(const context *c, model *dst, const model *a, const model *b);
uint32_t model_angle(const context *c, model *dst, const model *y, const model *x);
uint32_t model_power(const context *c, model *dst, const model *a, int32_t n);
/* -- kink.c */
uint32_t model_absolute(const context *c, model *dst, const model *a);
uint32_t model_extremum(const context *c, model *dst, const model *a, const model *b, uint32_t op);
#endif
