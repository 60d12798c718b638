/* row.h -- rows: polynomials with point coefficients, of degree 3 in xi [m], 1 in eps [nx], and 1 in each of xi and
** eps.
**
** A row is c | xi [m] | eps [nx] | xi xi | xi eps | norms | low | xi xi xi: the constant is c + low; where there are no
** data c | norms | low | eps. Pairs xi_i xi_j of i <= j, row by row, j < reach[i] only; xi_j eps_i for j < mixed,
** j-major; triples of i <= j <= k < cubic, in the same order. Rows of higher orders in time do not hold all of these
** parts (row_parts): what they would add is small, for it has a power of the step before it. A monomial that a row does
** not hold is dropped from every product; sums lose nothing, for what they add up is of the same order in time. Norms
** are sums of absolute values: of each part, and of the linear terms and pairs that have no triples (FAR). The
** coefficients of a part whose norm is 0 are not there: nothing reads them, and they may be anything.
*/
#ifndef ZONOTOPE_ROW_H
#define ZONOTOPE_ROW_H
#include <ambit/work.h>
#include <ambit/base.h>
#include <ambit/double_double.h>
#include <math.h>
#include <string.h>

struct terms;
enum part { PAIRS = 1, MIXED = 2, TRIPLES = 4, ERRORS = 8 }; /* of a row: xi xi, xi eps, xi xi xi, eps */
enum { NORM_L, NORM_R, NORM_Q, NORM_X, NORM_C, NORM_L_FAR, NORM_Q_FAR, NORMS, LOW = NORMS, ENDS };

typedef struct shape {
  uint32_t m, nx;
  uint32_t *reach;                /* [m] pairs (i, j) with i <= j < reach[i]; falling; none in row i if reach[i] <= i */
  uint32_t mixed;                 /* data that have terms with eps */
  uint32_t eps;                   /* 1 + m: where linear terms in eps start */
  uint32_t mix;                   /* where xi eps starts */
  uint32_t cubic;                 /* data that have triples; reach[i] >= cubic for each of them */
  uint32_t paired, mixing, cubed; /* orders in time whose rows hold pairs, xi eps, triples; cubed <= paired; */
  uint32_t erring;                /* eps; mixing <= erring */
  uint32_t room;                  /* orders in time whose rows have room for triples; cubed <= room */
  int lean;                       /* there are no data: eps come last, and room is for them; erring <= room */
  uint32_t norms;                 /* where norms are; also the number of coefficients before them */
  uint32_t cube;                  /* where triples start; a multiple of 4, and the length of a row without them */
  uint32_t triples;
  uint32_t stride; /* doubles of a row with triples, a multiple of 4 */
  double *scratch; /* [3 x stride] */
  uint32_t *pair;  /* [m + 1] where row i of the pairs starts: xi_i xi_j is at pair[i] + j - i; pair[0] = 1 + m + nx */
  ambit_work *counted;                                                                   /* or NULL */
  void (*sum)(const struct shape *s, const struct terms *t, double *to, uint32_t parts); /* portable.c, avx2.c */
} shape;

int shape_open(const ambit_host *h, shape *s, uint32_t m, uint32_t nx); /* all pairs; 0: no memory */
void shape_lean(shape *s);     /* of a shape without data: the short rows of high orders have no room for eps */
void shape_hold_all(shape *s); /* every order in time holds every part that it has room for */
void shape_place(shape *s);    /* offsets, from reach, mixed and cubic */

