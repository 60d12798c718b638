/* solver.h -- "ambit.solver/1": advances a problem in time and emits records. Roots are found by <ambit/root_finder.h>,
** what a model may leave out is chosen by <ambit/reduction.h>; one plugin may offer several. */
#ifndef AMBIT_SOLVER_H
#define AMBIT_SOLVER_H
#include "arithmetic.h"
#include "record.h"

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
/* States may jump at instants that are known (ambit_problem.njump): a solver that does not say so is never given
** any. */
#define AMBIT_WANT_JUMP 1024u

/* What the receiver of the records would like besides: a solver that can't, leaves it out; one that can, does so only
** where it is asked for. DENSE: the dense enclosure of each step. SET: the set at the end of each step as a function of
** the unknowns. */
#define AMBIT_EXTRA_DENSE 1u
#define AMBIT_EXTRA_SET 2u

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
  const ambit_implicit *implicit;  /* AMBIT_WANT_IMPLICIT; else NULL */
  const char *const *unknown_name; /* [nu] names of the data, for messages */
  /* The last nvarying of the np parameters are functions of time: measurable, within [p_lo, p_hi] at almost all times,
  ** each the same wherever it occurs, nothing else is known of them. `initial` gives their ranges. */
  uint32_t nvarying;
  /* AMBIT_WANT_JUMP: x becomes what jump[jump_number[k]] gives of x, p and the time, at instants in [time[0], end of
  ** time[]), in this order. A record that ends there has the states before the jump. Every sample draws the functions
  ** of time anew, as every instant does. The true instants are off by at most jump_error each: what is proved holds for
  ** them. Jumps only where time ascends. */
  uint32_t njump;
  const ambit_tape *const *jump; /* [njump] inputs as of rhs, outputs x [nx]; SERIES if that is wanted */
  uint32_t njump_time;
  const double *jump_time; /* [njump_time] never descending */
  const uint32_t *jump_number;
  double jump_error;
  /* [nx] bounds within which each state stays at all times: of solutions that leave them nothing is asked. Infinite
  ** where nothing is known; NULL: nowhere */
  const double *x_least, *x_most;
} ambit_problem;

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
  /* Which options `ambit compare` tries: lists, separated by ';', of options, separated by blanks, with their values,
  ** separated by commas: "order=6,10,15; tolerance=1e-6,1e-10". NULL: about the defaults of `order` and `tolerance`. */
  const char *compared;
  const char
      *cheap; /* options with which a proof costs little and need not be tight: "order=8 tolerance=1e-8", or NULL */
} ambit_solver;
#endif
