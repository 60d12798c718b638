/* proof.h -- what the files of phase 2 share.
**
** A lump is a function of (xi, eps, s) of which only a bound is known: lump j of each slot, |theta_j| <= rr_j, and one
** of each output. A target is a component of alpha (what a is off by) or an x'_i that is neither a state nor an
** unknown; sweeps give the coefficient of every lump in every target, as a centre and a half width over the set and the
** step.
*/
#ifndef ZONOTOPE_PROOF_H
#define ZONOTOPE_PROOF_H
#include "form.h"
#include "zonotope.h"

#define TIME_ORDERS 64 /* room for orders in time */
#define POWERS 4       /* degree in time of forms where there are no data */

/* how x'_i depends on what was swept */
enum link { LINK_STATE, LINK_UNKNOWN, LINK_TARGET };

typedef struct sweeps {
  forms forms;
  double *value;   /* [nslot] forms of the slots over the step */
  double *slope;   /* [nslope] forms of derivatives that are not slots; by z->proof->slope_at */
  double *adjoint; /* [nslot] forms of the sweep at hand */
  double *matrix;  /* [na x na] dR/da, then its factors, in the order of elimination */
  double *pivot;   /* [na] inverses of pivots */
  double *lambda;  /* [na x na] row k: -(row k of the inverse), by equation */
  double *scratch; /* [(na + 4)] forms */
} sweeps;

/* what a generator, or what went into a box, comes from */
enum origin {
  FROM_START,    /* rounding of the initial values and of the polynomials */
  FROM_DEGREE,   /* terms of the data that rows do not hold */
  FROM_TIME,     /* orders of time beyond the last */
  FROM_SQUARE,   /* products of distances from the polynomials */
  FROM_KERNEL,   /* how a lump acts on the state, depending on when in the step it acts */
  FROM_SLOPE,    /* how it does, depending on the data and on time */
  FROM_JACOBIAN, /* the same for distances that there are already */
  FROM_MIXED,    /* how the movement of old generators depends on the data */
  FROM_VARYING,  /* parameters that are functions of time */
  ORIGINS
};

typedef struct proof {
  size_t nrow;
  double *total, *drop, *scaled; /* [nrow] size of each row; what order k of an operation drops; total |h|^k */
  double *high, *low;            /* [nslot] bounds of |V| over the step; low 0 where it may vanish */
  double *delta;                 /* [nslot] |v* - V| */
  double gap[TIME_ORDERS];       /* of each power of time from its chord, at most; slope.c */
  double chebyshev[TIME_ORDERS][POWERS + 1]; /* of each power of time; slope.c */
  uint32_t *slope_at;                        /* [nslot] its first derivative form, or AMBIT_NO_SLOT */
  uint32_t *order;                           /* [na] unknowns in the order of elimination */
  uint32_t ntarget, nslope;
  uint32_t *target_out;                  /* [ntarget - na] the x' that target na + n is */
  uint32_t *link;                        /* [nx] kind of x'_i: enum link */
  uint32_t *link_to;                     /* [nx] the state, unknown or target */
  sweeps forms, points;                  /* over the set and the step; at its centre and start */
  double *C, *dC;                        /* [ntarget x nslot] coefficients of lumps in targets: middle, half width */
  double *dC_new, *dL_new, *rho, *close; /* while they are made */
  double *L, *dL;                        /* [ntarget x na] of the lumps of the equations */
  double *J, *dJ;                        /* [nx x nx] */
  double *weight;            /* [ntarget x nslot] C at the centre and the start: for the length of the step */
  double *weight_L;          /* [ntarget x na] */
  double *zeta, *zeta_new;   /* [nx] bound of |z| over the step; */
  double *ramp;              /* [nx] |z(s)| is at most s / h times this, too */
  double *alpha, *alpha_new; /* [na] */
  double *input;             /* [nin] */
  double *mean, *tilt, *reach, *wobble;                        /* [nx x nx] of K(s) = e^(J (h - s)), see kernel.c */
  double *power, *power_new, *size, *size_new, *jacobian_size; /* [nx x nx] */
  double *grow, *grow_path;                                    /* [nx] per state: sums for bounds */
  double *columns;                                             /* [(ngen_max + 2 (nslot + nout) + nx + 2 m) x nx] */
  double *turned;             /* [nx x mixed_stride] old generators, state by state, and 0; one more row */
  double *moves;              /* [nx x (nx + 3)] mixed.c */
  double *score, *sorted;     /* one of each column */
  double *end;                /* [nx x stride] rows at the end of the step */
  double *spread;             /* [nx] sizes of states' sets, for weights */
  double *largest;            /* [nx] of these, of the whole run */
  double *natural;            /* [nx] rates that rounding to doubles would have: pace.c */
  double *budget;             /* [nx] rates at which each state may be widened: pace.c */
  double *worth, usual;       /* parts.c: [3 nx]; length of steps */
  double *unit;               /* [nx] of the states, for norms */
  double *work;               /* [4 nx + na] */
  double paced;               /* what pace.c chose for the last step */
  uint32_t time_order;        /* in time, where there are no data, or jumps */
  uint32_t order_wait;        /* steps until a lower one is tried */
  int cut;                    /* did the last step end before the instant ahead? */
  double rho_before;          /* of a longer step that was tried; 0: none */
  uint32_t patience;          /* steps that are not halved for it */
  int prepared;               /* total and drop are those of the rows */
  double *boxes;              /* [ORIGINS x nx] what goes into the box */
  uint8_t *origin, *from;     /* of columns, of z->G */
  uint16_t *source, *made_by; /* vary.c: which function of time, of columns, of z->G; 0: none */
  struct depend *depend;      /* depend.c */
  struct change *change;      /* change.c */
  struct quartic *quartic;    /* quartic.c */
  struct residual *residual;  /* residual.c */
  double *late;               /* [nslot] what of z->r is FROM_TIME */
  double *range;              /* [2 m] */
  double *gain;               /* [2 nx] strip.c */
  /* records */
  double *dense_mid, *dense_rad, *dense_column;
  ambit_set set;
  double *rest, *coefficient;
} proof;

