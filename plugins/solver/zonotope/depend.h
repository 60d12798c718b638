/* depend.h -- how generators depend on the data: depend.c. */
#ifndef ZONOTOPE_DEPEND_H
#define ZONOTOPE_DEPEND_H
#include "zonotope.h"

/* e = (G + sum_j xi_j G_j) rho: G_j of the old generators. Rows of G_j are `stride` long. */
typedef struct depend {
  int any;                         /* are G_j followed? Else they are 0 */
  uint32_t mixed;                  /* data that there is room for */
  size_t stride;                   /* of a row of G_j */
  double *now, *next;              /* [mixed x nx x stride] */
  uint8_t *is_there;               /* [mixed] G_j is not 0 */
  double *depth;                   /* [nx x stride] bounds of sum_j |G_j|, of `next` until depend_keep() */
  double *size;                    /* [nx] sums of these over the generators */
  double *axis, *inverse, *radius; /* [nx x nx] columns in which sum_j xi_j G_j rho is bounded, their inverse; [nx] */
  double *work;                    /* [2 nx nx + nx] */
  double *turn, *along;            /* [m x crosses x nx] factors w of crosses; [m x crosses] sizes along them */
  uint32_t *kept;                  /* [ngen_max + nx] */
  void (*measure)(const double *G, size_t stride, size_t n, uint32_t nx, const double *w, uint32_t count, double *to);
} depend;

int depend_open(zono *z); /* 0: no memory */
void depend_start(zono *z);
void depend_begin(zono *z); /* G_j are followed from this step on, where nothing varies in time and nothing jumps */
/* at most sum_j |(G_j rho)_i| */
double depend_size(const zono *z, uint32_t i);
/* at most |sum_i y_i (sum_j xi_j G_j rho)_i|, y [nx] */
double depend_through(const zono *z, const double *y);
/* columns [nx x nx] and their inverse, about: the principal axes of d->work, a covariance in units of the states'
** sets */
void depend_axes(const zono *z, double *columns, double *inverse);
/* next and depth := what the step makes of G_j, from G in p->turned and rows at p->end */
void depend_move(zono *z);
/* along [count] := bounds of |w_r sum_j xi_j G_j rho|, w [count x nx], of before the step */
void depend_along(zono *z, const double *w, uint32_t count, double *along);
/* at most sum_j |G_j| of column c in state i, after depend_move(); 0 for new columns */
double depend_depth(const zono *z, uint32_t c, uint32_t i);
/* generators are those of the columns `kept` [count] from now on, behind which there is the box */
void depend_keep(zono *z, uint32_t count);

/* to [count] += sum_c |sum_k w_k G_kc|, c < n, G [nx x stride] */
void measure_portable(
    const double *G, size_t stride, size_t n, uint32_t nx, const double *w, uint32_t count, double *to);
#if defined(__x86_64__)
void measure_avx2(const double *G, size_t stride, size_t n, uint32_t nx, const double *w, uint32_t count, double *to);
#endif
#endif
