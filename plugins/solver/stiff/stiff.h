/* stiff.h -- what the files of the stiff plugin share.
**
** A step: collocation gives a polynomial (collocation.h), which is cut into pieces, each with its own exact
** polynomial P of its own time s in [-1, 1], and of the unknowns, if there are some (spread.c); on each piece the
** solution is P(s) + B(s) z(s) with a moving frame B and |z_b| <= w_b for blocks b of components, carried from piece to
** piece (prove.c). For sets of many unknowns parameters are states that do not move: n = nx + np.
** Proofs: docs/numerics/stiff.md.
*/
#ifndef STIFF_H
#define STIFF_H
#include "bound.h"
#include "collocation.h"
#include "field.h"
#include "metzler.h"
#include "splitting.h"
#include <ambit/ends.h>

#define LEVELS 5
#define PIECES_MAX 64
#define SLOPE_ORDER 8 /* of J along a piece */
#define FRAME_ORDER (SLOPE_ORDER + 3)

/* Why a piece or a run could not go on. */
enum why {
  WHY_NOTHING,
  WHY_NEWTON,
  WHY_ROUGH,     /* the polynomial is not accurate enough */
  WHY_UNDEFINED, /* f or its slopes are not defined or not smooth on the tube */
  WHY_SPLIT,
  WHY_FRAME,
  WHY_GROWTH, /* errors grow too fast to be bounded on the piece */
  WHY_FAST,   /* rates over the piece whose squares are no numbers */
  WHY_SHORT,
  WHY_WIDE,
  WHY_STOPPED
};

typedef struct options {
  uint32_t nodes, degree;
  double tolerance, step_max, step_min, width_max;
} options;

/* U(s) = sum_l U_l s^l and what goes with it; B(s) = U(s) diag(G0, I) */
typedef struct frame {
  split split;
  uint32_t order;
  int natural;         /* states and invariants (natural.c) */
  int still[N_MAX];    /* components that are invariants: nothing moves them but the defect */
  double decay[N_MAX]; /* of fast columns, about */
  square U[FRAME_ORDER + 1];
  square C;  /* about U_0^-1 */
  square G;  /* diag(G0, I) */
  square Gi; /* about its inverse */
  /* -- verified, in upward mode */
  iv start[N_MAX * N_MAX], end[N_MAX * N_MAX]; /* B(-1), B(1) */
  square size, reach;                          /* >= |U(s)|, >= |B(s)| */
  square E;                                    /* >= |(C U(s))^-1 - I| */
  square G_size, Gi_size;                      /* >= |diag(G0, I)|, |diag(G0, I)^-1| */
  square EG;                                   /* Gi G = I - K, EG >= K + K^2 + ... */
} frame;

/* (eta/2) J along the piece, entry by entry: coefficients 0 .. count-1 and a remainder */
typedef struct slopes {
  uint32_t *count;     /* [nx x n] */
  double *coefficient; /* [nx x n x (SLOPE_ORDER + 1)] */
  double *tail;        /* [nx x n] */
} slopes;

typedef struct stiff {
  const ambit_host *host;
  ambit_work *counted;
  ambit_problem problem;
  const ambit_num_service *num;
  options options;
  uint32_t nx, np, n, inputs;  /* inputs: states and parameters of the tapes, before time */
  series rhs, jacobian, slope; /* slope: only with parameters */
  real rhs_real, jacobian_real, slope_real;
  collocation q;
  dd *table; /* Chebyshev polynomials of the step's time as powers of a piece's (pieces.c) */

  /* -- the start: start + start_column xi +- start_rest, xi in [-1, 1]^nu */
  dd *start;             /* [n] */
  double *start_column;  /* [n x nu] */
  double *start_rest;    /* [n] */
  double *about, *scale; /* [nu] unknown j is about_j + scale_j xi_j */

  /* -- where P is a polynomial of the unknowns too (spread.c): parameters are no states then; rows of terms after 1 */
  int spread;
  terms terms;
  fields rhs_field, jacobian_field;
  double *start_row, *x_row;   /* [inputs x count] at the start of the run, of the step */
  double *Z_row, *c_row;       /* [N x nx x count] at the nodes, less the start; Chebyshev coefficients 1 .. N */
  double *residual_row;        /* [N nx x count] */
  double *P_row;               /* [nx x count x (N + 1)] */
  double *end_row, *saved_row; /* [nx x count] */
  double *set_coefficient;     /* [nx x count] */

  /* -- linear invariants of the right-hand side (natural.c) */
  uint32_t ninvariant, choice, choices; /* choice 0: eigenvectors, k: natural frame k */
  double savings[N_MAX + 1];            /* exponents that each choice would have saved */
  square *natural_C, *natural_U;        /* [choices] exact inverses of each other */
  int *natural_still;                   /* [choices x nx] */

  /* -- the set: end +- (end_error, B w) */
  dd *end;           /* [n] of the last polynomial, or the start */
  double *end_error; /* [n] */
  carried carried, saved;
  dd *saved_end;
  double *saved_error;

  /* -- the step */
  double t, t_next, guess;
  dd h;
  uint32_t level, next; /* 2^(level + 2) pieces; the instant ahead */
  int careful;          /* steps that are not made much longer yet */
  int at_instant;
  int looked_ahead;   /* collocation.h */
  spectrum *spectrum; /* [PIECES_MAX + 1] */
  double *rate;       /* [(PIECES_MAX + 1) x n x n] (eta/2) J at the ends of pieces */

  /* -- the piece */
  poly *P;              /* [n] */
  dd half;              /* eta / 2, exact */
  frame frame, refined; /* refined: scratch of refine.c */
  slopes slopes;
  double *box; /* [n] radius of the tube that slopes are over */
  /* [nx x terms x (N + 1)] coefficients of P' - (eta/2) f(P), and what else is in it */
  double *defect;
  double *defect_tail;     /* [nx] */
  double *gap, *gap_error; /* [n] where the last polynomial ended, less P(-1) */
  double *radius;          /* [n] bounds the error on the whole piece */
  double *below;           /* [n] what the step's start has below long double */
  double *shift;           /* [n] bounds how far P is from where slopes were computed */

  /* -- the record */
  double *lo, *hi, *tube_lo, *tube_hi; /* [nx] */
  double *limit;                       /* [nx] */
  double first_rate;                   /* about the largest of the equations at the start */
  dd *dense_sum;                       /* [nx x (N + 1)] */
  double *dense_mid, *dense_rad;       /* [nx x (N + 1)] */
  uint32_t *exponent;                  /* [nu] zeros, where the set's only term is constant */
  double *set_middle, *set_rest;       /* [nx] */
  uint32_t blamed;
  enum why last_why; /* of the last rejected step */
} stiff;

