/* polynomial.h -- polynomials of total degree <= d in m unknowns of [-1, 1], with double coefficients and one radius.
**
** Monomials lie in rows: a row is a monomial in the unknowns 1 .. m-1, its elements are the powers of unknown 0, so a
** product is a sum of convolutions of rows, and one unknown is one row. Rows are padded with zeros to multiples of four
** doubles, with four more zeros in front, which the convolution reads. A `cell` is a polynomial with norms by degree,
**   |f - p| <= rad on [-1, 1]^m.
** All arithmetic on coefficients is in upward mode; what rounding may have changed goes into the radius by a-priori
** bounds, gamma(n) = n u / (1 - n u), u = 2^-52, times magnitudes [Higham, Accuracy and Stability, ch. 3]. Proofs:
** docs/numerics/taylor_flow.md.
*/
#ifndef TAYLOR_MODEL_POLYNOMIAL_H
#define TAYLOR_MODEL_POLYNOMIAL_H
#include <ambit/rounding.h>
#include <ambit/solver.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define DEGREE_MAX 31
#define MONOMIALS_MAX 2000
#define UNKNOWNS_MAX 64
#define NO_ROW UINT32_MAX
#define TINY 0x1p-1000 /* more than what underflows in any sum here */

typedef double four __attribute__((vector_size(32), aligned(8), may_alias));

typedef struct row {
  uint32_t degree, length, groups; /* of the monomial; coefficients; groups of four doubles */
  uint32_t at;                     /* its first coefficient */
} row;

typedef struct pair { /* rows a times b */
  uint32_t a, b;
} pair;

struct sum;
struct series_part;
typedef struct space {
  uint32_t m, d, nrow, count; /* count: monomials */
  uint32_t terms;             /* most products that one coefficient of a product is a sum of */
  size_t size, degrees;       /* doubles of the coefficients, of a list by degree; multiples of four */
  size_t stride;              /* doubles of a cell */
  row *row;
  uint32_t *exponent; /* [nrow x m] of the row's monomial; that of unknown 0 is 0 */
  uint32_t *next;     /* [m x nrow] the row with one more of the unknown, or NO_ROW */
  pair *pair;
  uint32_t *pairs; /* [nrow + 1] the pairs whose product is in row r begin here */
  void (*convolve)(const struct space *s, struct sum *x, const struct series_part *of);
} space;

/* sum_{j=from}^{to} factor a_j b_(k-j), each term times j if `weighted`; a, b: rows of cells, order 0 first */
typedef struct series_part {
  double *a, *b;
  uint32_t from, to, k, weighted;
  double factor;
} series_part;

/* a polynomial in memory: `stride` doubles */
typedef struct cell {
  double *c;   /* [size] */
  double *deg; /* [degrees] sums of magnitudes by degree */
  double *suf; /* [degrees] suf[i]: sum of deg[j] with i + j > d */
  double *info;
} cell;
enum { NORM, RAD, TOP }; /* in info: sum of deg; radius; highest degree with a coefficient (-1: none) */

static inline cell cell_at(const space *s, double *base, size_t number) {
  double *c = base + number * s->stride;
  return (cell) { c, c + s->size, c + s->size + s->degrees, c + s->size + 2 * s->degrees };
}
static inline double cell_norm(cell x) { return x.info[NORM]; }
static inline double cell_rad(cell x) { return x.info[RAD]; }
static inline int cell_is_zero(cell x) { return x.info[TOP] < 0 && x.info[RAD] == 0; }

/* a sum of products on the way */
typedef struct sum {
  double *c;     /* [size] */
  double cut;    /* bound of what is beyond degree d */
  double rad;    /* bound of what the radii of the factors make different */
  double weight; /* sum of products of norms, for rounding */
  uint32_t count;
} sum;

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }
static inline double gamma_of(double n) { return n * 0x1p-52 / -(n * 0x1p-52 - 1); }

/* where the coefficient of unknown v alone lies; d > 0 */
static inline size_t polynomial_linear(const space *s, uint32_t v) {
  return v == 0 ? s->row[0].at + 1u : s->row[s->next[(size_t)v * s->nrow]].at;
}

ambit_status space_open(const ambit_host *h, space *s, uint32_t m, uint32_t d);
uint64_t space_count(uint32_t m, uint32_t d); /* monomials */
void sum_convolve_portable(const space *s, struct sum *x, const series_part *of);
void sum_convolve_avx2(const space *s, struct sum *x, const series_part *of);

/* -- cells; upward mode */
void cell_clear(const space *s, cell x);
void cell_finish(const space *s, cell x, double rad); /* norms of the coefficients that are there */
void cell_constant(const space *s, cell x, double mid, double rad);
void cell_copy(const space *s, cell to, cell from);
void cell_add(const space *s, cell to, cell a, cell b, double sign); /* a + sign b, sign 1 or -1 */
void cell_scale(const space *s, cell to, cell a, double factor);
void cell_euler(const space *s, cell to, cell a); /* sum of xi_j times the derivative by xi_j; rounding not in rad */

void sum_clear(const space *s, sum *x);
void sum_add(const space *s, sum *x, double factor, cell a, cell b); /* factor a b */
void sum_take(const space *s, const sum *x, double factor, cell to); /* factor times the sum */
double sum_rounding(const space *s, const sum *x);

/* out := coefficients of p(about + reach eta), eta in [-1, 1]^m, |about| + reach <= 1; returns a bound of what rounding
** changed. out may be p. */
double polynomial_restrict(const space *s, const double *p, const double *about, const double *reach, double *out);
double polynomial_norm(const space *s, const double *p);
/* low, high of a polynomial over the cube, from its coefficients */
void polynomial_bounds(const space *s, const double *p, double *low, double *high);
/* about its value at a vertex of the cube, and the same rounded to either side */
void polynomial_vertex(const space *s, const double *p, int upper, double *low, double *high);
#endif
