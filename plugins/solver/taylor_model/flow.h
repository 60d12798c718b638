/* flow.h -- what the files of the taylor_model solver share.
**
** A piece is a box of the unknowns, xi in [-1, 1]^m on it. At time t, for every xi of its sub-range number s,
**   x = X(xi) + z,  z in the zonotope of s;   p = P(xi) + r,  |r| <= parameter_rad,
** X, P polynomials with exact double coefficients. All arithmetic below flow_run() and flow_open() is in upward mode.
** Proofs: docs/numerics/taylor_flow.md.
*/
#ifndef TAYLOR_MODEL_FLOW_H
#define TAYLOR_MODEL_FLOW_H
#include "range.h"
#include "series.h"
#include "zonotope.h"
#include <ambit/jet.h>
#include <ambit/pool.h>
#include <ambit/solver.h>
#include <ambit/ends.h>
#include <ambit/work.h>

/* Why a piece could not go on. */
enum why {
  WHY_NOTHING,
  WHY_SERIES,  /* the right-hand side has no series over the piece */
  WHY_KINK,    /* abs, min or max meets its kink */
  WHY_NO_STEP, /* no step that is long enough could be proved */
  WHY_WIDE,
  WHY_DEFECT, /* the polynomials' truncation is above its tolerance: split, if there is room */
  WHY_STOPPED
};

typedef struct options {
  uint32_t order, time_order, slope_order, pieces_max, keep, outputs;
  double tolerance, split_tolerance, step_max, step_min, width_max;
} options;

/* a time from the start of a step: h +- error, |h| + error <= length */
typedef struct span {
  double h, error, length;
} span;

typedef struct piece {
  double t, guess;       /* s; length of the next step to try */
  uint32_t depth;        /* times it was split */
  uint32_t level;        /* how coarsely sub-ranges are taken together for slopes */
  int done, tolerant;    /* at the output instant; truncation does not count, for there is no room for more pieces */
  double parent_rest;    /* relative truncation for which its parent was split; 0: for another reason, or not */
  double futile;         /* relative truncation that no split mends */
  enum why why;          /* of the last step that was not made */
  uint32_t blamed;       /* state that is too wide */
  const char *kink;      /* that the last step could not pass, as the tape names it; NULL: none known */
  double *from, *to;     /* [m] its box of the unknowns of the run */
  double *x, *p;         /* [nx x space.size] [np x space.size] */
  double *parameter_rad; /* [np] */
  double *mid, *rad;     /* [ns x nx] the box of each sub-range */
  double *zonotope;      /* [ns] */
  double *lo, *hi, *tube_lo, *tube_hi; /* [nx] at the output instant, since the last one */
  double *pad;                         /* [nx] last distance from polynomials to solutions, a guess for the next */
  double *block;                       /* all of these arrays */
} piece;

/* memory and contexts of one thread */
typedef struct worker {
  struct flow *flow;
  series_source source;
  ambit_arithmetic polynomials; /* private: its jets are series_jets */
  ambit_jet *jet, *box, *near;  /* polynomials; slopes over a sub-range; derivatives near the step */
  series *series;               /* inside of jet */
  ambit_work *counted;
  zonotope_shape shape;
  search search;
  span step;
  double t_next;
  int at_goal, order_too_low;                        /* the step is only too long for the order of the slopes */
  uint32_t groups;                                   /* of sub-ranges, in the last step */
  double *tail_in, *dtail_in, *tail_out, *dtail_out; /* [nin] [nin x nx] [nx] [nx x nx] */
  double *local, *truncation;                        /* [nx] defect over the step: all of it; of time alone */
  double *size;                                      /* [nx] how large states are, for tolerances */
  double *eps, *deps, *excess, *dexcess;             /* [nx] [nx x nx] guesses and results of the inclusion */
  double *box_mid, *box_rad, *slope_mid, *slope_rad; /* [nx x (slope_order + 1)], times nx */
  double *near_mid, *near_rad, *A;                   /* [nx] [nx x nx] where the step is; |Df| h there */
  double *unit;                                      /* [nx] in which slopes are guessed */
  double *weight;                                    /* [nx] in which A has about its least norm */
  double *rate;                                      /* [nx x nx] |Df| over the piece at the start of the step */
  double *group_mid, *group_rad, *group_rest; /* [nx + np] [nx + np] [nx] box and remainder of a group of sub-ranges */
  /* for each group of sub-ranges: */
  double *transfer_mid, *transfer_rad;   /* [ns x nx x nx] */
  double *apart;                         /* [ns x nx] solutions from the polynomials at the end */
  double *reach;                         /* [ns x nx] most of J z during the step */
  double *x, *q, *scratch, *seed, *zero; /* [nx x size] [size] [4 nx] [nx] [nx] */
  double *tube_lo, *tube_hi, *rounding;  /* [nx] [nx] [nx] */
} worker;

