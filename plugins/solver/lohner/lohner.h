/* lohner.h -- what the files of the lohner plugin share.
**
** The set of states at time t is
**   { centre + low + C xi + G e : xi in [-1,1]^nc, e in [-1,1]^m }
** with centre + low the midpoint in double-double, C the columns of the unknowns (never condensed) and G the generators
** of everything that was added on the way (history.c). The parameters are fixed + F xi, with the same xi. Arrays of
** rows and columns are by rows. All arithmetic is in upward mode (ball.h). Proofs: docs/numerics/lohner.md.
*/
#ifndef LOHNER_H
#define LOHNER_H
#include "ball.h"
#include <ambit/jet.h>
#include <ambit/solver.h>
#include <ambit/ends.h>
#include <ambit/work.h>

#define PIECES_MAX 16

/* Generators w_c d_c, oldest first, in groups of n columns; a group has a level (history.c). */
typedef struct history {
  uint32_t n;    /* states */
  uint32_t keep; /* groups of one level before the older half is condensed; 0: one frame, condensed at every step */
  uint32_t group, room;                      /* groups held, and how many fit */
  uint32_t *level;                           /* [room] */
  size_t pitch;                              /* columns per row */
  double *direction;                         /* [n x pitch] */
  double *weight;                            /* [pitch] */
  double *block;                             /* [n x BLOCK] scratch of the product */
  double *frame, *shape, *size, *sum, *unit; /* scratch of condensing: [n x n] [n x n] [n] [n] [n] */
  uint32_t *order;                           /* [n] */
} history;

/* Why no step could be made; the run ends with a sentence about it (run.c). */
enum why {
  WHY_NOTHING,
  WHY_CENTRE,      /* the right-hand side has no series at the midpoint */
  WHY_BOX,         /* nor over the whole set */
  WHY_NO_STEP,     /* no step that is long enough could be proved */
  WHY_SHORT_STEPS, /* steps shrink so fast that the end is out of reach */
  WHY_WIDE,
  WHY_APART, /* the set does not meet an invariant */
  WHY_STOPPED
};

/* how far states may count as more than they are by themselves (size.c) */
enum leniency { LENIENT_NOT, LENIENT_NEAR, LENIENT_FAR };

/* How slopes get over a step (step.c) */
enum formula { FORMULA_AUTO, FORMULA_TAYLOR, FORMULA_HERMITE_OBRESCHKOFF };

typedef struct options {
  uint32_t order, slope_order, slope_order_max; /* slope orders: to start with, and most */
  uint32_t history, pieces, formula;
  double tolerance, step_max, step_min, width_max;
  int patient; /* step_min was given, and alone decides when steps are too short */
} options;

/* how long steps are (pace.c) */
typedef struct stretch {
  double from, longest; /* time at its start; longest step planned in it */
  uint64_t wide;        /* steps in it over wide sets */
} stretch;
typedef struct pace {
  uint64_t steps, until; /* done; end of this stretch, twice as far as that of the last one */
  stretch stretch[3];    /* the one before the last, the last, this one */
} pace;

/* k invariants, linear over the set: 0 in value +- varies + slope (xi, G e + low) (invariant.c), and the gain that uses
** them (contract.c) */
typedef struct constraint {
  uint32_t k; /* 0: there are none, and nothing below is used */
  ambit_jet *centre_jet, *box_jet;
  double *from, *to;             /* [nc] the cube of xi */
  double *value, *varies;        /* [k] */
  double *slope_mid, *slope_rad; /* [k x ndir] over the set */
  double *part_mid, *part_rad;   /* [ndir] over a piece of it */
  double *low, *high;            /* [k] what slopes leave, over all pieces */
  double *away, *outward;        /* [nx x nc] columns that lead away from the manifold; [k x nc] J of them */
  double *spread;                /* [k x history.pitch] J G */
  double *cross, *gain;          /* [k x nx] */
  double *normal, *whole, *done; /* [k x k] [k] [k] */
  double *unit;                  /* [k] one over how far each row reaches */
  double *before;                /* [nx] mean squares of the set */
  double *move;                  /* [nx x nx] */
  double *pivot_mid, *pivot_rad; /* [k x nx] scratch of the rank */
  double *largest;               /* [k] unit of each row, from the start */
  double *least;                 /* [k] pivots at the start, 0: none */
  uint32_t blamed;               /* the invariant that is not met, or loses rank */
  int lost;                      /* it loses rank */
} constraint;

