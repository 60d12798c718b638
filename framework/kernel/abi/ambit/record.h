/* record.h -- what solvers and root finders report, and who receives it. */
#ifndef AMBIT_RECORD_H
#define AMBIT_RECORD_H
#include "tape.h"

/* A set of states that still knows what it depends on: for every u in the box of the unknowns, with
** v_j = (u_j - about_j) / scale_j, |x_i(u) - sum_t coefficient[i * nterm + t] prod_j v_j^exponent[t * nu + j]| <=
** rest_i. A run can be continued from it without losing what the states have in common. */
typedef struct ambit_set {
  uint32_t size, nu, nterm, pad;
  const double *about, *scale; /* [nu]; scale > 0 */
  const uint32_t *exponent;    /* [nterm x nu] */
  const double *coefficient;   /* [nx x nterm] */
  const double *rest;          /* [nx] */
} ambit_set;

/* Result record: header first, so that readers skip kinds they do not know. Enclosures hold for every solution on which
** the invariants (if any) vanish. */
#define AMBIT_REC_STEP 1u  /* a step from t_from to t_to */
#define AMBIT_REC_EVENT 2u /* event number `event` happens within [t_from, t_to], ordered in time */
/* a box [lo, hi] of the searched one; boxes without a root are not reported. `event`: AMBIT_ROOT_* */
#define AMBIT_REC_ROOT 3u
#define AMBIT_REC_SEARCHED 4u /* the search is over: `ncoef` boxes were looked at; nothing else is set */
#define AMBIT_ROOT_UNDECIDED 0u
/* for each value of the parameters one root in it, and no other but those of reported boxes that meet this one */
#define AMBIT_ROOT_UNIQUE 1u
#define AMBIT_ROOT_PARTLY 2u /* the same, but for a part of the values of the parameters only */
typedef struct ambit_record {
  uint32_t size, kind;
  double t_from, t_to; /* s; t_to < t_from when integrating backwards */
  uint32_t nx, flags, event, rigorous;
  const double *lo, *hi;           /* [nx] at t_to; valid only during the call */
  const double *tube_lo, *tube_hi; /* [nx] over the whole step, or NULL */
  uint32_t order, ncoef;           /* order used (0 = none) */
  /* AMBIT_EXTRA_DENSE: for s from 0 to t_to - t_from (s and the difference as real numbers),
  ** x_i(t_from + s) in sum_{k < ndense} (dense_mid[i * ndense + k] +- dense_rad[i * ndense + k]) s^k
  **   +- sum_{c < ncolumn} |sum_{k < ncoef_column} dense_column[(i * ncolumn + c) * ncoef_column + k] s^k|; or NULL.
  ** Columns (ncoef_column <= ndense; there may be none) keep how what is uncertain grows and shrinks in the step. */
  uint32_t ndense, ncolumn, ncoef_column, pad;
  const double *dense_mid, *dense_rad, *dense_column;
  const ambit_set *set; /* AMBIT_EXTRA_SET: the set at t_to, inside [lo, hi]; or NULL */
  /* Where states leap at samples: how far the true time may be off the time of the record, s, but not before the start.
  ** The kernel says it (ambit_problem.jump_error), whatever the solver wrote. */
  double clock_error;
} ambit_record;

typedef struct ambit_sink ambit_sink;
struct ambit_sink {
  uint32_t size;
  int32_t (*emit)(ambit_sink *s, const ambit_record *r); /* nonzero: stop, return AMBIT_STOPPED */
  /* 0..1; nonzero: stop; call at least every step */
  int32_t (*progress)(ambit_sink *s, double done, const char *message);
};
#endif
