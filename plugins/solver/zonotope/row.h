/* row.h -- rows: polynomials with point coefficients, of degree 2 in xi [m], 1 in eps [nx], and 1 in each of xi and eps.
**
** A row is  c | xi [m] | eps [nx] | xi xi | xi eps | L R Q X:  pairs xi_i xi_j of i <= j, row by row, j < reach[i] only;
** xi_j eps_i for j < mixed, j-major; then the norms of the four parts (sums of absolute values). Data are numbered by
** how much they matter, so that pairs left out are those at the end. A monomial that a row does not hold is dropped from
** every product.
*/
#ifndef ZONOTOPE_ROW_H
#define ZONOTOPE_ROW_H
#include <ambit/base.h>
#include <math.h>
#include <string.h>

struct terms;

typedef struct shape {
  uint32_t m, nx;
  uint32_t *reach; /* [m] pairs (i, j) with i <= j < reach[i]; falling; none in row i if reach[i] <= i */
  uint32_t mixed;  /* data that have terms with eps */
  uint32_t eps;    /* 1 + m: where linear terms in eps start */
  uint32_t mix;    /* where xi eps starts */
  uint32_t norms;  /* where L R Q X are; also the number of coefficients */
  uint32_t stride; /* doubles of a row, a multiple of 4 */
  uint32_t *pair;  /* [m + 1] where row i of the pairs starts: xi_i xi_j is at pair[i] + j - i; pair[0] = 1 + m + nx */
  void (*sum)(const struct shape *s, const struct terms *t, double *to); /* portable.c, avx2.c */
} shape;

int shape_open(const ambit_host *h, shape *s, uint32_t m, uint32_t nx); /* all pairs; 0: no memory */
void shape_place(shape *s);                                             /* offsets, from reach and mixed */

static inline double row_l(const shape *s, const double *x) { return x[s->norms]; }
static inline double row_r(const shape *s, const double *x) { return x[s->norms + 1]; }
static inline double row_q(const shape *s, const double *x) { return x[s->norms + 2]; }
static inline double row_x(const shape *s, const double *x) { return x[s->norms + 3]; }
/* everything but the constant; everything */
static inline double row_moving(const shape *s, const double *x) {
  const double *n = x + s->norms;
  return n[0] + n[1] + n[2] + n[3];
}
static inline double row_total(const shape *s, const double *x) { return fabs(x[0]) + row_moving(s, x); }

/* sum of absolute values of all coefficients that a product of these rows has and a (*) b does not, but for rounding:
** only nonnegative terms are added */
double row_dropped(const shape *s, const double *a, const double *b);

void row_constant(const shape *s, double *to, double c);
void row_norms(const shape *s, double *x);                                 /* brings L R Q X up to date */
void row_scale(const shape *s, double *to, double scale, const double *a); /* to := scale a; may be a */

/* -- a sum of multiples of rows and of products of rows, made in one go */

#define TERMS 512

typedef struct terms {
  double c;
  uint32_t nrow, nouter;
  struct {
    double scale;
    const double *x;
  } row[TERMS]; /* scale times x but its constant */
  struct {
    double scale;
    const double *a, *b;
  } outer[TERMS]; /* scale times the products of linear parts */
} terms;

static inline void terms_clear(terms *t) { t->c = 0, t->nrow = t->nouter = 0; }
void terms_moving(const shape *s, terms *t, double scale, const double *x); /* scale (x - its constant) */
void terms_row(const shape *s, terms *t, double scale, const double *x);
void terms_outer(const shape *s, terms *t, double scale, const double *a, const double *b); /* without constants */
void terms_product(const shape *s, terms *t, double scale, const double *a, const double *b);
void terms_sum(const shape *s, const terms *t, double *to); /* with norms; `to` is none of the operands */
/* to := the function with value g, first and second derivative g1, g2 at the constant of a */
void row_function(const shape *s, double *to, const double *a, double g, double g1, double g2);
static inline void row_inverse(const shape *s, double *to, const double *a) {
  double i = 1 / a[0];
  row_function(s, to, a, i, -i * i, 2 * i * i * i);
}

void sum_portable(const shape *s, const terms *t, double *to);
#if defined(__x86_64__)
void sum_avx2(const shape *s, const terms *t, double *to);
#endif
#endif