/* the Hermite-Obreschkoff formula (hermite.c) */
typedef struct corrector {
  uint32_t r;                      /* order at both ends */
  ambit_jet *end_jet, *tube_jet;   /* derivatives over the end of the step, to order r; over the step, to 2 r + 1 */
  double *weight, *loose;          /* [r + 1] c_i +- loose */
  double *from_mid, *from_rad;     /* [nx x ndir] P */
  double *to_mid, *to_rad;         /* [nx x ndir] Q_xi, Q */
  double *error;                   /* [nx x ndir] bound of E by directions */
  double *guess_mid, *guess_rad;   /* [nx x ndir] the Taylor slopes at the end */
  double *inverse, *work, *defect; /* [nx x nx] A; scratch; |I - A Q| */
  double *dmid, *drad;             /* [ndir] scratch */
  double *added;                   /* [nx] what error and defect add to the set */
} corrector;

typedef struct lohner {
  const ambit_host *host;
  ambit_problem problem;
  const ambit_jet_service *jet;
  options options;
  uint32_t nx, np, nc, ndir; /* nc columns; directions of slopes: the columns, then the states */
  ambit_work *counted;
  ambit_jet *centre_jet, *box_jet;

  /* -- the set */
  double *start, *start_rest, *start_column; /* [nx] [nx] [nx x nc] as at time[0] */
  double *fixed, *fixed_column;              /* [np] [np x nc] */
  double *centre, *low, *column;             /* [nx] [nx] [nx x nc] */
  double *new_centre, *new_low;              /* [nx] */
  history history;
  double *rest, *radius; /* [nx] bounds of |G e|, and of |C xi + G e + low| */
  double *size;          /* [nx] how large each state is, for tolerances */
  double *unit, *grown;  /* [nx] sizes of states, and of the set, in a step, also of what is zero (size.c) */
  double *euler;         /* [nx x (nx + 2)] scratch of these */
  double *limit;         /* [nx] widest that each state may be */

  /* -- the step */
  double t, t_next;
  span step;
  int at_instant;                         /* the step ends on an instant of the problem */
  int corrected;                          /* slopes at the end are those of the corrector */
  int wide;                               /* slopes varied over the set in the last step */
  double varies;                          /* how much, relative to the set */
  enum leniency lenient;                  /* at first of this step, then of the next */
  uint32_t slope_order, next_slope_order; /* of this step, and of the next */
  double guess, longest;                  /* next step length to try; what its slopes are likely to allow */
  uint32_t next;                          /* the instant ahead */
  pace pace;
  double *series_mid, *series_rad;            /* [nx x (order + 1)] of the centre */
  double *slope_mid, *slope_rad;              /* [nx x (slope_order + 1) x ndir] over the box */
  double *excess, *box_excess, *slope_excess; /* [nx] [nx] [nx x ndir] what the polynomials lack on the step */
  double *slope_guess;                        /* [nx x ndir] */
  double *tail_in, *dtail_in;                 /* [nin] [nin x ndir] scratch of the proof */
  double *tail_out, *dtail_out;               /* [nx] [nx x ndir] */
  /* slopes at the end of the step, one matrix for each piece: [options.pieces x nx x ndir] */
  double *transfer_mid, *transfer_rad;
  double *whole_mid, *whole_rad; /* [nx x ndir] the same for the whole set */
  double *matrix;                /* [nx x ndir] the point matrix that the set is moved with */
  double *seed, *no_radius;      /* [ndir] */
  double *added;                 /* [nx] new box of the step */
  double *piece_from, *piece_to; /* [options.pieces x nc] ranges of xi */
  double *all_from, *all_to;     /* [nc] the whole cube of xi */
  double *curvature;             /* [nc] how much slopes vary */
  uint32_t pieces, *cuts;        /* of this step; [nc] into how many parts each xi is cut */

  /* -- the record */
  double *lo, *hi, *tube_lo, *tube_hi; /* [nx] */
  double *about, *scale;               /* [nu] xi of an unknown is (u - about) / scale */
  double *dense_mid, *dense_rad;       /* [nx x (order + 1)]; NULL: not asked for, as the next ones */
  double *dense_column;                /* [nx x ndir x (slope_order + 1)] */
  double *set_coefficient, *set_rest;  /* [nx x (nu + 1)] [nx] */
  ambit_set set;
  uint32_t blamed;  /* the state that is too wide */
  const char *kink; /* why there is no step, or NULL */

  corrector corrector;
  constraint constraint;
} lohner;

/* start.c: the initial set, from open() on */
ambit_status lohner_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
void lohner_close(void *self);
enum why lohner_start(lohner *s); /* the set at time[0]; WHY_NOTHING or WHY_APART */

/* run.c */
ambit_status lohner_run(void *self, ambit_sink *sink);

/* step.c */
double lohner_share_of_time(const lohner *s); /* that of the step in the run, 1 if it is a large one */
double lohner_least_step(const lohner *s);
enum why lohner_find_step(lohner *s); /* series, a length, and its proof */

