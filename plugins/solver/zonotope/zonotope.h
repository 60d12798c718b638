/* zonotope.h -- what the files of the zonotope solver share.
**
** The set at time t is { P(xi) + P_4(xi) + G rho + e : xi in [-1, 1]^m, rho in [-1, 1]^ngen, e in discs of this xi }: P
** a polynomial of degree 3 in the data, P_4 terms of degree 4 (quartic.c), which turn with the discs (discs.c) where
** there are any, G generators. For one step (P_4 + G rho + e)_i is written E_i eps_i, |eps_i| <= 1.
**
** Phase 1 (series.c, implicit.c, functions.c) finds rows V_jk, k <= K, for every slot j of the tape, such that
** V_j(s) = sum_k V_jk s^k nearly satisfies the equations. It is plain arithmetic in doubles and proves nothing. Phase 2
** (defect.c and on) bounds by how much each operation fails, and what that does to the solution.
**
** Rows are added and multiplied modulo an ideal of monomials (those that a row does not hold), so that sums, products,
** inverses and roots are those of a ring, but for rounding. With (*) for the truncated product of rows, and all
** operands final, phase 1 leaves in row k of a slot z, k = 0 .. K:
**   ADD SUB NEG    one rounding of each coefficient
**   MUL            z_k = sum_{j <= k} a_j (*) b_(k-j)                      SQR likewise
**   DIV            z_k = (a_k - sum_{1 <= j <= k} b_j (*) z_(k-j)) (*) i_0,   i_0 the inverse of b_0
**   SQRT           z_0 the root of a_0, z_k = (a_k - sum_{1 <= j < k} z_j (*) z_(k-j)) (*) i_0,   i_0 that of 2 z_0
**   SIN, COS       s_k = 1/k sum_{1 <= j <= k} j a_j (*) c_(k-j),  c_k = -1/k sum ...       SINH, COSH likewise
**   EXP            z_k = 1/k sum_{1 <= j <= k} j a_j (*) z_(k-j)
**   LOG            z_k = (a_k - 1/k sum_{1 <= j < k} j z_j (*) a_(k-j)) (*) i_0,   i_0 that of a_0
**   ATAN           z_k = (a_k - 1/k sum_{1 <= j < k} j z_j (*) q_(k-j)) (*) i_0,   q its aux slot, i_0 that of q_0
**   ATAN2          z_k = 1/k (sum_{1 <= j <= k} j (b_(k-j) (*) a_j - a_(k-j) (*) b_j)
**                             - sum_{1 <= j < k} j z_j (*) q_(k-j)) (*) i_0
**   ABS MIN MAX    a multiple of a, or of a and b, plus a constant: those of kink.c
** and for k = 0 of a function the Taylor polynomial of degree 3 about the constant of its operand.
** Each coefficient of a sum of n products is got by at most 10 n + 14 operations in doubles, in any order, contracted
** or not, but the constant, of which row.c knows more; the divisions by k and factors j are among them. i_0 is
** inverse_at(): b_0 (*) i_0 = 1 but for rounding. No value from before the solution of the implicit equations is left
** in them: nothing cancels that is not in the rows. Slots of degree 0 (constant in time) have row 0 only, the others
** K + 1, zero above the slot's degree.
*/
#ifndef ZONOTOPE_H
#define ZONOTOPE_H
#include "row.h"
#include <ambit/num.h>
#include <ambit/solver.h>
#include <ambit/ends.h>
#include <math.h>

#define ORDER_DATA 8 /* in time, with data */
#define FOLLOWED                                                                                                       \
  27 /* data: where there are more, they are numbered by how much they matter, and those that hardly do
                    ** are not followed */

/* Why a step could not be made. */
enum why {
  WHY_NOTHING,
  WHY_UNDEFINED, /* an operation outside its domain, or not finite */
  WHY_KINK,      /* abs, min or max of an unknown meets its kink */
  WHY_PIVOT,     /* a pivot of the implicit equations may vanish */
  WHY_GROWTH,    /* the bound of the distance could not be closed */
  WHY_WIDE,
  WHY_STEP,        /* no step that is long enough */
  WHY_SHORT_STEPS, /* too many steps to the end */
  WHY_STOPPED
};

typedef struct options {
  uint32_t time_order, history; /* 0: by need; generators kept, in multiples of nx, 0: by need */
  double tolerance, step_max, step_min, width_max;
} options;

