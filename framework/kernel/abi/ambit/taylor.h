/* taylor.h -- "ambit.taylor/1": Taylor models from the inside, for solvers whose sets are polynomials.
**
** Asked for at the plugin arithmetic/taylor_model (ambit_plugin.get), beside "ambit.arithmetic/1"; `ctx` is a context
** opened through that interface, elements are its elements (elem(ctx) bytes). An element stands for a function v of the
** normalised variables x in [-1, 1]^nvar (variable j of set(): middle + radius x_j, both rounded so that the set is
** covered; they are coefficients 0 and 1 + j) and claims, wherever v is defined,
**   |v(x) - p(x)| <= r  and  lo <= v(x) <= hi,
** p a polynomial of total degree <= order with double coefficients, r >= 0 its remainder (inf: p = 0, only the hull
** [lo, hi] is known). Monomials have indices in graded order: 0 is the constant, 1 + j is x_j.
**
** All functions: [ctx], in any rounding mode, inside and outside enter/leave; no allocation. dst never is an operand.
** Results are elements whose claims follow from those of the operands; flags are AMBIT_F_*.
*/
#ifndef AMBIT_TAYLOR_H
#define AMBIT_TAYLOR_H
#include "arithmetic.h"

#define AMBIT_TAYLOR "ambit.taylor/1"

typedef struct ambit_taylor {
  uint32_t size;

  /* -- monomials of a context */
  void (*shape)(void *ctx, uint32_t *nvar, uint32_t *order, uint32_t *count); /* count: monomials */
  void (*exponents)(void *ctx, uint32_t index, uint32_t *exponent);           /* exponent [nvar] */
  /* UINT32_MAX: of higher degree than the order */
  uint32_t (*index)(void *ctx, const uint32_t *exponent);

  /* -- parts of an element */
  double (*coefficient)(void *ctx, const void *x, uint32_t index);
  /* the nonzero ones, in graded order; index, coefficient [count] or NULL; returns how many */
  uint32_t (*terms)(void *ctx, const void *x, uint32_t *index, double *coefficient);
  double (*remainder)(void *ctx, const void *x); /* r */
  /* dst := sum of n monomials (each index at most once) + [lo, hi]; its hull follows from these */
  uint32_t (*build)(
      void *ctx, void *dst, uint32_t n, const uint32_t *index, const double *coefficient, double lo, double hi);
  /* x := x + [lo, hi], which need not contain 0 */
  uint32_t (*widen)(void *ctx, void *x, double lo, double hi);

  /* -- bounds */
  /* of p alone over [-1, 1]^nvar, splitting the domain into at most `boxes` boxes (and no more than the option of that
  ** name); 0: from the coefficients, fast */
  void (*range)(void *ctx, const void *x, uint32_t boxes, double *lo, double *hi);
  /* of v over a box [at_lo, at_hi] in [-1, 1]^nvar, each [nvar]; equal ends: at a point */
  void (*evaluate)(void *ctx, const void *x, const double *at_lo, const double *at_hi, double *lo, double *hi);

  /* -- arithmetic */
  uint32_t (*product)(void *ctx, void *dst, const void *a, const void *b);
  /* dst := v(w_1, ..., w_nvar), w an array of nvar elements. Where some w_j leaves [-1, 1] nothing is known of v: then
  ** PARTIAL is raised, and the result holds where all w_j are inside. dst must not be among w. */
  uint32_t (*compose)(void *ctx, void *dst, const void *v, const void *w);
  /* dst(y) := v with x_j = middle + radius y_j for the box [lo, hi] in [-1, 1]^nvar; lo, hi [nvar]. The cheap case of
  ** compose: a part of the domain, seen at full resolution. INVALID box (empty, NaN, outside): UNBOUNDED, dst is
  ** everything. */
  uint32_t (*restrict_to)(void *ctx, void *dst, const void *v, const double *lo, const double *hi);
  /* dst := integral of v from 0 to x_var by x_var, in the normalised variable (times the radius for the datum itself).
  ** Terms of degree order + 1 go to the remainder. v must be defined on the whole path. var >= nvar: UNBOUNDED,
  ** dst is everything. */
  uint32_t (*integrate)(void *ctx, void *dst, const void *v, uint32_t var);
  /* dst := derivative of the polynomial p by x_var; its remainder holds rounding only. The remainder of v cannot be
  ** differentiated: dst says something of v' only where that of v is known to be constant. r = inf or var >= nvar:
  ** UNBOUNDED, dst is everything. */
  uint32_t (*derive)(void *ctx, void *dst, const void *v, uint32_t var);
} ambit_taylor;
#endif
