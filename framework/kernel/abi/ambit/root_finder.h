/* root_finder.h -- "ambit.root_finder/1": finds the roots of f(x, p) = 0 in a box, for every value of the parameters,
** and emits records. */
#ifndef AMBIT_ROOT_FINDER_H
#define AMBIT_ROOT_FINDER_H
#include "arithmetic.h"
#include "record.h"

#define AMBIT_ROOT_FINDER "ambit.root_finder/1"

/* What a root finder may ask for besides f; the kernel builds only that. */
#define AMBIT_ROOT_WANT_JACOBIAN 1u /* df/dx as a tape, row by row, same inputs as f; valid where f is differentiable */
#define AMBIT_ROOT_WANT_SLOPE 2u    /* df/dp likewise */
#define AMBIT_ROOT_WANT_FURTHER 4u  /* further equations that a root satisfies too */

/* As many equations as unknowns. Inputs of every tape: x [nx], p [np]. */
typedef struct ambit_root_problem {
  uint32_t size, nx, np, nfurther;
  /* the further equations hold at every root of f that they do not exclude as soon as its enclosure is narrow
  ** (redundant ones that single out some of isolated roots): they narrow and exclude, roots are proved by f alone */
  uint32_t implied, pad;
  const char *const *name;                          /* [nx] unknowns, [np] parameters behind them */
  const ambit_tape *f, *jacobian, *slope, *further; /* [nx], [nx x nx], [nx x np], [nfurther]; NULL: not wanted, or
                                                      ** there is none */
  const ambit_arithmetic *arithmetic;               /* completed: every run[] filled */
  void *actx;                                       /* its context, lent to this root finder until close */
  const double *x_lo, *x_hi;                        /* [nx] the box that is searched, may be unbounded */
  const double *p_lo, *p_hi;                        /* [np] bounded */
} ambit_root_problem;

/* OK: every box is decided; UNABLE: some are not, or not all of the box was searched. */
typedef struct ambit_root_finder {
  uint32_t size, want; /* AMBIT_ROOT_WANT_* */
  uint32_t needs_rigorous;
  const char *arithmetics; /* as in ambit_solver */
  const ambit_param *param;
  /* [ctx] allocates everything here; `option` in declaration order, shapes flattened */
  ambit_status (*open)(const ambit_host *h, const ambit_root_problem *p, const double *option, void **self);
  /* [ctx] emits AMBIT_REC_ROOT for each box that may hold a root, AMBIT_REC_SEARCHED at the end; no allocation
  ** inside */
  ambit_status (*run)(void *self, ambit_sink *s);
  void (*close)(void *self);
  uint32_t (*want_for)(const double *option); /* NULL: `want`; else what these options need */
} ambit_root_finder;
#endif
