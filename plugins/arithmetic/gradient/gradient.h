/* gradient.h -- what the files of the gradient plugin share: an element and the loops over its directions.
**
** An element describes a function f of the independent data x over a box with centre c, by enclosures of
**   value        f(x) for every x of the box
**   centre       f(c)
**   derivative   the generalised partial derivatives (Clarke) of f by each x_j, at every point of the box
**   slope        numbers s_j r_j, r_j >= |x_j - c_j|, such that f(x) - f(c) = sum_j s_j (x_j - c_j): what datum j moves
** Bounds are stored as (-lo, hi), so that in upward mode the same instructions round both outward. A constant known
** only to lie in a set is any fixed number of that set, in value and centre alike. `known` says which parts are there;
** all bounds of a part that is there are finite.
*/
#ifndef GRADIENT_H
#define GRADIENT_H
#include "pair.h"
#include <ambit/arithmetic.h>
#include <ambit/num.h>
#include <ambit/rounding.h>

#define KNOWN_DERIVATIVE 1u /* f is defined and continuous on the whole box, with a bounded derivative */
#define KNOWN_SLOPE 2u
#define VARIES 4u /* depends on a datum; otherwise all derivatives and slopes are 0 and the arrays are not there */

typedef struct element {
  pair value, centre;
  uint64_t known;
  uint64_t pad[3];
  double part[]; /* [4 * width] */
} element;

enum { DERIVATIVE, SLOPE }; /* part k: -lo at [2 k width], hi at [(2 k + 1) width] */

/* The product p x for an interval p and each x = (-lo, hi) of an array, without a look at signs in the loop: with
** u, v >= 0, max(u x, v y) where x and y are the array or the array with its halves exchanged (turn). */
typedef struct factor {
  double u, v;
  int turn_u, turn_v;
} factor;

/* Loops over n directions, n a multiple of 4, in upward mode; an array of intervals is two of n doubles, -lo and hi,
** `n` apart. Each returns the sum of the magnitudes: not finite if some bound is not. */
typedef struct gradient_loops {
  double (*scale)(size_t n, double *r, factor p, const double *x);                              /* r := p x */
  double (*combine)(size_t n, double *r, factor p, const double *x, factor q, const double *y); /* r := p x + q y */
  double (*hull)(size_t n, double *r, const double *x, const double *y);
} gradient_loops;

extern const gradient_loops gradient_portable;
#if defined(__x86_64__)
extern const gradient_loops gradient_avx2;
#endif

typedef struct gradient_context {
  const ambit_num_service *num;
  const gradient_loops *loops;
  size_t nvar, width; /* width: nvar rounded up to a multiple of 4 */
  ambit_rounding outside;
} gradient_context;

static inline size_t element_doubles(const gradient_context *c) { return sizeof(element) / 8 + 4 * c->width; }

static inline element *element_at(const gradient_context *c, void *base, size_t index) {
  return (element *)(void *)((double *)base + index * element_doubles(c));
}

static inline double *part_of(const gradient_context *c, element *x, int part) {
  return x->part + 2 * c->width * (size_t)part;
}
static inline const double *part_in(const gradient_context *c, const element *x, int part) {
  return x->part + 2 * c->width * (size_t)part;
}

/* -- rules.c, upward mode. What an operation is at these operands: enclosures of its image, of its image of the
** centre, and of the factors of derivative and slope by each operand. A factor that is not bounded is none. */
typedef struct rule {
  pair value, centre;
  pair derivative[2], slope[2];
} rule;

uint32_t gradient_write_empty(element *r);
/* only the interval, where the rest is zero (without VARIES in known) or proves nothing (PARTIAL); returns flags */
uint32_t gradient_write_value(element *r, pair value, uint32_t flags, uint32_t known);
/* known: what is left of the operands' parts, VARIES included; b may be NULL */
uint32_t gradient_write(
    const gradient_context *c, element *r, const rule *z, uint32_t known, const element *a, const element *b);
/* the same for parts that are written already: magnitude of the slopes */
uint32_t gradient_finish(element *r, uint32_t known, double moved);

/* a run of any operation */
uint32_t gradient_run(const gradient_context *c, uint32_t op, void *base, size_t pitch, size_t lanes, size_t count,
    const uint32_t *dst, const uint32_t *a, const uint32_t *b);

/* -- functions.c: the operations with one operand but NEG; exponent: of POWN */
uint32_t gradient_function(const gradient_context *c, uint32_t op, int32_t exponent, element *r, const element *a);
#endif
