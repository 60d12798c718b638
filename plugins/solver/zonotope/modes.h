/* modes.h -- errors that are not followed one by one, in discs along the modes of the movement: modes.c, discs.c. */
#ifndef ZONOTOPE_MODES_H
#define ZONOTOPE_MODES_H
#include "proof.h"
#include <complex.h>

typedef double complex number;

/* sqrt(a^2 + b^2) but for 4 2^-53 of it; where squares would underflow, no less */
static inline double length(double a, double b) {
  a = fabs(a), b = fabs(b);
  return a + b > 1e-140 ? sqrt(a * a + b * b) : a + b;
}
static inline double modulus(number x) { return length(creal(x), cimag(x)); }

/* { Re((V + sum_j xi_j U_j) w) : |w_k| <= b_k }, U_j = V T_j but for rounding. Matrices [nx x nx] by rows. P_4 turns
** with them: the set has sum_j xi_j Re(U_j W) P_4 besides, where a is not 0. */
typedef struct discs {
  int any;
  number *V, *W; /* W: inverse of V, about */
  number *U, *T; /* [mixed x nx x nx] */
  double *S;     /* bound of sum_j |U_j| */
  double *tilt;  /* bound of sum_j |T_j| */
  double *b;     /* [nx] */
  double *a;     /* [nx] bounds of |W P_4| */
} discs;

/* cycle.c: of a sampled system */
typedef struct cycle {
  double *map, *next; /* [nx x nx] what came of errors since the last jump; scratch */
  number *V, *T, *X;  /* [nx x nx] where discs lie after a jump; scratch */
  uint32_t turns;     /* jumps until now */
  int known;          /* V */
} cycle;

typedef struct modes {
  cycle *cycle;           /* NULL: the system is not sampled */
  discs now, old;         /* at the end of the step, at its start */
  double *growth;         /* [nx x nx] what the step makes of one disc in another, at most */
  double rate;            /* per second, logarithm: discs grow at most so fast; they shrink if it is negative */
  int is_bad;             /* they would grow too much */
  uint32_t wait;          /* steps until they are tried again */
  double *in, *box;       /* [nx] what goes into the discs besides, by |W x|; what is left of it */
  number *A, *B, *C;      /* [nx x nx] */
  number *D, *G;          /* [mixed x nx x nx] */
  double *rest, *work;    /* [nx x nx] [8 nx nx + 7 nx] */
  double *sizes;          /* [8 nx x nx] map.c */
  double *along;          /* [2 nx] */
  double *all;            /* [3 nx] a + b at the start of the step; scratch */
  double *rest_of_fourth; /* [nx] bounds of |P_4 - V W P_4| */
} modes;

int modes_open(zono *z);   /* 0: no memory */
void modes_start(zono *z); /* no discs */
/* to := a b; what the step makes of e_k in state i, and of xi_j e_k */
void modes_product(size_t n, const number *a, const number *b, number *to);
double modes_flow(const zono *z, uint32_t i, uint32_t k);
double modes_mixed(const zono *z, uint32_t j, uint32_t i, uint32_t k);
/* modes.c: m->now for the end of the step, without b; 0: none were found */
int modes_find(zono *z);
/* map.c: m->now.b, m->in, m->box and m->growth from m->old, along m->now.V */
void map_discs(zono *z);
/* the same, with what quartic_near() knows of two data at once, in errors; adds to m->in, m->box */
void map_pairs(zono *z);
/* worth.c: may discs be of use? Of those that modes_find() found: are they not much wider than what they hold, or
** little enough for discs that shrink? After map_discs(): m->rate, and do they not grow too much? */
enum worth { WORTH_NOTHING, WORTH_IF_SHRINKING, WORTH_KEEPING };
int worth_trying(const zono *z);
enum worth worth_enclosing(zono *z);
int worth_keeping(zono *z);
int modes_invert(size_t n, const number *V, number *W, number *A); /* W := V^-1, about; A: scratch; 0: singular */
int cycle_open(zono *z);                                           /* 0: no memory */
void cycle_start(zono *z);
/* m->now.any, and where discs lie at the end of a step, after a jump; from p->end and m->old */
void cycle_step(zono *z);
void cycle_jump(zono *z);
/* discs.c: the discs as the step moves them, along its modes if there are any, else into m->box */
void discs_move(zono *z);
/* the same where states jump */
void discs_jump(zono *z);
/* discs += x [nx], real, once for all symbols; or the box += |x_i| where there are no discs */
void discs_put(zono *z, const double *x, enum origin from);
/* a bound of sum_i y_i e_i over discs; over those at the start of the step */
double discs_along(const zono *z, const discs *d, const double *y);
double discs_size(const zono *z, const double *y);
/* all of the box goes into the discs, and what they leave into the box */
void discs_finish(zono *z);
/* Do discs carry what the data make of P_4 in this step? */
int discs_carry(const zono *z);
/* P_4 of the end of the step turns with the axes, if there are any; before discs_finish() */
void discs_turn(zono *z);
/* half width of what that is in state i */
double discs_turned(const zono *z, uint32_t i);
double discs_width(const zono *z, uint32_t i); /* half width of state i */
#endif
