/* reduction.h -- "ambit.strategy/1": chooses what a model may leave out. It gets candidates, reference solutions to
** rank them by, and a way to prove what a choice of them costs.
**
** The kernel owns formulas and proofs, the plugin the strategy: in which order candidates are tried, how many at once,
** which are undone. A candidate is a replacement of one term (or variable) of the equations; any subset of them makes a
** reduced model. */
#ifndef AMBIT_REDUCTION_H
#define AMBIT_REDUCTION_H
#include "arithmetic.h"
#include "record.h"

#define AMBIT_STRATEGY "ambit.strategy/1"

/* A solution of the detailed model at one value of its data, in ordinary doubles: for rankings, it proves nothing. */
typedef struct ambit_reference {
  uint32_t scenario, ntime;
  const double *time; /* [ntime] s, ascending */
  const double *in;   /* [ntime x nin] by rows: x [nx], data [np], t: the inputs of every tape of the reduction */
} ambit_reference;

/* Rankings, for rank(): a greater value is a greater effect on the solution; INFINITY: not defined along the
** references, or not proved. ONE_STEP and the later ones are relative to the bounds: 1 means as much as is allowed. */
#define AMBIT_RANK_RESIDUAL 0u /* norm of F^k along the references (Mikelsons and Brandt 2009, equation 11) */
#define AMBIT_RANK_ONE_STEP 1u /* change of the outputs in one linearised implicit step from them (equation 12) */
#define AMBIT_RANK_LOWERED 2u  /* error of each candidate alone, by a run of lowered order */
#define AMBIT_RANK_EXACT 3u    /* error of each candidate alone, by a full run */
#define AMBIT_RANK_ADJOINT 4u  /* effect on the outputs to first order, by adjoint solutions for each output */
#define AMBIT_RANK_COUNT 5u

#define AMBIT_PROVE_FULL 0u    /* as the user wants it proved: only this may accept */
#define AMBIT_PROVE_LOWERED 1u /* cheaper: lowered order and coarser tolerance */

/* What the strategy did, in order: the undo log. */
#define AMBIT_TRY_ACCEPTED 0u /* these stay cut; the kernel believes it only of what the last full proof was about */
#define AMBIT_TRY_UNDONE 1u   /* error over a bound, or not proved; not tried again */
#define AMBIT_TRY_HALVED 2u   /* undone as well, but several: they are divided, the two halves follow */
typedef struct ambit_try {
  uint32_t size, outcome;    /* AMBIT_TRY_* */
  uint32_t ncandidate, pad;  /* of this cluster */
  const uint32_t *candidate; /* [ncandidate] in the order they were ranked */
  const double *error;       /* [noutput] proved with this cluster cut as well, or NULL if nothing was proved */
} ambit_try;

typedef struct ambit_reduction {
  uint32_t size, ncandidate, noutput, nreference, neffect, nin;
  const char *const *candidate; /* [ncandidate] for messages: "yaw_rate: term 2" */
  const char *const *output;    /* [noutput] */
  const double *bound;          /* [noutput] > 0: what a reduced model may be off by */
  /* [nx] >= 0: how much each state varies along the references; 0: it stays at 0, and has no scale of its own */
  const double *scale;
  const ambit_reference *reference; /* [nreference] */
  /* [neffect] the change f^k - f of a right-hand side: output m is what candidate effect_candidate[m] alone does to the
  ** rate of state effect_state[m]; rates without an entry are not changed. NULL: there are none */
  const ambit_tape *effect;
  const uint32_t *effect_candidate, *effect_state;
  /* these four, if AMBIT_STRATEGY_WANT_SLOPES is wanted */
  const ambit_tape *jacobian;        /* [nx x nx] df/dx by rows, or NULL where f has no derivative */
  const ambit_tape *output_jacobian; /* [noutput x nx] dy/dx, or NULL */
  const ambit_tape *rates;           /* [nx] f */
  const ambit_tape *output_value;    /* [noutput] y */
  /* Proves the model with cut[k] != 0 [ncandidate] against the detailed one over all scenarios: error [noutput] bounds
  ** the error of every output. OK: proved (whether error is under bound is for the caller to see); UNABLE: no bound
  ** could be proved; STOPPED: no time is left or the user interrupts: return at once, what was accepted stands. The
  ** same cut gives the same answer. */
  ambit_status (*prove)(void *user, uint32_t how, const uint8_t *cut, double *error);
  void (*rank)(void *user, uint32_t ranking, const double *value); /* [ncandidate]; may be called for several */
  void (*tried)(void *user, const ambit_try *t);                   /* each decision, as it is made */
  void *user;
  uint32_t nx, pad;
  const ambit_arithmetic *arithmetic; /* completed: every run[] filled */
  void *actx;                         /* its context, lent to this strategy until close */
} ambit_reduction;

#define AMBIT_STRATEGY_WANT_SLOPES 1u /* derivatives of rates and outputs: see ambit_reduction */

typedef struct ambit_strategy {
  uint32_t size, want; /* AMBIT_STRATEGY_WANT_* */
  uint32_t needs_rigorous;
  const char *arithmetics; /* as in ambit_solver */
  const ambit_param *param;
  /* [ctx] allocates everything here; `option` in declaration order, shapes flattened */
  ambit_status (*open)(const ambit_host *h, const ambit_reduction *r, const double *option, void **self);
  /* [ctx] decides about every candidate; no allocation inside; sink: progress only */
  ambit_status (*run)(void *self, ambit_sink *s);
  void (*close)(void *self);
  uint32_t (*want_for)(const double *option); /* NULL: `want`; else what these options need */
} ambit_strategy;
#endif