/* How the tape is read: inputs x [nx], a [na], p [np], t; outputs x' [nx], R [na]. */
typedef struct program {
  const ambit_tape *tape;
  uint32_t nx, na, np, uses_time;
  uint32_t nstage;
  const uint32_t *stage_end, *pivot; /* as in ambit_implicit */
  uint32_t *level;    /* [nslot] 0: independent of a; s + 1: depends on unknowns of stage s, none later */
  uint8_t *needed;    /* [nslot] on the way from unknowns of its level's stage to equations of that stage */
  uint32_t *sorted;   /* [ninstr] instructions by level, else in order */
  uint32_t *of_level; /* [nstage + 2] where each level starts in `sorted` */
} program;

typedef struct zono {
  const ambit_host *host;
  ambit_problem problem;
  const ambit_num_service *num;
  options options;
  program program;
  shape shape; /* of rows; shape.m data, shape.nx eps */
  uint32_t nx, na, np, m, nout, nslot;
  uint32_t bent;     /* data that need triples in rows, in the order of their weights; 0: not known */
  uint32_t nvarying; /* functions of time that the program depends on: all of the problem's, or none */
  uint32_t K, K_max; /* order in time of the present step; most that there is room for */
  /* -- rows */
  double *row;           /* [sum of orders_max x shape.stride] */
  dd *constant;          /* [nconst] of the tape, */
  double *constant_off;  /* [nconst] and what they are off by */
  double *zero;          /* [stride] */
  double *scratch;       /* [stride] */
  size_t *first;         /* [nslot] number of row 0 of the slot */
  size_t *at;            /* [nslot] where it is in `row` */
  double *inverse;       /* [ninverse x stride] */
  uint32_t *has_inverse; /* [ninstr] number of the inverse + 1, 0: none */
  struct kinks *kinks;   /* kink.c */
  struct modes *modes;   /* modes.c */
  struct basis *basis;   /* basis.c */
  /* -- the set */
  uint32_t *unknown;             /* [m] which of the problem's unknowns datum j is; AMBIT_NO_SLOT: the solver's own */
  uint8_t *minor, *has_minor;    /* [nu] unknowns that are no data, but errors of their state; [nx] these; or NULL */
  double *about, *scale;         /* [m] datum j is about_j + scale_j xi_j; 0 and 1 of the solver's own */
  double *start;                 /* [nx x stride] P at time[0] */
  double *start_rad;             /* [nx] what is left of the initial value besides */
  double *start_p, *start_p_rad; /* [np x stride] [np] of parameters */
  double *p_row, *p_rad;         /* [np x stride] [np] parameters: rows and what is left */
  double *P;                     /* [nx x stride] rows without eps */
  double *E;                     /* [nx] half widths of P_4 + G rho + e, rounded up */
  double *G;                     /* [(ngen_max + nx) x nx] column c at G + c nx */
  uint32_t ngen, ngen_max;
  /* -- the step: from t, h long (negative: backwards); s in [0, h] */
  double t, t_next, h, h_error; /* |(t_next - t) - h| <= h_error */
  double guess;                 /* length of the last step, without sign */
  double vary_most;             /* vary.c: the longest step; */
  uint32_t vary_room;           /* generators that are kept of what varies */
  uint32_t next;                /* the instant ahead */
  double *r;                    /* [nslot] what the operation itself fails by, see defect.c */
  double *rr;                   /* [nslot] the lump of each slot (constants and inputs included): r and second order */
  double *rr_out;               /* [nout] of each output */
  struct zono *jump;            /* [njump] jump.c: the programs of jumps; how many of them are done */
  uint32_t jumped;
  struct implicit *implicit; /* implicit.c */
  struct proof *proof;       /* sweep.c, error.c, close.c: allocated by zono_open_proof() */
  /* -- records */
  double *lo, *hi, *tube_lo, *tube_hi; /* [nx] */
  double *limit;                       /* [nx] widest that each state may be, */
  double *expected;                    /* [nx] and is expected to get, 0: not known (pilot.c) */
  /* -- failure */
  enum why why;
  uint32_t blamed;    /* state, slot or unknown */
  const char *detail; /* kink text, or NULL */
  ambit_sink *sink;
} zono;

/* -- rows of slots */

