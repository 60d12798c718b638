/* solver.h -- "ambit.solver/1": advances a problem in time, or finds the roots of one, and emits records. */
#ifndef AMBIT_SOLVER_H
#define AMBIT_SOLVER_H
#include "arithmetic.h"
#include "reduction.h"

#define AMBIT_SOLVER "ambit.solver/1"

/* What a solver may ask for; the kernel builds only that. */
#define AMBIT_WANT_RHS 1u    /* x' = f(x, p, t) as a tape */
#define AMBIT_WANT_SERIES 2u /* the rhs tape must be a SERIES tape */
/* df/dx as a tape, row by row, same inputs as the rhs; valid where f is defined and differentiable: off the cut of
** atan2, on which the entries may be finite although f jumps */
#define AMBIT_WANT_JACOBIAN 4u
#define AMBIT_WANT_INITIAL 8u /* initial state and parameters as a SERIES tape over the unknowns */
/* a context for each thread of "ambit.pool/1" (ambit_problem.worker), for solvers that work on pieces side by side */
#define AMBIT_WANT_WORKERS 16u
/* g(x, p, t) that stay zero along every solution that starts there, as a tape (SERIES if that is wanted), and with
** AMBIT_WANT_JACOBIAN their Jacobian; absent if the system has none */
#define AMBIT_WANT_INVARIANT 32u
#define AMBIT_WANT_SLOPE 64u /* df/dp as a tape, row by row, same inputs as the rhs; valid as the Jacobian is */
/* one variable more in the arithmetic's context, behind those of the unknowns: the time within a step, number nu of
** set(); a context without it (an older host's) only gives wider results */
#define AMBIT_WANT_TIME 128u
/* x' and equations for further unknowns that enter linearly, instead of formulas that divide: ambit_implicit; no rhs
** without AMBIT_WANT_RHS, even with AMBIT_WANT_SERIES */
#define AMBIT_WANT_IMPLICIT 256u
/* Parameters may be functions of time (ambit_problem.nvarying): a solver that does not say so is never given any. */
#define AMBIT_WANT_VARYING 512u
/* States may jump at instants that are known (ambit_problem.njump): a solver that does not say so is never given any. */
#define AMBIT_WANT_JUMP 1024u

/* What a solver solves. FLOW: x' = f from a start. ROOTS: f(x, p) = 0 with as many equations as unknowns x; rhs and
** jacobian are those of f, x0 is the box to be searched, there is no time; invariant: further equations that a root
** satisfies too, or absent. */
#define AMBIT_SOLVES_FLOW 0u
#define AMBIT_SOLVES_ROOTS 1u
/* which parts of a model may be left out: everything is in `reduction`, in the problem's arithmetic (real); of the
** rest only nx, np, name, uses_time are set; ends with what was accepted last; sink: progress only */
#define AMBIT_SOLVES_REDUCTION 2u

/* What the receiver of the records would like besides: a solver that can't, leaves it out; one that can, does so only
** where it is asked for. DENSE: the dense enclosure of each step. SET: the set at the end of each step as a function of the
** unknowns. */
#define AMBIT_EXTRA_DENSE 1u
#define AMBIT_EXTRA_SET 2u
/* ROOTS: the further equations hold at every root of f that they do not exclude as soon as its enclosure is narrow
** (redundant ones that single out some of isolated roots): they narrow and exclude, roots are proved by f alone */
#define AMBIT_EXTRA_IMPLIED 4u

/* A system in implicit form: unknowns a (accelerations, dependent speeds, multipliers) with R(x, a, p, t) = 0 and
** x' = F(x, a, p, t). They are solved for in stages: the equations of stage s are affine in the unknowns of stage s,
** depend on those of earlier stages in any way and on those of later stages not at all; dR_s/da_s is square. F may
** depend on all unknowns, affinely on those of each stage. Where all dR_s/da_s are regular and the invariants vanish,
** R = 0 determines a, and F is f. A solver proves that they are regular, on the sets that it encloses. No instruction
** divides by a pivot of dR/da. A system that has no such form has na = 0 and nstage = 0: then the tape is that of f. */
typedef struct ambit_implicit {
  uint32_t size, na, nstage, pad;
  /* a SERIES tape; inputs: x [nx], a [na], p [np], then t if uses_time; outputs: F [nx], R [na] */
  const ambit_tape *tape;
  /* [nstage] unknowns and equations of stage s: from stage_end[s - 1] (0 for the first) up to stage_end[s] - 1 */
  const uint32_t *stage_end;
  /* [na] the order, stage by stage, in which unknowns are best eliminated, unknown pivot[k] by equation pivot[k]:
  ** joints from the tips to the base, multipliers behind them */
  const uint32_t *pivot;
} ambit_implicit;