/* start.c */
ambit_status start_read(stiff *s); /* at open: start, its columns and rest */
void start_set(stiff *s);          /* end and carried, in upward mode */

/* open.c */
ambit_status stiff_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
void stiff_close(void *self);

/* run.c */
ambit_status stiff_run(void *self, ambit_sink *sink);

/* spread.c, in round-to-nearest: what has to be done for the terms of the unknowns */
ambit_status spread_read(stiff *s);                                     /* at open: start, start_row, start_rest */
int spread_open(stiff *s);                                              /* 0: no memory */
void spread_start(stiff *s);                                            /* x_row and end_row from the run's start */
int spread_solve(stiff *s);                                             /* the collocation of each term; 0: failed */
void spread_cut(stiff *s, const dd *table);                             /* P_row from Chebyshev coefficients */
void spread_keep(stiff *s, int back);                                   /* end_row saved, or brought back */
void spread_place(stiff *s);                                            /* x_row := the step's end */
double spread_gap(const stiff *s, uint32_t i);                          /* bounds what the rows of state i are off */
double spread_end(stiff *s, uint32_t i);                                /* end_row of state i; returns its error */
double spread_reach(const stiff *s, uint32_t i);                        /* >= |rows of P_i| on the piece */
void spread_put(const stiff *s, fields *to, const double *box);         /* inputs but time */
void spread_defect(stiff *s, uint32_t i, const field *f, double *rest); /* rows of defect; rest gets what is left */

/* natural.c, in round-to-nearest */
int natural_open(stiff *s); /* 0: no memory */
void natural_frame(stiff *s, uint32_t choice);
/* frame of the next step: the one in which errors are bounded to grow least; slopes over piece j have been computed */
void natural_choose(stiff *s, uint32_t j, uint32_t pieces);

/* step.c, in round-to-nearest */
enum why step_make(stiff *s); /* the set and the tube, from t to t_next, which it chooses */

/* pieces.c */
void pieces_fill(dd *table, uint32_t N);
size_t pieces_table_size(uint32_t N);
/* powers of a piece's time in the step's Chebyshev polynomials [(N + 1) x (N + 1)] */
const dd *pieces_table(const stiff *s, uint32_t level, uint32_t j);
/* P := the step's polynomial on piece j of 2^(level + 2), in its own time */
void pieces_cut(stiff *s, uint32_t level, uint32_t j);

/* evaluate.c, in round-to-nearest: what f and J are along the piece. 0: not defined */
int evaluate_defect(stiff *s, uint32_t j, uint32_t pieces);
void evaluate_gap(stiff *s); /* from where the last piece ended to where this one starts */
void evaluate_end(stiff *s); /* end := P(1) */
int evaluate_slopes(stiff *s, uint32_t j, uint32_t pieces); /* over the tube P +- box */
void evaluate_rates(stiff *s, uint32_t pieces);             /* rates and spectra at the ends of pieces; approximate */

/* frame.c */
int frame_choose(stiff *s, uint32_t j); /* in round-to-nearest; approximate */
/* refine.c: makes errors of the frame's directions keep apart better; approximate */
void frame_refine(stiff *s);
/* r [n x cols] := coefficient l of (eta/2) J, times X */
void frame_apply_slopes(const stiff *s, uint32_t l, uint32_t cols, const double *X, double *r);
int frame_verify(stiff *s); /* in upward mode, as is all below */

/* dense.c, only where it is asked for */
void dense_start(stiff *s);             /* the polynomial of the step, from the collocation */
void dense_piece(stiff *s, uint32_t j); /* its radius, from each proved piece */
int dense_is_good(const stiff *s);      /* 0: it cannot be written in doubles */

/* improve.c: P with a smaller defect, from the last one */
void improve_piece(stiff *s);

/* prove.c */
enum why prove_piece(stiff *s, uint32_t j, uint32_t pieces); /* carried: from s = -1 to s = 1 */

/* rates.c */
/* what multiplies errors: U^-1 ((eta/2) J U - U') in middle +- radius, then in blocks */
typedef struct matrix_bounds {
  iv middle[N_MAX * N_MAX];
  square radius;
} matrix_bounds;

void rates_bound(const stiff *s, matrix_bounds *r);
void rates_in_blocks(const stiff *s, const matrix_bounds *r, double *M); /* [blocks x blocks], a Metzler matrix */
#endif