static inline uint32_t orders(const zono *z, uint32_t slot) { return z->program.tape->degree[slot] ? z->K + 1 : 1; }
static inline double *row_at(const zono *z, uint32_t slot, uint32_t k) {
  const shape *s = &z->shape;
  double *row = z->row + z->at[slot];
  return k < s->room ? row + k * s->stride : row + s->room * s->stride + (k - s->room) * s->cube;
}
/* order k of a slot that may have fewer */
static inline const double *coefficient(const zono *z, uint32_t slot, uint32_t k) {
  return k < orders(z, slot) ? row_at(z, slot, k) : z->zero;
}
/* that of instruction i, which has one */
static inline const double *inverse_at(const zono *z, uint32_t i) {
  return z->inverse + (z->has_inverse[i] - 1) * z->shape.stride;
}
static inline double *zono_inverse(const zono *z, uint32_t i) {
  return z->inverse + (z->has_inverse[i] - 1) * z->shape.stride;
}
static inline uint32_t slot_x(const zono *z, uint32_t i) { return z->program.tape->nconst + i; }
static inline uint32_t slot_a(const zono *z, uint32_t i) { return z->program.tape->nconst + z->nx + i; }
static inline uint32_t slot_p(const zono *z, uint32_t i) { return z->program.tape->nconst + z->nx + z->na + i; }
static inline uint32_t slot_t(const zono *z) { return z->program.tape->nconst + z->nx + z->na + z->np; }
static inline const uint32_t *slot_out(const zono *z) { return z->program.tape->out; }

/* no data, no functions of time and no jumps: all that is not known is rounding, and what is left of it */
static inline int is_certain(const zono *z) { return z->m == 0 && z->problem.nvarying == 0 && z->problem.njump == 0; }

/* -- open.c, start.c, run.c, plugin.c (phase 1) */

ambit_status zono_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
ambit_status zono_run(void *self, ambit_sink *sink);
void zono_close(void *self);
/* arrays of rows, r, rr; host, program, shape, K_max are set; also for the initial tape, whose inputs are all p: it has
** neither x nor a nor implicit nor proof, and K = 0 */
int zono_open_rows(zono *z);
/* m, start, p_row from the initial tape; data in the order of the weights [nu] of their unknowns, or as they are */
ambit_status zono_start_open(zono *z, const double *weight);
void zono_start(zono *z); /* P, G, t as at time[0] */
/* pilot.c: weight [nu] += how much each datum matters in the whole run, and z->bent, or NULL; z->expected, of the whole
** run if states may wait at rest; 0: no memory */
int zono_pilot(zono *z, double *weight, int may_wait);
/* rows of all slots from P, E, p_row, t; z->K orders. 0: see z->why */
int zono_series(zono *z);
/* functions.c: row 0, row k > 0 of a quotient, root or elementary function; 0: undefined */
int zono_function_order0(zono *z, uint32_t instr);
int zono_function(zono *z, uint32_t instr, uint32_t k);

/* -- the other half (phase 2). Each returns 0 with z->why set where it fails. None allocates but zono_open_proof(). */

int zono_open_proof(zono *z);    /* all memory of what follows; 0: none left */
void zono_choose_order(zono *z); /* pace.c: z->K of the next step, before zono_series() */
/* pace.c: a length from the rows, |h| <= |h_most| with its sign; the caller sets h, t_next, h_error from it */
double zono_choose_step(zono *z, double h_most);
/* defect.c: z->r of all slots (and rr_out := what outputs fail by) over [0, z->h]; for the initial tape too */
int zono_defects(zono *z);
/* by how much the aux slot of TANH differs from 1 minus the square of its result, as polynomials */
double tanh_aux_error(const zono *z, uint32_t i);
/* forward bounds |Delta| of all slots from those of the inputs ([nin], in the order of the tape), with z->r as lumps;
** delta [nslot]; used for the initial tape too, where rows have one order and h is 0 */
int zono_spread(zono *z, const double *input, double *delta);
/* sweeps, zeta, kernels: proves the step over [0, z->h]; 0 with WHY_GROWTH: shorten it */
int zono_prove(zono *z);
void zono_finish(zono *z); /* close.c: P, G, E at the end of the step */
void zono_hull(zono *z);   /* range.c: lo, hi of P + E */
void zono_tube(zono *z);   /* range.c: tube_lo, tube_hi of the step; before zono_finish() */
/* dense.c, set.c: what the receiver asked for */
void zono_describe_dense(zono *z, ambit_record *r); /* before zono_finish() */
const ambit_set *zono_describe_set(zono *z);
#endif