/* Inputs of rhs, jacobian: x [nx], p [np], then t if uses_time. Inputs of initial: the unknowns [nu];
** its outputs: x(t0) [nx], p [np]. An unknown that several data share occurs once: correlation is kept. */
typedef struct ambit_problem {
  uint32_t size, nx, np, nu, extras, uses_time; /* extras: AMBIT_EXTRA_* */
  const char *const *name;                      /* [nx] state names, [np] parameter names behind them */
  const ambit_tape *rhs, *jacobian, *initial;   /* NULL when not wanted */
  const ambit_arithmetic *arithmetic;           /* completed: every run[] filled */
  void *actx;                                   /* its context, lent to this solver until close */
  const double *x0_lo, *x0_hi;                  /* [nx] hull of the initial set */
  const double *p_lo, *p_hi;                    /* [np] hull of the parameters (only uncertain data are parameters) */
  const double *u_lo, *u_hi;                    /* [nu] ranges of the unknowns */
  uint32_t ntime;                               /* >= 2 */
  /* [ntime] start, instants that a step must end on, end; ascending or descending, s */
  const double *time;
  uint32_t ninvariant;
  const ambit_tape *invariant, *invariant_jacobian; /* [ninvariant], [ninvariant x nx] by rows; inputs as of rhs */
  const char *const *invariant_name;                /* [ninvariant] "close: row 1", for messages */
  const ambit_tape *slope;                          /* [nx x np], or NULL if rhs has no derivative by p */
  uint32_t nworker;                                 /* threads that "ambit.pool/1" lends, at least 1 */
  /* [nworker] contexts like actx, one for each thread; worker[0] is actx; NULL unless wanted */
  void *const *worker;
  const ambit_reduction *reduction; /* AMBIT_SOLVES_REDUCTION; else NULL */
  const ambit_implicit *implicit;   /* AMBIT_WANT_IMPLICIT; else NULL */
  const char *const *unknown_name;  /* [nu] names of the data, for messages */
  /* The last nvarying of the np parameters are functions of time: measurable, within [p_lo, p_hi] at almost all times,
  ** each the same wherever it occurs, nothing else is known of them. `initial` gives their ranges. */
  uint32_t nvarying;
  /* AMBIT_WANT_JUMP: x becomes what jump[jump_number[k]] gives of x, p and the time, at instants in [time[0], end of
  ** time[]), in this order. A record that ends there has the states before the jump. Every sample draws the functions of
  ** time anew, as every instant does. The true instants are off by at most jump_error each: what is proved holds for
  ** them. Jumps only where time ascends. */
  uint32_t njump;
  const ambit_tape *const *jump; /* [njump] inputs as of rhs, outputs x [nx]; SERIES if that is wanted */
  uint32_t njump_time;
  const double *jump_time; /* [njump_time] never descending */
  const uint32_t *jump_number;
  double jump_error;
} ambit_problem;

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
} ambit_record;

typedef struct ambit_sink ambit_sink;
struct ambit_sink {
  uint32_t size;
  int32_t (*emit)(ambit_sink *s, const ambit_record *r); /* nonzero: stop, return AMBIT_STOPPED */
  /* 0..1; nonzero: stop; call at least every step */
  int32_t (*progress)(ambit_sink *s, double done, const char *message);
};

typedef struct ambit_solver {
  uint32_t size, want;     /* AMBIT_WANT_* */
  uint32_t needs_rigorous; /* 1: refuse an arithmetic that is not; 0: results prove nothing */
  /* names of those that it computes in, blank-separated, the first is the default: any other would have no effect, and
  ** is refused; NULL: every rigorous one */
  const char *arithmetics;
  const ambit_param *param;
  /* [ctx] allocates everything here; `option` in declaration order, shapes flattened */
  ambit_status (*open)(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
  /* [ctx] runs to the end; no allocation inside. Failures say why and which knob to turn, through h->fail of open's
  ** host */
  ambit_status (*run)(void *self, ambit_sink *s);
  void (*close)(void *self);
  uint32_t (*want_for)(const double *option); /* NULL: `want`; else what these options need */
  uint32_t solves;                            /* AMBIT_SOLVES_* */
  /* Which options `ambit compare` tries: lists, separated by ';', of options, separated by blanks, with their values,
  ** separated by commas: "order=6,10,15; tolerance=1e-6,1e-10". NULL: about the defaults of `order` and `tolerance`. */
  const char *compared;
  const char
      *cheap; /* options with which a proof costs little and need not be tight: "order=8 tolerance=1e-8", or NULL */
} ambit_solver;
#endif