typedef struct flow {
  const ambit_host *host;
  ambit_problem problem;
  const ambit_jet_service *jet;
  const ambit_num_service *num;
  const ambit_pool_service *pool_service;
  ambit_pool *pool;
  options options;
  space space;
  uint32_t nx, np, m, ns;        /* unknowns of the polynomials; sub-ranges of a piece */
  uint32_t *cuts;                /* [m] parts of each unknown; their product is ns */
  double *sub_about, *sub_reach; /* [ns x m] [m] */
  double *middle, *whole;        /* [m] [m] zeros, ones: the box of a piece */
  /* levels of grouping, 0 the finest; [levels] groups; [levels x ns] the group of each sub-range */
  uint32_t levels, *ngroup, *group;
  double *unit_mid, *unit_rad;                           /* [m] of the problem's unknowns: u = mid + rad xi */
  double *start_x, *start_p, *start_x_rad, *start_p_rad; /* as at time[0] */
  double *limit; /* [nx] widest that each state may be; pieces on their way only read it */
  uint32_t nworker;
  worker *worker;
  uint32_t npiece; /* pieces in use: piece[0 .. npiece - 1] */
  piece *piece;    /* [pieces_max + 1] one more for splitting */
  uint32_t *todo;  /* [pieces_max] */
  int put_off;     /* piece 0 is alone and goes on in spite of its truncation */
  uint32_t next;   /* the instant ahead */
  double t, t_to;
  uint32_t failed;  /* the piece that ended the run */
  _Atomic int stop; /* the receiver wants no more: pieces on the way give up */
  /* -- the record */
  double *lo, *hi, *tube_lo, *tube_hi; /* [nx] */
  struct dense *dense;                 /* NULL: not asked for */
  double *rest;                        /* [nx] */
  double *coefficient;                 /* [nx x monomials] */
  uint32_t *exponent;                  /* [monomials x nu] */
  ambit_set set;
  ambit_sink *sink;
} flow;

/* open.c, start.c */
ambit_status flow_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
void flow_close(void *self);
ambit_status flow_choose(const ambit_host *h, const ambit_problem *p, const double *option, options *o);
double flow_least_step(const flow *f, double t); /* s */
void flow_start(flow *f);                        /* piece 0 as at time[0] */

/* run.c */
ambit_status flow_run(void *self, ambit_sink *sink);
int32_t flow_ask(flow *f); /* progress; nonzero: stop */
int32_t flow_emit(flow *f, double t_from, int dense);
/* pieces.c: from t to f->t_to for all pieces; WHY_NOTHING, or why f->failed could not */
enum why flow_advance_pieces(flow *f);
int flow_split(flow *f, uint32_t number); /* 0: no room */
int flow_put_off(flow *f);                /* the split of piece 0; 0: it should not be */
enum why flow_go_back(flow *f);           /* to where it was put off, and in pieces from there to f->t */

/* step.c: one step, at most to `goal` */
enum why flow_step(worker *w, piece *p, double goal);
/* x [size] := the polynomials of state i at t, behind the start of the step; returns a bound of what is off */
double flow_evaluate(const worker *w, const span *t, uint32_t i, double *x);
/* size.c */
void flow_find_rates(worker *w, const piece *p);     /* w->rate */
void flow_find_sizes(const worker *w, double *size); /* [nx] how large states count as, after w->rate and the series */
/* unit [nx] := what states are to each other where all act on all for a while: in which slopes compare */
void flow_find_units(const worker *w, double *unit);
/* tube.c: what the polynomials know of the tube of a step that is proved */
void flow_narrow_tube(worker *w, const piece *p);
/* proof.c: slopes, distance and tube of group n of sub-ranges over w->step; 0: not proved */
int flow_prove(worker *w, piece *p, uint32_t n);
/* set.c */
void flow_boxes(worker *w, piece *p); /* mid, rad of each sub-range */
void flow_hull(worker *w, piece *p);  /* lo, hi */
/* kink.c: that the step which just failed could not pass */
const char *flow_kink(const worker *w);
/* dense.c */
int flow_open_dense(flow *f);                 /* 0: no memory */
void flow_describe(flow *f, ambit_record *r); /* dense enclosure of the last step */
const ambit_set *flow_describe_set(flow *f, const piece *p);
#endif
