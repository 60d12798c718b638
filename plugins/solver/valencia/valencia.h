/* valencia.h -- what the files of the valencia plugin share.
**
** The set of states at time t is
**   { P(xi) + B z : xi in [-1, 1]^nu, |z_j| <= w_j },
** P a polynomial in the normalised unknowns xi with double coefficients, B a square matrix. In the step to t + h, in
** the variable sigma in [-1, 1], x = p(sigma, xi) + B(sigma) z + r(sigma) with polynomials that need not be proved and
** an error r that is (verify.c). Parameters are middle + reach xi. Arrays of rows and columns are by rows. All
** arithmetic is in upward mode (interval.h). Proofs: docs/numerics/valencia.md.
*/
#ifndef VALENCIA_H
#define VALENCIA_H
#include "interval.h"
#include <ambit/block.h>
#include <ambit/jet.h>
#include <ambit/meter.h>
#include <ambit/num.h>
#include <ambit/solver.h>
#include <ambit/ends.h>

#define TERMS_MAX 512u /* of P, for each state */

/* Why no step could be made; the run ends with a sentence about it (run.c). */
enum why {
  WHY_NOTHING,
  WHY_DOMAIN,     /* the right-hand side is not defined, or not bounded, over the tube */
  WHY_CURVE,      /* no approximate solution could be computed */
  WHY_NO_SLOPES,  /* nor slopes: it is only continuous there (verify.c goes on without) */
  WHY_NO_CONTAIN, /* no error bound maps into itself */
  WHY_WIDE,
  WHY_STOPPED
};

enum exponential { EXPONENTIAL_AUTO, EXPONENTIAL_OFF, EXPONENTIAL_ON };

typedef struct options {
  uint32_t order, degree;
  enum exponential exponential;
  double tolerance, step_max, step_min, width_max;
} options;

/* Collocation at points node[i] in (-1, 1], the last being 1 (collocation.c). */
typedef struct stages {
  uint32_t n;
  double *node;      /* [n] */
  double *integral;  /* [n x n] of the Lagrange polynomial j from -1 to node i */
  double *transform; /* [n x n] from values at the nodes to Chebyshev coefficients */
  double *chebyshev; /* [n x n] coefficient m of T_l */
  double *rate;      /* [n x nx] derivatives at the nodes */
  double *jacobian;  /* [n x nx x (nx + np + 1)] */
  double *matrix;    /* [n nx x n nx] of the Newton iteration, decomposed */
  double *right;     /* [n nx x columns] */
  uint32_t *pivot;   /* [n nx] */
  double *slot;      /* [nslot x (1 + nx + np)] plain values and derivatives of the tape */
} stages;

/* Polynomials in xi: monomials, and the points at which curves are computed to find coefficients. */
typedef struct terms {
  uint32_t n;         /* monomials, the first is 1, number 1 + j is xi_j */
  uint32_t *exponent; /* [n x nu] */
  uint32_t *parent;   /* [n x 2] term = parent xi_which */
  uint32_t nsample;
  double *sample; /* [nsample x nu] */
  double *q, *r;  /* [n x nsample] orthonormal polynomials at the samples; [n x n] upper triangle */
} terms;

/* A frame for r in which its growth is bounded componentwise or, in pairs, in the Euclidean norm (eigen.c). */
typedef struct basis {
  double *v;         /* [nx x nx] columns */
  interval *inverse; /* [nx x nx] */
  uint32_t nblock;
  uint32_t *first; /* [nblock + 1] columns of a block, one or two */
} basis;

/* The right-hand side over a tube, in the arithmetic of the problem (symbols.c). */
typedef struct symbols {
  ambit_lane lane;
  size_t count;      /* elements, those of the tape first: see symbols.c */
  uint32_t time_var; /* number of the variable for sigma */
  int keeps;         /* x - x is 0: dependence on unknowns and time is kept */
  uint32_t degree;   /* and x^k - x^k up to this k */
  double *lo, *hi;   /* [nslot] over the tube */
  interval *slope;   /* [nslot x ndir] (slope.c) */
} symbols;