/* defect.c */
void defect_prepare(zono *z);                /* from the rows: once a step */
int defect_evaluate(zono *z, double length); /* z->r, z->rr_out, high, low over [0, length] */
/* sweep.c */
int sweep_open(zono *z, sweeps *w, uint32_t sigmas, int powers);
int sweep_coefficients(zono *z); /* C, L, J of proof from forms over [0, h] */
int sweep_weights(zono *z);      /* weight, weight_L: at the centre and the start */
/* inverse.c: w->lambda from w->matrix; 0: a pivot is 0 */
int inverse_find(zono *z, const sweeps *w);
/* origin.c: where the width comes from, as text that follows a clause; empty where there is nothing to say */
void origin_text(const zono *z, char *text, size_t room);
/* slope.c: forms of slots and of derivatives */
void slope_open(proof *p);
int slope_forms(zono *z, const sweeps *w, double h);
/* pace.c: budgets for a step of this length */
void pace_budget(zono *z, double length);
/* parts.c: z->shape's numbers of orders for the next step, from the rows and slopes of this one */
void parts_choose(zono *z);
/* set.c, dense.c; 0: no memory */
int set_open(zono *z);
int dense_open(zono *z);
/* of old generators, state by state: a multiple of 8 */
static inline size_t mixed_stride(const zono *z) { return (z->ngen + (size_t)7) / 8 * 8; }
/* mixed.c: prepares what follows, from G and E; */
void mixed_prepare(zono *z);
/* to [ngen] := sum_k y_k e_k, column by column; */
void mixed_through(const zono *z, const double *y, double *to);
/* a bound of it, with terms of degree 4 and discs; of y [count x nx], all together; kept: without these two; */
double mixed_size(const zono *z, const double *y);
double mixed_sizes(const zono *z, const double *y, size_t count, double *kept);
/* what the mixed terms do: columns from number `at` on, and the box of what they leave; returns the number of
** columns */
uint32_t mixed_add(zono *z, uint32_t at);
/* distance.c: columns from number `at` on, and the box of what they do not hold; returns the number of columns */
uint32_t distance_add(zono *z, uint32_t at);
/* close.c: the set after a jump, whose rows are p->end; put: what adds columns to those of the old generators */
void close_jump(zono *z, uint32_t (*put)(zono *z, const zono *by, uint32_t at), const zono *by);
/* kernel.c: sizes of J, and units in which J h is small; */
int kernel_units(zono *z);
/* mean, reach, wobble from J and |h|; 0: too long */
int kernel_find(zono *z);

/* what goes into the box */
static inline double *box(const zono *z, enum origin from, uint32_t i) { return z->proof->boxes + from * z->nx + i; }
static inline double *proof_form(const sweeps *w, double *array, size_t n) { return array + n * w->forms.stride; }
#endif
