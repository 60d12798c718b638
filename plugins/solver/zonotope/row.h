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
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct shape {
  uint32_t m, nx;
  uint32_t *reach;  /* [m] pairs (i, j) with i <= j < reach[i]; falling, and reach[i] > i or no pair in row i */
  uint32_t mixed;   /* data that have terms with eps */
  uint32_t eps;     /* 1 + m: where linear terms in eps start */
  uint32_t pairs;   /* where xi xi starts */
  uint32_t mix;     /* where xi eps starts */
  uint32_t norms;   /* where L R Q X are; also the number of coefficients */
  uint32_t stride;  /* doubles of a row, a multiple of 4 */
  uint32_t *pair;   /* [m] where row i of the pairs starts: xi_i xi_j is at pair[i] + j - i */
  /* to += scale sum_{j < n} a_j (*) b_j; norms of `to` are not updated; portable.c or avx2.c */
  void (*products)(const struct shape *s, double *to, double scale, const double *const *a, const double *const *b,
      const double *factor, uint32_t n);
} shape;

int shape_open(const ambit_host *h, shape *s, uint32_t m, uint32_t nx); /* all pairs; 0: no memory */

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

void row_zero(const shape *s, double *to);
void row_constant(const shape *s, double *to, double c);
void row_norms(const shape *s, double *x); /* brings L R Q X up to date */
void row_add(const shape *s, double *to, double scale, const double *a); /* to += scale a, norms left as they are */
void row_scale(const shape *s, double *to, double scale, const double *a); /* to := scale a, norms too */
/* to += scale a (*) b, norms left as they are; to is neither a nor b */
void row_product(const shape *s, double *to, double scale, const double *a, const double *b);
/* to := 1 / a in the ring; a's constant is not 0 */
void row_inverse(const shape *s, double *to, const double *a, double *scratch);
#endif
