/* krawczyk.h -- what the files of the krawczyk plugin share.
**
** All roots x of f(x, p) = 0 in a box, for every value of the parameters p in theirs. Rigorous operations are those of
** the services ambit.num/1 and ambit.contract/1, of the problem's arithmetic, and of the few functions marked "upward
** mode" (bound.c); everything else chooses points, matrices and boxes, which may be anything without harm. Proofs:
** docs/numerics/krawczyk.md.
*/
#ifndef KRAWCZYK_H
#define KRAWCZYK_H
#include <ambit/block.h>
#include <ambit/contract.h>
#include <ambit/num.h>
#include <ambit/solver.h>

typedef struct span {
  double lo, hi;
} span;

/* an interval matrix by rows, bounds in arrays of their own */
typedef struct matrix {
  double *lo, *hi;
} matrix;

typedef struct options {
  double tolerance;
  uint32_t boxes_max, undecided_max, roots_max;
} options;

/* boxes of n components, one behind the other */
typedef struct boxes {
  span *x;
  double *share; /* of the searched box, for progress; NULL: not kept */
  uint32_t count, room;
} boxes;

/* what the Newton operator says about the roots in a box */
enum verdict {
  VERDICT_NONE,    /* there are none */
  VERDICT_UNIQUE,  /* exactly one for each value of the parameters */
  VERDICT_AT_MOST, /* at most one for each */
  VERDICT_UNKNOWN
};

typedef struct krawczyk {
  const ambit_host *host;
  ambit_problem problem;
  const ambit_num_service *num;
  const ambit_contract_service *contract;
  options options;
  uint32_t n, np;
  ambit_lane rhs, jacobian, slope; /* f, df/dx, df/dp */
  ambit_contractor *shape;         /* of f */
  ambit_contractor *further;       /* of the further equations, or NULL */
  span *searched, *p, *p_mid;      /* [n] [np] [np] */

  /* -- the Newton operator */
  span *mid, *f, *f_mid, *b, *shift, *z, *row; /* [n] */
  span *estimate;   /* [n] if A is regular: where roots of the last box can be at most, also outside of it */
  span *p_off;      /* [np] */
  matrix J, A, off; /* [n x n] Jacobian; preconditioned; without its diagonal */
  span *diagonal;   /* [n] of A */
  matrix H;         /* [n x n] slopes, column by column */
  matrix S, CS;     /* [n x np] df/dp, preconditioned */
  double *C, *work; /* [n x n], approximate inverse */
  double *scale, *margin, *best; /* [n] u and <A> u of the proof that A is regular */
  matrix in, out;                /* [max(n, np)] operands of products */
  double *in_lo, *in_hi;         /* [n + np] operand of contractors */

  /* -- the search */
  boxes stack, proved, region, undecided; /* region: where the root of proved is the only one */
  span *box, *left, *enclosure, *around;  /* [n] */
  uint32_t examined;                      /* boxes so far */
  double done;                            /* share of the searched box */
} krawczyk;

/* memory.c */
ambit_status krawczyk_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
void krawczyk_close(void *self);

/* inverse.c: C := roughly the inverse of M [n x n], which is destroyed; 0: M seems singular. */
int krawczyk_invert(uint32_t n, double *M, double *C);

/* newton.c */
/* narrows x to where its roots are; UNIQUE: x is then the root's enclosure. AT_MOST: x may stay as it is */
enum verdict krawczyk_newton(krawczyk *k, span *x);

/* bound.c, in upward mode */
/* scale > 0 with margin <= <A> scale, margin > 0, if such is found: A is regular; 0: it is not */
int krawczyk_is_regular(const krawczyk *k);
/* z[i] := +-bound of |x_i| over all A x = -b */
void krawczyk_bound_solution(const krawczyk *k, span *z);

/* box.c: boxes of n components */
int box_is_empty(uint32_t n, const span *x);
int box_is_bounded(uint32_t n, const span *x);
int box_is_inside(uint32_t n, const span *x, const span *of);
int box_is_apart(uint32_t n, const span *x, const span *from);
int box_meet(uint32_t n, span *x, const span *y); /* x := x and y; 0: empty */
void box_join(uint32_t n, span *x, const span *y);
void box_copy(uint32_t n, span *to, const span *from);
double box_shrinking(uint32_t n, const span *x, const span *old); /* least ratio of widths; 1: nothing gained */
double box_point(span x);                                         /* where to cut it */
double box_extent(span x);                                        /* width relative to max(1, |x|) */
void box_inflate(uint32_t n, span *x);
span *boxes_at(const boxes *b, uint32_t n, uint32_t i);
int boxes_push(boxes *b, uint32_t n, const span *x, double share); /* 0: full */

/* prove.c */
/* narrows x; if it has one root for each parameter: 1, x its enclosure, `around` a box in which there is no other and
** which holds what x was. 0: no root in x, -1: not proved */
int krawczyk_prove(krawczyk *k, span *x, span *around);
/* narrows x by f = 0 and the further equations; 0: no root */
int krawczyk_contract(krawczyk *k, span *x);

/* search.c */
ambit_status krawczyk_run(void *self, ambit_sink *sink);
#endif
