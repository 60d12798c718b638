/* quartic.h -- what products of slots have of degree 4 in some of the data, or of degree 2 in eps, which rows do not
** hold. */
#ifndef ZONOTOPE_QUARTIC_H
#define ZONOTOPE_QUARTIC_H
#include "zonotope.h"

#define QUARTIC_ORDERS 64 /* room for orders in time */

#define FAR_GROUPS 16 /* of data whose triples are held or not together, at most */

/* Far triples: those of rows that have pairs, but hold no triples of these data (far.c). */
typedef struct far {
  uint32_t groups, from[FAR_GROUPS + 1]; /* group g: data from[g] to from[g + 1] - 1; 0 groups: there are none */
  uint8_t held[FAR_GROUPS][FAR_GROUPS][FAR_GROUPS]; /* those of groups g <= h <= l */
  double worth[FAR_GROUPS][FAR_GROUPS][FAR_GROUPS];
  uint32_t most, nrun;
  struct far_run *run; /* of the held ones, in their order */
} far;

/* triples (i, j, k) of from <= k < to */
typedef struct far_run {
  uint32_t i, j, from, to;
} far_run;

/* an operand in the chosen data, packed: l [n]; q by pair[i] + j - i, i <= j; c by triple[i n + j] + k - j,
** i <= j <= k; sizes of its parts at each order in time */
typedef struct operand {
  double *l, *q, *c, *r, *x; /* r [nx] of eps; x [n x nx] of xi eps */
  double size_l[QUARTIC_ORDERS], size_q[QUARTIC_ORDERS], size_c[QUARTIC_ORDERS], size_r[QUARTIC_ORDERS],
      size_x[QUARTIC_ORDERS];
  double *all_l,
      *all_q; /* [m], [pairs of a row] of all data, where there are far triples; sizes of linear terms of each
                         ** group, and of the pairs with which they make far triples that are held */
  double size_group[QUARTIC_ORDERS][FAR_GROUPS], size_with[QUARTIC_ORDERS][FAR_GROUPS];
} operand;

typedef struct quartic {
  uint32_t n, most;              /* data chosen, at most */
  uint32_t *datum;               /* [n] rising */
  uint32_t *pair, *triple;       /* [n] [n n] */
  uint32_t *pair_at, *triple_at; /* where the coefficients of pairs and triples are in a row */
  uint32_t pairs, triples, length;
  uint32_t fourth; /* monomials of degree 4, after which far triples come */
  const struct shape *shape;
  far far;
  operand a, b;
  double *product; /* [length] of degree 4: by i <= j <= k <= l, in this order; and far triples */
  uint32_t nx;
  double *near;     /* [pairs x nx] of the product, of degree 2 in the data and 1 in eps */
  double *near_sum; /* [nx x pairs x nx] */
  double *sum;      /* [nx x length] for each x', of this step */
  double *term;     /* [nx x length] what the set has */
  double *moved;    /* [nx x length] the same at the end of the step */
  double *size;     /* [nx] sums of sizes of `term` */
  double *rounding; /* [nx + na] of the sum */
  double *group;    /* [length] of products with the same coefficient together; near of it: */
  double *near_group;
  uint32_t squares;     /* 1: products of errors are known, too: */
  double *square_group; /* [nx x nx] of the group, by pairs of eps; */
  double *square_sum;   /* [(nx + na) x nx x nx] for each x', and for each equation where residual.c is at work */
  double *weight;       /* [nslot] of lumps, by the budgets of the states */
  uint8_t *chosen;      /* [nslot] */
  int8_t *sign;         /* [nslot] of a product in the sum that it goes into; 0: the slot is no product */
  uint32_t *root, *next, *made; /* [nslot] that sum; the next product of it; the instruction that makes a slot */
  uint32_t count;               /* slots chosen */
  int held;                     /* 1: the set has terms of degree 4; 0: `term`, `size` are of no meaning, and 0 */
  void (*multiply)(const struct quartic *q, double *to);
  void (*multiply_far)(const struct quartic *q, double *to);
  void (*add)(double *to, double scale, const double *x, size_t n);
} quartic;

/* sizes of a lump: at most; and without what is known of it: at most, of its integral from 0 to any s by |h|, of its
** mean over the step, of its first moment by (2 tau - 1) */
typedef struct lump {
  double most, rest, path, mean, moment;
} lump;

lump quartic_none(double size); /* nothing of it is known */
int quartic_open(zono *z);
/* chooses data and products, by what lumps add now; 0: it is not worth it */
int quartic_begin(zono *z);
/* the lump of slot j, with those of all chosen products that have the same coefficient, up to the sign, which are none
** from then on; what is known of them is added to the sums */
lump quartic_lump(zono *z, uint32_t j);
/* of x'_i and pair n: [nx] what one of each eps makes; rounding: of all pairs of x'_i */
double *quartic_near(zono *z, uint32_t i, uint32_t n);
/* bound of the products of errors in the sum of this step, of x'_n, or of equation n - nx */
double quartic_square(zono *z, uint32_t n);
/* bound of the sum of this step for x'_i */
double quartic_sum(const zono *z, uint32_t i);
/* sum of sizes of terms of state i */
double quartic_size(const zono *z, uint32_t i);
/* at most |sum_k by_k P_4,k|, by [nx] */
double quartic_through(zono *z, const double *by);
/* terms of state i at the end of the step: by [nx], what one of each state makes */
void quartic_move(zono *z, uint32_t i, const double *by);
/* adds the sum of this step: by [nx], what one of each x' makes; reach: its bound. Returns what is rounded. */
double quartic_end(zono *z, uint32_t i, const double *by, const double *reach);
void quartic_finish(zono *z);
double quartic_fresh(zono *z, const double *by);
/* Terms that come up no more, and are less than a step may add, go into the box: no step has to move them then. */
void quartic_drop(zono *z);

/* far.c; 0: no memory */
int far_open(zono *z);
/* which far triples are held, by what products drop now; q->length with them */
void far_choose(zono *z);
/* the operand's all_l, all_q in the middle of the step, times power, and their sizes */
void far_take(const zono *z, operand *o, uint32_t slot, double power);
/* size of the far triples that are held of order i of a and order j of b */
double far_size(const quartic *q, uint32_t i, uint32_t j);

/* product := the part of degree 4 of a b */
void quartic_portable(const quartic *q, double *to);
/* to := the far triples of a b */
void far_portable(const quartic *q, double *to);
/* to [n] += scale x */
void add_portable(double *to, double scale, const double *x, size_t n);
#if defined(__x86_64__)
void quartic_avx2(const quartic *q, double *to);
void far_avx2(const quartic *q, double *to);
void add_avx2(double *to, double scale, const double *x, size_t n);
#endif
#endif