/* size.c, all after the series of the step */
void lohner_choose_units(lohner *s); /* unit: sizes of states in the step */
void lohner_choose_grown(lohner *s); /* grown: what the step makes of the set */
/* what rounding adds to state i in the step: more than its size, where it stays at zero */
double lohner_noise(const lohner *s, uint32_t i);
int lohner_is_filled(const lohner *s); /* some state counts as more than it is */

/* pace.c */
void lohner_start_pace(lohner *s);
int lohner_steps_shrink(lohner *s); /* to be asked after each step */

/* series.c: coefficients of jets, values of polynomials */
uint32_t lohner_centre_series(lohner *s);
uint32_t lohner_box_series(lohner *s, const double *from, const double *to); /* from, to [nc]: part of xi's box */
void lohner_put_centre(const lohner *s, ambit_jet *jet);
void lohner_put_box(lohner *s, ambit_jet *jet, const double *from, const double *to); /* with seeds of slopes */
ball lohner_increment(const lohner *s, uint32_t i);               /* of the centre over the step, with its excess */
void lohner_transfer(const lohner *s, double *mid, double *rad);  /* slopes at the end of the step */
void lohner_tube(lohner *s);                                      /* bounds over the whole step */
double lohner_reach(const lohner *s, uint32_t j);                 /* bound of the coordinate of direction j */
void lohner_put_parameter(lohner *s, ambit_jet *jet, uint32_t i); /* its whole range, with seeds of slopes */
ball lohner_slope_over_step(const lohner *s, uint32_t i, uint32_t j);
/* hermite.c; not open if formula is FORMULA_TAYLOR */
ambit_status lohner_open_corrector(lohner *s);
void lohner_close_corrector(lohner *s);
/* better slopes at the end of the step, from the box series, its proof and the tube; 0: none */
int lohner_correct(lohner *s);
/* set.c */
void lohner_pieces(lohner *s); /* slopes at the end of the step for the pieces of the set; destroys the box series */
/* [-low, high]: what a row S of slopes, mid +- rad, and the point row `matrix` make different, (S - M) v, for xi in
** [from, to] */
void lohner_beyond(const lohner *s, const double *mid, const double *rad, const double *matrix, const double *from,
    const double *to, double *low, double *high);
void lohner_move(lohner *s); /* the set, from the start of the step to its end */
/* new midpoint of state i: the old one, a step and a shift; *rest: what is not in it */
void lohner_shift(const lohner *s, uint32_t i, double step, ball shift, double *centre, double *low, double *rest);
void lohner_hull(lohner *s); /* rest, radius, lo, hi of the set */

/* dense.c */
int lohner_open_extras(lohner *s); /* 0: out of memory */
void lohner_dense(lohner *s);      /* the enclosure over the step, from the series and its proof */
void lohner_grant(lohner *s, ambit_record *r);

/* kink.c */
/* the operation whose kink the set meets, or, if not `met`, comes near to; NULL: none. After lohner_find_step failed */
const char *lohner_kink(const lohner *s, int met);

/* invariant.c */
ambit_status lohner_open_invariants(lohner *s);
void lohner_close_invariants(lohner *s);
/* invariants over the set at time t, `pieces` of xi's cube at a time (at most 1: the whole); 0: they cannot be used */
int lohner_linearise(lohner *s, double t, uint32_t pieces);
/* contract.c */
/* the part of the set on which the invariants vanish, and its hull */
enum why lohner_contract(lohner *s, double t, uint32_t pieces);
/* rank.c */
void lohner_note_rank(lohner *s); /* as it is at the start */
int lohner_loses_rank(lohner *s); /* 1: constraint.blamed depends on others here, as far as can be told */

/* history.c */
int history_open(const ambit_host *h, history *g, uint32_t n, uint32_t keep);
void history_clear(history *g);
/* G := M G, rounded; adds what rounding may have changed to pad[n]. M [n x n], rows `pitch` apart; rest[n] is the
** sum before */
void history_multiply(history *g, const double *M, size_t pitch, const double *rest, double *pad);
void history_push(history *g, const double *box); /* n new generators: the box, one for each state */
void history_sum(const history *g, double *rest); /* rest[i] >= sum over columns of |G_ic| */
/* about J G [k x g->pitch], J [k x n] with rows `pitch` apart, about G (J G)^T, transposed [k x n], and about the sums
** of squares of the rows of G [n] */
void history_spread(const history *g, uint32_t k, const double *J, size_t pitch, double *spread);
void history_correlate(const history *g, uint32_t k, const double *spread, double *cross, double *square);

/* frame.c: orthogonal frames; results are approximate, bounds are not */
/* Gram-Schmidt of n columns of A [n x pitch], longest of length times weight first; order, size: scratch [n] */
void frame_orthogonal(
    uint32_t n, const double *A, size_t pitch, const double *weight, double *frame, uint32_t *order, double *size);
double frame_defect(
    uint32_t n, const double *frame); /* >= the row-sum norm of I - Q^T Q; infinite if anything is not finite */
#endif