/* what rows of order k hold */
static inline uint32_t row_parts(const shape *s, uint32_t k) {
  return (k < s->paired ? PAIRS : 0u) | (k < s->mixing ? MIXED : 0u) | (k < s->cubed ? TRIPLES : 0u) |
         (k < s->erring ? ERRORS : 0u);
}
static inline double row_l(const shape *s, const double *x) { return x[s->norms + NORM_L]; }
static inline double row_r(const shape *s, const double *x) { return x[s->norms + NORM_R]; }
static inline double row_q(const shape *s, const double *x) { return x[s->norms + NORM_Q]; }
static inline double row_x(const shape *s, const double *x) { return x[s->norms + NORM_X]; }
static inline double row_c(const shape *s, const double *x) { return x[s->norms + NORM_C]; }
/* of degree 2 and more; everything but the constant; everything */
static inline double row_bent(const shape *s, const double *x) { return row_q(s, x) + row_x(s, x) + row_c(s, x); }
static inline double row_moving(const shape *s, const double *x) { return row_l(s, x) + row_r(s, x) + row_bent(s, x); }
/* the constant: |low| <= 2^-53 |c| */
static inline double row_low(const shape *s, const double *x) { return x[s->norms + LOW]; }
static inline dd row_middle(const shape *s, const double *x) { return dd_make(x[0], row_low(s, x)); }
static inline double row_total(const shape *s, const double *x) { return fabs(x[0]) + row_moving(s, x); }

/* sum of absolute values of all coefficients that a product of these rows has and a (*) b, which holds these parts,
** does not, but for rounding: only nonnegative terms are added */
double row_dropped(const shape *s, const double *a, const double *b, uint32_t parts);
/* the same of (x - its constant)^3 and what a row of order 0 holds of it */
double row_dropped_cube(const shape *s, const double *x);
/* sizes of the parts of x that a row with these parts does not hold */
double row_lost(const shape *s, const double *x, uint32_t parts);

void row_constant(const shape *s, double *to, double c);
void row_norms(const shape *s, double *x);     /* brings norms up to date, all but that of triples: C stays */
void row_norms_all(const shape *s, double *x); /* of a row with triples */
/* to := a / n, of the parts that it is to hold; may be a */
void row_over(const shape *s, double *to, double n, const double *a, uint32_t parts);
/* to += scale a, but for norms and low; all parts are there in `to` */
void row_add(const shape *s, double *to, double scale, const double *a);
/* to := a, and 0 for parts that are not there */
void row_copy(const shape *s, double *to, const double *a);

/* -- a sum of multiples of rows and of products of rows, made in one go */

#define TERMS 512

typedef struct scaled_row {
  double scale;
  const double *x;
} scaled_row;

typedef struct scaled_product {
  double scale;
  const double *a, *b;
} scaled_product;

typedef struct terms {
  double c,
      low; /* the constant c + low: all products and sums in c are exact, what they round by is summed up in low */
  uint32_t nrow, nouter, nbend;
  scaled_row row[TERMS]; /* scale times x but its constant */
  scaled_product outer[TERMS],
      bend[2 * TERMS]; /* scale times the product of linear parts; of the linear part of a and pairs of b */
} terms;

static inline void terms_clear(terms *t) { t->c = t->low = 0, t->nrow = t->nouter = t->nbend = 0; }
void terms_moving(const shape *s, terms *t, double scale, const double *x); /* scale (x - its constant) */
void terms_row(const shape *s, terms *t, double scale, const double *x);
void terms_outer(const shape *s, terms *t, double scale, const double *a, const double *b); /* without constants */
void terms_product(const shape *s, terms *t, double scale, const double *a, const double *b);
/* scale j / k, to twice the digits for the constant */
void terms_share(const shape *s, terms *t, double scale, uint32_t j, uint32_t k, const double *a, const double *b);
/* with norms and these parts; `to` is none of the operands */
void terms_sum(const shape *s, const terms *t, double *to, uint32_t parts);
/* to := the function with this value, and derivatives g[1] on, at the constant of a; a row of order 0 */
void row_function(const shape *s, double *to, const double *a, dd value, const double g[4]);
void row_inverse(const shape *s, double *to, const double *a);

void sum_portable(const shape *s, const terms *t, double *to, uint32_t parts);
#if defined(__x86_64__)
void sum_avx2(const shape *s, const terms *t, double *to, uint32_t parts);
#endif
#endif