typedef struct valencia {
  const ambit_host *host;
  ambit_work *counted;
  const ambit_meter_service *meter; /* NULL: not profiled */
  ambit_problem problem;
  options options;
  const ambit_num_service *num;
  const ambit_jet_service *jet;
  ambit_jet *centre, *box; /* series of the right-hand side along the middle curve; with slopes, of all that is near */
  uint32_t nx, np, nu, ndir;
  stages stages;
  terms terms;
  symbols symbols;
  basis basis;
  double *middle, *reach, *loose; /* [np] [np x nu] of the parameters; [np] what is not known of them as a function */
  double *p, *b, *w;              /* the set: [nx x nterm] [nx x nx] [nx] */
  double *start_p, *start_w;      /* at the start of the run */
  double *curve;                  /* [nx x nterm x (n + 1)] of p(sigma, xi) by powers of sigma */
  double *frame;                  /* [nx x nx x (n + 1)] of B(sigma) */
  int frozen;                     /* only the constant term of p moves: the right-hand side has no slopes */
  interval half, time;            /* half the step; its middle instant */
  interval *jacobian;             /* [nx x (nx + np)] slopes over the tube */
  interval *defect;               /* [nx] f(p) - p' */
  interval *rate;                 /* [nx] over the tube: half f - p' (verify.c), 2 half f (faces.c) */
  uint32_t ncolumn;               /* directions: the unknowns, if p is linear in them, then z */
  int centred;                    /* residuals are of slopes about the middle (open.c) */
  interval *residual;             /* [ncolumn x nx] (half J) c - c' of each direction c(sigma) */
  double *tail;                   /* series.c */
  double *kept;                   /* [nx x nx] B at the start of the step without what goes into r */
  double *start, *rounding, *reach_z;           /* [nx] |r(-1)|; its part that P leaves; |B(sigma) z| */
  double *omega, *top, *eta, *forcing, *growth; /* [nx] and [nx x nx] in the basis, by blocks (verify.c) */
  double *last, *error, *over; /* [nx] |r| at the end, in the basis by blocks, and of the states; |r| over the step */
  double *steerable;           /* [nx] the part of the error that comes from the middle curve: it falls with the step */
  double *shift;               /* [nx] of the end of a frozen step */
  double *radius;              /* [nx] of the tube about p */
  interval *matrix, *column;   /* [nx x nx] slopes in the basis; [3 nx] */
  double *generator, *size, *shape, *sum, *directions, *next_w; /* frame.c */
  double *scale;                                                /* [nx] diagonal of D */
  double *eigen_room;                                           /* eigen.c */
  double *noise;                                                /* [nx] of computed derivatives */
  double *spectrum, *coefficients;                              /* scratch of collocation.c */
  double *sampled, *fitted; /* [n x nx x nsample], [nterm x n x nx] derivatives at the nodes: of the curves and of the
                             ** coefficients */
  double *scratch;
  double t, t_next, h;
  uint32_t next;
  int at_instant, cut; /* does the step end at an instant that was asked for? is it shorter than was asked for? */
  double guess, rate_known, *magnitude, *limit;
  uint32_t blamed;
  int kink, has_faces;       /* the tube reaches one; the box of the faces goes on from the step before */
  int is_smooth;             /* no operation of the right-hand side has a kink */
  int is_cut;                /* and [lo, hi] is that box's intersection with the set's hull */
  const char *kink_name;     /* of the one that the last tube reached, as the tape names it; or NULL */
  double *face_lo, *face_hi; /* [nx] */
  double *lo, *hi, *tube_lo, *tube_hi, *dense_mid, *dense_rad, *rest;
  double *set_about, *set_scale;
} valencia;

/* plugin.c */
extern const ambit_param valencia_param[];

/* open.c */
ambit_status valencia_open(const ambit_host *h, const ambit_problem *p, const double *option, void **self);
void valencia_close(void *self);

/* origin.c: P, B, w and parameters at the start; AMBIT_F_* */
uint32_t valencia_origin(valencia *s, ambit_lane *initial, interval *range, interval *slope);

/* point.c: f and its derivatives by states and parameters at a point, in plain doubles; 0: not finite */
int valencia_point(const valencia *s, const double *x, const double *p, double t, double *f, double *df);

/* collocation.c */
int valencia_stages_open(valencia *s);
/* p(sigma, xi) and B(sigma) of the step from t to t_next; 0: there is none */
int valencia_curve(valencia *s);
/* leaves only the middle curve moving, as the natural evaluation over a box wants it */
void valencia_freeze(valencia *s);

/* terms.c */
int valencia_terms_open(valencia *s);
/* c := coefficients from values at the samples; noise: what is not distinguished from 0 */
void valencia_terms_fit(const terms *t, const double *value, double noise, double *c);
interval valencia_terms_range(const terms *t, uint32_t nu, const double *coefficient, size_t stride);

/* symbols.c */
int valencia_symbols_open(valencia *s);
void valencia_symbols_close(valencia *s);
/* bounds of all slots at x = p(sigma, xi) +- radius (NULL: 0), for all xi or only xi = 0; out := half f - p' */
uint32_t valencia_symbols_run(valencia *s, const double *radius, int only_middle, interval *out);

/* slope.c: slopes of every slot of the tape by its inputs, given bounds of all slots; 0: some output has none */
int valencia_slopes(const ambit_num_service *num, const ambit_tape *t, uint32_t ndir, const double *lo,
    const double *hi, interval *slope);

/* series.c: defect of the middle curve, by its power series; 0: there is none */
int valencia_series(valencia *s, interval *defect);
/* residuals of the columns, after the middle curve; 0: no series */
int valencia_column_series(valencia *s);

/* verify.c */
enum why valencia_verify(valencia *s);
/* from the derivatives at the middle of the step: the basis, and what of B is kept apart from r */
void valencia_choose_basis(valencia *s, const double *jacobian);

/* eigen.c: a basis of (nearly) eigenvectors of the matrix a [n x n], or unit vectors */
int valencia_eigenbasis(valencia *s, const double *a);
void valencia_unit_basis(valencia *s);

/* faces.c: the box [lo, hi] at the start of the step -> one at its end, by the tube; 0: not evaluated */
int valencia_faces(valencia *s, double *lo, double *hi);
int valencia_at_kink(valencia *s);
int valencia_is_smooth(const ambit_tape *t); /* it has no kink anywhere */

/* frame.c: the set at the end of the step */
void valencia_move(valencia *s);

/* run.c */
ambit_status valencia_run(void *self, ambit_sink *sink);
#endif
